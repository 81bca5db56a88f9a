// SPDX-License-Identifier: GPL-3.0-or-later
// Rooms from regions of air: the raster says where they are, the parts into which walls divide their floors
// give their areas exactly.
#include "rooms.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include <geometry/sampling.hpp>

#include "floorfaces.hpp"
#include "gaps.hpp"
#include "roomnames.hpp"

namespace clerestory {
namespace {

constexpr double floorAreaLeast_m2 = 1.0;
constexpr double headroom_m = 1.6;
constexpr double levelTolerance_m = 0.002;  // faces of one floor
constexpr double floorReach_m = 0.6;        // from a storey's floor to that of one of its rooms
constexpr double platformLeast_m = 0.35;    // from somewhere on a floor of another level to the walls
constexpr double upward = 0.95;             // cosine of the steepest floor
constexpr double enclosedShare = 0.95;      // of rays from covered air outside, for it to be a room

std::size_t at(std::int32_t index) {
  return static_cast<std::size_t>(index);
}

glm::dvec3 centreOf(const Pieces& pieces, std::uint32_t piece) {
  glm::dvec3 sum(0.0);
  for (const std::uint32_t corner : pieces.polygons[piece]) sum += pieces.points[corner];
  return sum / static_cast<double>(pieces.polygons[piece].size());
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
  std::uint32_t piece;
  double height_m, area_m2;
  std::vector<Look> looks;

  [[nodiscard]] double shareOf(auto&& holds) const {
    return static_cast<double>(std::ranges::count_if(looks, holds)) / static_cast<double>(looks.size());
  }
  [[nodiscard]] double stoodOn_m2() const {
    return area_m2 * shareOf([](const Look& look) { return look.isStoodOn; });
  }
  [[nodiscard]] bool isNarrow(const Storey& storey) const {
    return std::ranges::none_of(
        looks, [&](const Look& look) { return storey.parted.toWall_m[look.cell] >= platformLeast_m; });
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

  /// By the raster; nothing beside it.
  [[nodiscard]] std::optional<Look> fromPiece(const glm::dvec3& point) const {
    const std::uint32_t cell = air_.map.cellAt(glm::dvec2(point));
    if (cell == AirMap::none) return std::nullopt;
    return lookAt(cell, storey_.parted.region[cell], air_.map.column(cell), point.z, point.z);
  }

  /// By a ray from the place itself.
  [[nodiscard]] std::optional<Look> fromLevel(const glm::dvec2& place, const Level& level) {
    const std::uint32_t cell = air_.map.cellAt(place);
    if (cell == AirMap::none) return std::nullopt;
    columns_.push_back(airColumn(building_, rays_, air_.domain, place, air_.map.bottom_m()));
    AirColumn& column = columns_.back();
    std::erase_if(column.spans, [&](const AirSpan& span) { return !isAir(place, span); });
    const std::int32_t region = hasAir(column) ? regionBy(cell) : -1;
    return lookAt(cell, region, column, level.lowest_m, level.highest_m);
  }

 private:
  /// A floor that runs through under a wall may count as the room's, and the wall's hollow as air with it.
  [[nodiscard]] bool isAir(const glm::dvec2& place, const AirSpan& span) const {
    constexpr double most_m = 1.0;
    const double height_m = span.low_m + std::min(0.5 * (span.high_m - span.low_m), most_m);
    return isInAir(building_, rays_, {place, height_m}, air_.domain);
  }

  [[nodiscard]] bool isInStorey(const AirSpan& span) const {
    return span.low_m < storey_.end_m && span.high_m > storey_.floor_m + 0.05 &&
           span.high_m - span.low_m > 0.05;
  }
  [[nodiscard]] bool hasAir(const AirColumn& column) const {
    return std::ranges::any_of(column.spans, [&](const AirSpan& span) { return isInStorey(span); });
  }

  /// That of a cell or, at a wall, of one beside it.
  [[nodiscard]] std::int32_t regionBy(std::uint32_t cell) const {
    if (storey_.parted.region[cell] >= 0) return storey_.parted.region[cell];
    for (int way = 0; way < 4; ++way) {
      const std::uint32_t next = air_.map.neighbour(cell, way);
      if (next != AirMap::none && storey_.parted.region[next] >= 0) return storey_.parted.region[next];
    }
    return -1;
  }

  [[nodiscard]] Look lookAt(std::uint32_t cell, std::int32_t region, const AirColumn& column, double low_m,
                            double high_m) const {
    constexpr double underCeiling_m = 0.12;
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
    Tile tile{piece, centreOf(pieces, piece).z, pieces.area_m2[piece], {}};
    if (std::abs(tile.height_m - storey.floor_m) > floorReach_m) continue;
    std::vector<glm::dvec3> polygon;
    for (const std::uint32_t corner : pieces.polygons[piece]) polygon.push_back(pieces.points[corner]);
    const std::uint32_t upper = 2 * piece + (pieces.normal[piece].z > 0.0 ? 0 : 1);
    const Sequence sequence(0x711e);
    for (std::uint32_t i = 0; i < count; ++i) {
      std::optional<Look> look =
          looks.fromPiece(pointOnPolygon<glm::dvec3>(polygon, sequence(i, 0), sequence(i, 1)));
      if (!look) continue;
      if (building.sideDomain[upper] != air.domain) look->isStoodOn = false;  // under a foot, a rug
      tile.looks.push_back(*look);
    }
    if (!tile.looks.empty()) tiles.push_back(std::move(tile));
  }
  std::stable_sort(tiles.begin(), tiles.end(),
                   [](const Tile& a, const Tile& b) { return a.height_m < b.height_m; });
  return tiles;
}

/// Where upright faces of the domain stand at about a height, and its doorways are: in plan, a little longer
/// than drawn, since walls end a little before each other.
std::vector<PlanLine> linesOf(const Building& building, const RoomAir& air, std::size_t storey,
                              const Level& level) {
  constexpr double beyondWall_m = 0.005;
  constexpr double beyondDoorway_m = 0.15;  // a frame stands between it and the wall
  constexpr double footMost_m = 0.02;       // above or below the floor
  constexpr double headLeast_m = 0.1;       // above it
  constexpr double lengthLeast_m = 0.02;
  std::vector<PlanLine> lines;
  const auto add = [&](const glm::dvec2& from, const glm::dvec2& to, double beyond_m) {
    const double length_m = glm::length(to - from);
    if (length_m < lengthLeast_m) return;
    const glm::dvec2 beyond = beyond_m / length_m * (to - from);
    lines.push_back({from - beyond, to + beyond});
  };
  for (const Upright& upright : uprightsOf(building, air.domain)) {
    if (upright.low_m <= level.highest_m + footMost_m && upright.high_m >= level.lowest_m + headLeast_m)
      add(upright.from, upright.to, beyondWall_m);
  }
  for (const Doorway& doorway : air.doorways[storey])
    add(glm::dvec2(doorway.from_m), glm::dvec2(doorway.to_m), beyondDoorway_m);
  return lines;
}

/// Adds what a level has of each region. A face that lies in two for want of a line is shared out.
void addFaces(const Building& building, const RoomAir& air, std::size_t s, FloorLooks& looks, Level& level) {
  constexpr double allShare = 0.67;  // things on a floor hide the air from some looks
  const Storey& storey = air.storeys[s];
  level.faces.resize(at(storey.parted.count));
  std::vector<std::uint32_t> covered;
  for (const Tile& tile : level.pieces) covered.push_back(tile.piece);
  const std::vector<PlanLine> lines = linesOf(building, air, s, level);
  for (const FloorFace& face : floorFaces(building.model.pieces, covered, lines)) {
    const auto count = static_cast<std::uint32_t>(std::clamp(24.0 + 16.0 * face.area_m2, 24.0, 400.0));
    std::map<std::int32_t, Tile> ofRegion;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::optional<Look> look = looks.fromLevel(face.sample(i, count), level);
      if (!look || look->region < 0) continue;
      ofRegion.try_emplace(look->region, Tile{0, level.height_m, 0.0, {}})
          .first->second.looks.push_back(*look);
    }
    for (auto& [region, tile] : ofRegion) {
      const double share = static_cast<double>(tile.looks.size()) / count;
      if (share < 1.0 - allShare) continue;
      const auto most = [&](auto&& holds) { return tile.shareOf(holds) > 0.5; };
      // A window's reveal, and the hollow of a wall that is open somewhere.
      if (tile.isNarrow(storey) && (most([](const Look& look) { return look.isInNiche; }) ||
                                    most([](const Look& look) { return look.isStoodOn; })))
        continue;
      tile.area_m2 = face.area_m2 * (share > allShare ? 1.0 : share);
      level.faces[at(region)].push_back(std::move(tile));
    }
  }
}

/// Levels of a storey, without surfaces that are hardly stood on: the hollow of a rug, the bottom of a
/// bookcase.
std::vector<Level> levelsOf(const Building& building, const RoomAir& air, std::size_t s, FloorLooks& looks) {
  const Pieces& pieces = building.model.pieces;
  const std::vector<Tile> tiles = tilesOf(building, air, air.storeys[s], looks);
  std::vector<Level> levels;
  for (std::size_t first = 0, end = 0; first < tiles.size(); first = end) {
    std::map<std::uint32_t, std::array<double, 2>> areaAndStoodOn_m2;  // by surface
    while (end < tiles.size() && tiles[end].height_m - tiles[first].height_m <= levelTolerance_m) {
      auto& [area_m2, stoodOn_m2] = areaAndStoodOn_m2[pieces.surface[tiles[end].piece]];
      area_m2 += tiles[end].area_m2;
      stoodOn_m2 += tiles[end].stoodOn_m2();
      ++end;
    }
    Level level{.height_m = tiles[first].height_m, .pieces = {}, .faces = {}};
    double level_m2 = 0.0;
    for (std::size_t i = first; i < end; ++i) {
      const auto& [area_m2, stoodOn_m2] = areaAndStoodOn_m2[pieces.surface[tiles[i].piece]];
      if (5.0 * stoodOn_m2 < area_m2) continue;
      level_m2 += tiles[i].area_m2;
      level.pieces.push_back(tiles[i]);
      for (const std::uint32_t corner : pieces.polygons[tiles[i].piece]) {
        level.lowest_m = std::min(level.lowest_m, pieces.points[corner].z);
        level.highest_m = std::max(level.highest_m, pieces.points[corner].z);
      }
    }
    if (level_m2 < floorAreaLeast_m2) continue;
    addFaces(building, air, s, looks, level);
    levels.push_back(std::move(level));
  }
  return levels;
}

/// The floor of a region.
struct Floor {
  double height_m = 0.0, area_m2 = 0.0;
  std::vector<std::uint32_t> pieces;
};

/// Whether a tile of another level is floor too: a platform and tiles of another thickness are, what lies
/// over the floor (a bed, a rug), a window's sill and the hollow of a wall are not.
bool liesBeside(const Tile& tile, double floor_m, const Storey& storey) {
  const double over = tile.shareOf([&](const Look& look) {
    return std::ranges::any_of(look.column->treads, [&](const Tread& tread) {
      return std::abs(tread.height_m - floor_m) <= levelTolerance_m && tread.height_m < tile.height_m;
    });
  });
  return over <= 0.5 && !tile.isNarrow(storey);
}

/// Of a storey's levels the one that most of the region can be stood on, the lower of equals, and what lies
/// beside it.
Floor floorOf(const std::vector<Level>& levels, const Storey& storey, std::int32_t region) {
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
    const auto isFloor = [&](const Tile& tile) {
      return &level == main || liesBeside(tile, main->height_m, storey);
    };
    double area_m2 = 0.0;
    for (const Tile& face : level.faces[at(region)]) area_m2 += isFloor(face) ? face.area_m2 : 0.0;
    if (&level != main && area_m2 < floorAreaLeast_m2) continue;
    floor.area_m2 += area_m2;
    for (const Tile& tile : level.pieces) {
      if (regionOf(tile) == region && isFloor(tile)) floor.pieces.push_back(tile.piece);
    }
  }
  return floor;
}

/// Air of a region by its cells: volume and the height of most of its ceiling.
struct AirMeasure {
  double volume_m3 = 0.0, plan_m2 = 0.0, ceiling_m = 0.0;
};

AirMeasure measureAir(const RoomAir& air, const Storey& storey, std::int32_t region) {
  const double cell_m2 = air.map.cell_m() * air.map.cell_m();
  AirMeasure measure;
  std::map<long, std::pair<std::size_t, double>> ceilings;  // cells and height, by centimetre
  for (std::uint32_t cell = 0; cell < air.map.size(); ++cell) {
    if (storey.parted.region[cell] != region) continue;
    double top_m = -1e300;
    for (const AirSpan& span : air.map.spans(cell)) {
      const double low_m = std::max(span.low_m, storey.floor_m - floorReach_m);
      const double high_m = std::min(span.high_m, storey.end_m);
      if (high_m <= low_m) continue;
      measure.volume_m3 += cell_m2 * (high_m - low_m);
      top_m = std::max(top_m, high_m);
    }
    measure.plan_m2 += cell_m2;
    auto& [cells, height_m] = ceilings[std::lround(100.0 * top_m)];
    height_m = top_m;
    ++cells;
  }
  std::size_t most = 0;
  for (const auto& [centimetre, ceiling] : ceilings) {
    if (ceiling.first <= most) continue;
    most = ceiling.first;
    measure.ceiling_m = ceiling.second;
  }
  return measure;
}

/// Volume of each domain by the divergence theorem: exact where all its sides are known.
std::map<std::int32_t, double> enclosedVolumes(const Building& building) {
  const Pieces& pieces = building.model.pieces;
  std::map<std::int32_t, double> volumes_m3;
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
    const std::uint32_t piece = side / 2;
    if (building.sideDomain[side] < 0 || building.innerGlass[piece]) continue;  // the same air on both sides
    const double sign = side % 2 == 0 ? 1.0 : -1.0;
    volumes_m3[building.sideDomain[side]] -=
        sign * pieces.area_m2[piece] * glm::dot(centreOf(pieces, piece), pieces.normal[piece]) / 3.0;
  }
  return volumes_m3;
}

