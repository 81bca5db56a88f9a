// SPDX-License-Identifier: GPL-3.0-or-later
// Openings too small to join airs, by which a dark room would have light.
#pragma once

#include <geometry/building.hpp>
#include <geometry/rays.hpp>

namespace clerestory {

/// Says in G252 which rooms nothing lights though an opening of 5 mm or more leads straight from them to lit
/// air, or outdoors: how much floor stays dark, and where the widest opening is. Rooms have to be known.
void tellShutOpenings(Building& building, const RayScene& rays);

}  // namespace clerestory
