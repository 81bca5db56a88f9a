// SPDX-License-Identifier: GPL-3.0-or-later
// A convex polygon as a point sees it above its horizon: directions to it, even by solid angle.
#pragma once

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace clerestory {

class SphericalPolygon {
 public:
  /// What of a convex planar `polygon` a point sees above the plane through it with the unit `normal`.
  SphericalPolygon(const glm::vec3& point, const glm::vec3& normal, std::span<const glm::vec3> polygon);

  /// Solid angle of what is seen. [sr]
  [[nodiscard]] double solidAngle_sr() const { return solidAngle_sr_; }

  /// A unit vector, even by solid angle for even u, v in [0, 1). J. Arvo, Stratified sampling of spherical
  /// triangles, SIGGRAPH 1995, over the triangles of a fan. Asked only where the solid angle is above 0.
  [[nodiscard]] glm::vec3 direction(float u, float v) const;

 private:
  struct Triangle {
    glm::dvec3 a, b;
    glm::dvec3 towardsC;  ///< unit vector at a, square to a, in the plane of a and c
    double cosineOfAB, sineAtA, cosineAtA;
    double solidAngle_sr;
  };
  void addTriangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

  std::vector<Triangle> fan_;
  double solidAngle_sr_ = 0.0;
};

}  // namespace clerestory