/// Share of level rays from the middle heights of a region that meet something within reach.
double enclosure(const RayScene& rays, const RoomAir& air, const Storey& storey, std::int32_t region) {
  constexpr std::uint32_t every = 97;  // cells
  constexpr float reach_m = 30.0F;
  const Sequence sequence(0xec);
  std::uint32_t cast = 0;
  std::uint32_t met = 0;
  std::uint32_t seen = 0;
  for (std::uint32_t cell = 0; cell < air.map.size(); ++cell) {
    if (storey.parted.region[cell] != region || ++seen % every != 0) continue;
    for (const AirSpan& span : air.map.spans(cell)) {
      if (span.high_m - span.low_m < headroom_m) continue;
      const glm::dvec3 place(air.map.middleOf(cell), 0.5 * (span.low_m + span.high_m));
      const float angle = 6.2831853F * sequence(cast, 0);
      ++cast;
      const glm::vec3 direction(std::cos(angle), std::sin(angle), 0.0F);
      if (rays.nearest(glm::vec3(place - rays.origin()), direction, RayScene::Barrier::opaqueAndGlass,
                       reach_m))
        ++met;
    }
  }
  return cast == 0 ? 0.0 : static_cast<double>(met) / cast;
}

/// A room with the region that it was made of.
struct Draft {
  Room room;
  const RoomAir* air;
  std::size_t storey;
  std::int32_t region;
};

