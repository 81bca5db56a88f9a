// SPDX-License-Identifier: GPL-3.0-or-later
// The colour map viridis (S. van der Walt and N. Smith, CC0) through ten of its colours.
#include "colormap.hpp"

#include <algorithm>
#include <cmath>

namespace clerestory {
namespace {

constexpr std::array<DisplayColour, 10> viridis = {{{0x44, 0x01, 0x54},
                                                    {0x48, 0x28, 0x78},
                                                    {0x3e, 0x49, 0x89},
                                                    {0x31, 0x68, 0x8e},
                                                    {0x26, 0x82, 0x8e},
                                                    {0x1f, 0x9e, 0x89},
                                                    {0x35, 0xb7, 0x79},
                                                    {0x6e, 0xce, 0x58},
                                                    {0xb5, 0xde, 0x2b},
                                                    {0xfd, 0xe7, 0x25}}};

}  // namespace

DisplayColour falseColour(double fraction) {
  const double place = (fraction > 0.0 ? std::min(fraction, 1.0) : 0.0) * (viridis.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), viridis.size() - 2);
  const double part = place - static_cast<double>(below);
  DisplayColour colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double a = viridis[below][c];
    const double b = viridis[below + 1][c];
    colour[c] = static_cast<std::uint8_t>(std::lround(a + part * (b - a)));
  }
  return colour;
}

bool wantsBlackText(const DisplayColour& ground) {
  const auto linear = [](std::uint8_t byte) {
    const double x = byte / 255.0;
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
  };
  const double luminance =
      0.2126 * linear(ground[0]) + 0.7152 * linear(ground[1]) + 0.0722 * linear(ground[2]);
  // WCAG 2.2's contrast is (L + 0.05) : (l + 0.05); both texts have the same where L + 0.05 is sqrt(1.05 *
  // 0.05).
  return luminance > std::sqrt(1.05 * 0.05) - 0.05;
}

std::string hexColour(const DisplayColour& colour) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text = "#";
  for (const std::uint8_t channel : colour) {
    text += digits[channel >> 4];
    text += digits[channel & 15];
  }
  return text;
}

std::uint8_t srgbByte(double linear) {
  const double x = linear > 0.0 ? std::min(linear, 1.0) : 0.0;
  const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * encoded));
}

}  // namespace clerestory
