// SPDX-License-Identifier: GPL-3.0-or-later
// Points that only divide an edge.
#pragma once

#include <array>
#include <map>

#include "soup.hpp"

namespace clerestory {

using EdgeEnds = std::array<std::uint32_t, 2>;

/// By place, the ends of the straight edge that it only divides: what the faces of each plane and surface
/// about it cover has an outline that goes straight on there. `placeOf`: by point of the soup.
std::map<std::uint32_t, EdgeEnds> dividedEdges(const Soup& soup, std::span<const std::uint32_t> placeOf,
                                               std::span<const glm::dvec3> places,
                                               const Tolerances& tolerances);

}  // namespace clerestory
