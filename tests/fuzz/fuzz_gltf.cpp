// SPDX-License-Identifier: GPL-3.0-or-later
// glTF, with a mutator that keeps GLB's framing valid so that what lies behind it is reached.
#include <algorithm>
#include <cstring>

#include <import/scene.hpp>

#include "readfile.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  return readAsFile("a.glb", data, size, [](const auto& file) { readModel(file, {}); });
}

#ifdef CLERESTORY_MUTATOR
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t maxSize);

namespace {

struct Glb {
  std::string json, binary;
};

std::uint32_t u32(const std::uint8_t* data) {
  std::uint32_t value = 0;
  std::memcpy(&value, data, sizeof(value));
  return value;
}

/// The two chunks of a GLB; the whole as JSON where it is none.
Glb split(const std::uint8_t* data, std::size_t size) {
  const auto text = [&](std::size_t from, std::size_t to) {
    return std::string(reinterpret_cast<const char*>(data) + from, to - from);
  };
  if (size < 20 || std::memcmp(data, "glTF", 4) != 0) {
    return {text(0, size), ""};
  }
  const std::size_t jsonEnd = std::min(size, 20 + std::size_t{u32(data + 12)});
  return {text(20, jsonEnd), size >= jsonEnd + 8 ? text(jsonEnd + 8, size) : ""};
}

std::string join(Glb glb) {
  glb.json.resize((glb.json.size() + 3) / 4 * 4, ' ');
  glb.binary.resize((glb.binary.size() + 3) / 4 * 4, '\0');
  std::string bytes = "glTF";
  const auto add = [&](std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    bytes.append(reinterpret_cast<const char*>(&word), 4);
  };
  add(2);
  add(28 + glb.json.size() + glb.binary.size());
  add(glb.json.size());
  bytes += "JSON" + glb.json;
  add(glb.binary.size());
  bytes += std::string("BIN\0", 4) + glb.binary;
  return bytes;
}

void mutate(std::string& part, std::size_t room) {
  const std::size_t size = part.size();
  part.resize(size + std::min<std::size_t>(room, 64));
  part.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(part.data()), size, part.size()));
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t maxSize,
                                               unsigned seed) {
  if (seed % 8 == 0 || maxSize < 64) {
    return LLVMFuzzerMutate(data, size, maxSize);  // the framing itself, now and then
  }
  Glb glb = split(data, size);
  const std::size_t used = 36 + glb.json.size() + glb.binary.size();
  const std::size_t room = maxSize > used ? maxSize - used : 0;
  mutate(seed % 8 < 6 || glb.binary.empty() ? glb.json : glb.binary, room);
  const std::string bytes = join(std::move(glb));
  const std::size_t count = std::min(bytes.size(), maxSize);
  std::memcpy(data, bytes.data(), count);
  return count;
}
#endif
