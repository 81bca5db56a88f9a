// SPDX-License-Identifier: GPL-3.0-or-later
// False colours of views: their scales, their colours, their lines.
#include "falsepicture.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace clerestory {
namespace {

DisplayColour colourAt(const DisplayImage& image, int x, int y) {
  const auto at = 3 * static_cast<std::size_t>(y * image.width + x);
  return {image.bytes.at(at), image.bytes.at(at + 1), image.bytes.at(at + 2)};
}

/// A picture of 400 x 20 pixels that grows to the right from 10 to 1,000, by the logarithm.
std::vector<float> ramp() {
  std::vector<float> values;
  for (int i = 0; i < 8000; ++i)
    values.push_back(std::pow(10.0F, 1.0F + 2.0F * (static_cast<float>(i % 400) + 0.5F) / 400.0F));
  return values;
}

TEST(FalsePicture, ScalesAreRoundAndHoldTheValues) {
  const std::vector<float> values = ramp();
  const ValueScale logarithmic = valueScale({values}, false);
  EXPECT_EQ(logarithmic.low, 10.0);
  EXPECT_EQ(logarithmic.high, 1000.0);
  EXPECT_EQ(logarithmic.ticks, (std::vector<double>{10, 20, 50, 100, 200, 500, 1000}));
  EXPECT_NEAR(logarithmic.fraction(100.0), 0.5, 1e-12);
  const ValueScale linear = valueScale({values}, true);
  EXPECT_EQ(linear.low, 0.0);
  EXPECT_EQ(linear.high, 1000.0);
  EXPECT_EQ(linear.ticks, (std::vector<double>{0, 200, 400, 600, 800, 1000}));
  EXPECT_NEAR(linear.fraction(250.0), 0.25, 1e-12);
}

TEST(FalsePicture, DarkAndBrokenValuesMakeNoScaleOfTheirOwn) {
  for (const bool isLinear : {false, true}) {
    const std::vector<float> nothing = {0.0F, -1.0F, std::nanf(""), HUGE_VALF};
    const ValueScale scale = valueScale({nothing, {}}, isLinear);
    EXPECT_LT(scale.low, scale.high);
    EXPECT_TRUE(std::isfinite(scale.high));
    falsePicture(nothing, 2, 2, scale, "Luminance, cd/m2");
  }
}

TEST(FalsePicture, ColoursAreTheScalesAndLinesLieAtItsTicks) {
  const std::vector<float> values = ramp();
  const ValueScale scale = valueScale({values}, false);
  const DisplayImage image = falsePicture(values, 400, 20, scale, "Illuminance, lx");
  int lines = 0;
  for (int x = 0; x + 1 < 400; ++x) {
    const auto value = static_cast<double>(values[static_cast<std::size_t>(x)]);
    const DisplayColour expected = falseColour(scale.fraction(value));
    if (colourAt(image, x, 3) == expected) continue;
    ++lines;
    double nearest = 1e9;
    for (const double tick : scale.ticks) nearest = std::min(nearest, std::abs(std::log(value / tick)));
    EXPECT_LT(nearest, std::log(10.0) * 2.0 / 400.0) << x;
  }
  EXPECT_EQ(lines, 5);  // 20, 50, 100, 200, 500
}

TEST(FalsePicture, WhatShowsNothingIsGrey) {
  std::vector<float> values = ramp();
  for (std::size_t i = 0; i < 200; ++i) values[i] = std::nanf("");
  const DisplayImage image = falsePicture(values, 400, 20, valueScale({values}, false), "Illuminance, lx");
  EXPECT_EQ(colourAt(image, 100, 0), (DisplayColour{200, 198, 194}));
}

}  // namespace
}  // namespace clerestory
