// SPDX-License-Identifier: GPL-3.0-or-later
// Floors by level: walls divide them into faces, whose areas are exact, and looks up from each say whose they
// are.
#include "floors.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <span>

#include "floorfaces.hpp"
#include "rooms.hpp"
#include "stacks.hpp"

namespace clerestory {
namespace {

constexpr float headroom_m = 1.6F;
constexpr double levelTolerance_m = 0.002;  // faces of one floor
constexpr double underCeiling_m = 0.12;     // free of furniture
constexpr double reachLeast_m = 0.35;       // from somewhere on a floor to the walls
constexpr double platformLeast_m = 0.7;     // width of a floor of another level: a sill has less
constexpr double sliverMost_m = 0.015;      // width, as a tile has it: of joints of 7.5 mm
constexpr double stoodOnLeast = 0.2;        // share of a surface, for it to be a floor
constexpr double upward = 0.95;             // cosine of the steepest floor

std::size_t at(std::int32_t index) {
  return static_cast<std::size_t>(index);
}

double heightOf(const Pieces& pieces, std::uint32_t piece) {
  double sum_m = 0.0;
  for (const std::uint32_t corner : pieces.polygons[piece]) sum_m += pieces.points[corner].z;
  return sum_m / static_cast<double>(pieces.polygons[piece].size());
}

/// A look up from a place on a floor.
struct Look {
  std::uint32_t cell;
  std::int32_t region;  ///< -1: none, the place lies under a wall
  const AirColumn* column;
  bool isStoodOn;
  bool isInNiche;  ///< nothing is free right above the floor, nor under the ceiling: a window's reveal
};

/// A part of a floor, a piece or a face, with looks from all over it.
struct Tile {
  std::uint32_t piece;  ///< itself, or the one that a face lies on
  double height_m, area_m2, outline_m;
  std::vector<Look> looks;