std::vector<Draft> draftsOf(const Building& building, const RayScene& rays, const RoomAir& air) {
  std::vector<Draft> drafts;
  for (std::size_t s = 0; s < air.storeys.size(); ++s) {
    const Storey& storey = air.storeys[s];
    FloorLooks looks(building, rays, air, storey);
    const std::vector<Level> levels = levelsOf(building, air, s, looks);
    for (std::int32_t region = 0; region < storey.parted.count; ++region) {
      Floor floor = floorOf(levels, storey, region);
      if (floor.area_m2 < floorAreaLeast_m2 || floor.pieces.empty()) continue;
      const AirMeasure measure = measureAir(air, storey, region);
      Room room;
      room.domain = air.domain;
      room.floorArea_m2 = floor.area_m2;
      room.floor_m = floor.height_m;
      room.floorPieces = std::move(floor.pieces);
      room.ceiling_m = measure.ceiling_m;
      // Cells at the walls are half in air: the floor's own area mends what they add or leave out.
      const double mend = floor.area_m2 / measure.plan_m2;
      room.volume_m3 = measure.volume_m3 * (std::abs(mend - 1.0) < 0.1 ? mend : 1.0);
      drafts.push_back({std::move(room), &air, s, region});
    }
  }
  return drafts;
}

/// Answers which room a place belongs to.
class RoomPlaces {
 public:
  RoomPlaces(const Building& building, const std::vector<Draft>& drafts) : building_(building) {
    for (std::size_t i = 0; i < drafts.size(); ++i) {
      const Draft& draft = drafts[i];
      Domain& own = domains_[draft.room.domain];
      own.air = draft.air;
      own.rooms[{draft.storey, draft.region}] = static_cast<std::int32_t>(i);
      if (own.first < 0) own.first = static_cast<std::int32_t>(i);
    }
  }

