// SPDX-License-Identifier: GPL-3.0-or-later
// The outdoor tree: divided where windows, sensors and views look, and nowhere else.
#pragma once

#include "hierarchy.hpp"
#include "world.hpp"

namespace clerestory {

/// The tree of the open domain `domain`. A side's weight is the share of looks that meet it, times the
/// domain's area; looks come through the portals, from sensors and from views.
Hierarchy outsideTree(const World& world, const Study& study, std::int32_t domain,
                      std::span<const std::uint32_t> sides);

}  // namespace clerestory
