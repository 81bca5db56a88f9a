// SPDX-License-Identifier: GPL-3.0-or-later
// A convex polygon as a point sees it above its horizon: directions to it, even by solid angle.
#pragma once

#include <glm/vec3.hpp>

#include <optional>
#include <span>
#include <vector>

namespace clerestory {

/// A triangle of directions.
struct SphericalTriangle {
  SphericalTriangle(const glm::dvec3& first, const glm::dvec3& second, const glm::dvec3& third);

  glm::dvec3 a, b, c;
  double solidAngle_sr;

  /// What its directions are found by. J. Arvo, Stratified sampling of spherical triangles, SIGGRAPH 1995.
  class Sampler {
   public:
    explicit Sampler(const SphericalTriangle& triangle);
    /// A unit vector: even by solid angle for even `area_sr` up to the triangle's own and even v in [0, 1).
    [[nodiscard]] glm::vec3 direction(double area_sr, double v) const;

   private:
    glm::dvec3 a_, b_;
    glm::dvec3 towardsC_;  ///< unit vector at a, square to a, in the plane of a and c
    double cosineOfAB_, sineAtA_, cosineAtA_, solidAngle_sr_;
  };
};

class SphericalPolygon {
 public:
  /// What of a convex planar `polygon` a point sees above the plane through it with the unit `normal`.
  SphericalPolygon(const glm::vec3& point, const glm::vec3& normal, std::span<const glm::vec3> polygon);

  /// Solid angle of what is seen. [sr]
  [[nodiscard]] double solidAngle_sr() const { return solidAngle_sr_; }

  /// A unit vector, even by solid angle for even u, v in [0, 1). Asked only where the solid angle is above 0.
  [[nodiscard]] glm::vec3 direction(float u, float v) const;

 private:
  struct Part {
    double solidAngle_sr;
    SphericalTriangle::Sampler sampler;
  };
  std::vector<Part> fan_;
  double solidAngle_sr_ = 0.0;
};

/// A direction to a polygon, and all of the polygon that is seen.
struct SphericalSample {
  glm::vec3 direction;
  double solidAngle_sr;
};

/// As a SphericalPolygon gives, in half of the time where one direction is asked for. Nothing where nothing
/// is seen.
std::optional<SphericalSample> sampleSeen(const glm::vec3& point, const glm::vec3& normal,
                                          std::span<const glm::vec3> polygon, float u, float v);

}  // namespace clerestory
