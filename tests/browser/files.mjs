// SPDX-License-Identifier: GPL-3.0-or-later
// Checks reports' files for machines: scene.glb by Khronos' validator, study.json by its schema. Run as
//   node files.mjs SCHEMA REPORT...
import assert from "node:assert/strict";
import path from "node:path";
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";

const require = createRequire(process.env.CLERESTORY_NODE ? `${process.env.CLERESTORY_NODE}/package.json` : import.meta.url);
const validator = require("gltf-validator");
const { default: Ajv } = require("ajv/dist/2020");

const [schemaFile, ...reports] = process.argv.slice(2);
const schema = JSON.parse(await readFile(schemaFile, "utf8"));
const validate = new Ajv({ allErrors: true, strict: true, allowUnionTypes: true }).compile(schema);

for (const report of reports) {
  const name = path.basename(report);
  const bytes = new Uint8Array(await readFile(path.join(report, "scene.glb")));
  const { issues, info } = await validator.validateBytes(bytes, { maxIssues: 20 });
  assert.deepEqual(issues.messages, [], name);
  assert.ok(info.totalTriangleCount > 0, name);
  assert.ok(!info.resources.some((resource) => resource.storage === "external"), name);
  console.log(`passed: ${name}: scene.glb is valid, ${info.totalTriangleCount} triangles`);

  const study = JSON.parse(await readFile(path.join(report, "study.json"), "utf8"));
  validate(study);
  assert.deepEqual(validate.errors, null, name);
  study.rooms[0].colour = "a key that nobody has documented";
  assert.equal(validate(study), false, name);
  console.log(`passed: ${name}: study.json keeps to its schema`);
}
