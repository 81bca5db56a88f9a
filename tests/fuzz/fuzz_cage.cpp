// SPDX-License-Identifier: GPL-3.0-or-later
// Subdivision cages in OBJ, tessellated and cleaned.
#include <geometry/building.hpp>
#include <import/scene.hpp>

#include "readfile.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  return readAsFile("a.obj", data, size, [](const auto& file) {
    ModelOptions options;
    options.units = "m";
    options.subdivide = {{"*", "catmark", 0.05}};
    cleanScene(readModel(file, options));
  });
}
