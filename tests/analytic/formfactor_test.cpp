// SPDX-License-Identifier: GPL-3.0-or-later
// Form factors against closed forms, closure and reciprocity, where polygons touch, vanish and cross the
// horizon.
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include <solver/formfactor.hpp>

namespace clerestory {
namespace {

using glm::dvec3;
using std::numbers::pi;
using Polygon = std::vector<dvec3>;

const dvec3 kUp(0.0, 0.0, 1.0);

float inFloat(dvec3 point, dvec3 normal, const Polygon& polygon) {
  const std::vector<glm::vec3> corners(polygon.begin(), polygon.end());
  return pointToPolygon(glm::vec3(point), glm::vec3(normal), corners);
}

/// x from x0 to x1, y from y0 to y1, at height z.
Polygon horizontal(double x0, double x1, double y0, double y1, double z) {
  return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

/// x from x0 to x1, z from z0 to z1, in the plane y.
Polygon upright(double x0, double x1, double y, double z0, double z1) {
  return {{x0, y, z0}, {x1, y, z0}, {x1, y, z1}, {x0, y, z1}};
}

/// The six faces of a box from the origin.
std::vector<Polygon> boxFaces(dvec3 size) {
  const auto [x, y, z] = std::array{size.x, size.y, size.z};
  return {horizontal(0, x, 0, y, 0),
          horizontal(0, x, 0, y, z),
          upright(0, x, 0, 0, z),
          upright(0, x, y, 0, z),
          {{0, 0, 0}, {0, y, 0}, {0, y, z}, {0, 0, z}},
          {{x, 0, 0}, {x, y, 0}, {x, y, z}, {x, 0, z}}};
}

Polygon regular(int corners, double radius, double z) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * pi * i / corners;
    polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  return polygon;
}

/// Point under the corner of a parallel a x b rectangle at distance c.
double parallelCorner(double a, double b, double c) {
  const double x = a / c, y = b / c, sx = std::hypot(1.0, x), sy = std::hypot(1.0, y);
  return (x / sx * std::atan(y / sx) + y / sy * std::atan(x / sy)) / (2.0 * pi);
}

/// Point at distance c from the foot corner of a perpendicular rectangle of width b and height h.
double perpendicularCorner(double b, double h, double c) {
  return (std::atan(b / c) - c / std::hypot(h, c) * std::atan(b / std::hypot(h, c))) / (2.0 * pi);
}

/// Directly opposed a x b rectangles at distance c (Hottel).
double opposed(double a, double b, double c) {
  const double x = a / c, y = b / c, sx = std::hypot(1.0, x), sy = std::hypot(1.0, y);
  return 2.0 / (pi * x * y) *
         (std::log(sx * sy / std::sqrt(1.0 + x * x + y * y)) + x * sy * std::atan(x / sy) +
          y * sx * std::atan(y / sx) - x * std::atan(x) - y * std::atan(y));
}

/// Rectangles with a common edge of length 1 at a right angle, from the one of depth w to the one of height
/// h.
double commonEdge(double w, double h) {
  const double ww = w * w, hh = h * h, s = ww + hh;
  const double product = (1 + ww) * (1 + hh) / (1 + s) * std::pow(ww * (1 + s) / ((1 + ww) * s), ww) *
                         std::pow(hh * (1 + s) / ((1 + hh) * s), hh);
  return (w * std::atan(1 / w) + h * std::atan(1 / h) - std::sqrt(s) * std::atan(1 / std::sqrt(s)) +
          0.25 * std::log(product)) /
         (pi * w);
}

/// The kernel summed over n x n midpoints of the parallelogram that starts with three corners, cut at the
/// horizon.
double bySampling(dvec3 point, dvec3 normal, const Polygon& p, int n) {
  const dvec3 u = p[1] - p[0], v = p.back() - p[0], area = glm::cross(u, v);
  double sum = 0.0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const dvec3 d = p[0] + (i + 0.5) / n * u + (j + 0.5) / n * v - point;
      sum += std::max(glm::dot(d, normal), 0.0) * std::abs(glm::dot(d, area)) / std::pow(glm::dot(d, d), 2);
    }
  return sum / (pi * n * n);
}

/// Parallel rectangles at distance c, each given by its x0, x1, y0, y1 (Hottel's closed form for any offset).
double parallel(const std::array<double, 4>& from, const std::array<double, 4>& to, double c) {
  const auto part = [c](double u, double v) {  // a double integral of the kernel, taken twice along x and y
    const double su = std::hypot(u, c), sv = std::hypot(v, c);
    return u * sv * std::atan(u / sv) + v * su * std::atan(v / su) -
           0.5 * c * c * std::log(u * u + v * v + c * c);
  };
  double sum = 0.0;
  for (int i = 0; i < 16; ++i) {
    const double sign = (i ^ i >> 1 ^ i >> 2 ^ i >> 3) % 2 == 0 ? 1.0 : -1.0;
    sum += sign * part(to[i >> 1 & 1] - from[i & 1], to[2 + (i >> 3 & 1)] - from[2 + (i >> 2 & 1)]);
  }
  return sum / (2.0 * pi * (from[1] - from[0]) * (from[3] - from[2]));
}

double areaOf(const Polygon& polygon) {
  dvec3 sum(0.0);
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum += glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return 0.5 * glm::length(sum);
}

/// Stokes' theorem on both ends, for polygons that face and do not touch each other: the mean logarithm of
/// the distance over each pair of edges, by Gauss' five points on 16 parts of each.
double byContours(const Polygon& from, const Polygon& to) {
  const std::array<double, 5> places = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                        0.9061798459386640};
  const std::array<double, 5> weights = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                         0.4786286704993665, 0.2369268850561891};
  constexpr std::size_t parts = 16, count = 5 * parts;
  const auto place = [&](std::size_t i) {
    return (static_cast<double>(i / 5) + 0.5 + 0.5 * places[i % 5]) / parts;
  };
  double sum = 0.0;
  for (std::size_t a = 0; a < from.size(); ++a)
    for (std::size_t b = 0; b < to.size(); ++b) {
      const dvec3 u = from[(a + 1) % from.size()] - from[a], v = to[(b + 1) % to.size()] - to[b];
      double mean = 0.0;
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < count; ++j)
          mean += 0.25 * weights[i % 5] * weights[j % 5] / (parts * parts) *
                  std::log(glm::distance(from[a] + place(i) * u, to[b] + place(j) * v));
      sum += glm::dot(u, v) * mean;
    }
  return std::abs(sum) / (2.0 * pi * areaOf(from));
}

