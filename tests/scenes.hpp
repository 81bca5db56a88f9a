// SPDX-License-Identifier: GPL-3.0-or-later
// Rooms, holes, panes and furniture for the tests, on top of what geometry/drawn.hpp draws.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include <geometry/building.hpp>
#include <import/study.hpp>

#include "geometry/drawn.hpp"

namespace clerestory::drawn {

/// Materials that a Drawing begins with.
inline constexpr std::uint32_t plaster = 0, glass = 1, wood = 2;

inline std::uint32_t addMaterial(Drawing& drawing, Material material) {
  drawing.scene.materials.push_back(std::move(material));
  return static_cast<std::uint32_t>(drawing.scene.materials.size() - 1);
}

/// An object of its own in the surfaces' table.
inline std::uint32_t addObject(Drawing& drawing, const std::string& name) {
  drawing.scene.objects.push_back(name);
  return static_cast<std::uint32_t>(drawing.scene.objects.size() - 1);
}

/// The faces of a box; `without` leaves out some: 0 bottom, 1 top, 2 south, 3 east, 4 north, 5 west.
inline void addBox(Drawing& drawing, const glm::dvec3& a, const glm::dvec3& b,
                   std::uint32_t material = plaster, std::uint32_t object = 0,
                   std::initializer_list<std::size_t> without = {}) {
  const std::vector<Outline> faces = box(a, b);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (std::find(without.begin(), without.end(), i) == without.end())
      drawing.face(faces[i], material, object);
  }
}

/// A rectangle in a wall's plane: from (x0, z0) to (x1, z1).
struct Hole {
  double x0, z0, x1, z1;
};

/// The wall from (x0, z0) to (x1, z1) in the plane y = `y`, with a hole in it.
inline void addWallWithHole(Drawing& drawing, double x0, double z0, double x1, double z1, double y,
                            const Hole& hole, std::uint32_t material = plaster) {
  const auto add = [&](double left, double low, double right, double high) {
    if (right > left && high > low) drawing.face(upright(left, low, right, high, y), material);
  };
  add(x0, z0, hole.x0, z1);
  add(hole.x1, z0, x1, z1);
  add(hole.x0, z0, hole.x1, hole.z0);
  add(hole.x0, hole.z1, hole.x1, z1);
}

/// A box room whose south wall has a hole.
inline void addRoomWithHole(Drawing& drawing, const glm::dvec3& a, const glm::dvec3& b, const Hole& hole) {
  addBox(drawing, a, b, plaster, 0, {2});
  addWallWithHole(drawing, a.x, a.z, b.x, b.z, a.y, hole);
}

/// The same with a pane in the hole.
inline void addRoomWithPane(Drawing& drawing, const glm::dvec3& a, const glm::dvec3& b, const Hole& hole) {
  addRoomWithHole(drawing, a, b, hole);
  drawing.face(upright(hole.x0, hole.z0, hole.x1, hole.z1, a.y), glass);
}

inline Building buildingOf(const Scene& scene, const Study& study = {}) {
  return makeBuilding(cleanScene(scene), study);
}

/// A grid of given points that look up.
inline GridSettings gridOf(const std::vector<glm::dvec3>& points) {
  GridSettings grid;
  grid.name = "points";
  for (const glm::dvec3& point : points) grid.points.push_back({point.x, point.y, point.z, 0.0, 0.0, 1.0});
  return grid;
}

/// Points over the plan of a box, `step_m` apart and half of that off its walls.
inline std::vector<glm::dvec3> pointsOver(const glm::dvec3& a, const glm::dvec3& b, double height_m,
                                          double step_m) {
  std::vector<glm::dvec3> points;
  for (double y = a.y + 0.5 * step_m; y < b.y; y += step_m) {
    for (double x = a.x + 0.5 * step_m; x < b.x; x += step_m) points.emplace_back(x, y, a.z + height_m);
  }
  return points;
}

}  // namespace clerestory::drawn
