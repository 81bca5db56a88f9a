// SPDX-License-Identifier: GPL-3.0-or-later
// Checks and mirrors planes of intensities.
#include "photometrygrid.hpp"

#include <algorithm>
#include <cmath>

namespace clerestory {
namespace {

constexpr double kTolerance_deg = 1e-3;
constexpr double kNoise = 0.005;  // of the greatest intensity: what a goniophotometer may put below 0

}  // namespace

void checkAngles(const std::vector<double>& angles_deg, double low, double high, const std::string& what,
                 const Place& place) {
  for (std::size_t i = 0; i < angles_deg.size(); ++i) {
    if (angles_deg[i] < low - kTolerance_deg || angles_deg[i] > high + kTolerance_deg) {
      failAt(place, what + " " + numberText(angles_deg[i]) + " is not within " + numberText(low) + " and " +
                        numberText(high) + " degrees");
    }
    if (i > 0 && angles_deg[i] <= angles_deg[i - 1]) {
      failAt(place, what + "s have to rise, but " + numberText(angles_deg[i]) + " follows " +
                        numberText(angles_deg[i - 1]));
    }
  }
}

void checkIntensities(std::vector<double>& intensity_cd, const Place& place) {
  const double most = *std::max_element(intensity_cd.begin(), intensity_cd.end());
  if (!(most > 0.0)) failAt(place, "no intensity is above 0, so the luminaire gives no light");
  for (double& value : intensity_cd) {
    if (value < -kNoise * most) failAt(place, "intensity " + numberText(value) + " is below 0");
    value = std::max(value, 0.0);
  }
}

void mirrorPlanes(std::vector<double>& longitude_deg, std::vector<double>& planes, bool atLast) {
  const std::size_t count = longitude_deg.size();
  const std::size_t each = planes.size() / count;
  const double mirror_deg = atLast ? longitude_deg.back() : longitude_deg.front();
  std::vector<double> angles;
  std::vector<double> values;
  for (std::size_t i = count; i-- > 0;) {
    const bool isMirror = i == (atLast ? count - 1 : 0);
    if (isMirror) continue;
    angles.push_back(2.0 * mirror_deg - longitude_deg[i]);
    const auto first = planes.begin() + static_cast<std::ptrdiff_t>(i * each);
    values.insert(values.end(), first, first + static_cast<std::ptrdiff_t>(each));
  }
  if (atLast) {
    longitude_deg.insert(longitude_deg.end(), angles.begin(), angles.end());
    planes.insert(planes.end(), values.begin(), values.end());
  } else {
    longitude_deg.insert(longitude_deg.begin(), angles.begin(), angles.end());
    planes.insert(planes.begin(), values.begin(), values.end());
  }
}

void closeCircle(std::vector<double>& longitude_deg, std::vector<double>& planes, const Place& place) {
  if (longitude_deg.size() == 1) return;
  const std::size_t each = planes.size() / longitude_deg.size();
  const double lacks_deg = 360.0 - (longitude_deg.back() - longitude_deg.front());
  if (lacks_deg <= kTolerance_deg) {
    longitude_deg.back() = longitude_deg.front() + 360.0;
    return;
  }
  double widest_deg = 0.0;
  for (std::size_t i = 1; i < longitude_deg.size(); ++i)
    widest_deg = std::max(widest_deg, longitude_deg[i] - longitude_deg[i - 1]);
  if (lacks_deg > widest_deg + kTolerance_deg) {
    failAt(place, "the planes from " + numberText(longitude_deg.front()) + " to " +
                      numberText(longitude_deg.back()) + " degrees leave a part of the circle open");
  }
  longitude_deg.push_back(longitude_deg.front() + 360.0);
  planes.insert(planes.end(), planes.begin(), planes.begin() + static_cast<std::ptrdiff_t>(each));
}

}  // namespace clerestory
