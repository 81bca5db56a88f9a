// SPDX-License-Identifier: GPL-3.0-or-later
// Rooms: closed air with a floor to stand on, measured by the divergence theorem.
#include "rooms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <span>

#include <geometry/sampling.hpp>

namespace clerestory {
namespace {

constexpr double floorAreaMin_m2 = 1.5;
constexpr float heightMin_m = 1.6F;
constexpr double meanChordMin_m =
    0.6;  // 4 V / S: a cavity in a wall has twice its thickness, an office 2.6 m
constexpr double levelTolerance_m = 0.002;
constexpr std::array coverHeights_m{0.05, 0.5, 1.2, 1.8,
                                    2.3};  // where the air over covered floor is looked for
constexpr double upward = 0.95;            // cosine of the steepest floor

glm::dvec3 centreOf(const Pieces& pieces, std::uint32_t piece) {
  glm::dvec3 sum(0.0);
  for (const std::uint32_t corner : pieces.polygons[piece]) sum += pieces.points[corner];
  return sum / static_cast<double>(pieces.polygons[piece].size());
}

/// The sides of one domain that look up, as pieces with the height of their centre.
struct Tread {
  std::uint32_t piece;
  double height_m;
};

/// Share of a piece over which a person can stand: none in the hollow of a slab, a roof or a rug.
double headroomShare(const Pieces& pieces, const RayScene& rays, std::uint32_t piece) {
  constexpr std::uint32_t count = 32;
  std::vector<glm::vec3> polygon;
  for (const std::uint32_t corner : pieces.polygons[piece])
    polygon.emplace_back(pieces.points[corner] - rays.origin());
  const Sequence sequence(mixKeys(0x4ead, piece));
  std::uint32_t high = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::vec3 from = pointOnPolygon<glm::vec3>(polygon, sequence(i, 0), sequence(i, 1));
    const auto hit =
        rays.nearest(from + glm::vec3(0, 0, rayOffset_m), {0, 0, 1}, RayScene::Barrier::opaqueAndGlass);
    if (hit.distance_m >= heightMin_m) ++high;
  }
  return static_cast<double>(high) / count;
}

/// Treads of about one height.
struct Level {
  std::span<const Tread> treads;
  double area_m2 = 0.0;
};

/// Levels by falling area, the lower of equals first.
std::vector<Level> levelsOf(const Pieces& pieces, std::span<const Tread> byHeight) {
  std::vector<Level> levels;
  for (std::size_t first = 0; first < byHeight.size();) {
    Level level;
    std::size_t last = first;
    for (; last < byHeight.size() && byHeight[last].height_m - byHeight[first].height_m <= levelTolerance_m;
         ++last) {
      level.area_m2 += pieces.area_m2[byHeight[last].piece];
    }
    level.treads = byHeight.subspan(first, last - first);
    levels.push_back(level);
    first = last;
  }
  std::stable_sort(levels.begin(), levels.end(),
                   [](const Level& a, const Level& b) { return a.area_m2 > b.area_m2; });
  return levels;
}

/// The level of the largest area among the lower half of what can be stood on.
/// A level counts by the area with headroom, which is a quarter of a room's floor at least; the rest may
/// stand under tables and shelves.
void chooseFloor(const Pieces& pieces, const RayScene& rays, std::vector<Tread> treads, double low_m,
                 double high_m, Room& room) {
  std::erase_if(treads, [&](const Tread& tread) { return tread.height_m > 0.5 * (low_m + high_m); });
  std::stable_sort(treads.begin(), treads.end(),
                   [](const Tread& a, const Tread& b) { return a.height_m < b.height_m; });
  double mostHigh_m2 = 0.0;
  for (const Level& level : levelsOf(pieces, treads)) {
    if (level.area_m2 <= mostHigh_m2) break;  // neither this one nor those after it can have more
    std::map<std::uint32_t, double> areaOfSurface_m2;
    std::map<std::uint32_t, double> highOfSurface_m2;
    std::vector<std::uint32_t> floor;
    for (const auto& [piece, height_m] : level.treads) {
      areaOfSurface_m2[pieces.surface[piece]] += pieces.area_m2[piece];
      highOfSurface_m2[pieces.surface[piece]] += headroomShare(pieces, rays, piece) * pieces.area_m2[piece];
      floor.push_back(piece);
    }
    // A surface that is hardly stood on is no floor: the hollow of a rug, the bottom of a bookcase.
    std::erase_if(floor, [&](std::uint32_t piece) {
      return 5.0 * highOfSurface_m2[pieces.surface[piece]] < areaOfSurface_m2[pieces.surface[piece]];
    });
    double area_m2 = 0.0;
    double high_m2 = 0.0;
    for (const std::uint32_t piece : floor) area_m2 += pieces.area_m2[piece];
    for (const auto& [surface, high] : highOfSurface_m2) high_m2 += high;
    const double height_m = level.treads.front().height_m;
    const bool isMore = high_m2 > mostHigh_m2 || (high_m2 == mostHigh_m2 && height_m < room.floor_m);
    if (high_m2 > 0.0 && isMore && 4.0 * high_m2 >= area_m2) {
      mostHigh_m2 = high_m2;
      room.floorArea_m2 = area_m2;
      room.floor_m = height_m;
      room.floorPieces = std::move(floor);
    }
  }
}

/// Adds the parts of a floor that are covered by rugs and furniture: same surface, same level, the room above
/// them.
void addCoveredFloor(const Building& building, const RayScene& rays, Room& room) {
  const Pieces& pieces = building.model.pieces;
  std::set<std::uint32_t> own(room.floorPieces.begin(), room.floorPieces.end());
  std::set<std::uint32_t> surfaces;
  for (const std::uint32_t piece : own) surfaces.insert(pieces.surface[piece]);
  for (std::uint32_t piece = 0; piece < pieces.size(); ++piece) {
    if (own.contains(piece) || !surfaces.contains(pieces.surface[piece])) continue;
    glm::dvec3 place = centreOf(pieces, piece);
    if (std::abs(pieces.normal[piece].z) < upward || std::abs(place.z - room.floor_m) > levelTolerance_m)
      continue;
    const bool isUnderRoom = std::any_of(coverHeights_m.begin(), coverHeights_m.end(), [&](double height_m) {
      return isInAir(building, rays, place + glm::dvec3(0.0, 0.0, height_m), room.domain);
    });
    if (!isUnderRoom) continue;
    room.floorPieces.push_back(piece);
    room.floorArea_m2 += pieces.area_m2[piece];
  }
}

/// Everything that is measured of a domain in one pass over its sides.
struct Measures {
  double volume_m3 = 0.0;
  double low_m = 1e300, high_m = -1e300;
  std::vector<Tread> treads;
};

std::map<std::int32_t, Measures> measureDomains(const Building& building) {
  const Pieces& pieces = building.model.pieces;
  std::map<std::int32_t, Measures> measures;
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
    const std::uint32_t piece = side / 2;
    if (building.sideDomain[side] < 0 || building.innerGlass[piece])
      continue;  // has the same air on both sides
    Measures& own = measures[building.sideDomain[side]];
    const glm::dvec3 normal = side % 2 == 0 ? pieces.normal[piece] : -pieces.normal[piece];
    const glm::dvec3 centre = centreOf(pieces, piece);
    own.volume_m3 -= pieces.area_m2[piece] * glm::dot(centre, normal) / 3.0;
    for (const std::uint32_t corner : pieces.polygons[piece]) {
      own.low_m = std::min(own.low_m, pieces.points[corner].z);
      own.high_m = std::max(own.high_m, pieces.points[corner].z);
    }
    if (normal.z > upward) own.treads.push_back({piece, centre.z});
  }
  return measures;
}

