// SPDX-License-Identifier: GPL-3.0-or-later
// The line that edges of a raster's cells make.
#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <span>
#include <vector>

namespace clerestory {

/// The longest way along `edges` (their ends, which neighbours share to a thousandth of a cell), without the
/// steps of cells: its ends and the corners between them. Empty where the edges go round without an end.
std::vector<glm::dvec2> lineAlong(std::span<const std::array<glm::dvec2, 2>> edges, double cell_m);

}  // namespace clerestory