  [[nodiscard]] double shareOf(auto&& holds) const {
    return static_cast<double>(std::ranges::count_if(looks, holds)) / static_cast<double>(looks.size());
  }
  /// Without what lies under walls, of which pieces may have any amount.
  [[nodiscard]] double inAir_m2() const {
    return area_m2 * shareOf([](const Look& look) { return look.isStoodOn || look.region >= 0; });
  }
  [[nodiscard]] double stoodOn_m2() const {
    return area_m2 * shareOf([](const Look& look) { return look.isStoodOn; });
  }
  /// That of a square or a circle with as much area for its outline, half of a long strip's. [m]
  [[nodiscard]] double width_m() const { return 4.0 * area_m2 / outline_m; }
  /// Whether all of it lies at a wall.
  [[nodiscard]] bool isNarrow(const Storey& storey) const {
    return std::ranges::none_of(
        looks, [&](const Look& look) { return storey.parted.toWall_m[look.cell] >= reachLeast_m; });
  }
};

/// The region of most looks; -1 where none has one.
std::int32_t regionOf(const Tile& tile) {
  std::map<std::int32_t, std::size_t> votes;
  for (const Look& look : tile.looks) ++votes[look.region];
  const auto most = std::max_element(votes.begin(), votes.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == votes.end() ? -1 : most->first;
}

/// The surfaces at about one height that may be a floor.
struct Level {
  double height_m = 0.0;
  double lowest_m = 1e300, highest_m = -1e300;  ///< of their corners: a ramp has no one height
  std::vector<Tile> pieces;
  std::vector<std::vector<Tile>> faces;  ///< by region
};

/// Looks up over a storey.
class FloorLooks {
 public:
  FloorLooks(const Building& building, const RayScene& rays, const RoomAir& air, const Storey& storey)
      : building_(building), rays_(rays), air_(air), storey_(storey) {}

  /// By the raster, and by a ray for whether the place can be stood on; nothing beside the raster.
  [[nodiscard]] std::optional<Look> fromPiece(const glm::dvec3& point) const {
    const std::uint32_t cell = air_.map.cellAt(glm::dvec2(point));
    if (cell == AirMap::none) return std::nullopt;
    Look look = lookAt(cell, storey_.parted.region[cell], air_.map.column(cell), point.z, point.z);
    const glm::vec3 from(point + glm::dvec3(0.0, 0.0, levelTolerance_m) - rays_.origin());
    look.isStoodOn = !rays_.meetsAny(from, {0, 0, 1}, RayScene::Barrier::opaqueAndGlass, headroom_m);
    return look;
  }

  /// By a ray from the place itself, over which the air belongs to the region that it sees close by: a wall
  /// between tells them apart. Nothing where no region is close by.
  [[nodiscard]] std::optional<Look> fromLevel(const glm::dvec2& place, const Level& level) {
    const std::uint32_t cell = air_.map.cellAt(place);
    if (cell == AirMap::none) return std::nullopt;
    const NearCells near = cellsOfRegions(cell, place);
    if (near.count == 0) return std::nullopt;
    columns_.push_back(airColumn(building_, rays_, air_.domain, place, air_.map.bottom_m()));
    AirColumn& column = columns_.back();
    std::int32_t region = -1;
    std::erase_if(column.spans, [&](const AirSpan& span) {
      if (!isInStorey(span)) return false;
      const std::int32_t seen = regionSeenFrom(place, near, span);
      if (region < 0) region = seen;
      return seen < 0;
    });
    return lookAt(cell, region, column, level.lowest_m, level.highest_m);
  }

  [[nodiscard]] bool isInAir(const glm::dvec3& point) const {
    return clerestory::isInAir(building_, rays_, point, air_.domain);
  }

 private:
  /// Some of nine cells, by distance.
  struct NearCells {
    std::array<std::pair<double, std::uint32_t>, 9> cells;
    std::size_t count = 0;
  };

  /// That of the nearest cell about a place that nothing hides from it: at a person's middle or, between
  /// furniture, under the ceiling.
  [[nodiscard]] std::int32_t regionSeenFrom(const glm::dvec2& place, const NearCells& near,
                                            const AirSpan& span) const {
    constexpr double most_m = 1.0;
    const double low_m = span.low_m + std::min(0.5 * (span.high_m - span.low_m), most_m);
    const double high_m = storey_.ceiling_m - underCeiling_m;
    const std::int32_t region = regionSeenAt({place, low_m}, near);
    const bool reachesUp = span.high_m > high_m && high_m > low_m;
    return region >= 0 || !reachesUp ? region : regionSeenAt({place, high_m}, near);
  }

  /// Those that lie in a region, of a cell and the ones about it.
  [[nodiscard]] NearCells cellsOfRegions(std::uint32_t cell, const glm::dvec2& place) const {
    NearCells near;
    const auto offer = [&](std::uint32_t other) {
      if (other != AirMap::none && storey_.parted.region[other] >= 0)
        near.cells[near.count++] = {glm::length(air_.map.middleOf(other) - place), other};
    };
    offer(cell);
    for (int way = 0; way < 4; ++way) {
      const std::uint32_t next = air_.map.neighbour(cell, way);
      offer(next);
      if (next != AirMap::none) offer(air_.map.neighbour(next, (way + 1) % 4));
    }
    std::sort(near.cells.begin(), near.cells.begin() + static_cast<std::ptrdiff_t>(near.count));
    return near;
  }

  [[nodiscard]] std::int32_t regionSeenAt(const glm::dvec3& place, const NearCells& near) const {
    const glm::vec3 from(place - rays_.origin());
    for (std::size_t i = 0; i < near.count; ++i) {
      const std::uint32_t other = near.cells[i].second;
      const glm::vec3 to(glm::dvec3(air_.map.middleOf(other), place.z) - rays_.origin());
      const bool isInAir = std::ranges::any_of(air_.map.spans(other), [&](const AirSpan& air) {
        return air.low_m < place.z && air.high_m > place.z;
      });
      if (isInAir && !rays_.occluded(from, to, RayScene::Barrier::opaqueAndGlass))
        return storey_.parted.region[other];
    }
    return -1;
  }

  [[nodiscard]] bool isInStorey(const AirSpan& span) const {
    return span.low_m < storey_.end_m && span.high_m > storey_.floor_m + 0.05 &&
           span.high_m - span.low_m > 0.05;
  }

  [[nodiscard]] Look lookAt(std::uint32_t cell, std::int32_t region, const AirColumn& column, double low_m,
                            double high_m) const {
    Look look{cell, region, &column, false, true};
    for (const AirSpan& span : column.spans) {
      const bool isOnFloor = span.low_m > low_m - levelTolerance_m && span.low_m < high_m + levelTolerance_m;
      if (isOnFloor && span.high_m - span.low_m >= headroom_m) look.isStoodOn = true;
      if (isOnFloor || (isInStorey(span) && span.high_m > storey_.ceiling_m - underCeiling_m))
        look.isInNiche = false;
    }
    return look;
  }

  const Building& building_;
  const RayScene& rays_;
  const RoomAir& air_;
  const Storey& storey_;
  std::deque<AirColumn> columns_;
};

/// Level pieces about a storey's floor, by height.
std::vector<Tile> tilesOf(const Building& building, const RoomAir& air, const Storey& storey,
                          const FloorLooks& looks) {
  constexpr std::uint32_t count = 24;
  const Pieces& pieces = building.model.pieces;
  std::vector<Tile> tiles;
  for (std::uint32_t piece = 0; piece < pieces.size(); ++piece) {
    if (std::abs(pieces.normal[piece].z) < upward) continue;
    Tile tile{piece, heightOf(pieces, piece), pieces.area_m2[piece], 0.0, {}};
    if (std::abs(tile.height_m - storey.floor_m) > floorReach_m) continue;
    const auto loop = pieces.polygons[piece];
    const auto cornerAt = [&](std::size_t corner) {
      return glm::dvec2(pieces.points[loop[corner % loop.size()]]);
    };
    FloorFace face{pieces.area_m2[piece], 0.0, {}};
    for (std::size_t i = 0; i < loop.size(); ++i)
      face.outline_m += glm::length(cornerAt(i + 1) - cornerAt(i));
    for (std::size_t i = 2; i < loop.size(); ++i)
      face.triangles.push_back({cornerAt(0), cornerAt(i - 1), cornerAt(i)});
    tile.outline_m = face.outline_m;
    const std::uint32_t upper = 2 * piece + (pieces.normal[piece].z > 0.0 ? 0 : 1);
    for (const glm::dvec2& place : face.samples(air.map.frame(), count)) {
      const double height_m = heightOver(pieces, piece, place);
      std::optional<Look> look = looks.fromPiece({place, height_m});
      if (!look) continue;
      // A threshold lies in two airs, and its side in that of most of it: one under an outer door is
      // outdoors, of one between rooms the place tells.
      const std::int32_t own = building.sideDomain[upper];
      const bool isOutdoors = own >= 0 && building.domains[at(own)].open;
      if (look->isStoodOn && own != air.domain)
        look->isStoodOn = !isOutdoors && looks.isInAir({place, height_m + 0.5 * headroom_m});
      tile.looks.push_back(*look);
    }
    if (!tile.looks.empty()) tiles.push_back(std::move(tile));
  }
  std::stable_sort(tiles.begin(), tiles.end(),
                   [](const Tile& a, const Tile& b) { return a.height_m < b.height_m; });
  return tiles;
}

/// Whether something stands in the plane of an upright piece at a height: the piece itself, or what goes on
/// over it.
bool standsAt(const RayScene& rays, const Upright& upright, double height_m) {
  constexpr double off_m = 0.002;
  if (upright.high_m >= height_m) return true;
  const glm::dvec2 middle = 0.5 * (upright.from + upright.to);
  const auto local = [&](double side) {
    return glm::vec3(glm::dvec3(middle + side * off_m * upright.normal, height_m) - rays.origin());
  };
  return rays.occluded(local(-1.0), local(1.0), RayScene::Barrier::opaqueAndGlass);
}

/// Where an upright piece stands at a height: how a wall with a door was divided changes nothing. As it was
/// where it does not reach there.
Upright slicedAt(const Pieces& pieces, const Upright& upright, double height_m) {
  if (upright.low_m >= height_m || upright.high_m <= height_m) return upright;
  const glm::dvec2 along(-upright.normal.y, upright.normal.x);
  const auto placeOf = [&](const glm::dvec2& place) { return glm::dot(place - upright.from, along); };
  Upright sliced = upright;
  std::swap(sliced.from, sliced.to);
  const auto loop = pieces.polygons[upright.piece];
  for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
    const glm::dvec3& a = pieces.points[loop[j]];
    const glm::dvec3& b = pieces.points[loop[i]];
    if ((a.z < height_m) == (b.z < height_m)) continue;
    const glm::dvec2 met(a + (height_m - a.z) / (b.z - a.z) * (b - a));
    if (placeOf(met) < placeOf(sliced.from)) sliced.from = met;
    if (placeOf(met) > placeOf(sliced.to)) sliced.to = met;
  }
  return sliced;
}

/// Parts of one upright plane in plan, joined where they touch.
std::vector<PlanLine> wholeLines(const std::vector<Upright>& parts) {
  constexpr double same_m = 1e-6;
  if (parts.empty()) return {};
  const Upright& first = parts.front();
  const auto placeOf = [&](const glm::dvec2& place) {
    return glm::dot(place - first.from, glm::dvec2(-first.normal.y, first.normal.x));
  };
  std::vector<PlanLine> order;
  for (const Upright& part : parts) {
    order.push_back({part.from, part.to});
    if (placeOf(part.to) < placeOf(part.from)) std::swap(order.back().from_m, order.back().to_m);
  }
  std::sort(order.begin(), order.end(),
            [&](const PlanLine& a, const PlanLine& b) { return placeOf(a.from_m) < placeOf(b.from_m); });
  std::vector<PlanLine> lines;
  for (const PlanLine& part : order) {
    if (lines.empty() || placeOf(part.from_m) > placeOf(lines.back().to_m) + same_m) {
      lines.push_back(part);
    } else if (placeOf(part.to_m) > placeOf(lines.back().to_m)) {
      lines.back().to_m = part.to_m;
    }
  }
  return lines;
}

/// Where upright faces stand at about a height, and a domain's doorways are: in plan, a little longer
/// than drawn, since walls end a little before each other.
std::vector<PlanLine> linesOf(const Building& building, const RayScene& rays, const RoomAir& air,
                              std::size_t storey, const Level& level) {
  constexpr double beyondWall_m = 0.005;
  constexpr double beyondDoorway_m = 0.15;  // a frame stands between it and the wall
  constexpr double footMost_m = 0.02;       // above or below the floor
  constexpr double headLeast_m = 0.1;       // above it
  constexpr double lengthLeast_m = 1e-4;
  std::vector<PlanLine> lines;
  const auto add = [&](const glm::dvec2& from, const glm::dvec2& to, double beyond_m) {
    const double length_m = glm::length(to - from);
    if (length_m < lengthLeast_m) return;
    const glm::dvec2 beyond = beyond_m / length_m * (to - from);
    lines.push_back({from - beyond, to + beyond});
  };
  std::map<std::uint32_t, std::vector<Upright>> byPolygon;
  for (const Upright& upright : uprightsOf(building.model.pieces))
    byPolygon[upright.polygon].push_back(upright);
  for (const auto& [polygon, uprights] : byPolygon) {
    std::vector<Upright> standing;
    for (const Upright& upright : uprights) {
      if (upright.low_m <= level.highest_m + footMost_m &&
          standsAt(rays, upright, level.lowest_m + headLeast_m))
        standing.push_back(slicedAt(building.model.pieces, upright, level.highest_m + footMost_m));
    }
    for (const PlanLine& line : wholeLines(standing)) add(line.from_m, line.to_m, beyondWall_m);
  }
  for (const Doorway& doorway : air.doorways[storey])
    if (!doorway.alongFloors) add(glm::dvec2(doorway.from_m), glm::dvec2(doorway.to_m), beyondDoorway_m);
  return lines;
}

/// The level's first piece that covers a place.
std::uint32_t pieceAt(const Pieces& pieces, const Level& level, const glm::dvec2& place) {
  for (const Tile& tile : level.pieces) {
    const auto loop = pieces.polygons[tile.piece];
    const auto isLeft = [&](std::size_t i) {
      const glm::dvec2 from(pieces.points[loop[i]]);
      const glm::dvec2 way = glm::dvec2(pieces.points[loop[(i + 1) % loop.size()]]) - from;
      return way.x * (place.y - from.y) - way.y * (place.x - from.x) >= 0.0;
    };
    const bool first = isLeft(0);
    std::size_t i = 1;
    while (i < loop.size() && isLeft(i) == first) ++i;
    if (i == loop.size()) return tile.piece;
  }
  return level.pieces.front().piece;
}

/// Adds what a level has of each region. A face that lies in two for want of a line is shared out.
void addFaces(const Building& building, const RayScene& rays, const RoomAir& air, std::size_t s,
              FloorLooks& looks, Level& level) {
  constexpr double allShare = 0.67;        // things on a floor hide the air from some looks
  constexpr double sharedLeast_m2 = 0.05;  // a smaller face is of one region, or of none
  constexpr double slitLeast_m2 = 2.5e-4;  // a smaller sliver is left out: rounding says what is seen from it
  constexpr double sliverShare = 0.95;     // a joint reaches under walls, a sheet's edge stands in a room
  const Storey& storey = air.storeys[s];
  level.faces.resize(at(storey.parted.count));
  std::vector<std::uint32_t> covered;
  for (const Tile& tile : level.pieces) covered.push_back(tile.piece);
  const std::vector<PlanLine> lines = linesOf(building, rays, air, s, level);
  for (const FloorFace& face : floorFaces(building.model.pieces, covered, lines)) {
    const bool isSliver = 4.0 * face.area_m2 < sliverMost_m * face.outline_m;
    if (isSliver && face.area_m2 < slitLeast_m2) continue;
    const auto count = static_cast<std::uint32_t>(std::clamp(24.0 + 16.0 * face.area_m2, 24.0, 400.0));
    std::map<std::int32_t, Tile> ofRegion;
    for (const glm::dvec2& place : face.samples(air.map.frame(), count)) {
      const std::optional<Look> look = looks.fromLevel(place, level);
      if (!look || look->region < 0) continue;
      const auto found = ofRegion.find(look->region);
      if (found != ofRegion.end()) {
        found->second.looks.push_back(*look);
        continue;
      }
      const std::uint32_t piece = pieceAt(building.model.pieces, level, place);
      ofRegion.emplace(look->region, Tile{piece, level.height_m, face.area_m2, face.outline_m, {*look}});
    }
    const bool isSmall = face.area_m2 < sharedLeast_m2;
    const double shareLeast = isSliver ? sliverShare : isSmall ? 0.5 : 1.0 - allShare;
    for (auto& [region, tile] : ofRegion) {
      const double share = static_cast<double>(tile.looks.size()) / count;
      if (share < shareLeast) continue;
      const double niche = tile.shareOf([](const Look& look) { return look.isInNiche; });
      if (tile.isNarrow(storey) && niche > 0.5) continue;  // a window's reveal
      if (share <= allShare && !isSmall) {
        tile.area_m2 *= share;
        tile.outline_m *= share;
      }
      level.faces[at(region)].push_back(std::move(tile));
    }
  }
}

/// Levels of a storey, without surfaces that are hardly stood on: the hollow of a rug, the bottom of a
/// bookcase.
std::vector<Level> levelsOf(const Building& building, const RayScene& rays, const RoomAir& air, std::size_t s,
                            FloorLooks& looks) {
  const Pieces& pieces = building.model.pieces;
  const std::vector<Tile> tiles = tilesOf(building, air, air.storeys[s], looks);
  std::vector<Level> levels;
  for (std::size_t first = 0, end = 0; first < tiles.size(); first = end) {
    std::map<std::uint32_t, std::array<double, 2>> areaAndStoodOn_m2;  // by surface
    while (end < tiles.size() && tiles[end].height_m - tiles[first].height_m <= levelTolerance_m) {
      auto& [area_m2, stoodOn_m2] = areaAndStoodOn_m2[pieces.surface[tiles[end].piece]];
      area_m2 += tiles[end].inAir_m2();
      stoodOn_m2 += tiles[end].stoodOn_m2();
      ++end;
    }
    Level level{.height_m = tiles[first].height_m, .pieces = {}, .faces = {}};
    double level_m2 = 0.0;
    for (std::size_t i = first; i < end; ++i) {
      const auto& [area_m2, stoodOn_m2] = areaAndStoodOn_m2[pieces.surface[tiles[i].piece]];
      if (stoodOn_m2 < stoodOnLeast * area_m2) continue;
      level_m2 += tiles[i].inAir_m2();
      level.pieces.push_back(tiles[i]);
      for (const std::uint32_t corner : pieces.polygons[tiles[i].piece]) {
        level.lowest_m = std::min(level.lowest_m, pieces.points[corner].z);
        level.highest_m = std::max(level.highest_m, pieces.points[corner].z);
      }
    }
    if (level_m2 < floorAreaLeast_m2) continue;
    addFaces(building, rays, air, s, looks, level);
    levels.push_back(std::move(level));
  }
  return levels;
}

/// Whether tiles of another level may be floor too: a platform and tiles of another thickness are, what lies
/// over the floor (a bed, a rug) or under something is not.
bool lieBeside(std::span<const Tile* const> tiles, double floor_m) {
  double area_m2 = 0.0;
  double over_m2 = 0.0;
  double stoodOn_m2 = 0.0;
  for (const Tile* tile : tiles) {
    const double over = tile->shareOf([&](const Look& look) {
      return std::ranges::any_of(look.column->treads, [&](const Tread& tread) {
        return std::abs(tread.height_m - floor_m) <= levelTolerance_m && tread.height_m < tile->height_m;
      });
    });
    area_m2 += tile->area_m2;
    over_m2 += over * tile->area_m2;
    stoodOn_m2 += tile->stoodOn_m2();
  }
  return over_m2 <= 0.5 * area_m2 && stoodOn_m2 >= stoodOnLeast * area_m2;
}

/// Height of the air over a face, in the mean.
double airOver_m(const Tile& face, const Storey& storey) {
  double sum_m = 0.0;
  for (const Look& look : face.looks) {
    for (const AirSpan& span : look.column->spans)
      sum_m += std::max(0.0, std::min(span.high_m, storey.end_m) - std::max(span.low_m, face.height_m));
  }
  return sum_m / static_cast<double>(face.looks.size());
}

/// Those of a level's tiles that are floor beside the main one: of each surface all or none, so that it goes
/// on under a kitchen.
std::vector<const Tile*> besideMain(const Pieces& pieces, std::span<const Tile* const> tiles,
                                    double floor_m) {
  std::map<std::uint32_t, std::vector<const Tile*>> bySurface;
  for (const Tile* tile : tiles) bySurface[pieces.surface[tile->piece]].push_back(tile);
  std::vector<const Tile*> result;
  for (const auto& [surface, own] : bySurface) {
    if (lieBeside(own, floor_m)) result.insert(result.end(), own.begin(), own.end());
  }
  return result;
}

/// Of a storey's levels the one that most of the region can be stood on, the lower of equals, and what lies
/// beside it.
Floor floorOf(const Pieces& pieces, const Storey& storey, const std::vector<Level>& levels,
              std::int32_t region) {
  const Level* main = nullptr;
  double mostStoodOn_m2 = 0.0;
  for (const Level& level : levels) {
    double stoodOn_m2 = 0.0;
    for (const Tile& face : level.faces[at(region)]) stoodOn_m2 += face.stoodOn_m2();
    if (stoodOn_m2 <= mostStoodOn_m2) continue;
    mostStoodOn_m2 = stoodOn_m2;
    main = &level;
  }
  if (main == nullptr) return {};
  Floor floor{.height_m = main->height_m, .pieces = {}};
  for (const Level& level : levels) {
    std::vector<const Tile*> faces;
    std::vector<const Tile*> own;
    for (const Tile& face : level.faces[at(region)]) faces.push_back(&face);
    for (const Tile& tile : level.pieces) {
      if (regionOf(tile) == region) own.push_back(&tile);
    }
    if (&level != main) {
      faces = besideMain(pieces, faces, main->height_m);
      std::erase_if(faces, [](const Tile* face) { return face->width_m() < platformLeast_m; });
      own = besideMain(pieces, own, main->height_m);
    }
    double area_m2 = 0.0;
    double air_m3 = 0.0;
    for (const Tile* face : faces) {
      area_m2 += face->area_m2;
      air_m3 += face->area_m2 * airOver_m(*face, storey);
    }
    if (&level != main && area_m2 < floorAreaLeast_m2) continue;
    floor.area_m2 += area_m2;
    floor.air_m3 += air_m3;
    for (const Tile* tile : own) floor.pieces.push_back(tile->piece);
  }
  return floor;
}

}  // namespace

std::vector<Floor> floorsOf(const Building& building, const RayScene& rays, const RoomAir& air,
                            std::size_t storey) {
  FloorLooks looks(building, rays, air, air.storeys[storey]);
  const std::vector<Level> levels = levelsOf(building, rays, air, storey, looks);
  std::vector<Floor> floors;
  for (std::int32_t region = 0; region < air.storeys[storey].parted.count; ++region)
    floors.push_back(floorOf(building.model.pieces, air.storeys[storey], levels, region));
  return floors;
}

}  // namespace clerestory
