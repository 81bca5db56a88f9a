// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a building is the same in all the ways that it may be drawn and written.
#pragma once

#include "asgltf.hpp"
#include "redrawn.hpp"

namespace clerestory::drawn {

inline Scene asGltf(const Scene& scene) {
  const TempFolder folder;
  return read(folder.write("model.glb", glbOf(scene)));
}

/// Faces as the triangles that a glTF holds: that those of a slightly warped one were one it does not tell.
inline Scene inTriangles(const Scene& scene) {
  return withFaces(scene, [&](Scene& result, std::span<const std::uint32_t> c, const auto& add) {
    const std::vector<std::uint32_t> triangles = trianglesOf(result, c);
    for (std::size_t i = 0; i < triangles.size(); i += 3)
      add({triangles[i], triangles[i + 1], triangles[i + 2]});
  });
}

/// With as many digits as a glTF holds.
inline Scene inFloats(const Scene& scene) {
  const auto decimalOf = [](double value) {
    char text[32];
    const char* end = std::to_chars(text, text + sizeof text, static_cast<float>(value)).ptr;
    std::from_chars(text, end, value);
    return value;
  };
  return moved(
      scene, [&](const glm::dvec3& p) { return glm::dvec3(decimalOf(p.x), decimalOf(p.y), decimalOf(p.z)); });
}

/// A glTF moves points by up to 0.24 µm: its floors and panes are those of the model itself, and all of it is
/// that of the model with its faces in triangles and its points rounded alike.
inline void expectSameHoweverDrawn(const std::filesystem::path& file) {
  const Scene scene = read(file);
  const Building expected = buildingOf(scene);
  ASSERT_FALSE(expected.rooms.empty());
  ASSERT_FALSE(expected.portals.empty());
  const std::vector<std::pair<std::string, Scene>> others = {
      {"turned by 0.3 rad", turned(scene, 0.3)},
      {"mirrored", mirrored(scene)},
      {"in millimetres", inUnit(file, scene.axes, "mm")},
      {"in inches", inUnit(file, scene.axes, "in")},
      {"reversed", reversed(scene)},
      {"shuffled", shuffled(scene, 3)},
      {"divided in six", divided(scene, 3, 2)}};
  for (const auto& [how, other] : others) {
    SCOPED_TRACE(how);
    expectSame(other, expected);
  }
  SCOPED_TRACE("as glTF");
  const Building inGltf = buildingOf(asGltf(scene));
  expectSame(inGltf, buildingOf(inFloats(inTriangles(scene))));
  SCOPED_TRACE("as the model itself");
  expectSameFloorsAndPanes(inGltf, expected);
}

}  // namespace clerestory::drawn
