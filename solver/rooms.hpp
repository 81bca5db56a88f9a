// SPDX-License-Identifier: GPL-3.0-or-later
// What is told of a room beside its sensors: a formula's daylight factor, hours of sun.
#pragma once

#include <vector>

#include <solver/solution.hpp>

#include "world.hpp"

namespace clerestory {

/// Checks of the building's rooms, in their order.
std::vector<RoomValue> measureRooms(const World& world, const Study& study);

}  // namespace clerestory
