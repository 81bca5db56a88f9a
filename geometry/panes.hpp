// SPDX-License-Identifier: GPL-3.0-or-later
// Panes that are drawn as solids or as several sheets become one sheet each.
#pragma once

#include "soup.hpp"

namespace clerestory {

/// A planar polygon with its convex pieces.
struct DividedPolygon {
  PlanarPolygon polygon;
  std::vector<Loop> pieces;
};

/// Finds sheets of one glazing material that lie parallel, close behind each other, and keeps one of each
/// unit: the first along the canonical normal. Drops the others and the rims between them.
void dropFurtherPaneSheets(std::span<const glm::dvec3> points, std::span<const Material> materials,
                           const Tolerances& tolerances, std::vector<DividedPolygon>& polygons,
                           CleanupCounts& counts);

}  // namespace clerestory
