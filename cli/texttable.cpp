// SPDX-License-Identifier: GPL-3.0-or-later
// Lays out tables for a terminal.
#include "texttable.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace clerestory {
namespace {

// How many characters of UTF-8 text there are.
std::size_t lengthOf(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
}

}  // namespace

std::string TextTable::text() const {
  std::vector<std::size_t> widths(rows_.front().size());
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], lengthOf(row[i]));
    }
  }
  std::string text;
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string space(widths[i] - lengthOf(row[i]), ' ');
      const bool isNumber = i > 0 && i + 1 < row.size();
      line += "  " + (isNumber ? space + row[i] : row[i] + space);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string number(double value, int digits) {
  std::ostringstream text;
  const double step = std::pow(10.0, -digits);
  const bool isZero = std::abs(value) < 0.5 * step;  // without a sign
  text << std::fixed << std::setprecision(digits) << (isZero ? 0.0 : value);
  return text.str();
}

}  // namespace clerestory
