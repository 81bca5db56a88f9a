// SPDX-License-Identifier: GPL-3.0-or-later
// Two faces in one plane, back to back: a floor and the ceiling below it, a wall drawn once for each room.
#pragma once

#include <geometry/building.hpp>

namespace clerestory {

/// Gives each side of such a pair to one of the two pieces, which keeps its material and name there. Models
/// wind their faces either towards a room or out of it: a side belongs to the piece that is wound as most of
/// what is seen from there. The two are parted by the width of a ray's offset, and what is between is dark.
/// Rooms have to be known, of which the exact floors stay; sides' domains and rooms and the domains' areas
/// follow. False where there is no pair.
bool partBackToBack(Building& building);

}  // namespace clerestory
