// SPDX-License-Identifier: GPL-3.0-or-later
// Checks a report's files for machines: scene.glb by Khronos' validator, study.json by its schema. Run as
//   node files.mjs REPORT SCHEMA
import assert from "node:assert/strict";
import path from "node:path";
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";

const require = createRequire(process.env.CLERESTORY_NODE ? `${process.env.CLERESTORY_NODE}/package.json` : import.meta.url);
const validator = require("gltf-validator");
const { default: Ajv } = require("ajv/dist/2020");

const [report, schemaFile] = process.argv.slice(2);

const bytes = new Uint8Array(await readFile(path.join(report, "scene.glb")));
const { issues, info } = await validator.validateBytes(bytes, { maxIssues: 20 });
assert.deepEqual(issues.messages, []);
assert.ok(info.totalTriangleCount > 0);
assert.ok(!info.resources.some((resource) => resource.storage === "external"));
console.log(`passed: scene.glb is valid, ${info.totalTriangleCount} triangles`);

const study = JSON.parse(await readFile(path.join(report, "study.json"), "utf8"));
const validate = new Ajv({ allErrors: true, strict: true, allowUnionTypes: true }).compile(JSON.parse(await readFile(schemaFile, "utf8")));
validate(study);
assert.deepEqual(validate.errors, null);
study.rooms[0].colour = "a key that nobody has documented";
assert.equal(validate(study), false);
console.log("passed: study.json keeps to its schema");
