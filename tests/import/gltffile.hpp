// SPDX-License-Identifier: GPL-3.0-or-later
// Small glTF files written in memory: a square, of which a test changes what it is about.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

#include <import/scene.hpp>

#include "tempfolder.hpp"

namespace clerestory {

template <typename Value>
inline void append(std::string& bytes, Value value) {
  char raw[sizeof(Value)];
  std::memcpy(raw, &value, sizeof(Value));
  bytes.append(raw, sizeof(Value));
}

/// A square 4 x 3 in the plane of x and z, facing +y, as floats; then the indices of two triangles as shorts.
inline std::string squareBytes() {
  std::string bytes;
  for (const float v : {0.F, 0.F, 0.F, 0.F, 0.F, 3.F, 4.F, 0.F, 3.F, 4.F, 0.F, 0.F}) {
    append(bytes, v);
  }
  for (const int i : {0, 1, 2, 0, 2, 3}) {
    append(bytes, static_cast<std::uint16_t>(i));
  }
  return bytes;  // 48 + 12
}

inline std::string glb(std::string json, std::string binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  std::string bytes = "glTF";
  append<std::uint32_t>(bytes, 2);
  append(bytes, static_cast<std::uint32_t>(28 + json.size() + binary.size()));
  append(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  append(bytes, static_cast<std::uint32_t>(binary.size()));
  bytes += std::string("BIN\0", 4) + binary;
  return bytes;
}

/// What a test changes in the document of the square.
struct Parts {
  std::string nodes = R"([{"mesh":0,"name":"floor"}])";
  std::string primitive = R"({"attributes":{"POSITION":0},"indices":1})";
  std::string extras;  // of the mesh, with a comma before it
  std::string positions = R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"})";
  std::string indices = R"({"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"})";
  std::string view = R"({"buffer":0,"byteLength":48})";
  std::string buffer = R"({"byteLength":60})";
  std::string rest;  // with a comma before it
};

inline std::string jsonOf(const Parts& p) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":)" + p.nodes +
         R"(,"meshes":[{"name":"mesh","primitives":[)" + p.primitive + "]" + p.extras +
         R"(}],"accessors":[)" + p.positions + "," + p.indices + R"(],"bufferViews":[)" + p.view +
         R"(,{"buffer":0,"byteOffset":48,"byteLength":12}],"buffers":[)" + p.buffer + "]" + p.rest + "}";
}

inline Scene read(const Parts& parts) {
  const TempFolder folder;
  return readModel(folder.write("a.glb", glb(jsonOf(parts), squareBytes())), {});
}

inline std::string errorOf(const Parts& parts) {
  return inputErrorOf([&] { read(parts); });
}

}  // namespace clerestory
