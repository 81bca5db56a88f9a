// SPDX-License-Identifier: GPL-3.0-or-later
// Points turned one by one; a mirror image turns outlines round, so that they stay counterclockwise as seen
// from the front. Normals come to lie on a grid too, so that they have the same digits.
#include "ownframe.hpp"

#include <algorithm>
#include <numeric>

namespace clerestory {
namespace {

template <class Turn>
void turn(const PlanFrame& frame, Pieces& pieces, const Turn& turnPlace) {
  for (glm::dvec3& point : pieces.points) point = turnPlace(point);
  if (!isMirrored(frame)) return;
  auto& [begin, corners] = pieces.polygons;
  for (std::size_t i = 0; i + 1 < begin.size(); ++i)
    std::reverse(corners.begin() + begin[i], corners.begin() + begin[i + 1]);
}

}  // namespace

PlanFrame ownFrameOf(std::span<const glm::dvec3> points, const PolygonList& polygons) {
  std::vector<std::uint32_t> all(polygons.size());
  std::iota(all.begin(), all.end(), 0U);
  PlanFrame frame = planFrameOf(points, polygons, all);
  frame.origin_m = glm::dvec2(0.0);
  return frame;
}

void turnInto(const PlanFrame& frame, const Tolerances& tolerances, Pieces& pieces) {
  turn(frame, pieces, [&](const glm::dvec3& place) { return intoFrame(frame, place); });
  for (glm::dvec3& point : pieces.points) point = onGrid(point, tolerances.grid_m);
  for (glm::dvec3& normal : pieces.normal) normal = onGrid(intoFrame(frame, normal), normalGrid);
}

void turnOutOf(const PlanFrame& frame, Pieces& pieces) {
  turn(frame, pieces, [&](const glm::dvec3& place) { return outOfFrame(frame, place); });
  for (glm::dvec3& normal : pieces.normal) normal = outOfFrame(frame, normal) + 0.0;
}

}  // namespace clerestory
