// SPDX-License-Identifier: GPL-3.0-or-later
// Plans of a building as it was understood: rooms, windows and the borders between rooms, a drawing a storey.
#pragma once

#include <string>
#include <vector>

#include <geometry/building.hpp>

namespace clerestory {

struct StoreyPlan {
  double floor_m;   ///< of its lowest room
  std::string svg;  ///< a whole file; 1 m is the same length in all of a building's plans
};

/// A plan of each storey that has rooms, the lowest first. It shows what a cut 1.1 m above the floor meets,
/// every pane of the storey's rooms, and openings between rooms.
std::vector<StoreyPlan> storeyPlans(const Building& building);

}  // namespace clerestory