/// Numbers that are the same on every machine, in [-1, 1).
class Numbers {
 public:
  double next() { return static_cast<double>(engine_()) / 2147483648.0 - 1.0; }
  dvec3 vector() {
    const double x = next(), y = next(), z = next();
    return {x, y, z};
  }
  dvec3 unit() {
    while (true)
      if (const dvec3 v = vector(); glm::dot(v, v) < 1.0 && glm::dot(v, v) > 0.01) return glm::normalize(v);
  }

 private:
  std::mt19937 engine_{20240501};
};

TEST(PointToPolygon, ParallelRectangle) {
  for (const double c : {1e-3, 0.1, 1.0, 3.0, 50.0}) {
    EXPECT_NEAR(pointToPolygon({0, 0, 0}, kUp, horizontal(0, 4, 0, 3, c)), parallelCorner(4, 3, c), 1e-15);
    const double four =
        parallelCorner(1, 2, c) + parallelCorner(3, 2, c) + parallelCorner(1, 1, c) + parallelCorner(3, 1, c);
    EXPECT_NEAR(pointToPolygon({1, 2, 0}, kUp, horizontal(0, 4, 0, 3, c)), four, 1e-15);
  }
}

TEST(PointToPolygon, PerpendicularRectangle) {
  for (const double c : {1e-6, 1e-3, 0.25, 1.0, 20.0})
    EXPECT_NEAR(pointToPolygon({0, c, 0}, kUp, upright(0, 2, 0, 0, 3)), perpendicularCorner(2, 3, c), 1e-15);
}

