// SPDX-License-Identifier: GPL-3.0-or-later
// Doorways as the raster finds them, moved to the model's own edges.
#include "doorways.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cut.hpp"

namespace clerestory {
namespace {

constexpr double uprightHeight_m = 1.2;  // of what can be a door's side
constexpr double revealMost_m = 0.8;     // depth of a reveal: a thick wall's
constexpr double revealLeast_m = 0.02;
constexpr double reach_m = 0.35;  // from the raster's end of a doorway to the model's
constexpr double facing = 0.85;   // cosine between a reveal's normal and the doorway's direction

/// An upright face of the domain in plan.
struct Upright {
  glm::dvec2 from, to, normal;
};

std::vector<Upright> uprightsOf(const Building& building, std::int32_t domain, double floor_m) {
  const Pieces& pieces = building.model.pieces;
  std::vector<Upright> uprights;
  for (std::uint32_t piece = 0; piece < pieces.size(); ++piece) {
    const glm::dvec3& normal = pieces.normal[piece];
    if (building.sideDomain[2 * piece] != domain && building.sideDomain[2 * piece + 1] != domain) continue;
    if (std::abs(normal.z) > 0.02) continue;
    const glm::dvec2 along = glm::normalize(glm::dvec2(-normal.y, normal.x));
    double low_m = std::numeric_limits<double>::infinity();
    double high_m = -low_m;
    Upright upright{{}, {}, glm::dvec2(normal)};
    double first = low_m;
    double last = -low_m;
    for (const std::uint32_t corner : pieces.polygons[piece]) {
      const glm::dvec3& point = pieces.points[corner];
      low_m = std::min(low_m, point.z);
      high_m = std::max(high_m, point.z);
      const double place = glm::dot(glm::dvec2(point), along);
      if (place < first) {
        first = place;
        upright.from = glm::dvec2(point);
      }
      if (place > last) {
        last = place;
        upright.to = glm::dvec2(point);
      }
    }
    const double usable_m = std::min(high_m, floor_m + 2.0) - std::max(low_m, floor_m);
    if (usable_m >= uprightHeight_m) uprights.push_back(upright);
  }
  return uprights;
}

glm::dvec2 snapped(const std::vector<Upright>& uprights, const glm::dvec2& end, const glm::dvec2& direction) {
  glm::dvec2 best = end;
  double least_m = reach_m;
  const auto offer = [&](const glm::dvec2& place) {
    const double distance_m = glm::length(place - end);
    if (distance_m >= least_m) return;
    least_m = distance_m;
    best = place;
  };
  for (const Upright& upright : uprights) {
    const double depth_m = glm::length(upright.to - upright.from);
    if (depth_m < revealLeast_m || depth_m > revealMost_m) continue;
    if (std::abs(glm::dot(upright.normal, direction)) >= facing) offer(0.5 * (upright.from + upright.to));
  }
  if (least_m < reach_m) return best;
  for (const Upright& upright : uprights) {
    offer(upright.from);
    offer(upright.to);
  }
  return best;
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

}  // namespace

std::vector<Doorway> doorwaysOf(const Building& building, const RoomAir& air, const Storey& storey) {
  std::vector<Doorway> doorways;
  if (storey.parted.openings.empty()) return doorways;
  const std::vector<Upright> uprights = uprightsOf(building, air.domain, storey.floor_m);
  for (const Opening& opening : storey.parted.openings) {
    const auto [low_m, high_m] = heightsOf(air, storey, opening);
    const glm::dvec2 way = opening.to_m - opening.from_m;
    if (glm::length(way) < 1e-9 || high_m <= low_m) continue;
    const glm::dvec2 direction = glm::normalize(way);
    const glm::dvec2 from = snapped(uprights, opening.from_m, direction);
    const glm::dvec2 to = snapped(uprights, opening.to_m, direction);
    if (glm::length(to - from) < 0.1) continue;
    doorways.push_back({opening.regions, {from, low_m}, {to, low_m}, high_m - low_m, opening.alongFloors});
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
