// SPDX-License-Identifier: GPL-3.0-or-later
// What can be stood on in each region of a storey.
#pragma once

#include <cstdint>
#include <vector>

#include <geometry/building.hpp>
#include <geometry/rays.hpp>

#include "doorways.hpp"

namespace clerestory {

inline constexpr double floorAreaLeast_m2 = 1.0;  ///< of a room, and of a floor at another level within one
inline constexpr double floorReach_m = 0.6;       ///< from a storey's floor to that of one of its rooms

/// The floor of a region: its main level with platforms and other levels beside that, furniture or not.
struct Floor {
  double height_m = 0.0, area_m2 = 0.0;
  double air_m3 = 0.0;  ///< over it, within the storey
  std::vector<std::uint32_t> pieces;
};

/// By region of a storey; without area where none is found.
std::vector<Floor> floorsOf(const Building& building, const RayScene& rays, const RoomAir& air,
                            std::size_t storey);

}  // namespace clerestory
