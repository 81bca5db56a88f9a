// SPDX-License-Identifier: GPL-3.0-or-later
// What the steps of the clean-up share: canonical loops and frames of planes.
#include "soup.hpp"

#include <algorithm>
#include <cmath>

namespace clerestory {

void startAtSmallest(std::span<const glm::dvec3> points, Loop& loop) {
  std::rotate(loop.begin(),
              std::min_element(loop.begin(), loop.end(),
                               [&](std::uint32_t a, std::uint32_t b) {
                                 return lexicographicallyLess(points[a], points[b]);
                               }),
              loop.end());
}

PlaneFrame::PlaneFrame(const glm::dvec3& unitNormal, const glm::dvec3& pointOnPlane)
    : normal(unitNormal), offset_m(glm::dot(unitNormal, pointOnPlane)) {
  constexpr double level = 1e-6;  // rad
  const double horizontal = std::hypot(normal.x, normal.y);
  const glm::dvec3 along = horizontal > level ? glm::dvec3(-normal.y, normal.x, 0.0) / horizontal
                                              : glm::normalize(glm::dvec3(normal.z, 0.0, -normal.x));
  u = along;
  v = glm::cross(normal, u);
}

}  // namespace clerestory
