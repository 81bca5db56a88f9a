// SPDX-License-Identifier: GPL-3.0-or-later
// Direct light at the samples of a picture, measured where it is uneven and smoothed within its noise.
#pragma once

#include "viewsamples.hpp"

namespace clerestory {

/// How direct light at samples is measured.
struct DirectMeasure {
  float rays;           ///< of a point, to all that shines on it
  float deviationMost;  ///< in all light; more rays while it is above
};

/// Finds the direct light of samples whose reflected light is known.
template <int K>
void gatherDirect(const SolvedLight<K>& light, const DirectMeasure& measure, ViewSamples<K>& samples);

}  // namespace clerestory
