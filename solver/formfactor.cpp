// SPDX-License-Identifier: GPL-3.0-or-later
// Form factors to polygons: Lambert's contour sum after a cut at the horizon, and cubature as a reference.
//
// Lambert, J. H.: Photometria, 1760: the contour sum F = 1/(2 pi) |sum of angle_i n . unit(v_i x v_i+1)|.
// Sutherland, I. E., Hodgman, G. W.: Reentrant polygon clipping, 1974.
// Radon, J.: Zur mechanischen Kubatur, 1948: the seven points of degree five in a triangle.
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <solver/formfactor.hpp>

namespace clerestory {
namespace {

using glm::dvec3;
using std::numbers::pi;

constexpr std::size_t kMaxCorners = 32;  // of a part; larger polygons are summed as a fan of parts
constexpr std::size_t kMaxClipped = 48;  // a cut drops a corner for every two it adds
constexpr double kGrazing = 1e-14;       // squared sine of a height above the horizon that may be rounding
constexpr double kTouching = 1e-24;      // squared ratio of lengths below which the shorter is rounding

/// Corners as seen from the receiver, which is the origin.
struct Corners {
  std::array<dvec3, kMaxClipped> v;
  std::array<double, kMaxClipped> z;  // height over the receiver's horizon
  std::size_t count = 0;

  void add(const dvec3& corner, double height) {
    v[count] = corner;
    z[count++] = height;
  }
};

/// The angle between a and b over |a x b|, from a . a, b . b, a . b and |a x b|^2; to rounding.
struct ExactAngle {
  static constexpr double kSmall = 4e-8;  // squared spread over distance below which the area form serves

  static double perCross(double, double, double ab, double crossSquared) {
    const double cross = std::sqrt(crossSquared);
    return cross > 0.0 ? std::atan2(cross, ab) / cross : 0.0;
  }
};

/// The same without libm, to 6e-8 of the angle.
struct FastAngle {
  static constexpr double kSmall = 1.0 / 1024.0;

  /// angle / sin(angle) as a function of x = 1 - cos(angle) in [0, 1]: sum of n! / (2n + 1)!! x^n,
  /// interpolated in Chebyshev points but for the constant.
  static double overSine(double x) {
    const double x2 = x * x, x4 = x2 * x2;
    const double low = (0.3333333637 + 0.1333284358 * x) + (0.05727148323 + 0.02411409888 * x) * x2;
    const double high = (0.01784092271 - 0.01161207318 * x) + (0.02821458834 - 0.01994595728 * x) * x2;
    return 1.0 + x * (low + x4 * (high + 0.00825140588 * x4));
  }

  static double perCross(double aa, double bb, double ab, double crossSquared) {
    const double inverse = 1.0 / std::sqrt(aa * bb);
    const double acute = overSine(1.0 - std::abs(ab) * inverse) * inverse;
    return ab >= 0.0 ? acute : pi / std::sqrt(crossSquared) - acute;
  }
};

/// What an edge's term needs of its ends.
struct Edge {
  double aa, bb, ab;
  dvec3 cross;  // a x b
  double cross2;

  Edge(const dvec3& a, const dvec3& b)
      : aa(glm::dot(a, a)),
        bb(glm::dot(b, b)),
        ab(glm::dot(a, b)),
        cross(glm::cross(aa < bb ? a : b, b - a)),  // by the edge, which keeps its digits where it is short
        cross2(glm::dot(cross, cross)) {}

  /// Whether the edge passes through the origin or ends there.
  bool touchesOrigin() const {
    const auto [low, high] = std::minmax(aa, bb);
    return low <= kTouching * high || (ab <= 0.0 && cross2 <= kTouching * high * high);
  }

