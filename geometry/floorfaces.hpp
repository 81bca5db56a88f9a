// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of a floor as lines in plan divide it: what does not depend on how its surfaces were cut before.
#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <span>
#include <vector>

#include <geometry/building.hpp>

#include "planframe.hpp"

namespace clerestory {

struct PlanLine {
  glm::dvec2 from_m, to_m;
};

/// A part of a floor in plan that no line divides.
struct FloorFace {
  double area_m2 = 0.0;
  double outline_m = 0.0;                            ///< length, of holes too
  std::vector<std::array<glm::dvec2, 3>> triangles;  ///< counterclockwise

  /// Points spread evenly along lines of a frame, whatever the triangles.
  [[nodiscard]] std::vector<glm::dvec2> samples(const PlanFrame& frame, std::uint32_t count) const;
};

/// What some level pieces cover together, each place once, divided by `lines` and by the outlines of surfaces
/// that lie on each other. Areas are exact.
std::vector<FloorFace> floorFaces(const Pieces& pieces, std::span<const std::uint32_t> level,
                                  std::span<const PlanLine> lines);

}  // namespace clerestory
