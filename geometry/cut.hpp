// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts surfaces where panes and walls meet them, so that none is half inside, half outside.
#pragma once

#include <span>

#include <geometry/building.hpp>

namespace clerestory {

/// Splits opaque pieces (reveals, sills, frames) along the planes of the panes whose edges they meet.
/// Areas add up; the canonical order of the pieces is kept.
void cutAtPanes(Pieces& pieces, const std::vector<Material>& materials);

/// Splits the pieces `inTwoAirs` (a floor that runs through under a wall, a post that stands in a slab) along
/// the planes of those that `partAirs` and meet them. Returns the piece that each of the new ones is a part
/// of.
std::vector<std::uint32_t> cutWhereMet(Pieces& pieces, const std::vector<bool>& inTwoAirs,
                                       const std::vector<bool>& partAirs);

/// An upright rectangle over the line between two points.
struct UprightCut {
  glm::dvec3 from_m, to_m;
  double height_m;
  std::int32_t domain;  ///< whose pieces it cuts
};

/// Splits opaque pieces of the cuts' domains (`sideDomain`: 2 × pieces) that pass through these rectangles.
/// Returns the piece that each of the new ones is a part of.
std::vector<std::uint32_t> cutUpright(Pieces& pieces, const std::vector<Material>& materials,
                                      const std::vector<std::int32_t>& sideDomain,
                                      const std::vector<UprightCut>& cuts);

/// A surface that another one runs through.
struct Crossing {
  std::uint32_t piece;  ///< before the cut
  glm::dvec3 place_m;   ///< the middle of the line along which they cross
  double length_m;
};

/// Splits opaque pieces at others of one air with them that run through them, by 3 cm at least on either
/// side, or that stand on them as a partition does; both along 0.1 m at least. `sideDomain`: 2 × pieces. What
/// runs through is added to `crossings`. Returns the piece that each of the new ones is a part of.
std::vector<std::uint32_t> cutWhereCrossed(Pieces& pieces, const std::vector<Material>& materials,
                                           const std::vector<std::int32_t>& sideDomain,
                                           std::vector<Crossing>& crossings);

/// Numbers what a building knows by piece anew after a cut: `wholeOf` as the cuts above return it, of
/// `before` pieces.
void followCut(Building& building, std::size_t before, std::span<const std::uint32_t> wholeOf);

}  // namespace clerestory
