// SPDX-License-Identifier: GPL-3.0-or-later
// Arvo's spherical triangles, in double since small polygons leave little of their angles' sums.
#include "sphericalpolygon.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace clerestory {
namespace {

using glm::dvec3;

constexpr double leastSolidAngle_sr = 1e-9;  // below this rounding rules; nothing is lost with it

dvec3 squareTo(const dvec3& axis, const dvec3& vector) {
  const dvec3 rest = vector - glm::dot(vector, axis) * axis;
  const double length = glm::length(rest);
  return length > 0.0 ? rest / length : dvec3(0.0);
}

}  // namespace

SphericalPolygon::SphericalPolygon(const glm::vec3& point, const glm::vec3& normal,
                                   std::span<const glm::vec3> polygon) {
  // Corners above the horizon, and where edges cross it.
  std::vector<dvec3> corners;
  corners.reserve(polygon.size() + 2);
  dvec3 before = dvec3(polygon.back()) - dvec3(point);
  double beforeHeight = glm::dot(before, dvec3(normal));
  for (const glm::vec3& corner : polygon) {
    const dvec3 own = dvec3(corner) - dvec3(point);
    const double height = glm::dot(own, dvec3(normal));
    if ((height > 0.0) != (beforeHeight > 0.0))
      corners.push_back((before * height - own * beforeHeight) / (height - beforeHeight));
    if (height > 0.0) corners.push_back(own);
    before = own;
    beforeHeight = height;
  }
  for (dvec3& corner : corners) {
    const double length = glm::length(corner);
    if (length <= 0.0) return;  // a corner of it stands on the point itself
    corner /= length;
  }
  for (std::size_t i = 2; i < corners.size(); ++i) addTriangle(corners[0], corners[i - 1], corners[i]);
}

void SphericalPolygon::addTriangle(const dvec3& a, const dvec3& b, const dvec3& c) {
  Triangle triangle{};
  triangle.a = a;
  triangle.b = b;
  triangle.towardsC = squareTo(a, c);
  triangle.cosineOfAB = glm::dot(a, b);
  const dvec3 planeOfB = glm::cross(a, b);
  const dvec3 planeOfC = glm::cross(a, c);
  const double sine = glm::length(glm::cross(planeOfB, planeOfC));
  const double cosine = glm::dot(planeOfB, planeOfC);
  const double scale = std::hypot(sine, cosine);
  triangle.sineAtA = scale > 0.0 ? sine / scale : 0.0;
  triangle.cosineAtA = scale > 0.0 ? cosine / scale : 1.0;
  // A. van Oosterom, J. Strackee, The solid angle of a plane triangle, 1983.
  triangle.solidAngle_sr = 2.0 * std::atan2(std::abs(glm::dot(planeOfB, c)),
                                            1.0 + triangle.cosineOfAB + glm::dot(b, c) + glm::dot(c, a));
  if (!(triangle.solidAngle_sr > leastSolidAngle_sr)) return;
  solidAngle_sr_ += triangle.solidAngle_sr;
  fan_.push_back(triangle);
}

glm::vec3 SphericalPolygon::direction(float u, float v) const {
  double target = static_cast<double>(u) * solidAngle_sr_;
  std::size_t i = 0;
  while (i + 1 < fan_.size() && target >= fan_[i].solidAngle_sr) target -= fan_[i++].solidAngle_sr;
  const Triangle& own = fan_[i];
  const double area = std::min(target, own.solidAngle_sr);
  const double sine = std::sin(area);
  const double cosineOfArea = std::cos(area);
  const double s = sine * own.cosineAtA - cosineOfArea * own.sineAtA;
  const double t = cosineOfArea * own.cosineAtA + sine * own.sineAtA;
  const double p = t - own.cosineAtA;
  const double q = s + own.sineAtA * own.cosineOfAB;
  const double below = (q * s + p * t) * own.sineAtA;
  const double ratio = below != 0.0 ? ((q * t - p * s) * own.cosineAtA - q) / below : 1.0;
  const double cosine = std::clamp(ratio, -1.0, 1.0);
  const dvec3 c = cosine * own.a + std::sqrt(1.0 - cosine * cosine) * own.towardsC;
  const double z = 1.0 - static_cast<double>(v) * (1.0 - glm::dot(c, own.b));
  return glm::vec3(glm::normalize(z * own.b + std::sqrt(std::max(1.0 - z * z, 0.0)) * squareTo(own.b, c)));
}

}  // namespace clerestory
