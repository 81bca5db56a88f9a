// SPDX-License-Identifier: GPL-3.0-or-later
// MTL, by a model that names it.
#include <import/scene.hpp>

#include "readfile.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  static const FuzzFolder folder;
  folder.write("a.mtl", reinterpret_cast<const char*>(data), size);
  static const std::string model =
      "mtllib a.mtl\nv 0 0 0\nv 4 0 0\nv 0 3 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\nusemtl "
      "glass\nf 1 2 3\n";
  static const std::filesystem::path file = folder.write("a.obj", model.data(), model.size());
  try {
    readModel(file, {});
  } catch (const InputError&) {
  }
  return 0;
}
