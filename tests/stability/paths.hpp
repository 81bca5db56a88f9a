// SPDX-License-Identifier: GPL-3.0-or-later
// Closed matt scenes by paths, which know neither elements nor links: the truth where there is no closed
// form.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include <geometry/parallel.hpp>
#include <geometry/rays.hpp>
#include <geometry/sampling.hpp>

namespace clerestory {

/// Illuminances of a grid's sensors, each by `count` paths. A path goes on from a surface with the
/// probability of its reflectance, and brings what the surfaces emit that it meets.
inline std::vector<double> byPaths_lx(const Building& building, const SensorGrid& grid, std::uint32_t count) {
  const RayScene rays(building.model, building.innerGlass);
  const Pieces& pieces = building.model.pieces;
  std::vector<double> values(grid.points.size(), 0.0);
  forEachIndex(values.size(), 1, [&](std::size_t i) {
    std::mt19937 random(static_cast<unsigned>(i));
    const auto even = [&] { return static_cast<float>(random() >> 8U) * 0x1p-24F; };
    for (std::uint32_t path = 0; path < count; ++path) {
      glm::vec3 point(grid.points[i] - rays.origin());
      glm::vec3 normal(grid.normals[i]);
      for (;;) {
        const float u = even();
        const glm::vec3 direction = cosineDirection(normal, u, even());
        const RayScene::Hit hit = rays.nearest(point, direction, RayScene::Barrier::opaque);
        if (!hit) break;
        const Material& material = building.model.materials[pieces.material[hit.piece]];
        values[i] += material.exitance_lm_m2.g / count;
        if (static_cast<double>(even()) >= material.reflectance.g) break;
        normal = (hit.front ? 1.0F : -1.0F) * glm::vec3(pieces.normal[hit.piece]);
        point += hit.distance_m * direction + rayOffset_m * normal;
      }
    }
  });
  return values;
}

}  // namespace clerestory
