// SPDX-License-Identifier: GPL-3.0-or-later
// Rooms among the air domains, and sensor grids over their floors.
#pragma once

#include <geometry/building.hpp>
#include <geometry/rays.hpp>

#include "doorways.hpp"

namespace clerestory {

/// The air that may hold rooms: of closed domains, and of the outside where it is under a roof.
std::vector<RoomAir> airOfRooms(const Building& building, const RayScene& rays);

/// Fills rooms, borders, sideRoom and the portals' rooms, in an order (by the model's own axes, which `frame`
/// was turned out of) and with names that do not depend on the file's order. Covered air outside is a room
/// where it is nearly enclosed or no domain is closed.
void findRooms(Building& building, const PlanFrame& frame, const RayScene& rays,
               const std::vector<RoomAir>& airs);

/// Whether most of what can be seen from a point belongs to the domain: not so inside furniture or a wall.
bool isInAir(const Building& building, const RayScene& rays, const glm::dvec3& point, std::int32_t domain);

/// Fills building.grids from the study: one grid over each matching room's floor, an outline or a list of
/// points. Throws InputError for a grid that matches no room or has no sensor.
void layGrids(Building& building, const Study& study, const RayScene& rays);

}  // namespace clerestory