  [[nodiscard]] std::int32_t roomOf(std::uint32_t side) const {
    const auto found = domains_.find(building_.sideDomain[side]);
    if (found == domains_.end()) return -1;
    const Domain& own = found->second;
    const bool isOpen = building_.domains[at(building_.sideDomain[side])].open;
    if (own.rooms.size() == 1 && !isOpen) return own.first;
    const Pieces& pieces = building_.model.pieces;
    constexpr double off_m = 0.06;
    const glm::dvec3 place =
        centreOf(pieces, side / 2) + (side % 2 == 0 ? off_m : -off_m) * pieces.normal[side / 2];
    const std::uint32_t cell = own.air->map.cellAt(glm::dvec2(place));
    if (isOpen && (cell == AirMap::none || own.air->map.spans(cell).empty())) return -1;
    return roomAt(own, cell, place.z);
  }

 private:
  struct Domain {
    const RoomAir* air = nullptr;
    std::map<std::pair<std::size_t, std::int32_t>, std::int32_t> rooms;  ///< by storey and region
    std::int32_t first = -1;
  };

  /// That of the storey at the height; of one below where there the air has no floor of its own.
  static std::int32_t roomAt(const Domain& own, std::uint32_t cell, double height_m) {
    if (cell == AirMap::none) return own.first;
    std::size_t storey = 0;
    while (storey + 1 < own.air->storeys.size() && height_m > own.air->storeys[storey + 1].floor_m - 0.3)
      ++storey;
    for (std::size_t below = storey + 1; below-- > 0;) {
      const auto room = own.rooms.find({below, own.air->storeys[below].nearest[cell]});
      if (room != own.rooms.end()) return room->second;
    }
    return own.first;
  }

