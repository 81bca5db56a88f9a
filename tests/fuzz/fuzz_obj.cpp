// SPDX-License-Identifier: GPL-3.0-or-later
// OBJ.
#include <import/scene.hpp>

#include "readfile.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  return readAsFile("a.obj", data, size, [](const auto& file) { readModel(file, {}); });
}
