// SPDX-License-Identifier: GPL-3.0-or-later
// Unpacks the elements that report/viewermesh.cpp has packed; the two files belong together.

/** What a packed logarithmic code stands for: 0, or 2^-14 to 2^26. */
export function valueOf(code) {
  return code > 0 ? 2 ** (((code - 1) / 16382) * 40 - 14) : 0;
}

async function inflate(base64) {
  const bytes = Uint8Array.from(atob(base64.trim()), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Reads arrays one after the other: all low bytes, then all high bytes, of differences to the one before. */
class Reader {
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 0;
  }
  shorts(count, into, stride = 1, first = 0) {
    let value = 0;
    for (let i = 0; i < count; ++i) {
      value = (value + this.bytes[this.at + i] + 256 * this.bytes[this.at + count + i]) & 0xffff;
      into[first + stride * i] = value;
    }
    this.at += 2 * count;
    return into;
  }
  octets(count, into, stride = 1, first = 0) {
    let value = 0;
    for (let i = 0; i < count; ++i) {
      value = (value + this.bytes[this.at + i]) & 0xff;
      into[first + stride * i] = value;
    }
    this.at += count;
    return into;
  }
}

/** #corners: positions in steps, codes of illuminance and exitance, tint, row; #elements: corner counts. */
export async function readMesh(base64, info) {
  const reader = new Reader(await inflate(base64));
  const { elements, corners } = info;
  const counts = reader.shorts(elements, new Uint16Array(elements));
  const rowLow = reader.shorts(elements, new Uint16Array(elements));
  const rowHigh = reader.shorts(elements, new Uint16Array(elements));
  const positions = new Uint16Array(3 * corners);
  for (let axis = 0; axis < 3; ++axis) reader.shorts(corners, positions, 3, axis);
  const illuminance = reader.shorts(corners, new Uint16Array(corners));
  const exitance = reader.shorts(corners, new Uint16Array(corners));
  const tint = new Uint8Array(3 * corners);
  for (let c = 0; c < 3; ++c) reader.octets(corners, tint, 3, c);
  if (reader.at !== reader.bytes.length) throw new Error("the page's elements are damaged");
  const rowOfCorner = new Float32Array(corners);
  for (let e = 0, at = 0; e < elements; at += counts[e++]) {
    rowOfCorner.fill(rowLow[e] + 65536 * rowHigh[e], at, at + counts[e]);
  }
  return { counts, positions, illuminance, exitance, tint, rowOfCorner };
}

/** Fans of the elements whose row is asked for, as indices of corners. */
export function triangulate(mesh, wants) {
  const indices = [];
  let first = 0;
  for (const count of mesh.counts) {
    if (wants(mesh.rowOfCorner[first])) {
      for (let i = 2; i < count; ++i) indices.push(first, first + i - 1, first + i);
    }
    first += count;
  }
  return Uint32Array.from(indices);
}
