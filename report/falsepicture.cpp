// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses a scale, paints values in its colours and writes lines, numbers and a legend over and under them.
#include "falsepicture.hpp"

#include <algorithm>
#include <cmath>

#include "metrics.hpp"
#include "numbers.hpp"

namespace clerestory {
namespace {

constexpr DisplayColour paper = {255, 255, 255};
constexpr DisplayColour ink = {40, 38, 35};
constexpr DisplayColour nothing = {200, 198, 194};
constexpr int numbersEvery_px = 96;
constexpr double decadesMost = 3.0;

/// 1, 2 or 5 times a power of ten: the largest that is not above `value`.
double stepBelow(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {5.0, 2.0}) {
    if (step * power <= value * (1.0 + 1e-9)) return step * power;
  }
  return power;
}

double stepAfter(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step) + 1e-9));
  const double digit = step / power;
  return power * (digit < 1.5 ? 2.0 : digit < 3.5 ? 5.0 : 10.0);
}

/// Which of the bands between the ticks a value lies in.
std::ptrdiff_t bandOf(const ValueScale& scale, float value) {
  return std::upper_bound(scale.ticks.begin(), scale.ticks.end(), static_cast<double>(value)) -
         scale.ticks.begin();
}

/// Mean over a square of pixels; NaN where any of it shows nothing or it spans more than a third of the mean:
/// a number there would be nobody's.
double evenValue(std::span<const float> values, int width, int x, int y, int half) {
  double sum = 0.0;
  double least = 1e300;
  double most = 0.0;
  for (int dy = -half; dy <= half; ++dy) {
    for (int dx = -half; dx <= half; ++dx) {
      const auto value = static_cast<double>(values[static_cast<std::size_t>((y + dy) * width + x + dx)]);
      if (!(value > 0.0)) return std::nan("");
      sum += value;
      least = std::min(least, value);
      most = std::max(most, value);
    }
  }
  const double mean = sum / ((2.0 * half + 1.0) * (2.0 * half + 1.0));
  return most - least < mean / 3.0 ? mean : std::nan("");
}

std::string numberOf(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return shortestFloat(std::round(value / power) * power);
}

void paintValues(DisplayImage& image, std::span<const float> values, int height, const ValueScale& scale) {
  const auto width = static_cast<std::size_t>(image.width);
  const std::size_t count = width * static_cast<std::size_t>(height);
  std::vector<std::ptrdiff_t> bands(count, -1);  // -1 where nothing is shown
  for (std::size_t i = 0; i < count; ++i) {
    const bool isShown = !std::isnan(values[i]);
    if (isShown) bands[i] = bandOf(scale, values[i]);
    image.set(i, isShown ? falseColour(scale.fraction(static_cast<double>(values[i]))) : nothing);
  }
  for (std::size_t i = 0; i + width < count; ++i) {
    if (i % width + 1 == width || bands[i] < 0) continue;
    for (const std::size_t other : {i + 1, i + width}) {
      if (bands[other] < 0 || bands[other] == bands[i]) continue;
      const bool isBright = scale.fraction(static_cast<double>(values[other])) > 0.5;
      image.set(i, isBright ? ink : paper);
    }
  }
}

void paintNumbers(DisplayImage& image, std::span<const float> values, int height, const ValueScale& scale) {
  constexpr int half = 3;
  for (int y = numbersEvery_px / 2; y + half < height; y += numbersEvery_px) {
    for (int x = numbersEvery_px / 2; x + half < image.width; x += numbersEvery_px) {
      const double value = evenValue(values, image.width, x, y, half);
      if (std::isnan(value)) continue;
      drawText(image, x, y + 5, numberOf(value), 14, scale.fraction(value) > 0.5 ? ink : paper,
               TextAlign::centre);
    }
  }
}

void paintLegend(DisplayImage& image, const ValueScale& scale, int top, const std::string& title) {
  const int left = 24;
  const int width = std::max(1, std::min(image.width - 2 * left, 640));
  for (int x = 0; x < width; ++x) {
    image.fill(left + x, top + 28, left + x + 1.0, top + 42, falseColour((x + 0.5) / width));
  }
  drawText(image, left, top + 19, title, 14, ink, TextAlign::left);
  int last = -1000;
  for (const double tick : scale.ticks) {
    const int x = left + static_cast<int>(std::lround(width * scale.fraction(tick)));
    if (x - last < 34) continue;  // numbers would touch
    image.fill(x, top + 42, x + 1.0, top + 47, ink);
    drawText(image, x, top + 62, shortestFloat(tick), 13, ink, TextAlign::centre);
    last = x;
  }
}

}  // namespace

double ValueScale::fraction(double value) const {
  if (!(value > low)) return 0.0;
  return std::min(1.0,
                  isLinear ? (value - low) / (high - low) : std::log(value / low) / std::log(high / low));
}

ValueScale valueScale(const std::vector<std::span<const float>>& pictures, bool isLinear) {
  std::vector<float> values;
  for (const std::span<const float> picture : pictures) {
    std::copy_if(picture.begin(), picture.end(), std::back_inserter(values),
                 [](float value) { return value > 0.0F && std::isfinite(value); });
  }
  ValueScale scale;
  scale.isLinear = isLinear;
  double least = 1.0;
  double most = 10.0;
  if (!values.empty()) {
    const auto quantile = [&](double share) {
      const auto place =
          values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
      std::nth_element(values.begin(), place, values.end());
      return static_cast<double>(*place);
    };
    most = std::max(quantile(0.99), 1e-6);
    least = std::max(quantile(0.01), most * std::pow(10.0, -decadesMost));
  }
  if (isLinear) {
    const double step = stepBelow(most / 4.0);
    scale.low = 0.0;
    scale.high = step * std::ceil(most / step - 1e-9);
    for (int i = 0; step * i < scale.high * 1.001; ++i) scale.ticks.push_back(step * i);
    return scale;
  }
  scale.low = stepBelow(least);
  scale.high = stepAfter(scale.low);
  while (scale.high < most) scale.high = stepAfter(scale.high);
  for (double tick = scale.low; tick < scale.high * 1.01; tick = stepAfter(tick)) scale.ticks.push_back(tick);
  return scale;
}

DisplayImage falsePicture(std::span<const float> values, int width, int height, const ValueScale& scale,
                          const std::string& title) {
  DisplayImage image(width, height + falseLegend_px, paper);
  paintValues(image, values, height, scale);
  paintNumbers(image, values, height, scale);
  paintLegend(image, scale, height, title);
  return image;
}

std::vector<float> luminancesOf(const LuminanceImage& image) {
  std::vector<float> values;
  values.reserve(image.pixels_cd_m2.size());
  for (const glm::vec3& pixel : image.pixels_cd_m2)
    values.push_back(static_cast<float>(luminousY(glm::dvec3(pixel))));
  return values;
}

}  // namespace clerestory
