// SPDX-License-Identifier: GPL-3.0-or-later
// Doorways as the raster finds them, moved to the model's own edges.
#include "doorways.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "cut.hpp"

namespace clerestory {
namespace {

constexpr double uprightHeight_m = 1.2;  // of what can be a door's side
constexpr double revealMost_m = 0.8;     // depth of a reveal: a thick wall's
constexpr double revealLeast_m = 0.02;
constexpr double reach_m = 0.35;  // from the raster's end of a doorway to the model's
constexpr double facing = 0.85;   // cosine between a reveal's normal and the doorway's direction

/// A place of the model's that a doorway may end at.
struct End {
  glm::dvec2 place_m;
  double distance_m, depth_m;
};

/// The model's own end of a doorway, for the raster's: in the middle of the deepest reveal about there, so
/// that a frame within a reveal and a cell more or less change nothing.
glm::dvec2 snapped(const std::vector<Upright>& uprights, const glm::dvec2& end, const glm::dvec2& direction) {
  constexpr double aboutThere_m = 0.15;
  constexpr double alike_m = 0.01;
  std::vector<End> ends;
  const auto offer = [&](const glm::dvec2& place, double depth_m) {
    const double distance_m = glm::length(place - end);
    if (distance_m < reach_m) ends.push_back({place, distance_m, depth_m});
  };
  for (const Upright& upright : uprights) {
    const double depth_m = glm::length(upright.to - upright.from);
    if (depth_m < revealLeast_m || depth_m > revealMost_m) continue;
    if (std::abs(glm::dot(upright.normal, direction)) >= facing)
      offer(0.5 * (upright.from + upright.to), depth_m);
  }
  if (ends.empty()) {
    for (const Upright& upright : uprights) {
      offer(upright.from, 0.0);
      offer(upright.to, 0.0);
    }
  }
  if (ends.empty()) return end;
  const double nearest_m = std::ranges::min(ends, {}, &End::distance_m).distance_m;
  std::erase_if(ends, [&](const End& other) { return other.distance_m > nearest_m + aboutThere_m; });
  const double deepest_m = std::ranges::max(ends, {}, &End::depth_m).depth_m;
  std::erase_if(ends, [&](const End& other) { return other.depth_m < deepest_m - alike_m; });
  return std::ranges::min(ends, {}, &End::distance_m).place_m;
}

/// Foot and head of the air over the opening's cells.
std::pair<double, double> heightsOf(const RoomAir& air, const Storey& storey, const Opening& opening) {
  double low_m = std::numeric_limits<double>::infinity();
  double high_m = storey.floor_m;
  for (const std::uint32_t cell : opening.cells) {
    for (const AirSpan& span : air.map.spans(cell)) {
      if (span.high_m < storey.floor_m + 0.05 || span.low_m > storey.end_m - 0.05) continue;
      low_m = std::min(low_m, span.low_m);
      high_m = std::max(high_m, std::min(span.high_m, storey.end_m));
    }
  }
  return {std::max(low_m, storey.floor_m - 0.5), high_m};
}

/// Makes an upright reach over a part of its plane as well.
void add(Upright& upright, const Upright& part) {
  const glm::dvec2 along(-upright.normal.y, upright.normal.x);
  for (const glm::dvec2& place : {part.from, part.to}) {
    if (glm::dot(place - upright.from, along) < 0.0) upright.from = place;
    if (glm::dot(place - upright.to, along) > 0.0) upright.to = place;
  }
  upright.low_m = std::min(upright.low_m, part.low_m);
  upright.high_m = std::max(upright.high_m, part.high_m);
}

/// Polygons of the pieces: how one was divided changes nothing.
std::vector<Upright> wholeOnes(const std::vector<Upright>& pieces) {
  std::map<std::uint32_t, Upright> byPolygon;
  for (const Upright& piece : pieces) add(byPolygon.try_emplace(piece.polygon, piece).first->second, piece);
  std::vector<Upright> wholes;
  for (const auto& [polygon, whole] : byPolygon) wholes.push_back(whole);
  return wholes;
}

}  // namespace

std::vector<Upright> uprightsOf(const Pieces& pieces) {
  std::vector<Upright> uprights;
  for (std::uint32_t piece = 0; piece < pieces.size(); ++piece) {
    const glm::dvec3& normal = pieces.normal[piece];
    if (std::abs(normal.z) > 0.02) continue;
    const auto corners = pieces.polygons[piece];
    const glm::dvec2 any(pieces.points[corners[0]]);
    Upright upright{any,
                    any,
                    glm::dvec2(normal),
                    std::numeric_limits<double>::infinity(),
                    -std::numeric_limits<double>::infinity(),
                    pieces.polygon[piece],
                    piece};
    for (const std::uint32_t corner : corners) {
      const double height_m = pieces.points[corner].z;
      add(upright, {glm::dvec2(pieces.points[corner]), glm::dvec2(pieces.points[corner]), upright.normal,
                    height_m, height_m, upright.polygon, piece});
    }
    uprights.push_back(upright);
  }
  return uprights;
}

std::vector<Doorway> doorwaysOf(const Building& building, const RoomAir& air, const Storey& storey) {
  std::vector<Doorway> doorways;
  if (storey.parted.openings.empty()) return doorways;
  std::vector<Upright> uprights = wholeOnes(uprightsOf(building.model.pieces));
  std::erase_if(uprights, [&](const Upright& upright) {
    return std::min(upright.high_m, storey.floor_m + 2.0) - std::max(upright.low_m, storey.floor_m) <
           uprightHeight_m;
  });
  for (const Opening& opening : storey.parted.openings) {
    const auto [low_m, high_m] = heightsOf(air, storey, opening);
    const glm::dvec2 way = opening.to_m - opening.from_m;
    if (glm::length(way) < 1e-9 || high_m <= low_m) continue;
    const glm::dvec2 direction = glm::normalize(way);
    const glm::dvec2 from = snapped(uprights, opening.from_m, direction);
    const glm::dvec2 to = snapped(uprights, opening.to_m, direction);
    if (glm::length(to - from) < 0.1) continue;
    doorways.push_back(
        {opening.regions, {from, low_m}, {to, low_m}, high_m - low_m, opening.alongFloors, {}});
    for (const glm::dvec2& bend : opening.bends_m) doorways.back().bends_m.emplace_back(bend, low_m);
  }
  return doorways;
}

bool cutAtDoorways(Building& building, const std::vector<RoomAir>& airs) {
  std::vector<UprightCut> cuts;
  for (const RoomAir& air : airs) {
    for (const std::vector<Doorway>& doorways : air.doorways) {
      for (const Doorway& doorway : doorways) {
        if (!doorway.alongFloors)
          cuts.push_back({doorway.from_m, doorway.to_m, doorway.height_m, air.domain});
      }
    }
  }
  const std::size_t before = building.model.pieces.size();
  if (cuts.empty()) return false;
  const std::vector<std::uint32_t> wholeOf =
      cutUpright(building.model.pieces, building.model.materials, building.sideDomain, cuts);
  if (wholeOf.size() == before) return false;
  followCut(building, before, wholeOf);
  return true;
}

}  // namespace clerestory
