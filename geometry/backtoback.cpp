// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs by the places of their corners; the winding that a domain sees by area.
#include "backtoback.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include <geometry/rays.hpp>

namespace clerestory {
namespace {

constexpr double apart_m = rayOffset_m;  // that each of a pair gives way

using Pair = std::array<std::uint32_t, 2>;
using Place = std::array<long, 3>;  // in steps of 10 µm

/// Opaque pieces with the same corners that look to opposite sides.
std::vector<Pair> pairsOf(const CleanModel& model) {
  constexpr double stepsPerMetre = 1e5;
  const Pieces& pieces = model.pieces;
  std::map<std::vector<Place>, std::vector<std::uint32_t>> byCorners;
  for (std::uint32_t piece = 0; piece < pieces.size(); ++piece) {
    if (model.materials[pieces.material[piece]].glazing) continue;
    std::vector<Place> corners;
    for (const std::uint32_t corner : pieces.polygons[piece]) {
      const glm::dvec3 steps = stepsPerMetre * pieces.points[corner];
      corners.push_back({std::lround(steps.x), std::lround(steps.y), std::lround(steps.z)});
    }
    std::sort(corners.begin(), corners.end());
    byCorners[std::move(corners)].push_back(piece);
  }
  std::vector<Pair> pairs;
  for (const auto& [corners, list] : byCorners) {
    if (list.size() == 2 && glm::dot(pieces.normal[list[0]], pieces.normal[list[1]]) < 0.0)
      pairs.push_back({list[0], list[1]});
  }
  return pairs;
}

/// By domain: area whose front is seen from there, less that whose back is. Pairs show both. [m²]
std::vector<double> frontsSeen(const Building& building, const std::vector<Pair>& pairs) {
  const Pieces& pieces = building.model.pieces;
  std::vector<bool> isPaired(pieces.size(), false);
  for (const Pair& pair : pairs) isPaired[pair[0]] = isPaired[pair[1]] = true;
  std::vector<double> fronts_m2(building.domains.size(), 0.0);
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
    const std::int32_t domain = building.sideDomain[side];
    if (domain < 0 || isPaired[side / 2]) continue;
    fronts_m2[static_cast<std::size_t>(domain)] += (side % 2 == 0 ? 1.0 : -1.0) * pieces.area_m2[side / 2];
  }
  return fronts_m2;
}

void move(Pieces& pieces, std::uint32_t piece, const glm::dvec3& way_m) {
  for (std::uint32_t i = pieces.polygons.begin[piece]; i < pieces.polygons.begin[piece + 1]; ++i) {
    std::uint32_t& corner = pieces.polygons.corners[i];
    const glm::dvec3 place = pieces.points[corner] + way_m;
    corner = static_cast<std::uint32_t>(pieces.points.size());
    pieces.points.push_back(place);
  }
}

/// Takes a side out of its domain and room.
void darken(Building& building, std::uint32_t side) {
  std::int32_t& domain = building.sideDomain[side];
  if (domain >= 0)
    building.domains[static_cast<std::size_t>(domain)].area_m2 -= building.model.pieces.area_m2[side / 2];
  domain = -1;
  building.sideRoom[side] = -1;
}

}  // namespace

bool partBackToBack(Building& building) {
  const std::vector<Pair> pairs = pairsOf(building.model);
  if (pairs.empty()) return false;
  const std::vector<double> fronts_m2 = frontsSeen(building, pairs);
  const auto frontsFrom = [&](std::uint32_t side) {
    const std::int32_t domain = building.sideDomain[side];
    return domain < 0 ? 0.0 : fronts_m2[static_cast<std::size_t>(domain)];
  };
  for (const auto& [a, b] : pairs) {
    // Before `a` its front is seen and b's back, behind it the other way round: where fronts are the rule on
    // both sides each piece has its own front, where backs are, its own back.
    const bool haveFronts = frontsFrom(2 * a) + frontsFrom(2 * b) >= 0.0;
    const std::uint32_t hidden = haveFronts ? 1 : 0;
    darken(building, 2 * a + hidden);
    darken(building, 2 * b + hidden);
    const glm::dvec3 way_m = (haveFronts ? apart_m : -apart_m) * building.model.pieces.normal[a];
    move(building.model.pieces, a, way_m);
    move(building.model.pieces, b, -way_m);
  }
  return true;
}

}  // namespace clerestory
