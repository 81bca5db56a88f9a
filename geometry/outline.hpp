// SPDX-License-Identifier: GPL-3.0-or-later
// The outline of what faces of one plane cover together.
#pragma once

#include <optional>

#include "planeclusters.hpp"

namespace clerestory {

struct Outline {
  std::vector<Loop> rings;  ///< the covered region on their left about the frame's normal
  bool overlaps = false;    ///< parts are covered more than once
};

/// May add points to the soup where edges cross. Empty where crossings cannot be resolved.
std::optional<Outline> outlineOf(Soup& soup, const Tolerances& tolerances, const PlaneFrame& frame,
                                 std::span<const Face> faces);

}  // namespace clerestory