TEST(PointToPolygon, TiltedReceiver) {
  const Polygon ceiling = horizontal(-1, 2, -1, 1.5, 2);
  for (const double tilt : {0.1, 0.4, 0.7}) {  // the whole rectangle stays above the horizon
    const dvec3 normal(std::sin(tilt), 0.0, std::cos(tilt));
    EXPECT_NEAR(pointToPolygon({0, 0, 0}, normal, ceiling), bySampling({0, 0, 0}, normal, ceiling, 2000),
                1e-7);
  }
  const Polygon disc =
      regular(1000, 1.0, 1.0);  // on its axis the factor is that of the axis times the cosine
  const double polygonOverDisc = std::sin(2 * pi / 1000) * 1000 / (2 * pi);
  EXPECT_NEAR(pointToPolygon({0, 0, 0}, {0.6, 0, 0.8}, disc), 0.8 * 0.5 * (1 + polygonOverDisc) / 2, 3e-6);
}

TEST(PointToPolygon, WallLeaningOverItsFoot) {
  for (const double angle :
       {0.3, 1.0, pi / 2, 2.5}) {  // between floor and wall; the wall is as good as endless
    const dvec3 rise(0.0, -std::cos(angle), std::sin(angle));
    const Polygon wall = {
        {-1e8, 0, 0}, {1e8, 0, 0}, dvec3(1e8, 0, 0) + 1e8 * rise, dvec3(-1e8, 0, 0) + 1e8 * rise};
    EXPECT_NEAR(pointToPolygon({0, -1e-2, 0}, kUp, wall), (1 - std::cos(pi - angle)) / 2, 1e-9);
  }
}

TEST(PointToPolygon, TouchingPoints) {
  const Polygon wall = upright(-3, 3, 0, 0, 2);
  EXPECT_NEAR(pointToPolygon({0, 0, 0}, kUp, wall), 0.5, 1e-15);
  EXPECT_NEAR(pointToPolygon({3, 0, 0}, kUp, wall), 0.25, 1e-15);
  EXPECT_NEAR(pointToPolygon({3, 0, 0.5}, kUp, wall), 0.25, 1e-15);
  EXPECT_NEAR(pointToPolygon({1, 0, 0.5}, kUp, wall), 0.5, 1e-15);
  EXPECT_EQ(pointToPolygon({0, 0, 2}, kUp, wall), 0.0);
  for (const double step : {1e-9, -1e-9}) EXPECT_NEAR(pointToPolygon({1, step, 0.5}, kUp, wall), 0.5, 1e-8);
  EXPECT_NEAR(static_cast<double>(inFloat({0, 0, 0}, kUp, wall)), 0.5, 1e-7);
  EXPECT_NEAR(static_cast<double>(inFloat({3, 0, 0}, kUp, wall)), 0.25, 1e-7);
  const Polygon leaning = {{-3, 0, 0}, {3, 0, 0}, {3, -1, 1}, {-3, -1, 1}};  // its front over the point
  EXPECT_NEAR(pointToPolygon({0, 0, 0}, kUp, leaning), pointToPolygon({0, -1e-9, 0}, kUp, leaning), 1e-8);
}

TEST(PointToPolygon, InItsPlaneIsNothing) {
  const Polygon floor = horizontal(0, 4, 0, 3, 1);
  for (const dvec3 point : {dvec3(2, 1, 1), dvec3(0, 0, 1), dvec3(4, 1, 1), dvec3(7, 1, 1), dvec3(2, 1, 2)}) {
    EXPECT_EQ(pointToPolygon(point, kUp, floor), 0.0);
    EXPECT_EQ(inFloat(point, kUp, floor), 0.0F);
  }
  EXPECT_NEAR(pointToPolygon({7, 1, 1}, {1, 0, 0}, floor), 0.0, 1e-15);
  EXPECT_NEAR(pointToPolygon({7, 1, 1}, glm::normalize(dvec3(-1, 0, 1)), floor), 0.0, 1e-15);
}

