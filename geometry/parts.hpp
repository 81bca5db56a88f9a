// SPDX-License-Identifier: GPL-3.0-or-later
// Convex pieces in parts: what every cut has to do.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <vector>

#include <geometry/building.hpp>

namespace clerestory {

/// A convex outline in space.
using Polygon = std::vector<glm::dvec3>;

Polygon polygonOf(const Pieces& pieces, std::uint32_t piece);

double areaOf(const Polygon& polygon);

/// As seen along a unit normal.
double areaAlong(const glm::dvec3& normal, const Polygon& polygon);

/// A convex polygon parted by a plane; `cut` holds the two points where its outline meets it.
struct Parts {
  Polygon front, back, cut;
};

/// Parts at the plane through a point. Corners within 0.1 µm of it count as on it.
Parts partAt(const Polygon& polygon, const glm::dvec3& onPlane, const glm::dvec3& normal);

/// Puts each piece's parts, one or several that make it up, in its place. Returns the piece that each of the
/// new ones is a part of.
std::vector<std::uint32_t> divide(
    Pieces& pieces,
    const std::function<std::vector<Polygon>(std::uint32_t piece, const Polygon& whole)>& partsOf);

}  // namespace clerestory
