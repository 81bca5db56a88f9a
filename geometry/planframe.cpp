// SPDX-License-Identifier: GPL-3.0-or-later
// A frame from moments of area, which neither the order of polygons nor a division of them changes.
#include "planframe.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "soup.hpp"

namespace clerestory {
namespace {

/// Polygons as triangles, whose areas count against a polygon's where they lie beside it.
class Triangles {
 public:
  Triangles(std::span<const glm::dvec3> points, const PolygonList& polygons)
      : points_(points), polygons_(polygons) {}

  /// Calls with the corners in plan and the area of each.
  template <class Take>
  void forEach(const Take& take) const {
    for (std::size_t i = 0; i < polygons_.size(); ++i) {
      const auto corners = polygons_[i];
      if (corners.size() < 3) continue;
      const glm::dvec3 normal = doubleAreaVector(points_, corners);
      const double length = glm::length(normal);
      if (length <= 0.0) continue;
      const glm::dvec3& a = points_[corners[0]];
      for (std::size_t k = 2; k < corners.size(); ++k) {
        const glm::dvec3& b = points_[corners[k - 1]];
        const glm::dvec3& c = points_[corners[k]];
        take(glm::dvec2(a), glm::dvec2(b), glm::dvec2(c),
             0.5 * glm::dot(glm::cross(b - a, c - a), normal) / length);
      }
    }
  }

 private:
  std::span<const glm::dvec3> points_;
  const PolygonList& polygons_;
};

glm::dvec2 centreOf(const Triangles& triangles) {
  glm::dvec2 sum(0.0);
  double total_m2 = 0.0;
  triangles.forEach([&](const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, double area_m2) {
    sum += area_m2 / 3.0 * (a + b + c);
    total_m2 += area_m2;
  });
  return total_m2 > 0.0 ? sum / total_m2 : sum;
}

/// Area, and second and third moment of it along two axes. [m²], [m⁴], [m⁵]
struct Moments {
  double area_m2 = 0.0;
  glm::dvec2 second{0.0}, third{0.0};
};

Moments momentsOf(const Triangles& triangles, const PlanFrame& frame) {
  Moments moments;
  triangles.forEach([&](const glm::dvec2& p, const glm::dvec2& q, const glm::dvec2& r, double area_m2) {
    const glm::dvec2 a = frame.toFrame(p);
    const glm::dvec2 b = frame.toFrame(q);
    const glm::dvec2 c = frame.toFrame(r);
    // Complete symmetric sums of the corners' coordinates.
    const glm::dvec2 second = a * a + b * (a + b) + c * (a + b + c);
    const glm::dvec2 third = a * a * a + b * (a * a + b * (a + b)) + c * second;
    moments.area_m2 += area_m2;
    moments.second += area_m2 / 6.0 * second;
    moments.third += area_m2 / 10.0 * third;
  });
  return moments;
}

/// Unit vector along most of the upright ones among polygons; quarter turns are alike.
glm::dvec2 directionOf(std::span<const glm::dvec3> points, const PolygonList& polygons,
                       std::span<const std::uint32_t> walls) {
  constexpr double quarter = 0.5 * std::numbers::pi;
  constexpr double alike = 1e-4;  // radians: walls that were meant to be parallel
  struct Wall {
    double angle, area_m2;
  };
  std::vector<Wall> byAngle;
  for (const std::uint32_t wall : walls) {
    if (polygons[wall].size() < 3) continue;
    const glm::dvec3 normal = 0.5 * doubleAreaVector(points, polygons[wall]);
    const double area_m2 = glm::length(normal);
    if (area_m2 <= 0.0 || std::abs(normal.z) > 0.1 * area_m2) continue;
    const double angle = std::fmod(std::atan2(normal.y, normal.x) + 2.0 * std::numbers::pi, quarter);
    byAngle.push_back({angle, area_m2});
    if (angle < alike) byAngle.push_back({angle + quarter, area_m2});  // all around
  }
  std::sort(byAngle.begin(), byAngle.end(), [](const Wall& a, const Wall& b) { return a.angle < b.angle; });
  double most_m2 = 0.0;
  double direction = 0.0;
  for (std::size_t first = 0, end = 0; first < byAngle.size(); first = end) {
    double area_m2 = 0.0;
    for (; end < byAngle.size() && byAngle[end].angle - byAngle[first].angle <= alike; ++end)
      area_m2 += byAngle[end].area_m2;
    if (area_m2 <= most_m2) continue;
    most_m2 = area_m2;
    // That of the median wall: a few that are a little askew do not turn the others out of their axes.
    double passed_m2 = 0.0;
    for (std::size_t i = first; passed_m2 < 0.5 * area_m2; ++i) {
      passed_m2 += byAngle[i].area_m2;
      direction = byAngle[i].angle;
    }
  }
  constexpr double square = 1e-9;  // radians: along the model's own axes but for rounding
  if (std::min(direction, std::abs(quarter - direction)) < square) return {1.0, 0.0};
  constexpr double stepsOfRadian = 1e12;  // rounding decides nothing
  direction = std::round(direction * stepsOfRadian) / stepsOfRadian;
  return {std::cos(direction), std::sin(direction)};
}

/// Whether a moment is less than nothing, where rounding makes it more or less than that.
bool isNegative(double third_m5, double second_m4, double area_m2) {
  constexpr double nothing = 1e-6;
  return third_m5 < -nothing * second_m4 * std::sqrt(second_m4 / std::max(area_m2, 1e-300));
}

}  // namespace

PlanFrame planFrameOf(std::span<const glm::dvec3> points, const PolygonList& polygons,
                      std::span<const std::uint32_t> walls) {
  const Triangles triangles(points, polygons);
  PlanFrame frame;
  frame.origin_m = centreOf(triangles);
  frame.along = directionOf(points, polygons, walls);
  frame.across = {-frame.along.y, frame.along.x};
  const Moments moments = momentsOf(triangles, frame);
  constexpr double square = 1.0 + 1e-9;
  if (isNegative(moments.third.x, moments.second.x, moments.area_m2)) frame.along = -frame.along;
  if (isNegative(moments.third.y, moments.second.y, moments.area_m2)) frame.across = -frame.across;
  if (moments.second.y > square * moments.second.x) std::swap(frame.along, frame.across);
  return frame;
}

}  // namespace clerestory
