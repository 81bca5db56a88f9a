// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of the solved light, by a final gather at every visible point.
#pragma once

#include <solver/solution.hpp>

#include "sensors.hpp"

namespace clerestory {

/// Renders a view in luminance. Irradiance is gathered once for a few pixels together, smoothed within its
/// own noise where the surface goes on, and multiplied by each pixel's own reflectance, so edges and textures
/// stay sharp. Pixels that these do not surround on their surface gather for themselves.
template <int K>
LuminanceImage renderView(const SolvedLight<K>& light, const ViewSettings& view,
                          const GatherSettings& settings);

}  // namespace clerestory
