// SPDX-License-Identifier: GPL-3.0-or-later
// Constrained Delaunay triangulation of edges in a plane, with winding numbers.
#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace clerestory {

/// An edge that has the region on its left `times` more often than on its right; 0: it divides the region.
struct PlaneEdge {
  std::uint32_t from, to;
  int times;
};

struct Triangulation {
  static constexpr std::uint32_t none = 0xffffffffU;
  struct Triangle {
    std::array<std::uint32_t, 3> corner;     ///< counterclockwise
    std::array<std::uint32_t, 3> neighbour;  ///< across the edge from corner i to i + 1; or none
    std::array<bool, 3> constrained;         ///< whether that edge was given
    int winding;                             ///< how often the region covers the triangle
  };
  std::vector<Triangle> triangles;
  bool crossing = false;  ///< given edges cross or run through points: `triangles` is then empty
};

/// Triangulates the hull of the edges. The result depends on coordinates alone, not on the order of the
/// input. Points that no edge uses are left out; points of different index differ.
Triangulation triangulate(std::span<const glm::dvec2> points, std::span<const PlaneEdge> edges);

}  // namespace clerestory
