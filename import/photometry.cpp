// SPDX-License-Identifier: GPL-3.0-or-later
// Looks intensities up, integrates them, and makes those that no file states.
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <import/photometry.hpp>

#include "eulumdat.hpp"
#include "ies.hpp"
#include "textfile.hpp"

namespace clerestory {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kAngleTolerance_deg = 1e-6;

/// Where a value lies in an ascending list: between `low` and the next, `share` of the way.
struct Between {
  std::size_t low = 0;
  double share = 0.0;
  bool isIn = false;
};

Between placeIn(const std::vector<double>& list, double value) {
  if (list.size() == 1) return {0, 0.0, std::abs(value - list[0]) <= kAngleTolerance_deg};
  if (value < list.front() - kAngleTolerance_deg || value > list.back() + kAngleTolerance_deg) return {};
  const auto above = std::upper_bound(list.begin() + 1, list.end() - 1, value);
  const auto low = static_cast<std::size_t>(above - list.begin()) - 1;
  return {low, std::clamp((value - list[low]) / (list[low + 1] - list[low]), 0.0, 1.0), true};
}

/// Direction of the poles and of longitudes 0 and 90, in the luminaire's axes.
struct Frame {
  glm::dvec3 pole, zero, quarter;
};

Frame frameOf(IntensityDistribution::Type type) {
  switch (type) {
    case IntensityDistribution::Type::a:
      return {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}};
    case IntensityDistribution::Type::b:
      return {{0, -1, 0}, {0, 0, -1}, {1, 0, 0}};
    default:
      return {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
  }
}

/// A point source of an intensity that depends on gamma alone.
Photometry pointSource(const std::string& name, std::vector<double> gamma_deg,
                       std::vector<double> intensity_cd) {
  Photometry photometry;
  photometry.name = name;
  photometry.distribution.longitude_deg = {0.0};
  for (double& gamma : gamma_deg) gamma -= 90.0;
  photometry.distribution.latitude_deg = std::move(gamma_deg);
  photometry.distribution.intensity_cd = std::move(intensity_cd);
  return photometry;
}

}  // namespace

glm::dvec3 IntensityDistribution::pole() const {
  return frameOf(type).pole;
}

double IntensityDistribution::latitudeOf(const glm::dvec3& direction) const {
  return std::asin(std::clamp(glm::dot(direction, frameOf(type).pole), -1.0, 1.0)) / kDegree;
}

double IntensityDistribution::intensity(const glm::dvec3& direction) const {
  const Frame frame = frameOf(type);
  const Between row = placeIn(latitude_deg, latitudeOf(direction));
  if (!row.isIn) return 0.0;
  const std::size_t next = std::min(row.low + 1, latitude_deg.size() - 1);
  const auto along = [&](std::size_t column) {
    const double* const values = intensity_cd.data() + column * latitude_deg.size();
    return values[row.low] + row.share * (values[next] - values[row.low]);
  };
  if (longitude_deg.size() == 1) return along(0);
  double longitude =
      std::atan2(glm::dot(direction, frame.quarter), glm::dot(direction, frame.zero)) / kDegree;
  while (longitude < longitude_deg.front() - kAngleTolerance_deg) longitude += 360.0;
  const Between column = placeIn(longitude_deg, longitude);
  if (!column.isIn) return 0.0;
  return (1.0 - column.share) * along(column.low) + column.share * along(column.low + 1);
}

double IntensityDistribution::flux_lm() const {
  // Along a longitude: of v0 + (v1 - v0) (b - b0) / (b1 - b0), times cos b. Across: the trapezoid is exact.
  std::vector<double> strips(longitude_deg.size(), 0.0);
  for (std::size_t column = 0; column < strips.size(); ++column) {
    const double* const values = intensity_cd.data() + column * latitude_deg.size();
    for (std::size_t i = 0; i + 1 < latitude_deg.size(); ++i) {
      const double low = latitude_deg[i] * kDegree;
      const double high = latitude_deg[i + 1] * kDegree;
      const double rise = std::sin(high) + (std::cos(high) - std::cos(low)) / (high - low);
      strips[column] += values[i] * (std::sin(high) - std::sin(low) - rise) + values[i + 1] * rise;
    }
  }
  if (strips.size() == 1) return 2.0 * std::numbers::pi * strips[0];
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < strips.size(); ++i)
    sum += 0.5 * (strips[i] + strips[i + 1]) * (longitude_deg[i + 1] - longitude_deg[i]) * kDegree;
  return sum;
}

double LampTilt::at(double tilt_deg) const {
  if (angle_deg.empty()) return 1.0;
  const double tilt = std::clamp(tilt_deg, angle_deg.front(), angle_deg.back());
  const Between place = placeIn(angle_deg, tilt);
  const std::size_t next = std::min(place.low + 1, factor.size() - 1);
  return factor[place.low] + place.share * (factor[next] - factor[place.low]);
}

Photometry readPhotometry(const std::filesystem::path& file) {
  constexpr std::uintmax_t kMostBytes = 16U << 20U;
  return photometryFrom(readWholeFile(file, "photometric", kMostBytes), file);
}

Photometry photometryFrom(const std::string& bytes, const std::filesystem::path& file) {
  const std::string ending = lowerCase(file.extension().string());
  if (ending == ".ies") return readIes(bytes, file);
  if (ending == ".ldt") return readEulumdat(bytes, file);
  throw InputError(file.string() + ": a photometric file's name ends in .ies or .ldt");
}

Photometry uniformPhotometry(double intensity_cd) {
  return pointSource("uniform", {0.0, 180.0}, {intensity_cd, intensity_cd});
}

Photometry lambertianPhotometry(double intensity_cd) {
  std::vector<double> gamma_deg;
  std::vector<double> values_cd;
  for (int half = 0; half <= 180; ++half) {  // straight lines over half a degree err by 1e-5 at most
    gamma_deg.push_back(0.5 * half);
    values_cd.push_back(intensity_cd * std::cos(gamma_deg.back() * kDegree));
  }
  values_cd.back() = 0.0;
  return pointSource("lambertian", gamma_deg, values_cd);
}

Photometry spotPhotometry(double intensity_cd, double inner_deg, double outer_deg) {
  constexpr int kSteps = 64;
  const double innerCosine = std::cos(inner_deg * kDegree);
  const double outerCosine = std::cos(outer_deg * kDegree);
  std::vector<double> gamma_deg;
  std::vector<double> values_cd;
  if (inner_deg > 0.0) {
    gamma_deg.push_back(0.0);
    values_cd.push_back(intensity_cd);
  }
  for (int step = 0; step <= kSteps; ++step) {
    gamma_deg.push_back(inner_deg + (outer_deg - inner_deg) * step / kSteps);
    const double share = (std::cos(gamma_deg.back() * kDegree) - outerCosine) / (innerCosine - outerCosine);
    values_cd.push_back(intensity_cd * std::clamp(share, 0.0, 1.0) * std::clamp(share, 0.0, 1.0));
  }
  return pointSource("spot", gamma_deg, values_cd);
}

}  // namespace clerestory