TEST(PointToPolygon, ClosureInsideABox) {
  Numbers numbers;
  for (int i = 0; i < 2000; ++i) {
    const dvec3 size(4.0, 0.07, 300.0), normal = numbers.unit();
    const dvec3 point = size * (0.5 + 0.499999 * numbers.vector());
    double sum = 0.0;
    float fast = 0.0F;
    for (const Polygon& face : boxFaces(size)) {
      sum += pointToPolygon(point, normal, face);
      fast += inFloat(point, normal, face);
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_NEAR(static_cast<double>(fast), 1.0, 2e-5);
  }
}

TEST(PointToPolygon, CrossingTheHorizon) {
  const double above = perpendicularCorner(2, 3, 1.5);
  EXPECT_NEAR(pointToPolygon({0, 1.5, 0}, kUp, upright(0, 2, 0, -5, 3)), above, 1e-15);
  EXPECT_NEAR(pointToPolygon({0, 1.5, 0}, kUp, Polygon{{0, 0, 3}, {0, 0, -5}, {2, 0, -5}, {2, 0, 3}}), above,
              1e-15);
  EXPECT_EQ(pointToPolygon({0, 1.5, 0}, kUp, upright(0, 2, 0, -5, -1)), 0.0);
  const Polygon slanted = {{-1, 2, -1}, {1, 2, -1}, {1, 1, 2}, {-1, 1, 2}};
  EXPECT_NEAR(pointToPolygon({0, 0, 0}, kUp, slanted), bySampling({0, 0, 0}, kUp, slanted, 3000), 1e-6);
}

TEST(PointToPolygon, ConcavePolygons) {
  // A comb whose teeth reach above the horizon, one by one and as a whole.
  Polygon comb = {{-4, 2, -1}};
  double teeth = 0.0;
  for (int i = 0; i < 4; ++i) {
    const double x = -4.0 + 2.0 * i;
    for (const dvec3 corner :
         {dvec3(x, 2, 1), dvec3(x + 1, 2, 1), dvec3(x + 1, 2, -0.5), dvec3(x + 2, 2, -0.5)})
      comb.push_back(corner);
    teeth += pointToPolygon({0.3, 0, 0}, kUp, upright(x, x + 1, 2, 0, 1));
  }
  comb.emplace_back(4, 2, -1);
  EXPECT_NEAR(pointToPolygon({0.3, 0, 0}, kUp, comb), teeth, 1e-15);
  const Polygon corner = {{0, 0, 2}, {2, 0, 2}, {2, 1, 2}, {1, 1, 2}, {1, 2, 2}, {0, 2, 2}};
  const double parts = pointToPolygon({1.5, 1.5, 0}, kUp, horizontal(0, 2, 0, 1, 2)) +
                       pointToPolygon({1.5, 1.5, 0}, kUp, horizontal(0, 1, 1, 2, 2));
  EXPECT_NEAR(pointToPolygon({1.5, 1.5, 0}, kUp, corner), parts, 1e-15);
}

TEST(PointToPolygon, ManyCorners) {
  for (const int corners : {31, 32, 33, 62, 63, 64, 500}) {
    const double r = 2.0, z = 1.0, a = r * std::cos(pi / corners), b = 2 * r * std::sin(pi / corners);
    const double exact = corners * a / std::hypot(z, a) * 2 * std::atan(b / 2 / std::hypot(z, a)) / (2 * pi);
    EXPECT_NEAR(pointToPolygon({0, 0, 0}, kUp, regular(corners, r, z)), exact, 1e-14);
    EXPECT_NEAR(static_cast<double>(inFloat({0, 0, 0}, kUp, regular(corners, r, z))), exact, 2e-7);
  }
}

TEST(PointToPolygon, MillimetresBesideKilometres) {
  const Polygon square = horizontal(-500, 500, -500, 500, 0);
  const dvec3 above(120, -333, 1e-3), down(0, 0, -1);
  EXPECT_NEAR(1.0 - pointToPolygon(above, down, square),
              1.0 - parallelCorner(620, 167, 1e-3) - parallelCorner(380, 167, 1e-3) -
                  parallelCorner(620, 833, 1e-3) - parallelCorner(380, 833, 1e-3),
              1e-15);
  EXPECT_NEAR(static_cast<double>(inFloat(above, down, square)), 1.0, 1e-7);
  const double step = 1.0 / 1024.0;
  const dvec3 beside(500 - step, 0, step);  // about a millimetre from its edge too
  const double half = parallelCorner(1000 - step, 500, step) + parallelCorner(step, 500, step);
  EXPECT_NEAR(pointToPolygon(beside, down, square), 2 * half, 1e-15);
  // A square millimetre a kilometre away, and its cosine laws.
  const double tiny = pointToPolygon({0, 0, 0}, kUp, horizontal(600, 600.001, 0, 0.001, 800));
  EXPECT_NEAR(tiny / (0.8 * 0.8 * 1e-6 / (pi * 1e6)), 1.0, 3e-6);
  EXPECT_NEAR(
      static_cast<double>(inFloat({0, 0, 0}, kUp, horizontal(-0.0005, 0.0005, -0.0005, 0.0005, 1000))) /
          (1e-6 / (pi * 1e6)),
      1.0, 1e-5);
}

TEST(PointToPolygon, SidesAndWindingCountAlike) {
  Polygon polygon = {{1, 2, 1}, {3, 2, 1.5}, {3, 3, 2.5}};
  const double one = pointToPolygon({0, 0, 0}, kUp, polygon);
  std::swap(polygon[0], polygon[2]);
  EXPECT_NEAR(pointToPolygon({0, 0, 0}, kUp, polygon), one, 1e-16);
  EXPECT_GT(one, 0.003);
}

TEST(PointToPolygon, FloatAgreesWithDouble) {
  Numbers numbers;
  double worst = 0.0;
  for (int i = 0; i < 200000; ++i) {
    const double size = std::exp2(6.0 * numbers.next());
    const dvec3 centre = 3.0 * numbers.vector(), u = size * numbers.unit(), v = size * numbers.unit();
    std::vector<glm::vec3> corners;
    for (const dvec3 corner : {centre - u, centre + v, centre + u, centre - v}) corners.emplace_back(corner);
    const Polygon same(corners.begin(), corners.end());
    const glm::vec3 normal(numbers.unit());
    const double exact = pointToPolygon(dvec3(0.0), dvec3(normal), same);
    worst =
        std::max(worst, std::abs(static_cast<double>(pointToPolygon(glm::vec3(0), normal, corners)) - exact));
  }
  EXPECT_LT(worst, 2e-7);
}

TEST(PointsToPolygon, AgreeWithDoubleAtEachPoint) {
  // Some see all of the polygon, some have it cut by their horizon, are far from it, or touch it.
  Numbers numbers;
  for (int i = 0; i < 40000; ++i) {
    std::vector<glm::vec3> corners;
    for (const dvec3& corner : regular(3 + i % 6, std::exp2(5.0 * numbers.next()), 0.0))
      corners.emplace_back(corner);
    const dvec3 middle = 4.0 * numbers.vector();
    const double apart = std::exp2(4.0 * numbers.next());
    std::array<glm::vec3, 6> points;
    for (glm::vec3& point : points) point = glm::vec3(middle + apart * numbers.vector());
    if (i % 10 == 0) points[1] = corners[0];
    if (i % 10 == 1) points[2] = 0.5F * (corners[0] + corners[1]);
    const glm::vec3 normal(numbers.unit());
    const std::size_t count = 1 + static_cast<std::size_t>(i) % points.size();
    std::array<float, 6> formFactors;
    formFactors.fill(-1.0F);
    pointsToPolygon(std::span(points).first(count), normal, corners, formFactors);
    const Polygon same(corners.begin(), corners.end());
    for (std::size_t k = 0; k < count; ++k)
      EXPECT_NEAR(static_cast<double>(formFactors[k]), pointToPolygon(dvec3(points[k]), dvec3(normal), same),
                  2e-7);
    for (std::size_t k = count; k < points.size(); ++k) EXPECT_EQ(formFactors[k], -1.0F);
  }
}

TEST(PointToPolygon, ContinuousAcrossTheAreaForm) {
  Numbers numbers;
  for (int i = 0; i < 2000; ++i) {
    const glm::dquat turn = glm::angleAxis(3.0 * numbers.next(), numbers.unit());
    const Polygon shape = regular(3 + i % 4, 1.0, 0.0);
    double spread = 0.0;  // from the first corner, what the forms are chosen by
    for (const dvec3& corner : shape) spread = std::max(spread, glm::distance(corner, shape[0]));
    const dvec3 towards = glm::normalize(numbers.unit() + dvec3(0, 0, 1.2));
    const auto at = [&](double distance, bool single) {
      Polygon moved;
      for (const dvec3& corner : shape) moved.push_back(turn * (corner - shape[0]) + distance * towards);
      return single ? static_cast<double>(inFloat(dvec3(0.0), kUp, moved))
                    : pointToPolygon(dvec3(0.0), kUp, moved);
    };
    const double plump = std::abs(glm::dot(turn * dvec3(0, 0, 1), towards));  // seen edge-on, digits go
    if (plump < 0.05) continue;
    const double exact = spread / 2e-4, fast = spread * 32.0;
    EXPECT_NEAR(at(exact * (1 + 1e-13), false) / at(exact * (1 - 1e-13), false), 1.0, 1e-11 / plump);
    EXPECT_NEAR(at(fast * (1 + 2e-6), true) / at(fast * (1 - 2e-6), true), 1.0, 1.5e-5 / plump);
  }
}

TEST(PointToPolygon, RelativeAccuracyOfTheAreaForm) {
  // A rectangle of 1 x 0.7 m at a growing distance against the closed form's series-free sum in long double.
  for (double distance = 2.0; distance < 1e5; distance *= 1.1) {
    const long double d = distance, x = 1.0L / d, y = 0.7L / d, sx = std::sqrt(1 + x * x),
                      sy = std::sqrt(1 + y * y);
    const long double exact =
        (x / sx * std::atan(y / sx) + y / sy * std::atan(x / sy)) / (2 * std::numbers::pi_v<long double>);
    const Polygon polygon = horizontal(0, 1, 0, 0.7, distance);
    const double ratio = static_cast<double>(pointToPolygon(dvec3(0.0), kUp, polygon) / exact);
    EXPECT_NEAR(ratio, 1.0, 1e-11) << distance;
    EXPECT_NEAR(static_cast<double>(inFloat(dvec3(0.0), kUp, horizontal(0, 1, 0, 0.75, distance))) /
                    parallelCorner(1, 0.75, static_cast<double>(static_cast<float>(distance))),
                1.0, 2e-6)
        << distance;
  }
}

TEST(PolygonToPolygon, OpposedRectangles) {
  for (const double c : {0.1, 1.0, 4.0})
    EXPECT_NEAR(polygonToPolygon(horizontal(0, 2, 0, 1, 0), horizontal(0, 2, 0, 1, c), 1e-8),
                opposed(2, 1, c), 1e-8);
}

TEST(PolygonToPolygon, PerpendicularRectanglesWithACommonEdge) {
  for (const auto& [w, h] : {std::pair{1.0, 1.0}, std::pair{2.0, 0.5}, std::pair{0.05, 1.0}})
    EXPECT_NEAR(polygonToPolygon(horizontal(0, 1, 0, w, 0), upright(0, 1, 0, 0, h), 1e-7), commonEdge(w, h),
                1e-7);
}

TEST(PolygonToPolygon, ParallelRectanglesAnywhere) {
  EXPECT_NEAR(parallel({0, 2, 0, 1}, {0, 2, 0, 1}, 0.7), opposed(2, 1, 0.7), 1e-14);
  for (const double c : {0.2, 1.0, 5.0})
    for (const auto& to : {std::array{0.5, 1.0, 0.25, 0.5}, std::array{-3.0, 4.0, -2.0, 2.0},
                           std::array{2.0, 3.0, 1.0, 4.0}, std::array{6.0, 6.5, -4.0, -1.0}})
      EXPECT_NEAR(
          polygonToPolygon(horizontal(0, 2, 0, 1, 0), horizontal(to[0], to[1], to[2], to[3], c), 1e-9),
          parallel({0, 2, 0, 1}, to, c), 2e-9);
}

TEST(PolygonToPolygon, PerpendicularRectanglesApart) {
  const Polygon floor = horizontal(0, 3, -2, -0.25, 0);
  for (const Polygon& wall : {upright(0, 3, 0, 0, 2), upright(1, 2, 0.5, 1, 1.5), upright(5, 6, 0, 0.5, 4)})
    EXPECT_NEAR(polygonToPolygon(floor, wall, 1e-9), byContours(floor, wall), 2e-9);
  // Floors and walls in pairs along one line: half of the floor sees the wall that it touches and the one
  // beside that.
  const double whole = commonEdge(0.5, 0.5);  // 2 x 1 m on 2 x 1 m, in units of the edge
  const double same = commonEdge(1.0, 1.0);
  EXPECT_NEAR(polygonToPolygon(horizontal(0, 1, 0, 1, 0), upright(1, 2, 0, 0, 1), 1e-7), whole - same, 2e-7);
}

TEST(PolygonToPolygon, TiltedPolygons) {
  const Polygon floor = horizontal(0, 2, 0, 1, 0);
  for (const double angle : {0.5, 0.8, 1.4, 2.4}) {  // a board beside the floor, its front towards all of it
    const dvec3 rise(0.0, std::cos(angle), std::sin(angle)), foot(0.3, 1.2, 0.1);
    const Polygon board = {foot, foot + dvec3(1.5, 0.0, 0.0), foot + dvec3(1.5, 0.0, 0.0) + rise,
                           foot + rise};
    const double expected = byContours(floor, board);
    EXPECT_GT(expected, 0.0);
    EXPECT_NEAR(polygonToPolygon(floor, board, 1e-9), expected, 2e-9) << angle;
  }
  // The faces of a regular tetrahedron touch at 70.5 degrees and share all light among three.
  const std::array<dvec3, 4> corners = {dvec3(1, 1, 1), dvec3(1, -1, -1), dvec3(-1, 1, -1), dvec3(-1, -1, 1)};
  const Polygon base = {corners[0], corners[2], corners[1]};  // its front towards the fourth
  EXPECT_NEAR(polygonToPolygon(base, Polygon{corners[0], corners[1], corners[3]}, 1e-7), 1.0 / 3.0, 1e-7);
}

TEST(PolygonToPolygon, TinyAgainstHuge) {
  // A square millimetre a metre over a hectare and off its middle.
  Polygon tiny = horizontal(12.0, 12.001, -33.0, -32.999, 1.0);
  std::swap(tiny[1], tiny[3]);  // looks down
  const Polygon huge = horizontal(-50, 50, -50, 50, 0.0);
  const double seen = parallelCorner(62, 17, 1) + parallelCorner(38, 17, 1) + parallelCorner(62, 83, 1) +
                      parallelCorner(38, 83, 1);
  EXPECT_NEAR(polygonToPolygon(tiny, huge, 1e-9), seen, 1e-7);  // over the millimetre it varies by 1e-8
  const double back = polygonToPolygon(huge, tiny, 1e-16);
  EXPECT_NEAR(back / (1e-10 * seen), 1.0, 2e-6);
  // Touching: a strip of a millimetre's height all along a wall's foot sees half of its hemisphere filled.
  const double strip = polygonToPolygon(upright(0, 10, 0, 0, 0.001), horizontal(0, 10, -10, 0, 0), 1e-6);
  EXPECT_NEAR(strip, commonEdge(0.0001, 1.0), 1e-6);
}

TEST(PolygonToPolygon, Reciprocity) {
  const Polygon a = horizontal(0, 3, 0, 2, 0), b = {{0.5, 0.5, 2}, {0.5, 1.5, 2.5}, {2.5, 1.0, 3}};
  const double areaB = 0.5 * glm::length(glm::cross(b[1] - b[0], b[2] - b[0]));
  EXPECT_NEAR(6.0 * polygonToPolygon(a, b, 1e-10), areaB * polygonToPolygon(b, a, 1e-10), 1e-9);
  const Polygon wall = upright(1, 4, 2, 0, 2.5), floor = horizontal(0, 3, 0, 2, 0);  // touching along a part
  EXPECT_NEAR(7.5 * polygonToPolygon(wall, floor, 1e-7), 6.0 * polygonToPolygon(floor, wall, 1e-7), 1.5e-6);
}

TEST(PolygonToPolygon, ClosureOfABox) {
  const std::vector<Polygon> faces = boxFaces({2, 3, 1});
  double sum = 0.0;
  for (std::size_t i = 1; i < faces.size(); ++i) sum += polygonToPolygon(faces[0], faces[i], 1e-7);
  EXPECT_NEAR(sum, 1.0, 5e-7);
}

TEST(PolygonToPolygon, OnlyTheReceiversFrontSees) {
  Polygon floor = horizontal(0, 1, 0, 1, 0);
  const Polygon ceiling = horizontal(0, 1, 0, 1, 1);
  EXPECT_GT(polygonToPolygon(floor, ceiling, 1e-4), 0.19);
  EXPECT_EQ(polygonToPolygon(ceiling, floor, 1e-4), 0.0);
  std::swap(floor[1], floor[3]);
  EXPECT_EQ(polygonToPolygon(floor, ceiling, 1e-4), 0.0);
}

float meanOf(const Polygon& receiver, const Polygon& sender) {
  const std::vector<glm::vec3> own(receiver.begin(), receiver.end());
  const std::vector<glm::vec3> other(sender.begin(), sender.end());
  const auto normal = [](const Polygon& p) {
    return glm::vec3(glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0])));
  };
  const auto area =
      static_cast<float>(glm::length(glm::cross(receiver[1] - receiver[0], receiver[2] - receiver[0])));
  return meanFormFactor(own, normal(receiver), area, other, normal(sender));
}

