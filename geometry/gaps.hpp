// SPDX-License-Identifier: GPL-3.0-or-later
// Where the air of a room leaks out, so that it can be found and closed in CAD.
#pragma once

#include <optional>

#include <geometry/building.hpp>

namespace clerestory {

/// A hole on the widest way from a room to the open.
struct Gap {
  glm::dvec3 place_m;
  double width_m;  ///< of the ball that passes, within a voxel (3 cm, more in large models)
};

/// The narrowest place on the way from `inside` to beyond the box around it that the largest ball can take;
/// none if no ball gets out. `low` and `high` bound what is looked at; glass is closed.
std::optional<Gap> widestGap(const Pieces& pieces, const glm::dvec3& inside, const glm::dvec3& low,
                             const glm::dvec3& high);

}  // namespace clerestory
