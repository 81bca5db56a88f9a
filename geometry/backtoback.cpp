// SPDX-License-Identifier: GPL-3.0-or-later
// The winding that a domain sees is known by area.
#include "backtoback.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <vector>

#include <geometry/rays.hpp>

#include "overlaps.hpp"

namespace clerestory {
namespace {

using Pair = std::array<std::uint32_t, 2>;

constexpr double apart_m = rayOffset_m;  // that each of a pair gives way
constexpr double sharedLeast_m2 = 0.01;  // smaller ones are not worth a cut

bool areBackToBack(const Pieces& pieces, std::uint32_t a, std::uint32_t b) {
  return glm::dot(drawnNormal(pieces, a), drawnNormal(pieces, b)) < 0.0;
}

bool isBetweenLights(const Building& building, std::uint32_t piece) {
  if (building.model.materials[building.model.pieces.material[piece]].glazing) return false;
  return std::ranges::all_of(std::array{2 * piece, 2 * piece + 1}, [&](std::uint32_t side) {
    const std::int32_t domain = building.sideDomain[side];
    return domain >= 0 && building.domains[static_cast<std::size_t>(domain)].lit;
  });
}

/// Of pieces over each other the first two that are drawn for opposite sides.
std::vector<Pair> pairsOf(const CleanModel& model) {
  std::vector<Pair> pairs;
  for (const std::vector<std::uint32_t>& layers : layersOf(model)) {
    const auto other = std::find_if(layers.begin() + 1, layers.end(), [&](std::uint32_t piece) {
      return areBackToBack(model.pieces, layers[0], piece);
    });
    if (other != layers.end()) pairs.push_back({layers[0], *other});
  }
  return pairs;
}

/// By domain: area that is drawn for there, less that which is seen from behind. Pairs show both. [m²]
std::vector<double> drawnFor(const Building& building, const std::vector<Pair>& pairs) {
  const Pieces& pieces = building.model.pieces;
  std::vector<bool> isPaired(pieces.size(), false);
  for (const Pair& pair : pairs) isPaired[pair[0]] = isPaired[pair[1]] = true;
  std::vector<double> drawn_m2(building.domains.size(), 0.0);
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
    const std::int32_t domain = building.sideDomain[side];
    if (domain < 0 || isPaired[side / 2]) continue;
    const bool isDrawn = (side % 2 == 1) == pieces.isDrawnForBack[side / 2];
    drawn_m2[static_cast<std::size_t>(domain)] += (isDrawn ? 1.0 : -1.0) * pieces.area_m2[side / 2];
  }
  return drawn_m2;
}

}  // namespace

void cutBackToBack(Building& building) {
  const Pieces& pieces = building.model.pieces;
  std::vector<std::uint32_t> among;
  for (std::uint32_t piece = 0; piece < pieces.size(); ++piece)
    if (isBetweenLights(building, piece)) among.push_back(piece);
  cutOverlaps(building, Overlaps(pieces, among, sharedLeast_m2, [&](std::uint32_t a, std::uint32_t b) {
                return areBackToBack(pieces, a, b);
              }));
}

void partBackToBack(Building& building) {
  Pieces& pieces = building.model.pieces;
  const std::vector<Pair> pairs = pairsOf(building.model);
  if (pairs.empty()) return;
  const std::vector<double> drawn_m2 = drawnFor(building, pairs);
  /// The side that a piece is drawn for, or the one behind it.
  const auto sideOf = [&](std::uint32_t piece, bool isDrawn) {
    return 2 * piece + (isDrawn == pieces.isDrawnForBack[piece] ? 1U : 0U);
  };
  const auto drawnBefore = [&](std::uint32_t piece) {
    const std::int32_t domain = building.sideDomain[sideOf(piece, true)];
    return domain < 0 ? 0.0 : drawn_m2[static_cast<std::size_t>(domain)];
  };
  for (const auto& [a, b] : pairs) {
    // Before `a` it is seen as drawn and b from behind, behind it the other way round: where the first is the
    // rule on both sides each piece has the side that it is drawn for, else the other one.
    const bool areAsDrawn = drawnBefore(a) + drawnBefore(b) >= 0.0;
    darken(building, sideOf(a, !areAsDrawn));
    darken(building, sideOf(b, !areAsDrawn));
    const glm::dvec3 way_m = (areAsDrawn ? apart_m : -apart_m) * drawnNormal(pieces, a);
    move(pieces, a, way_m);
    move(pieces, b, -way_m);
  }
}

}  // namespace clerestory
