// SPDX-License-Identifier: GPL-3.0-or-later
// Which domains are looked at for rooms, and within which bounds.
#include <glm/geometric.hpp>

#include <algorithm>
#include <map>

#include <geometry/sampling.hpp>

#include "rooms.hpp"

namespace clerestory {
namespace {

constexpr double floorLeast_m2 = 0.8;  // of faces that look up, for a domain to be worth a look
constexpr double heightLeast_m = 1.6;
constexpr double upward = 0.95;

/// Whether most rays upward from a piece's upper side meet something.
bool isCovered(const Pieces& pieces, const RayScene& rays, std::uint32_t piece) {
  constexpr std::uint32_t count = 32;
  std::vector<glm::vec3> polygon;
  for (const std::uint32_t corner : pieces.polygons[piece]) {
    polygon.emplace_back(pieces.points[corner] - rays.origin());
  }
  const Sequence sequence(mixKeys(0xf1, piece));
  std::uint32_t met = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::vec3 from = pointOnPolygon<glm::vec3>(polygon, sequence(i, 0), sequence(i, 1));
    const glm::vec3 direction = cosineDirection({0, 0, 1}, sequence(i, 2), sequence(i, 3));
    if (rays.nearest(from + glm::vec3(0, 0, rayOffset_m), direction, RayScene::Barrier::opaqueAndGlass))
      ++met;
  }
  return met >= count / 2;
}

struct Extent {
  double floor_m2 = 0.0, low_m = 1e300, high_m = -1e300;
  std::vector<std::uint32_t> sides;
};

}  // namespace

std::vector<RoomAir> airOfRooms(const Building& building, const RayScene& rays) {
  const Pieces& pieces = building.model.pieces;
  std::map<std::int32_t, Extent> extents;
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
    const std::int32_t domain = building.sideDomain[side];
    const std::uint32_t piece = side / 2;
    if (domain < 0 || building.innerGlass[piece]) continue;
    const bool looksUp = (side % 2 == 0 ? 1.0 : -1.0) * pieces.normal[piece].z > upward;
    // Outdoors only what lies under a roof: the ground may reach to the horizon.
    const bool isOpen = building.domains[static_cast<std::size_t>(domain)].open;
    if (isOpen && (!looksUp || !isCovered(pieces, rays, piece))) continue;
    Extent& extent = extents[domain];
    if (looksUp) extent.floor_m2 += pieces.area_m2[piece];
    extent.sides.push_back(side);
    for (const std::uint32_t corner : pieces.polygons[piece]) {
      extent.low_m = std::min(extent.low_m, pieces.points[corner].z);
      extent.high_m = std::max(extent.high_m, isOpen ? 1e300 : pieces.points[corner].z);
    }
  }
  std::vector<RoomAir> airs;
  for (const auto& [domain, extent] : extents) {
    if (extent.floor_m2 < floorLeast_m2 || extent.high_m - extent.low_m < heightLeast_m) continue;
    RoomAir air{domain, AirMap(building, rays, domain, extent.sides), {}, {}};
    air.storeys = storeysOf(air.map, pieces, rays);
    for (const Storey& storey : air.storeys) air.doorways.push_back(doorwaysOf(building, air, storey));
    if (!air.storeys.empty()) airs.push_back(std::move(air));
  }
  return airs;
}

}  // namespace clerestory
