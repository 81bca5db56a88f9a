// SPDX-License-Identifier: GPL-3.0-or-later
// Axes in plan that follow from a model's own shape.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <cstdint>
#include <span>

#include <import/scene.hpp>

namespace clerestory {

/// Unit axes square to each other, of either handedness, about a point of the plan. However a model is
/// turned, moved, mirrored or divided, its points have the same coordinates here: what is sampled along them
/// finds the same.
struct PlanFrame {
  glm::dvec2 origin_m{0.0}, along{1.0, 0.0}, across{0.0, 1.0};

  [[nodiscard]] glm::dvec2 toFrame(const glm::dvec2& plan) const {
    return {glm::dot(plan - origin_m, along), glm::dot(plan - origin_m, across)};
  }
  [[nodiscard]] glm::dvec2 toPlan(const glm::dvec2& place) const {
    return origin_m + place.x * along + place.y * across;
  }
};

/// About the centre of some polygons' area, along most of the upright ones among `walls` (indices of
/// polygons). The first axis is the one that they reach further along, and each points to where the fewer of
/// them reach further.
PlanFrame planFrameOf(std::span<const glm::dvec3> points, const PolygonList& polygons,
                      std::span<const std::uint32_t> walls);

}  // namespace clerestory
