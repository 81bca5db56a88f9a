// SPDX-License-Identifier: GPL-3.0-or-later
// The air of rooms, domain by domain, and the cut between rooms that share it.
#pragma once

#include <geometry/building.hpp>
#include <geometry/rays.hpp>

#include "storeys.hpp"

namespace clerestory {

/// An opening between two regions of a storey, exactly: upright over the line between two ends. Where only
/// floors tell the two apart its line may bend.
struct Doorway {
  std::array<std::int32_t, 2> regions;
  glm::dvec3 from_m, to_m;  ///< at its foot
  double height_m;
  bool alongFloors;
  std::vector<glm::dvec3> bends_m;
};

/// A domain's air as its rooms see it.
struct RoomAir {
  std::int32_t domain;
  AirMap map;
  std::vector<Storey> storeys;
  std::vector<std::vector<Doorway>> doorways{};  ///< by storey
};

/// An upright piece in plan.
struct Upright {
  glm::dvec2 from, to, normal;
  double low_m, high_m;
  std::uint32_t polygon;  ///< that it is a part of
  std::uint32_t piece;
};

/// Those of all polygons, also where a piece is hidden in a wall.
std::vector<Upright> uprightsOf(const Pieces& pieces);

/// The openings of a storey. Their ends lie in the middle of the reveals that they stand between, else at the
/// nearest upright edge of a wall, else where the raster has them.
std::vector<Doorway> doorwaysOf(const Building& building, const RoomAir& air, const Storey& storey);

/// Cuts the pieces that pass through doorways, so that none lies in two rooms; floors that differ need no
/// cut. Domains, portals and inner glass are numbered anew. False where nothing was cut.
bool cutAtDoorways(Building& building, const std::vector<RoomAir>& airs);

}  // namespace clerestory