  const Building& building_;
  std::map<std::int32_t, Domain> domains_;
};

void addBorders(Building& building, const std::vector<Draft>& drafts, const std::vector<RoomAir>& airs) {
  std::map<std::tuple<const RoomAir*, std::size_t, std::int32_t>, std::int32_t> roomOf;
  for (std::size_t i = 0; i < drafts.size(); ++i)
    roomOf[{drafts[i].air, drafts[i].storey, drafts[i].region}] = static_cast<std::int32_t>(i);
  for (const RoomAir& air : airs) {
    for (std::size_t s = 0; s < air.storeys.size(); ++s) {
      for (const Doorway& doorway : air.doorways[s]) {
        const auto a = roomOf.find({&air, s, doorway.regions[0]});
        const auto b = roomOf.find({&air, s, doorway.regions[1]});
        if (a == roomOf.end() || b == roomOf.end()) continue;
        const auto [low, high] = std::minmax(a->second, b->second);
        building.borders.push_back({{low, high}, doorway.from_m, doorway.to_m, doorway.height_m});
      }
    }
  }
}

/// Where and how wide the largest gap of a room is, in words; empty where none is found within 3 m of it.
std::optional<Gap> gapAround(const Building& building, const Room& room) {
  constexpr double around_m = 3.0;
  const Pieces& pieces = building.model.pieces;
  glm::dvec3 low(1e300);
  glm::dvec3 high(-1e300);
  std::uint32_t largest = room.floorPieces.front();
  for (const std::uint32_t piece : room.floorPieces) {
    if (pieces.area_m2[piece] > pieces.area_m2[largest]) largest = piece;
    for (const std::uint32_t corner : pieces.polygons[piece]) {
      low = glm::min(low, pieces.points[corner]);
      high = glm::max(high, pieces.points[corner]);
    }
  }
  low -= around_m;
  high = glm::dvec3(high.x, high.y, room.ceiling_m) + around_m;
  const glm::dvec3 inside =
      centreOf(pieces, largest) + glm::dvec3(0.0, 0.0, 0.5 * (room.ceiling_m - room.floor_m));
  return widestGap(pieces, inside, low, high);
}

}  // namespace

