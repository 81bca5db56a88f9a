// SPDX-License-Identifier: GPL-3.0-or-later
// Views in false colours, of luminance or illuminance: with lines of equal value, numbers and a legend.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "image.hpp"

namespace clerestory {

/// What the colours stand for. Ticks lie within, the ends among them.
struct ValueScale {
  double low = 1.0, high = 10.0;
  bool isLinear = false;
  std::vector<double> ticks;

  [[nodiscard]] double fraction(double value) const;  ///< [0, 1] along the scale
};

/// A scale over the values of pictures that are to be compared, but for the brightest and the darkest
/// hundredth: from nought in even steps, or logarithmic over three decades at most. NaN and what is not
/// positive does not count.
ValueScale valueScale(const std::vector<std::span<const float>>& pictures, bool isLinear);

/// Height of the legend below a picture. [pixels]
inline constexpr int falseLegend_px = 76;

/// `values` (#width * height, rows from the top; NaN: nothing to show, grey). `title` is ASCII and names the
/// unit.
DisplayImage falsePicture(std::span<const float> values, int width, int height, const ValueScale& scale,
                          const std::string& title);

/// Luminances of a view, one a pixel. [cd/m²]
std::vector<float> luminancesOf(const LuminanceImage& image);

}  // namespace clerestory
