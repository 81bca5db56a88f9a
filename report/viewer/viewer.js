// SPDX-License-Identifier: GPL-3.0-or-later
// The building in 3D: the solution's elements in the page, to be turned, walked through, cut and asked.
import {
  Box3,
  BufferAttribute,
  BufferGeometry,
  Color,
  DataTexture,
  DoubleSide,
  FrontSide,
  LinearFilter,
  Mesh,
  PerspectiveCamera,
  Raycaster,
  Scene,
  ShaderMaterial,
  SRGBColorSpace,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { readMesh, triangulate, valueOf } from "./mesh.js";
import { Walk } from "./walk.js";

const vertexShader = `
  attribute float illuminance;
  attribute float exitance;
  attribute vec3 tint;
  attribute float row;
  uniform float metres;
  varying float vIlluminance;
  varying vec3 vExitance;
  varying vec3 vPlace;
  varying float vRow;
  float valueOf(float code) { return code > 0.5 ? exp2((code - 1.0) / 16382.0 * 40.0 - 14.0) : 0.0; }
  void main() {
    vec3 place = position * metres;
    vIlluminance = valueOf(illuminance);
    vExitance = valueOf(exitance) * 4.0 * tint;
    vPlace = place;
    vRow = row;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;

// Display colours follow the pictures: a curve that bends at the top instead of clipping, then sRGB.
const fragmentShader = `
  uniform sampler2D ramp;
  uniform vec2 scale;
  uniform bool falseColour;
  uniform float exposure;
  uniform vec4 section;
  uniform float picked;
  uniform float alpha;
  varying float vIlluminance;
  varying vec3 vExitance;
  varying vec3 vPlace;
  varying float vRow;
  vec3 srgb(vec3 c) { return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c)); }
  void main() {
    if (dot(section.xyz, vPlace) > section.w) discard;
    vec3 colour;
    if (falseColour) {
      float at = (log2(max(vIlluminance, 1e-6)) - scale.x) / (scale.y - scale.x);
      colour = texture2D(ramp, vec2(clamp(at, 0.002, 0.998), 0.5)).rgb;
    } else {
      vec3 light = exposure * vExitance;
      colour = srgb(clamp(light * (1.0 + light / 9.0) / (1.0 + light), 0.0, 1.0));
    }
    if (abs(vRow - picked) < 0.5) colour = mix(colour, vec3(1.0, 0.55, 0.1), 0.45);
    gl_FragColor = vec4(colour, alpha);
  }`;

/** A one-row texture of the legend's colours, from dark to light. */
function rampTexture(colours) {
  const bytes = new Uint8Array(colours.length * 4);
  colours.forEach((hex, i) => {
    for (let c = 0; c < 3; ++c) bytes[4 * i + c] = parseInt(hex.slice(1 + 2 * c, 3 + 2 * c), 16);
    bytes[4 * i + 3] = 255;
  });
  const texture = new DataTexture(bytes, colours.length, 1);
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

/** The surfaces of `rows` as one drawable; corners are shared, only triangles are chosen. */
function drawable(shared, triangles, uniforms, alpha) {
  const geometry = new BufferGeometry();
  for (const [name, attribute] of Object.entries(shared)) geometry.setAttribute(name, attribute);
  geometry.setIndex(new BufferAttribute(triangles, 1));
  const material = new ShaderMaterial({
    vertexShader,
    fragmentShader,
    uniforms: { ...uniforms, alpha: { value: alpha } },
    side: alpha < 1 ? DoubleSide : FrontSide,
    transparent: alpha < 1,
    depthWrite: alpha === 1,
  });
  return new Mesh(geometry, material);
}

/**
 * Moves corners two steps outwards, so that no crack shows where a large element meets small ones. Panes stay: what
 * shines through twice where they overlap would show.
 */
function swell(mesh, glass) {
  let first = 0;
  for (const count of mesh.counts) {
    if (glass.has(mesh.rowOfCorner[first])) {
      first += count;
      continue;
    }
    const middle = [0, 0, 0];
    for (let i = 0; i < 3 * count; ++i) middle[i % 3] += mesh.positions[3 * first + i] / count;
    for (let corner = first; corner < first + count; ++corner) {
      const way = middle.map((m, axis) => mesh.positions[3 * corner + axis] - m);
      const factor = 2 / Math.max(Math.hypot(...way), 2);
      for (let axis = 0; axis < 3; ++axis) {
        const moved = mesh.positions[3 * corner + axis] + Math.round(factor * way[axis]);
        mesh.positions[3 * corner + axis] = Math.max(0, Math.min(65535, moved));
      }
    }
    first += count;
  }
  return mesh;
}

class Viewer {
  constructor(host, info, mesh) {
    this.host = host;
    this.info = info;
    this.glass = new Set(info.glass);
    this.mesh = swell(mesh, this.glass);
    this.canvas = host.querySelector("canvas");
    this.renderer = new WebGLRenderer({ canvas: this.canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.scene = new Scene();
    this.inside = new Box3(new Vector3(...info.inside_low_m), new Vector3(...info.inside_high_m));
    this.uniforms = {
      ramp: { value: rampTexture(info.colours) },
      scale: { value: new Vector2(Math.log2(info.low_lx), Math.log2(info.high_lx)) },
      metres: { value: info.step_m },
      falseColour: { value: false },
      exposure: { value: info.exposure },
      section: { value: [0, 0, 1, 1e9] },
      picked: { value: -1 },
    };
    this.build();
    this.placeCamera();
    this.orbit = new OrbitControls(this.camera, this.canvas);
    this.inside.getCenter(this.orbit.target);
    this.orbit.addEventListener("change", () => this.draw());
    this.orbit.update();
    this.orbit.saveState();
    this.walk = new Walk(this.camera, this.canvas, info, () => this.draw());
    this.connect();
    new ResizeObserver(() => this.resize()).observe(this.canvas.parentElement);
    this.resize();
    host.dataset.ready = "true";
  }

  build() {
    const { mesh, info, glass } = this;
    const shared = {
      position: new BufferAttribute(mesh.positions, 3),
      illuminance: new BufferAttribute(mesh.illuminance, 1),
      exitance: new BufferAttribute(mesh.exitance, 1),
      tint: new BufferAttribute(mesh.tint, 3, true),
      row: new BufferAttribute(mesh.rowOfCorner, 1),
    };
    this.solid = drawable(shared, triangulate(mesh, (row) => !glass.has(row)), this.uniforms, 1);
    this.panes = drawable(shared, triangulate(mesh, (row) => glass.has(row)), this.uniforms, 0.35);
    for (const part of [this.solid, this.panes]) {
      part.scale.setScalar(info.step_m);
      part.frustumCulled = false;
      this.scene.add(part);
    }
  }

  /** Looks down at the rooms from the south-west, from so far that they just fit into the picture. */
  placeCamera() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    const aspect = width / height || 1;
    const middle = this.inside.getCenter(new Vector3());
    const radius = Math.max(0.5 * this.inside.getSize(new Vector3()).length(), 0.5);
    const all = new Vector3(...this.info.size_m).length();
    this.camera = new PerspectiveCamera(45, aspect, radius / 500, 12 * radius + all);
    this.camera.up.set(0, 0, 1);
    this.camera.position.copy(middle).add(new Vector3(-0.75, -1.1, 0.95));
    this.camera.lookAt(middle);
    const slope = Math.tan((0.5 * 45 * Math.PI) / 180);
    const turned = this.camera.quaternion.clone().invert();
    let away = 0.5;
    for (let corner = 0; corner < 8; ++corner) {
      const at = [0, 1, 2].map((axis) => (corner & (1 << axis) ? this.inside.max : this.inside.min).getComponent(axis));
      const { x, y, z } = new Vector3(...at).sub(middle).applyQuaternion(turned);
      away = Math.max(away, z + Math.abs(y) / slope, z + Math.abs(x) / (slope * aspect));
    }
    this.camera.position.copy(middle).addScaledVector(new Vector3(0, 0, 1).applyQuaternion(this.camera.quaternion), 1.06 * away);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      const paper = getComputedStyle(this.host).getPropertyValue("--tint").trim();
      this.renderer.setClearColor(new Color(paper || "#888888"));
      this.renderer.render(this.scene, this.camera);
    });
  }

  connect() {
    const control = (name) => this.host.querySelector(`[data-viewer="${name}"]`);
    control("colours").addEventListener("change", (event) => this.showColours(event.target.value));
    control("motion").addEventListener("change", (event) => this.move(event.target.value));
    control("axis").addEventListener("change", () => this.cut());
    control("section").addEventListener("input", () => this.cut());
    control("exposure").addEventListener("input", (event) => {
      this.uniforms.exposure.value = this.info.exposure * 2 ** Number(event.target.value);
      this.draw();
    });
    control("reset").addEventListener("click", () => this.reset());
    this.pickOnClick();
    new MutationObserver(() => this.draw()).observe(document.documentElement, { attributes: true });
    this.cut();
    this.showColours(control("colours").value);
  }

  showColours(kind) {
    const isFalse = kind === "illuminance";
    this.uniforms.falseColour.value = isFalse;
    this.host.querySelector(".legend3d").hidden = !isFalse;
    this.draw();
  }

  move(kind) {
    const walks = kind === "walk";
    this.camera.fov = walks ? 65 : 45;
    this.camera.updateProjectionMatrix();
    this.orbit.enabled = !walks;
    this.walk.enable(walks);
    if (!walks) this.reset();
    this.draw();
  }

  reset() {
    const motion = this.host.querySelector('[data-viewer="motion"]');
    if (motion.value === "walk") {
      this.walk.begin();
      return;
    }
    this.orbit.reset();
    this.draw();
  }

  /** Takes away what lies beyond the section plane. */
  cut() {
    const axis = { x: 0, y: 1, z: 2 }[this.host.querySelector('[data-viewer="axis"]').value];
    const slider = this.host.querySelector('[data-viewer="section"]');
    const normal = [0, 0, 0];
    normal[axis] = 1;
    const [low, high] = [this.info.inside_low_m[axis], this.info.inside_high_m[axis]];
    const at = low + (Number(slider.value) / Number(slider.max)) * (high - low);
    const whole = slider.value === slider.max;
    this.uniforms.section.value = [...normal, whole ? 1e9 : at];
    const text = whole ? "whole" : `${(at + this.info.origin_m[axis]).toFixed(2)} m`;
    this.host.querySelector('[data-viewer="section-text"]').textContent = text;
    slider.setAttribute("aria-valuetext", text);
    this.draw();
  }

  pickOnClick() {
    let start = null;
    this.canvas.addEventListener("pointerdown", (event) => (start = [event.clientX, event.clientY]));
    this.canvas.addEventListener("pointerup", (event) => {
      if (!start || Math.hypot(event.clientX - start[0], event.clientY - start[1]) > 4) return;
      const box = this.canvas.getBoundingClientRect();
      this.pick((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
    });
    this.canvas.addEventListener("keydown", (event) => {
      if (event.key === "Enter") this.pick(0.5, 0.5);
      else if (this.orbit.enabled) this.turn(event);
    });
  }

  /** Goes round the building by arrow keys, nearer and farther by plus and minus. */
  turn(event) {
    const step = Math.PI / 24;
    const [around, down, scale] =
      { ArrowLeft: [-1, 0, 1], ArrowRight: [1, 0, 1], ArrowUp: [0, -1, 1], ArrowDown: [0, 1, 1],
        "+": [0, 0, 0.88], "-": [0, 0, 1 / 0.88] }[event.key] ?? [0, 0, 0];
    if (!scale) return;
    event.preventDefault();
    const way = this.camera.position.clone().sub(this.orbit.target).multiplyScalar(scale);
    const fromTop = Math.acos(way.z / way.length());
    const turned = Math.min(Math.max(fromTop + down * step, 0.02), Math.PI - 0.02);
    const direction = Math.atan2(way.y, way.x) + around * step;
    const flat = way.length() * Math.sin(turned);
    const up = way.length() * Math.cos(turned);
    this.camera.position.set(flat * Math.cos(direction), flat * Math.sin(direction), up).add(this.orbit.target);
    this.orbit.update();
  }

  /** Asks the surface under a point of the picture, [0, 1] from its upper left corner. */
  pick(x, y) {
    const caster = new Raycaster();
    caster.setFromCamera(new Vector2(2 * x - 1, 1 - 2 * y), this.camera);
    const [nx, ny, nz, limit] = this.uniforms.section.value;
    const hit = caster
      .intersectObject(this.solid)
      .find(({ point }) => nx * point.x + ny * point.y + nz * point.z <= limit);
    this.uniforms.picked.value = -1;
    this.draw();
    const text = this.host.querySelector(".picked");
    if (!hit) {
      text.textContent = "There is no surface here.";
      return;
    }
    const row = this.mesh.rowOfCorner[hit.face.a];
    this.uniforms.picked.value = row;
    this.tell(text, row, this.valueAt(hit));
  }

  /** Illuminance at a hit: of its corners, by their nearness. */
  valueAt(hit) {
    let sum = 0;
    let weights = 0;
    for (const corner of [hit.face.a, hit.face.b, hit.face.c]) {
      const way = new Vector3(...this.mesh.positions.subarray(3 * corner, 3 * corner + 3))
        .multiplyScalar(this.info.step_m)
        .distanceTo(hit.point);
      const weight = 1 / Math.max(way, 1e-4);
      sum += weight * valueOf(this.mesh.illuminance[corner]);
      weights += weight;
    }
    return sum / weights;
  }

  tell(host, row, here_lx) {
    const source = document.getElementById(`surface-${row}`);
    host.replaceChildren();
    const list = document.createElement("dl");
    const add = (label, value) => {
      const pair = document.createElement("div");
      const dt = document.createElement("dt");
      const dd = document.createElement("dd");
      dt.textContent = label;
      dd.textContent = value;
      pair.append(dt, dd);
      list.append(pair);
    };
    add("Here", `${here_lx >= 10 ? Math.round(here_lx) : here_lx.toPrecision(2)} lx`);
    const heads = source ? source.closest("table").tHead.rows[0].cells : [];
    for (let c = 0; c < heads.length; ++c) {
      const name = heads[c].dataset.name ?? "";
      const unit = heads[c].dataset.unit ?? "";
      add(name, `${source.cells[c].textContent} ${unit}`.trim());
    }
    host.append(list);
    if (!source) return;
    document.querySelectorAll("tr.chosen").forEach((other) => other.classList.remove("chosen"));
    source.classList.add("chosen");
    const link = document.createElement("a");
    link.href = `#surface-${row}`;
    link.textContent = "Its row in the table";
    host.append(link);
  }
}

async function start() {
  const host = document.getElementById("viewer");
  if (!host) return;
  try {
    const info = JSON.parse(document.getElementById("mesh-info").textContent);
    const mesh = await readMesh(document.getElementById("mesh-data").textContent, info);
    host.hidden = false;
    window.clerestoryViewer = new Viewer(host, info, mesh);
  } catch (error) {
    host.hidden = true;
    const note = document.getElementById("viewer-note");
    note.hidden = false;
    note.textContent = `The building cannot be shown in 3D in this browser (${error.message}).`;
  }
}
start();
