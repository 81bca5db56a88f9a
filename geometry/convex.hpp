// SPDX-License-Identifier: GPL-3.0-or-later
// Planar polygons with holes become few, plump convex pieces.
#pragma once

#include "soup.hpp"

namespace clerestory {

/// Convex loops that cover the polygon, wound as it is. Rectangles where all its edges are square to each
/// other, which may add points; else merged Delaunay triangles. Empty where the outline crosses itself.
std::vector<Loop> convexPieces(std::vector<glm::dvec3>& points, const PlanarPolygon& polygon,
                               const Tolerances& tolerances);

}  // namespace clerestory
