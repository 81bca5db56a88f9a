// SPDX-License-Identifier: GPL-3.0-or-later
// Prints numbers, without regard to the locale.
#include "numbers.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace clerestory {
namespace {

template <typename Number>
std::string shortest(Number value) {
  if (!std::isfinite(value)) return {};
  std::array<char, 64> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value == Number(0) ? Number(0) : value).ptr;
  return {text.data(), end};
}

std::string fixed(double value, int decimals) {
  std::array<char, 400> text;  // the largest double has 309 digits before the point
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, decimals).ptr;
  return {text.data(), end};
}

}  // namespace

std::string shortestFloat(double value) {
  return shortest(static_cast<float>(value));
}

std::string shortestDouble(double value) {
  return shortest(value);
}

std::string coordinate(double metres) {
  return shortest(std::round(metres * 1e6) / 1e6);
}

double asWritten(double value) {
  const std::string text = shortestFloat(value);
  double written = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(text.data(), text.data() + text.size(), written);
  return written;
}

std::string fixedNumber(double value, int decimals) {
  if (!std::isfinite(value)) return "–";
  std::string digits = fixed(std::abs(value), decimals);
  const bool isZero = digits.find_first_not_of("0.") == std::string::npos;
  std::size_t at = digits.find('.');
  if (at == std::string::npos) at = digits.size();
  if (at > 4) {  // four digits read well without a gap
    for (; at > 3; at -= 3) digits.insert(at - 3, "\u202F");
  }
  return (value < 0.0 && !isZero ? "\u2212" : "") + digits;
}

std::string roundedNumber(double value, int figures) {
  if (!std::isfinite(value)) return "–";
  if (value == 0.0) return "0";
  const int magnitude = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  const double step = std::pow(10.0, magnitude - figures);
  const double rounded = magnitude > figures ? std::round(value / step) * step : value;
  return fixedNumber(rounded, std::min(std::max(0, figures - magnitude), 6));
}

std::string illuminanceText(double lx) {
  return std::abs(lx) < 9.95 ? fixedNumber(lx, 1)
                             : fixedNumber(std::abs(lx) < 999.5 ? lx : std::round(lx / 10.0) * 10.0, 0);
}

std::string factorText(double pct) {
  return fixedNumber(pct, std::abs(pct) < 0.995 ? 2 : 1);
}

std::string shortNumber(double value) {
  return shortest(std::round(value * 100.0) / 100.0);
}

}  // namespace clerestory
