// SPDX-License-Identifier: GPL-3.0-or-later
// Measures of what a scene draws, faces and cages alike, before anything is cleaned.
#pragma once

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <span>

#include <import/scene.hpp>

namespace clerestory {

struct Box {
  glm::dvec3 low{std::numeric_limits<double>::max()};
  glm::dvec3 high{std::numeric_limits<double>::lowest()};

  void add(const glm::dvec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  [[nodiscard]] glm::dvec3 extent() const { return high - low; }
  /// Smallest first.
  [[nodiscard]] glm::dvec3 sortedExtent() const {
    glm::dvec3 e = extent();
    std::sort(&e.x, &e.x + 3);
    return e;
  }
};

/// Calls `visit` with each polygon of the scene, cages included.
template <typename Visit>
void forEachPolygon(const Scene& scene, const Visit& visit) {
  for (std::size_t f = 0; f < scene.faces.size(); ++f) {
    visit(scene.faces[f]);
  }
  for (const Cage& cage : scene.cages) {
    for (std::size_t f = 0; f < cage.faces.size(); ++f) {
      visit(cage.faces[f]);
    }
  }
}

/// Normal of the polygon, as long as its area.
inline glm::dvec3 areaVector(const Scene& scene, std::span<const std::uint32_t> polygon) {
  glm::dvec3 sum(0.0);
  const glm::dvec3 first = scene.points[polygon[0]];
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    sum += glm::cross(scene.points[polygon[i]] - first, scene.points[polygon[i + 1]] - first);
  }
  return 0.5 * sum;
}

/// Of everything drawn.
inline Box boxOf(const Scene& scene) {
  Box box;
  forEachPolygon(scene, [&](std::span<const std::uint32_t> polygon) {
    for (const std::uint32_t corner : polygon) {
      box.add(scene.points[corner]);
    }
  });
  return box;
}

}  // namespace clerestory