  /// Its part of Lambert's sum: the angle times n . unit(a x b).
  template <class Angle>
  double term(const dvec3& normal) const {
    return Angle::perCross(aa, bb, ab, cross2) * glm::dot(normal, cross);
  }
};

template <class Corner>
dvec3 doubleAreaNormal(std::span<const Corner> polygon) {
  const dvec3 origin(polygon[0]);
  dvec3 sum(0.0);
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    sum += glm::cross(dvec3(polygon[i]) - origin, dvec3(polygon[i + 1]) - origin);
  return sum;
}

/// Stands for an edge through the origin (from a to b): seen by a receiver that has stepped off the polygon
/// to its front, within its own horizon, the edge runs over a corner in the opposite direction.
template <class Angle, class Corner>
double touchingTerm(const dvec3& a, const dvec3& b, const dvec3& normal, std::span<const Corner> polygon) {
  const dvec3 front = doubleAreaNormal(polygon);
  const dvec3 back = glm::dot(front, normal) * normal - front;
  const double length2 = glm::dot(back, back), aa = glm::dot(a, a), bb = glm::dot(b, b);
  if (length2 <= kTouching * glm::dot(front, front)) return 0.0;  // the receiver lies in the polygon's plane
  const dvec3 corner = back * std::sqrt(std::max(aa, bb) / length2);
  return (aa <= kTouching * bb ? 0.0 : Edge(a, corner).term<Angle>(normal)) +
         (bb <= kTouching * aa ? 0.0 : Edge(corner, b).term<Angle>(normal));
}

template <class Angle, class Corner>
double contourSum(const Corners& corners, const dvec3& normal, std::span<const Corner> polygon) {
  double sum = 0.0;
  for (std::size_t i = 0, last = corners.count - 1; i < corners.count; last = i++) {
    const dvec3 &a = corners.v[last], &b = corners.v[i];
    const Edge edge(a, b);
    sum += edge.touchesOrigin() ? touchingTerm<Angle>(a, b, normal, polygon) : edge.term<Angle>(normal);
  }
  return sum;
}

/// 2 pi times the form factor by area, over a fan with the midpoints of edges as points: relative error of
/// third order in the polygon's size over its distance.
double areaSum(const Corners& corners) {
  const auto kernel = [&](std::size_t i, std::size_t j) {
    const dvec3 middle = corners.v[i] + corners.v[j];  // doubled, which is 8 in the kernel
    const double distance2 = glm::dot(middle, middle);
    return (corners.z[i] + corners.z[j]) / (distance2 * distance2);
  };
  double sum = 0.0, diagonal = kernel(0, 1);
  for (std::size_t i = 1; i + 1 < corners.count; ++i) {
    const dvec3 doubleArea = glm::cross(corners.v[i] - corners.v[0], corners.v[i + 1] - corners.v[0]);
    const double next = kernel(0, i + 1);
    sum += glm::dot(corners.v[0], doubleArea) * (diagonal + kernel(i, i + 1) + next);
    diagonal = next;
  }
  return sum * (8.0 / 3.0);
}

/// The part of a polygon above the horizon; a concave one may get edges there and back along it, which
/// cancel.
void clipToHorizon(const Corners& corners, Corners& clipped) {
  std::size_t last = corners.count - 1;
  for (std::size_t i = 0; i < corners.count; last = i++) {
    const double from = corners.z[last], to = corners.z[i];
    if ((from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0))
      clipped.add((corners.v[last] * to - corners.v[i] * from) / (to - from), 0.0);
    if (to >= 0.0) clipped.add(corners.v[i], to);
  }
}

bool isSmall(const Corners& corners, double limit) {
  double spread = 0.0;
  for (std::size_t i = 1; i < corners.count; ++i) {
    const dvec3 d = corners.v[i] - corners.v[0];
    spread = std::max(spread, glm::dot(d, d));
  }
  return spread < limit * glm::dot(corners.v[0], corners.v[0]);
}

template <class Angle, class Corner>
double signedSum(const Corners& corners, const dvec3& normal, std::span<const Corner> polygon) {
  return isSmall(corners, Angle::kSmall) ? areaSum(corners) : contourSum<Angle>(corners, normal, polygon);
}

/// 2 pi times the form factor to one part of the fan, signed by its winding.
template <class Angle, class Corner>
double partSum(const dvec3& point, const dvec3& normal, std::span<const Corner> polygon, std::size_t first) {
  Corners corners;
  double lowest = 0.0, highest = 0.0, farthest2 = 0.0;
  const std::size_t end = std::min(first + kMaxCorners - 1, polygon.size());
  for (std::size_t i = first - 1; i < end; ++i) {
    const dvec3 v = dvec3(polygon[i < first ? 0 : i]) - point;
    const double z = glm::dot(v, normal);
    corners.add(v, z);
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
    farthest2 = std::max(farthest2, glm::dot(v, v));
  }
  if (highest * highest <= kTouching * farthest2) return 0.0;
  if (lowest >= 0.0) return signedSum<Angle>(corners, normal, polygon);
  Corners clipped;
  clipToHorizon(corners, clipped);
  return clipped.count < 3 ? 0.0 : signedSum<Angle>(clipped, normal, polygon);
}

template <class Angle, class Corner>
double formFactor(const dvec3& point, const dvec3& normal, std::span<const Corner> polygon) {
  double sum = 0.0;
  for (std::size_t first = 1; first + 1 < polygon.size(); first += kMaxCorners - 2)
    sum += partSum<Angle>(point, normal, polygon, first);
  return std::min(std::abs(sum) / (2.0 * pi), 1.0);
}

/// A value for each of some points. Loops over them have no branches, so that they become vector
/// instructions.
using Lanes = std::array<double, 4>;
struct LaneVectors {
  Lanes x, y, z;
};

/// 2 pi times the form factors of four points at once, by the contour. Says no where that does not serve:
/// where the polygon is small for one of them, or reaches down to its horizon, as one that it touches does.
bool contourSums(const std::array<dvec3, 4>& points, const dvec3& normal, std::span<const glm::vec3> polygon,
                 Lanes& sums) {
  double spread = 0.0;
  for (const glm::vec3& corner : polygon) {
    const dvec3 d = dvec3(corner) - dvec3(polygon[0]);
    spread = std::max(spread, glm::dot(d, d));
  }
  const auto seen = [&](const dvec3& corner, LaneVectors& v) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      v.x[i] = corner.x - points[i].x;
      v.y[i] = corner.y - points[i].y;
      v.z[i] = corner.z - points[i].z;
    }
  };
  LaneVectors a, b;
  seen(dvec3(polygon[0]), b);
  Lanes serves;  // where it stays above zero
  for (std::size_t i = 0; i < serves.size(); ++i)
    serves[i] = spread - FastAngle::kSmall * (b.x[i] * b.x[i] + b.y[i] * b.y[i] + b.z[i] * b.z[i]);
  sums = {};
  seen(dvec3(polygon.back()), a);
  for (const glm::vec3& corner : polygon) {
    seen(dvec3(corner), b);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const double aa = a.x[i] * a.x[i] + a.y[i] * a.y[i] + a.z[i] * a.z[i];
      const double bb = b.x[i] * b.x[i] + b.y[i] * b.y[i] + b.z[i] * b.z[i];
      const double ab = a.x[i] * b.x[i] + a.y[i] * b.y[i] + a.z[i] * b.z[i];
      const double height = b.x[i] * normal.x + b.y[i] * normal.y + b.z[i] * normal.z;
      const double ox = aa < bb ? a.x[i] : b.x[i], oy = aa < bb ? a.y[i] : b.y[i],
                   oz = aa < bb ? a.z[i] : b.z[i];
      const double ex = b.x[i] - a.x[i], ey = b.y[i] - a.y[i], ez = b.z[i] - a.z[i];
      const double cx = oy * ez - oz * ey, cy = oz * ex - ox * ez, cz = ox * ey - oy * ex;
      const double cross2 = cx * cx + cy * cy + cz * cz;
      const double inverse = 1.0 / std::sqrt(aa * bb);
      const double acute = FastAngle::overSine(1.0 - std::abs(ab) * inverse) * inverse;
      const double obtuse = pi / std::sqrt(cross2) - acute;
      sums[i] += (ab >= 0.0 ? acute : obtuse) * (cx * normal.x + cy * normal.y + cz * normal.z);
      const double raised = height > 0.0 ? height * height - kGrazing * bb : -1.0;
      serves[i] = std::min(serves[i], raised);
    }
    a = b;
  }
  return std::ranges::all_of(serves, [](double value) { return value > 0.0; });
}

