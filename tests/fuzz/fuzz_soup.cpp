// SPDX-License-Identifier: GPL-3.0-or-later
// Cleaning of small polygon soups: bytes are corners on a grid of 5 cm, which makes faces touch, overlap and
// cross.
#include <cstdint>

#include <geometry/building.hpp>
#include <import/scene.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  Scene scene;
  scene.materials.push_back({.name = "plaster"});
  scene.materials.push_back({.name = "glass", .glazing = true});
  scene.objects = {"a", "b"};
  for (std::size_t at = 0; at + 1 < size;) {
    const unsigned head = data[at++];
    const std::size_t corners = 3 + (head & 3U);
    if (at + 2 * corners > size) break;
    std::vector<std::uint32_t> face;
    for (std::size_t i = 0; i < corners; ++i, at += 2) {
      face.push_back(static_cast<std::uint32_t>(scene.points.size()));
      const unsigned xy = data[at];
      const unsigned zf = data[at + 1];  // height, and by how many tenths of a millimetre it is missed
      scene.points.emplace_back(0.05 * (xy & 15U), 0.05 * (xy >> 4U), 0.05 * (zf & 15U) + 1e-4 * (zf >> 4U));
    }
    scene.faces.add(face);
    scene.faceMaterial.push_back(head >> 7U);
    scene.faceObject.push_back(head >> 6U & 1U);
  }
  cleanScene(scene);
  return 0;
}