/// x from x0 to x1, z from z0 to z1, in the plane y; looks along +y.
Polygon uprightAhead(double x0, double x1, double y, double z0, double z1) {
  return {{x1, y, z0}, {x0, y, z0}, {x0, y, z1}, {x1, y, z1}};
}

// Parallelograms against the cubature; what the header promises of each.
TEST(MeanFormFactor, TouchingAndNearPolygons) {
  const Polygon floor = horizontal(0, 1, 0, 1, 0);
  const auto expect = [](const Polygon& receiver, const Polygon& sender, double relative) {
    const double exact = polygonToPolygon(receiver, sender, 1e-8);
    EXPECT_NEAR(meanOf(receiver, sender), exact, relative * exact);
  };
  expect(floor, uprightAhead(0, 1, 0, 0, 1), 0.002);
  expect(uprightAhead(0, 1, 0, 0, 1), floor, 0.002);
  expect(floor, uprightAhead(1, 2, 0, 0, 1), 0.004);  // at a corner
  expect(horizontal(0, 3, 0, 2.8, 0), uprightAhead(0.3, 0.5, 0, 0, 0.2),
         0.004);  // small on a large one's edge
  expect(uprightAhead(0.3, 0.5, 0, 0, 0.2), horizontal(0, 3, 0, 2.8, 0), 0.004);
  expect(uprightAhead(0, 3.2, 0, 0, 1.8), horizontal(0, 3.2, 0, 0.15, 0), 0.012);  // a long strip
  expect(floor, uprightAhead(0, 1, -0.5, 0, 1), 0.001);                            // apart
  expect(floor, {{0, 0, 0.03}, {0, 1, 0.03}, {1, 1, 0.03}, {1, 0, 0.03}}, 0.001);  // close over it
}

