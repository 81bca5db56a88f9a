// SPDX-License-Identifier: GPL-3.0-or-later
// Turns luminaires.
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <import/luminaire.hpp>

namespace clerestory {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// Rodrigues' rotation by the shortest turn from straight down to `aim`.
glm::dmat3 turnFromDown(const glm::dvec3& aim) {
  const glm::dvec3 down(0, 0, -1);
  const double cosine = glm::dot(down, aim);
  if (cosine < -1.0 + 1e-12) return glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1);
  const glm::dvec3 v = glm::cross(down, aim);
  const glm::dmat3 cross(0, v.z, -v.y, -v.z, 0, v.x, v.y, -v.x, 0);
  return glm::dmat3(1.0) + cross + cross * cross / (1.0 + cosine);
}

/// Angle that a direction has against the horizontal.
double rise_deg(const glm::dvec3& direction) {
  return std::asin(std::min(std::abs(direction.z), 1.0)) / kDegree;
}

}  // namespace

glm::dmat3 luminaireAxes(const glm::dvec3& aim, double rotation_deg) {
  const double c = std::cos(rotation_deg * kDegree);
  const double s = std::sin(rotation_deg * kDegree);
  return turnFromDown(aim) * glm::dmat3(c, s, 0, -s, c, 0, 0, 0, 1);
}

double tiltFactor(const LampTilt& tilt, const glm::dmat3& axes) {
  switch (tilt.lamp) {
    case LampTilt::Lamp::alongC0:
      return tilt.at(rise_deg(axes[0]));
    case LampTilt::Lamp::alongC90:
      return tilt.at(rise_deg(axes[1]));
    default:
      return tilt.at(std::acos(std::clamp(axes[2].z, -1.0, 1.0)) / kDegree);
  }
}

}  // namespace clerestory
