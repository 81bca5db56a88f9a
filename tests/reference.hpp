// SPDX-License-Identifier: GPL-3.0-or-later
// Reference illuminances from files of numbers, and the one definition of error that the project has.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace clerestory {

/// A sensor that looks up and what it should read: lux, or a daylight factor in %.
struct ReferencePoint {
  std::array<double, 3> place_m;
  double value;
  double standardDeviation = 0.0;  ///< of the value, where the table has it
};

/// Rows of x, y, z, a value and perhaps its standard deviation, parted by commas or blanks; rows that do not
/// begin so (headers) are passed over.
inline std::vector<ReferencePoint> readReference(const std::filesystem::path& file) {
  std::vector<ReferencePoint> points;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    ReferencePoint point{};
    if (!(numbers >> point.place_m[0] >> point.place_m[1] >> point.place_m[2] >> point.value)) continue;
    if (!(numbers >> point.standardDeviation)) point.standardDeviation = 0.0;
    points.push_back(point);
  }
  EXPECT_FALSE(points.empty()) << file << " holds no reference values";
  return points;
}

/// Errors of a grid's sensors as fractions: (ours - true) / max(true, 5 % of the grid's mean).
struct GridErrors {
  double bias = 0.0, rms = 0.0, p95 = 0.0, maximum = 0.0;
};

inline std::ostream& operator<<(std::ostream& stream, const GridErrors& errors) {
  return stream << "bias " << 100.0 * errors.bias << " %, RMS " << 100.0 * errors.rms << " %, p95 "
                << 100.0 * errors.p95 << " %, maximum " << 100.0 * errors.maximum << " %";
}

inline GridErrors errorsOf(const std::vector<double>& ours, const std::vector<double>& truth) {
  GridErrors errors;
  EXPECT_EQ(ours.size(), truth.size());
  if (ours.size() != truth.size() || ours.empty()) return errors;
  const auto count = static_cast<double>(ours.size());
  double mean = 0.0;
  for (const double value : truth) mean += value / count;
  std::vector<double> sizes;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const double error = (ours[i] - truth[i]) / std::max(truth[i], 0.05 * mean);
    errors.bias += error / count;
    errors.rms += error * error / count;
    sizes.push_back(std::abs(error));
  }
  errors.rms = std::sqrt(errors.rms);
  std::sort(sizes.begin(), sizes.end());
  errors.p95 = sizes[static_cast<std::size_t>(std::ceil(0.95 * count)) - 1];
  errors.maximum = sizes.back();
  return errors;
}

/// The errors, written to the test's output too.
inline GridErrors measuredErrors(const std::string& what, const std::vector<double>& ours,
                                 const std::vector<double>& truth) {
  const GridErrors errors = errorsOf(ours, truth);
  std::ostringstream text;
  text << errors;
  testing::Test::RecordProperty(what, text.str());
  std::cout << what << ": " << errors << '\n';
  return errors;
}

}  // namespace clerestory
