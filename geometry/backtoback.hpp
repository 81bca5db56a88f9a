// SPDX-License-Identifier: GPL-3.0-or-later
// Two faces in one plane, back to back: a floor and the ceiling below it, a wall drawn once for each room.
#pragma once

#include <geometry/building.hpp>

namespace clerestory {

/// Cuts opaque pieces that lie back to back over a part of each, light on either side, so that they become
/// such pairs there: one attic's floor over the ceilings of three rooms. Domains have to be known.
void cutBackToBack(Building& building);

/// Gives each side of such a pair to one of the two pieces, which keeps its material and name there. Models
/// draw their faces either for the room or for what is behind them: a side belongs to the piece that is drawn
/// as most of what is seen from there. The two are parted by the width of a ray's offset, and what is between
/// is dark. Rooms have to be known, of which the exact floors stay; sides' domains and rooms and the domains'
/// areas follow.
void partBackToBack(Building& building);

}  // namespace clerestory
