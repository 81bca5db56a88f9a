// SPDX-License-Identifier: GPL-3.0-or-later
// Storeys by the heights at which there is floor to stand on.
#include "storeys.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace clerestory {
namespace {

constexpr double headroom_m = 1.6;
constexpr double storeyLeast_m = 1.8;    // between floors of two storeys
constexpr double floorLeast_m2 = 0.5;    // free of furniture: a lavatory with what stands in it
constexpr double furniture_m = 1.2;      // tops of beds and tables lie within this height over the floor …
constexpr double floorShare = 0.25;      // … of which this share of their area shows around them
constexpr double overDoors_m = 2.15;     // above the floor: above the usual lintel
constexpr double underCeiling_m = 0.12;  // where a ceiling is lower than that
constexpr double sameFloor_m = 0.05;
constexpr double aboveDoors_m =
    0.25;  // over that height, tops of wardrobes; higher air belongs to no room here

/// How much floor with headroom there is, by height in steps of 2 cm. [m²]
std::map<double, double> floorAreas(const AirMap& map) {
  std::map<double, double> areas_m2;
  for (std::uint32_t cell = 0; cell < map.size(); ++cell) {
    for (const AirSpan& span : map.spans(cell)) {
      if (span.high_m - span.low_m < headroom_m) continue;
      areas_m2[std::round(span.low_m * 50.0) / 50.0] += map.cell_m() * map.cell_m();
    }
  }
  return areas_m2;
}

/// Floors of storeys, from the lowest up: the largest first, or the lower one that shows around it.
std::vector<double> floorsOf(const AirMap& map) {
  const std::map<double, double> areas_m2 = floorAreas(map);
  std::vector<std::pair<double, double>> order(areas_m2.begin(), areas_m2.end());
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<double> floors;
  for (const auto& [height_m, area_m2] : order) {
    if (area_m2 < floorLeast_m2) break;
    double floor_m = height_m;
    for (const auto& [lower_m, shown_m2] : areas_m2) {
      if (lower_m < floor_m && height_m - lower_m < furniture_m && shown_m2 >= floorShare * area_m2)
        floor_m = lower_m;
    }
    const bool isNew = std::ranges::none_of(
        floors, [&](double other_m) { return std::abs(other_m - floor_m) < storeyLeast_m; });
    if (isNew) floors.push_back(floor_m);
  }
  std::sort(floors.begin(), floors.end());
  return floors;
}

/// Height of most of the ceiling over a floor.
double ceilingOver(const AirMap& map, double floor_m) {
  std::map<double, std::size_t> cells;
  for (std::uint32_t cell = 0; cell < map.size(); ++cell) {
    for (const AirSpan& span : map.spans(cell)) {
      if (span.low_m < floor_m + headroom_m && span.high_m > floor_m + headroom_m)
        ++cells[std::round(span.high_m * 20.0) / 20.0];
    }
  }
  const auto most = std::max_element(cells.begin(), cells.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == cells.end() ? floor_m + headroom_m : most->first;
}

/// Whether something stands between two cells of a storey, in the middle of the tallest air that both have
/// between two heights.
bool isClosedBetween(const AirMap& map, const RayScene& rays, std::uint32_t a, std::uint32_t b, double low_m,
                     double high_m) {
  double tallest_m = 0.0;
  double middle_m = 0.0;
  for (const AirSpan& first : map.spans(a)) {
    for (const AirSpan& second : map.spans(b)) {
      const double bottom_m = std::max({first.low_m, second.low_m, low_m});
      const double top_m = std::min({first.high_m, second.high_m, high_m});
      if (top_m - bottom_m <= tallest_m) continue;
      tallest_m = top_m - bottom_m;
      middle_m = 0.5 * (bottom_m + top_m);
    }
  }
  if (tallest_m <= 0.0) return true;
  if (!map.mayStop(a) && !map.mayStop(b)) return false;
  const auto local = [&](std::uint32_t cell) {
    return glm::vec3(glm::dvec3(map.middleOf(cell), middle_m) - rays.origin());
  };
  return rays.occluded(local(a), local(b), RayScene::Barrier::opaqueAndGlass);
}

StoreyCells cellsOf(const AirMap& map, const Pieces& pieces, const RayScene& rays, double floor_m,
                    double end_m, double ceiling_m) {
  const double high_m = floor_m + std::clamp(ceiling_m - floor_m - underCeiling_m, headroom_m, overDoors_m);
  const std::vector<bool> none(map.size());
  StoreyCells cells{none, none, std::vector<std::int32_t>(map.size(), -1), {none, none}, {none, none}};
  for (std::uint32_t cell = 0; cell < map.size(); ++cell) {
    for (const AirSpan& span : map.spans(cell)) {
      if (span.low_m > std::min(end_m, high_m + aboveDoors_m) || span.high_m < floor_m + sameFloor_m)
        continue;
      if (span.high_m - span.low_m > sameFloor_m) cells.any[cell] = true;
      if (span.high_m > high_m) cells.high[cell] = true;
    }
    for (const Tread& tread : map.treads(cell)) {
      if (std::abs(tread.height_m - floor_m) <= sameFloor_m)
        cells.surface[cell] =
            static_cast<std::int32_t>(pieces.surface[tread.piece]);  // of several the highest
    }
  }
  for (int way = 0; way < 2; ++way) {
    const auto w = static_cast<std::size_t>(way);
    for (std::uint32_t cell = 0; cell < map.size(); ++cell) {
      const std::uint32_t next = map.neighbour(cell, way);
      if (next == AirMap::none || !cells.any[cell] || !cells.any[next]) continue;
      const bool isOpenAbove =
          cells.high[cell] && cells.high[next] && !isClosedBetween(map, rays, cell, next, high_m, end_m);
      cells.isClosedAbove[w][cell] = !isOpenAbove;
      cells.isClosed[w][cell] =
          !isOpenAbove && isClosedBetween(map, rays, cell, next, floor_m - sameFloor_m, end_m);
    }
  }
  return cells;
}

}  // namespace

std::vector<Storey> storeysOf(const AirMap& map, const Pieces& pieces, const RayScene& rays) {
  std::vector<Storey> storeys;
  const std::vector<double> floors = floorsOf(map);
  for (std::size_t i = 0; i < floors.size(); ++i) {
    const double end_m = i + 1 < floors.size() ? floors[i + 1] : std::numeric_limits<double>::infinity();
    const double ceiling_m = std::min(ceilingOver(map, floors[i]), end_m);
    Storey storey{floors[i],
                  end_m,
                  ceiling_m,
                  partAtNecks(map, cellsOf(map, pieces, rays, floors[i], end_m, ceiling_m)),
                  {}};
    if (storey.parted.count == 0) continue;
    storey.nearest = nearestRegion(map, storey.parted.region);
    storeys.push_back(std::move(storey));
  }
  return storeys;
}

}  // namespace clerestory
