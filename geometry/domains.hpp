// SPDX-License-Identifier: GPL-3.0-or-later
// Which sides of which pieces share the same air.
#pragma once

#include <geometry/building.hpp>
#include <geometry/rays.hpp>

namespace clerestory {

/// Fills sideDomain, domains, portals and innerGlass of `building` from its model. Two places share the same
/// air where something 6 cm wide could fly from one to the other; a narrower gap counts as closed. Pieces
/// that stand in two airs are cut at what meets them.
void findDomains(Building& building);

}  // namespace clerestory