/// Treads of the outside that have a roof: most rays upward from them meet something.
void keepCovered(const Pieces& pieces, const RayScene& rays, std::vector<Tread>& treads) {
  std::erase_if(treads, [&](const Tread& tread) {
    constexpr std::uint32_t count = 32;
    std::vector<glm::vec3> polygon;
    for (const std::uint32_t corner : pieces.polygons[tread.piece]) {
      polygon.emplace_back(pieces.points[corner] - rays.origin());
    }
    const Sequence sequence(mixKeys(0xf1, tread.piece));
    std::uint32_t met = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const glm::vec3 from = pointOnPolygon<glm::vec3>(polygon, sequence(i, 0), sequence(i, 1));
      const glm::vec3 direction = cosineDirection({0, 0, 1}, sequence(i, 2), sequence(i, 3));
      if (rays.nearest(from + glm::vec3(0, 0, rayOffset_m), direction, RayScene::Barrier::opaqueAndGlass))
        ++met;
    }
    return met < count / 2;
  });
}

}  // namespace

void findRooms(Building& building, const RayScene& rays) {
  const Pieces& pieces = building.model.pieces;
  std::map<std::int32_t, Measures> measures = measureDomains(building);
  for (auto& [domain, measured] : measures) {
    const Domain& air = building.domains[static_cast<std::size_t>(domain)];
    if (air.open || 4.0 * measured.volume_m3 < meanChordMin_m * air.area_m2) continue;
    Room room;
    room.domain = domain;
    room.volume_m3 = measured.volume_m3;
    chooseFloor(pieces, rays, measured.treads, measured.low_m, measured.high_m, room);
    if (room.floorArea_m2 < floorAreaMin_m2) continue;
    addCoveredFloor(building, rays, room);
    building.rooms.push_back(std::move(room));
  }

  if (building.rooms.empty() && !building.domains.empty() && building.domains[0].open) {
    Measures& outside = measures[0];
    keepCovered(pieces, rays, outside.treads);
    Room room;
    room.domain = 0;
    chooseFloor(pieces, rays, outside.treads, outside.low_m, outside.high_m, room);
    if (room.floorArea_m2 >= floorAreaMin_m2) {
      addDiagnosis(building.diagnoses,
                   {"G251",
                    "no part of the model is closed air: its covered floor is taken as one room, lit through "
                    "every gap; close the envelope (walls, floor, ceiling, panes) for exact rooms",
                    ""});
      building.rooms.push_back(std::move(room));
    }
  }

  // From south to north, west to east, bottom to top: names that do not depend on the file's order.
  const auto place = [&](const Room& room) {
    const glm::dvec3 centre = centreOf(pieces, room.floorPieces.front());
    return std::array{std::round(10.0 * room.floor_m), std::round(10.0 * centre.y), centre.x};
  };
  std::stable_sort(building.rooms.begin(), building.rooms.end(),
                   [&](const Room& a, const Room& b) { return place(a) < place(b); });
  for (std::size_t i = 0; i < building.rooms.size(); ++i) {
    building.rooms[i].name = "Room " + std::to_string(i + 1);
  }
}

}  // namespace clerestory
