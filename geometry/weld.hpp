// SPDX-License-Identifier: GPL-3.0-or-later
// Repair of single faces: points on a grid and welded, degenerate and repeated faces dropped, warped ones
// split.
#pragma once

#include "findings.hpp"
#include "soup.hpp"

namespace clerestory {

/// Puts points on the grid and welds those nearer than the tolerance: each goes to the nearest of the points
/// kept before it, those of large surfaces first: a thing on a wall gives way, however the model lies.
/// Points that only divide an edge follow its ends: dividing faces changes nothing. The result's points are
/// sorted, used, and free of duplicates.
Soup weld(const Soup& soup, const Tolerances& tolerances, CleanupCounts& counts);

/// Drops repeated corners and faces without area; starts every face at its smallest corner.
void dropDegenerateFaces(Soup& soup, const Tolerances& tolerances, CleanupCounts& counts, Findings& findings);

/// A face or polygon as far as its being drawn twice is concerned.
struct Footprint {
  Loop corners;  ///< sorted
  std::uint32_t material, object;
  bool front;     ///< its normal has the canonical sign
  bool bothWays;  ///< drawn both ways: it takes both sides that are free, and is wound to one of them
  bool isDrawnAlready = false;
};

/// Marks those that are drawn already: the same corners in the same material, or wound the same way in
/// another. The first by names is kept; its winding and whether it is drawn both ways are set.
void markDuplicates(std::vector<Footprint>& footprints, const NameRanks& ranks);

/// Drops faces that are drawn twice.
void dropDuplicateFaces(Soup& soup, const NameRanks& ranks, CleanupCounts& counts, Findings& findings);

/// Splits faces whose corners leave their plane into triangles.
void splitWarpedFaces(Soup& soup, const Tolerances& tolerances, CleanupCounts& counts, Findings& findings);

}  // namespace clerestory