// Farther apart than they are wide the four points of the outer rule leave 1e-7 (its error falls by the
// eighth power of 8 and more), and what is left are logarithms and angles: those of all lengths between 2
// and 8.
TEST(MeanFormFactor, PolygonsApartAgreeWithHottelsClosedForm) {
  for (double distance = 2.0; distance < 8.0; distance *= 1.07) {
    const Polygon above = {{0.3, 0, distance}, {0.3, 1, distance}, {1.3, 1, distance}, {1.3, 0, distance}};
    const double exact = parallel({0, 1, 0, 1}, {0.3, 1.3, 0, 1}, distance);
    EXPECT_NEAR(meanOf(horizontal(0, 1, 0, 1, 0), above), exact, 2e-6 * exact) << distance;
  }
}

TEST(MeanFormFactor, OnlyWhatLiesInFrontCounts) {
  const Polygon floor = horizontal(0, 1, 0, 1, 0);
  // Half of the wall is below the floor's plane; half of the floor is behind the wall's.
  EXPECT_NEAR(meanOf(floor, uprightAhead(0, 1, 0, -1, 1)), meanOf(floor, uprightAhead(0, 1, 0, 0, 1)), 1e-6);
  EXPECT_NEAR(meanOf(horizontal(0, 1, -1, 1, 0), uprightAhead(0, 1, 0, 0, 1)),
              0.5F * meanOf(floor, uprightAhead(0, 1, 0, 0, 1)), 1e-6);
  EXPECT_EQ(meanOf(floor, uprightAhead(0, 1, 2, 0, 1)), 0.0F);  // sees its back
  EXPECT_EQ(meanOf(floor, horizontal(0, 1, 0, 1, 0)), 0.0F);
}

}  // namespace
}  // namespace clerestory
