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

/// Puts faces in the order of their corners and names, of like ones those that the weld has not moved first:
/// the file's is forgotten.
void sortFaces(Soup& soup, const NameRanks& ranks);

/// A face or polygon as far as its being drawn twice is concerned.
struct Footprint {
  Loop corners;  ///< sorted
  std::uint32_t material, object;
  bool isGlass;  ///< which has both sides, whatever objects it is of
  DrawnSides drawn;
  bool isDrawnAlready = false;
};

/// Marks those that are drawn already: the same corners in the same material and object, or for the same
/// sides in others. The first by names is kept, for those sides of all of its like that are free.
void markDuplicates(std::vector<Footprint>& footprints, const NameRanks& ranks);

/// Drops faces that are drawn twice.
void dropDuplicateFaces(Soup& soup, std::span<const Material> materials, const NameRanks& ranks,
                        CleanupCounts& counts, Findings& findings);

/// Splits faces whose corners leave their plane into triangles.
void splitWarpedFaces(Soup& soup, const Tolerances& tolerances, CleanupCounts& counts, Findings& findings);

}  // namespace clerestory
