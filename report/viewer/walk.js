// SPDX-License-Identifier: GPL-3.0-or-later
// Walking: arrow keys or W A S D move at eye height, dragging looks around.
import { Euler, Vector3 } from "three";

const eyeHeight_m = 1.6;
const speed_m_s = 1.8;
const keys = {
  ArrowUp: [0, 1], w: [0, 1],
  ArrowDown: [0, -1], s: [0, -1],
  ArrowLeft: [-1, 0], a: [-1, 0],
  ArrowRight: [1, 0], d: [1, 0],
};

export class Walk {
  constructor(camera, canvas, info, draw) {
    Object.assign(this, { camera, canvas, info, draw });
    this.held = new Set();
    this.enabled = false;
    canvas.addEventListener("keydown", (event) => this.press(event));
    canvas.addEventListener("keyup", (event) => this.held.delete(event.key));
    canvas.addEventListener("blur", () => this.held.clear());
    canvas.addEventListener("pointermove", (event) => this.look(event));
  }

  enable(on) {
    this.enabled = on;
    if (on) this.begin();
  }

  /** Stands in the largest room and looks along the building. */
  begin() {
    const [x, y, floor] = this.info.walk_m;
    this.camera.position.set(x, y, floor + eyeHeight_m);
    const [low, high] = [this.info.inside_low_m, this.info.inside_high_m];
    const [width, depth] = [high[0] - low[0], high[1] - low[1]];
    const [ahead, aside] = [(low[1] + high[1]) / 2 - y, (low[0] + high[0]) / 2 - x];
    const isMiddle = Math.hypot(ahead, aside) < 2;
    this.turn = isMiddle ? (width > depth ? -Math.PI / 2 : 0) : Math.atan2(-aside, ahead);
    this.tilt = 0;
    this.aim();
    this.canvas.focus({ preventScroll: true });
  }

  aim() {
    this.camera.quaternion.setFromEuler(new Euler(Math.PI / 2 + this.tilt, 0, this.turn, "ZXY"));
    this.draw();
  }

  look(event) {
    if (!this.enabled || !(event.buttons & 1)) return;
    this.turn += event.movementX * 0.005;
    this.tilt = Math.max(-1.4, Math.min(1.4, this.tilt + event.movementY * 0.005));
    this.aim();
  }

  press(event) {
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (!this.enabled || !(key in keys)) return;
    event.preventDefault();
    this.held.add(event.key);
    if (this.held.size === 1 && !this.moving) this.stride(performance.now());
  }

  stride(before) {
    this.moving = requestAnimationFrame((now) => {
      this.moving = 0;
      if (!this.enabled || this.held.size === 0) return;
      const way = new Vector3();
      for (const held of this.held) {
        const [right, ahead] = keys[held.length === 1 ? held.toLowerCase() : held];
        way.x += right * Math.cos(this.turn) - ahead * Math.sin(this.turn);
        way.y += right * Math.sin(this.turn) + ahead * Math.cos(this.turn);
      }
      if (way.lengthSq() > 0) {
        this.camera.position.addScaledVector(way.normalize(), (speed_m_s * Math.min(now - before, 100)) / 1000);
      }
      this.draw();
      this.stride(now);
    });
  }
}