void findRooms(Building& building, const RayScene& rays, const std::vector<RoomAir>& airs) {
  const Pieces& pieces = building.model.pieces;
  std::vector<Draft> drafts;
  std::vector<Draft> covered;  // outdoors
  for (const RoomAir& air : airs) {
    std::vector<Draft> own = draftsOf(building, rays, air);
    std::vector<Draft>& list = building.domains[at(air.domain)].open ? covered : drafts;
    std::move(own.begin(), own.end(), std::back_inserter(list));
  }
  const bool noneIsClosed = drafts.empty();
  for (Draft& draft : covered) {
    const Storey& storey = draft.air->storeys[draft.storey];
    if (!noneIsClosed && enclosure(rays, *draft.air, storey, draft.region) < enclosedShare) continue;
    drafts.push_back(std::move(draft));
  }

  const std::map<std::int32_t, double> volumes_m3 = enclosedVolumes(building);
  std::map<std::int32_t, std::size_t> roomsOf;
  for (const Draft& draft : drafts) ++roomsOf[draft.room.domain];
  for (Draft& draft : drafts) {
    const auto exact = volumes_m3.find(draft.room.domain);
    const bool isWhole = roomsOf[draft.room.domain] == 1 && exact != volumes_m3.end();
    if (isWhole && std::abs(exact->second - draft.room.volume_m3) < 0.05 * draft.room.volume_m3)
      draft.room.volume_m3 = exact->second;
  }

  // From bottom to top, south to north, west to east: names that do not depend on the file's order.
  const auto place = [&](const Draft& draft) {
    const glm::dvec3 centre = centreOf(pieces, draft.room.floorPieces.front());
    return std::array{std::round(10.0 * draft.room.floor_m), std::round(10.0 * centre.y), centre.x};
  };
  std::stable_sort(drafts.begin(), drafts.end(),
                   [&](const Draft& a, const Draft& b) { return place(a) < place(b); });
  for (std::size_t i = 0; i < drafts.size(); ++i) {
    drafts[i].room.name = "Room " + std::to_string(i + 1);
    building.rooms.push_back(drafts[i].room);
  }

  const RoomPlaces places(building, drafts);
  building.sideRoom.resize(building.sideDomain.size());
  for (std::uint32_t side = 0; side < building.sideRoom.size(); ++side)
    building.sideRoom[side] = places.roomOf(side);
  for (Portal& portal : building.portals)
    portal.room = building.sideRoom[2 * portal.piece + (portal.frontIsInside ? 0 : 1)];
  nameRooms(building);
  addBorders(building, drafts, airs);

  if (noneIsClosed && !drafts.empty()) {
    Diagnosis diagnosis{
        "G251",
        "no part of the model is closed air: its covered floor is taken as one room, lit "
        "through every gap; close the envelope (walls, floor, ceiling, panes) for exact rooms",
        ""};
    if (const std::optional<Gap> gap = gapAround(building, drafts.front().room)) {
      char text[60];
      std::snprintf(text, sizeof text, "; the largest gap is about %.2f m wide", gap->width_m);
      diagnosis.message += text;
      diagnosis.place_m = gap->place_m;
      building.marks.push_back({"G251", "", gap->place_m});
    }
    addDiagnosis(building.diagnoses, diagnosis);
  }
}

}  // namespace clerestory
