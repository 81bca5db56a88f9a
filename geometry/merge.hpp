// SPDX-License-Identifier: GPL-3.0-or-later
// Coplanar neighbours of one object and material become maximal planar polygons with holes.
#pragma once

#include "findings.hpp"
#include "soup.hpp"

namespace clerestory {

/// Merges; may add points where faces of one plane cross. Faces whose overlap cannot be resolved stay as
/// drawn.
std::vector<PlanarPolygon> mergeCoplanar(Soup& soup, const Tolerances& tolerances, Findings& findings);

/// Drops corners that lie on the line of their neighbours, but for those in `needed` (sorted).
void dropCollinearCorners(std::span<const glm::dvec3> points, double tolerance_m, Loop& loop,
                          std::span<const std::uint32_t> needed = {});

}  // namespace clerestory