/// A triangle of the receiver in the reference cubature, by two corners seen from the first.
struct Triangle {
  dvec3 origin, first, second;

  double signedArea(const dvec3& normal) const { return 0.5 * glm::dot(glm::cross(first, second), normal); }

  std::array<Triangle, 4> quarters() const {
    const dvec3 a = 0.5 * first, b = 0.5 * second;
    return {{{origin, a, b}, {origin + a, a, b}, {origin + b, a, b}, {origin + a + b, -a, -b}}};
  }
};

/// Radon's seven points.
double meanFormFactor(const Triangle& triangle, const dvec3& normal, std::span<const dvec3> sender) {
  const double root = std::sqrt(15.0);
  const auto at = [&](double u, double v) {
    return pointToPolygon(triangle.origin + u * triangle.first + v * triangle.second, normal, sender);
  };
  const auto orbit = [&](double u) { return at(u, u) + at(1.0 - 2.0 * u, u) + at(u, 1.0 - 2.0 * u); };
  return (270.0 * at(1.0 / 3.0, 1.0 / 3.0) + (155.0 - root) * orbit((6.0 - root) / 21.0) +
          (155.0 + root) * orbit((6.0 + root) / 21.0)) /
         1200.0;
}

/// A triangle's integral with an estimate of its error: that of the next coarser cubature.
struct Cell {
  Triangle triangle;
  double integral = 0.0, error = 0.0;

