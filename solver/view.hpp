// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of the solved light, by a final gather at every visible point.
#pragma once

#include <solver/solution.hpp>

#include "sensors.hpp"

namespace clerestory {

/// How light in a picture is sampled.
struct PictureSettings {
  std::uint32_t rays;   ///< of a record of reflected light, at most
  float directRays;     ///< of a point, to all that shines on it
  float deviationMost;  ///< of direct light, in all light; more rays while it is above
};

/// What an asked accuracy means for pictures: `draft` has half as many rays as `standard`, `fine` two and a
/// half times as many.
PictureSettings picturesFor(double accuracy);

/// Renders a view in luminance. Irradiance is found once for every surface in a tile of a few pixels and
/// multiplied by each pixel's own reflectance, so edges stay sharp. Reflected light is interpolated between
/// records, direct light where its shadows are even; pixels that no sample is near gather for themselves.
template <int K>
LuminanceImage renderView(const SolvedLight<K>& light, const ViewSettings& view,
                          const PictureSettings& settings);

}  // namespace clerestory
