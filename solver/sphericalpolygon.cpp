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

/// The triangles of a fan over what of a polygon a point sees above its horizon, corners as directions. False
/// where a corner stands on the point itself: what was visited counts for nothing then.
template <class Visit>
bool forEachTriangle(const glm::vec3& point, const glm::vec3& normal, std::span<const glm::vec3> polygon,
                     const Visit& visit) {
  std::size_t count = 0;
  dvec3 first;
  dvec3 last;
  const auto add = [&](const dvec3& corner) {
    const double length = glm::length(corner);
    if (length <= 0.0) return false;
    const dvec3 direction = corner / length;
    if (count == 0) first = direction;
    if (count >= 2) visit(SphericalTriangle(first, last, direction));
    last = direction;
    ++count;
    return true;
  };
  dvec3 before = dvec3(polygon.back()) - dvec3(point);
  double beforeHeight = glm::dot(before, dvec3(normal));
  for (const glm::vec3& corner : polygon) {
    const dvec3 own = dvec3(corner) - dvec3(point);
    const double height = glm::dot(own, dvec3(normal));
    if ((height > 0.0) != (beforeHeight > 0.0) &&
        !add((before * height - own * beforeHeight) / (height - beforeHeight)))
      return false;
    if (height > 0.0 && !add(own)) return false;
    before = own;
    beforeHeight = height;
  }
  return true;
}

}  // namespace

// A. van Oosterom, J. Strackee, The solid angle of a plane triangle, 1983.
SphericalTriangle::SphericalTriangle(const dvec3& first, const dvec3& second, const dvec3& third)
    : a(first),
      b(second),
      c(third),
      solidAngle_sr(2.0 * std::atan2(std::abs(glm::dot(glm::cross(a, b), c)),
                                     1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a))) {}

SphericalTriangle::Sampler::Sampler(const SphericalTriangle& triangle)
    : a_(triangle.a),
      b_(triangle.b),
      towardsC_(squareTo(a_, triangle.c)),
      cosineOfAB_(glm::dot(a_, b_)),
      solidAngle_sr_(triangle.solidAngle_sr) {
  const dvec3 planeOfB = glm::cross(a_, b_);
  const dvec3 planeOfC = glm::cross(a_, triangle.c);
  const double sine = glm::length(glm::cross(planeOfB, planeOfC));
  const double cosine = glm::dot(planeOfB, planeOfC);
  const double scale = std::sqrt(sine * sine + cosine * cosine);
  sineAtA_ = scale > 0.0 ? sine / scale : 0.0;
  cosineAtA_ = scale > 0.0 ? cosine / scale : 1.0;
}

glm::vec3 SphericalTriangle::Sampler::direction(double area_sr, double v) const {
  const double area = std::min(area_sr, solidAngle_sr_);
  const double sine = std::sin(area);
  const double cosineOfArea = std::cos(area);
  const double s = sine * cosineAtA_ - cosineOfArea * sineAtA_;
  const double t = cosineOfArea * cosineAtA_ + sine * sineAtA_;
  const double p = t - cosineAtA_;
  const double q = s + sineAtA_ * cosineOfAB_;
  const double below = (q * s + p * t) * sineAtA_;
  const double ratio = below != 0.0 ? ((q * t - p * s) * cosineAtA_ - q) / below : 1.0;
  const double cosine = std::clamp(ratio, -1.0, 1.0);
  const dvec3 c = cosine * a_ + std::sqrt(1.0 - cosine * cosine) * towardsC_;
  const double z = 1.0 - v * (1.0 - glm::dot(c, b_));
  return glm::vec3(glm::normalize(z * b_ + std::sqrt(std::max(1.0 - z * z, 0.0)) * squareTo(b_, c)));
}

SphericalPolygon::SphericalPolygon(const glm::vec3& point, const glm::vec3& normal,
                                   std::span<const glm::vec3> polygon) {
  const bool isWhole = forEachTriangle(point, normal, polygon, [&](const SphericalTriangle& triangle) {
    if (!(triangle.solidAngle_sr > leastSolidAngle_sr)) return;
    solidAngle_sr_ += triangle.solidAngle_sr;
    fan_.push_back({triangle.solidAngle_sr, SphericalTriangle::Sampler(triangle)});
  });
  if (isWhole) return;
  fan_.clear();
  solidAngle_sr_ = 0.0;
}

glm::vec3 SphericalPolygon::direction(float u, float v) const {
  double target = static_cast<double>(u) * solidAngle_sr_;
  std::size_t i = 0;
  while (i + 1 < fan_.size() && target >= fan_[i].solidAngle_sr) target -= fan_[i++].solidAngle_sr;
  return fan_[i].sampler.direction(target, static_cast<double>(v));
}

std::optional<SphericalSample> sampleSeen(const glm::vec3& point, const glm::vec3& normal,
                                          std::span<const glm::vec3> polygon, float u, float v) {
  // Of the triangles up to each one the last is taken with its share of them, so that one pass tells.
  std::optional<SphericalTriangle> taken;
  double total_sr = 0.0;
  double rest = static_cast<double>(u);  // even in [0, 1) after each choice
  const bool isWhole = forEachTriangle(point, normal, polygon, [&](const SphericalTriangle& triangle) {
    if (!(triangle.solidAngle_sr > leastSolidAngle_sr)) return;
    total_sr += triangle.solidAngle_sr;
    const double before = 1.0 - triangle.solidAngle_sr / total_sr;
    if (rest < before) {
      rest /= before;
    } else {
      taken = triangle;
      rest = (rest - before) / (1.0 - before);
    }
  });
  if (!isWhole || !taken) return std::nullopt;
  const SphericalTriangle::Sampler sampler(*taken);
  return SphericalSample{sampler.direction(rest * taken->solidAngle_sr, static_cast<double>(v)), total_sr};
}

}  // namespace clerestory