  Cell(const Triangle& part, const dvec3& normal, std::span<const dvec3> sender) : triangle(part) {
    const double area = part.signedArea(normal);
    for (const Triangle& quarter : part.quarters())
      integral += 0.25 * area * meanFormFactor(quarter, normal, sender);
    error = std::abs(integral - area * meanFormFactor(part, normal, sender));
  }
  bool operator<(const Cell& other) const { return error < other.error; }
};

}  // namespace

double pointToPolygon(glm::dvec3 point, glm::dvec3 normal, std::span<const glm::dvec3> polygon) {
  return formFactor<ExactAngle>(point, normal, polygon);
}

float pointToPolygon(glm::vec3 point, glm::vec3 normal, std::span<const glm::vec3> polygon) {
  return static_cast<float>(formFactor<FastAngle>(dvec3(point), dvec3(normal), polygon));
}

void pointsToPolygon(std::span<const glm::vec3> points, glm::vec3 normal, std::span<const glm::vec3> polygon,
                     std::span<float> formFactors) {
  std::array<dvec3, 4> four;
  for (std::size_t first = 0; first < points.size(); first += four.size()) {
    const std::size_t count = std::min(four.size(), points.size() - first);
    for (std::size_t i = 0; i < four.size(); ++i) four[i] = dvec3(points[first + std::min(i, count - 1)]);
    Lanes sums;
    const bool together = contourSums(four, dvec3(normal), polygon, sums);
    for (std::size_t i = 0; i < count; ++i)
      formFactors[first + i] = together ? static_cast<float>(std::min(std::abs(sums[i]) / (2.0 * pi), 1.0))
                                        : pointToPolygon(points[first + i], normal, polygon);
  }
}

double polygonToPolygon(std::span<const glm::dvec3> receiver, std::span<const glm::dvec3> sender,
                        double tolerance) {
  constexpr std::size_t kMaxCells = 1'000'000;
  const dvec3 doubleArea = doubleAreaNormal(receiver);
  const double area = 0.5 * glm::length(doubleArea);
  if (!(area > 0.0)) return 0.0;
  const dvec3 normal = doubleArea / (2.0 * area);
  std::vector<Cell> cells;  // a heap, largest error first
  double error = 0.0;
  const auto add = [&](const Triangle& part) {
    cells.emplace_back(part, normal, sender);
    error += cells.back().error;
    std::push_heap(cells.begin(), cells.end());
  };
  for (std::size_t i = 1; i + 1 < receiver.size(); ++i)
    add({receiver[0], receiver[i] - receiver[0], receiver[i + 1] - receiver[0]});
  while (error > tolerance * area && cells.size() < kMaxCells) {
    std::pop_heap(cells.begin(), cells.end());
    const Cell worst = cells.back();
    cells.pop_back();
    error -= worst.error;
    for (const Triangle& quarter : worst.triangle.quarters()) add(quarter);
  }
  double integral = 0.0;
  for (const Cell& cell : cells) integral += cell.integral;
  return integral / area;
}

}  // namespace clerestory
