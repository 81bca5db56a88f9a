// SPDX-License-Identifier: GPL-3.0-or-later
// What a point surely cannot see: polygons that stand behind a single piece, by geometry and not by samples.
#pragma once

#include <glm/vec3.hpp>

#include <span>

#include "world.hpp"

namespace clerestory {

/// Whether a single opaque piece hides all of the convex planar `polygon` (#≥3, local coordinates) from a
/// point. `false` says nothing: several pieces may hide it together.
bool isBehindOnePiece(const World& world, const glm::vec3& from, std::span<const glm::vec3> polygon);

}  // namespace clerestory
