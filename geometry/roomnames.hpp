// SPDX-License-Identifier: GPL-3.0-or-later
// Names of rooms as the model's objects hold them.
#pragma once

#include <geometry/building.hpp>

namespace clerestory {

/// Renames the rooms whose sides are known, where the names of what surrounds them say how they are called:
/// * a name's beginning that most of a room's surface has and no other room's ("Attic" of Attic_Top,
/// Attic_Left),
/// * else the object of its floor, if no other room stands on it and its name holds a word for a room
///   ("Kitchen floor").
/// Others keep their names, and so do rooms that would be called alike.
void nameRooms(Building& building);

}  // namespace clerestory
