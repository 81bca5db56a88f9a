// SPDX-License-Identifier: GPL-3.0-or-later
// Rooms from regions of air: where the raster has them, with the floors that are found there.
#include "rooms.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <string>

#include <geometry/sampling.hpp>

#include "floors.hpp"
#include "gaps.hpp"
#include "ownframe.hpp"
#include "roomnames.hpp"

namespace clerestory {
namespace {

constexpr float headroom_m = 1.6F;
constexpr double slopingShare = 0.2;    // most of a ceiling at one height, for it to be level
constexpr double enclosedShare = 0.95;  // of rays from covered air outside, for it to be a room

std::size_t at(std::int32_t index) {
  return static_cast<std::size_t>(index);
}

glm::dvec3 centreOf(const Pieces& pieces, std::uint32_t piece) {
  glm::dvec3 sum(0.0);
  for (const std::uint32_t corner : pieces.polygons[piece]) sum += pieces.points[corner];
  return sum / static_cast<double>(pieces.polygons[piece].size());
}

/// Centre of a room's floor in the model's axes, which `frame` was turned out of.
glm::dvec3 centreOfFloor(const Pieces& pieces, const Room& room, const PlanFrame& frame) {
  glm::dvec3 sum(0.0);
  double area_m2 = 0.0;
  for (const std::uint32_t piece : room.floorPieces) {
    sum += pieces.area_m2[piece] * centreOf(pieces, piece);
    area_m2 += pieces.area_m2[piece];
  }
  return outOfFrame(frame, sum / area_m2);
}

/// Air of a region by its cells: the height of most of its ceiling (the mean one where it slopes), and how
/// much there is where the storey has no floor, over a stair.
struct AirMeasure {
  double ceiling_m = 0.0, overNoFloor_m3 = 0.0;
};

AirMeasure measureAir(const RoomAir& air, const Storey& storey, std::int32_t region) {
  const double cell_m2 = air.map.cell_m() * air.map.cell_m();
  AirMeasure measure;
  std::map<long, std::pair<std::size_t, double>> ceilings;  // cells and height, by centimetre
  for (std::uint32_t cell = 0; cell < air.map.size(); ++cell) {
    if (storey.parted.region[cell] != region) continue;
    const double lowest_m = storey.floor_m - floorReach_m;
    double top_m = -1e300;
    for (const AirSpan& span : air.map.spans(cell)) {
      const double high_m = std::min(span.high_m, storey.end_m);
      if (high_m <= lowest_m) continue;
      if (span.low_m < lowest_m) measure.overNoFloor_m3 += cell_m2 * (high_m - storey.floor_m);
      top_m = std::max(top_m, high_m);
    }
    auto& [cells, height_m] = ceilings[std::lround(100.0 * top_m)];
    height_m = top_m;
    ++cells;
  }
  std::size_t most = 0;
  std::size_t all = 0;
  double sum_m = 0.0;
  for (const auto& [centimetre, ceiling] : ceilings) {
    const auto& [cells, height_m] = ceiling;
    all += cells;
    sum_m += static_cast<double>(cells) * height_m;
    if (cells <= most) continue;
    most = cells;
    measure.ceiling_m = height_m;
  }
  const bool slopes = static_cast<double>(most) < slopingShare * static_cast<double>(all);
  if (slopes) measure.ceiling_m = sum_m / static_cast<double>(all);
  return measure;
}

/// Volumes of the domains whose sides close them, by the divergence theorem. Seldom those of a drawn model:
/// sides within furniture and joints are told apart by samples.
std::map<std::int32_t, double> enclosedVolumes(const Building& building) {
  constexpr double closed = 1e-9;  // of the surface: how far its sides' area vectors are from none together
  struct Enclosure {
    double volume_m3 = 0.0, area_m2 = 0.0;
    glm::dvec3 areaVector_m2{0.0};
  };
  const Pieces& pieces = building.model.pieces;
  std::map<std::int32_t, Enclosure> enclosures;
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
    const std::uint32_t piece = side / 2;
    if (building.sideDomain[side] < 0 || building.innerGlass[piece]) continue;  // the same air on both sides
    const glm::dvec3 outwards_m2 =
        (side % 2 == 0 ? -1.0 : 1.0) * pieces.area_m2[piece] * pieces.normal[piece];
    Enclosure& own = enclosures[building.sideDomain[side]];
    own.volume_m3 += glm::dot(centreOf(pieces, piece), outwards_m2) / 3.0;
    own.area_m2 += pieces.area_m2[piece];
    own.areaVector_m2 += outwards_m2;
  }
  std::map<std::int32_t, double> volumes_m3;
  for (const auto& [domain, own] : enclosures) {
    if (glm::length(own.areaVector_m2) <= closed * own.area_m2) volumes_m3[domain] = own.volume_m3;
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
      const PlanFrame& frame = air.map.frame();
      const glm::vec3 direction(
          std::cos(angle) * glm::vec2(frame.along) + std::sin(angle) * glm::vec2(frame.across), 0.0F);
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
    std::vector<Floor> floors = floorsOf(building, rays, air, s);
    for (std::int32_t region = 0; region < storey.parted.count; ++region) {
      Floor& floor = floors[at(region)];
      if (floor.area_m2 < floorAreaLeast_m2 || floor.pieces.empty()) continue;
      const AirMeasure measure = measureAir(air, storey, region);
      Room room;
      room.domain = air.domain;
      room.floorArea_m2 = floor.area_m2;
      room.floor_m = floor.height_m;
      room.floorPieces = std::move(floor.pieces);
      room.ceiling_m = measure.ceiling_m;
      room.volume_m3 = floor.air_m3 + measure.overNoFloor_m3;
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
        RoomBorder& border = building.borders.emplace_back();
        border = {{low, high}, {doorway.from_m}, doorway.height_m};
        border.line_m.insert(border.line_m.end(), doorway.bends_m.begin(), doorway.bends_m.end());
        border.line_m.push_back(doorway.to_m);
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

void findRooms(Building& building, const PlanFrame& frame, const RayScene& rays,
               const std::vector<RoomAir>& airs) {
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
    const glm::dvec3 centre = centreOfFloor(pieces, draft.room, frame);
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
