// SPDX-License-Identifier: GPL-3.0-or-later
// Mean form factors of near polygons by Stokes' theorem: an integral around both outlines, which has no
// singularity to miss where they touch.
//
// Sparrow, E. M.: A new and simpler formulation for radiative angle factors, 1963: with A the receiver's
// area, A F = 1/(2 pi) sum over pairs of edges of cos(edges) times the double integral of ln r.
// The inner integral is closed (Mitalas, G. P., Stephenson, D. G., 1966), the outer one Gauss-Legendre.
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <solver/formfactor.hpp>

namespace clerestory {
namespace {

using glm::dvec3;

constexpr std::size_t cornersMost = contourCornersMost + 1;  // a cut of a convex polygon adds one
constexpr double onPlane_m = 1e-6;  // float corners of touching polygons miss by that

struct Outline {
  std::array<dvec3, cornersMost> corner;
  std::size_t count = 0;
};

/// The part of a convex polygon in front of a plane; corners as seen from `origin`.
Outline cutInFront(std::span<const glm::vec3> polygon, const dvec3& origin, const dvec3& onPlane,
                   const dvec3& normal) {
  Outline outline;
  const auto height = [&](std::size_t i) { return glm::dot(dvec3(polygon[i]) - onPlane, normal); };
  std::size_t last = polygon.size() - 1;
  double from = height(last);
  double highest = from;
  for (std::size_t i = 0; i < polygon.size(); last = i++) {
    const double to = height(i);
    if ((from > onPlane_m && to < -onPlane_m) || (from < -onPlane_m && to > onPlane_m)) {
      const dvec3 a = dvec3(polygon[last]) - origin;
      const dvec3 b = dvec3(polygon[i]) - origin;
      outline.corner[outline.count++] = a + (from / (from - to)) * (b - a);
    }
    highest = std::max(highest, to);
    if (to >= -onPlane_m) outline.corner[outline.count++] = dvec3(polygon[i]) - origin;
    from = to;
  }
  if (highest <= onPlane_m) outline.count = 0;
  return outline;
}

/// A value for each point of the outer rule. Loops over them have no branches, so that they become vector
/// instructions; those of the mathematics library do not, and took a tenth of a solve.
using OfPoints = std::array<double, 4>;

/// ln x of normal positive numbers, to 1e-12: 2 atanh((m - 1) / (m + 1)) of a mantissa m in [1/√2, √2).
OfPoints logOf(const OfPoints& x) {
  constexpr std::uint64_t mantissa = 0x000fffffffffffffU;
  constexpr std::uint64_t rootHalf = 0x3fe6a09e667f3bcdU;  // 1/√2
  constexpr std::uint64_t twoTo52 = 0x4330000000000000U;
  OfPoints result;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(x[i]) - rootHalf;
    const std::uint64_t raised = bits + (std::uint64_t{1024} << 52U);  // so that exponents are positive
    const double exponent = std::bit_cast<double>((raised >> 52U) | twoTo52) - (0x1p52 + 1024.0);
    const double m = std::bit_cast<double>((bits & mantissa) + rootHalf);
    const double r = (m - 1.0) / (m + 1.0);
    const double r2 = r * r;
    const double series =
        r2 * (1.0 / 3 + r2 * (1.0 / 5 + r2 * (1.0 / 7 + r2 * (1.0 / 9 + r2 * (1.0 / 11 + r2 / 13)))));
    result[i] = exponent * std::numbers::ln2 + 2.0 * (r + r * series);
  }
  return result;
}

/// The angle of (x, y), y >= 0, in [0, pi], to 1e-12; 0 at the origin.
OfPoints angleOf(const OfPoints& x, const OfPoints& y) {
  constexpr double tanEighth = 0.41421356237309503;  // tan(pi / 8)
  constexpr double tiny = 1e-300;
  using std::numbers::pi;
  OfPoints result;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double wide = std::abs(x[i]);
    const double low = std::min(wide, y[i]);
    const double high = std::max(wide, y[i]) + tiny;
    const bool isSteep = low > tanEighth * high;
    const double t = (isSteep ? low - high : low) / (isSteep ? low + high : high);
    const double t2 = t * t;
    // The odd series, of which the first term that is left out is below 1e-12 at tan(pi / 8).
    double series = 1.0 / 25;
    for (int k = 23; k >= 1; k -= 2) series = 1.0 / k - t2 * series;
    const double acute = (isSteep ? pi / 4 : 0.0) + t * series;
    const double first = y[i] > wide ? pi / 2 - acute : acute;
    result[i] = x[i] < 0.0 ? pi - first : first;
  }
  return result;
}

/// The outer integral, over the edge from b, of the integral of ln |point - x| over the edge from a, `length`
/// long along the unit vector `along`; but for the term -length, which cancels around an outline.
double pairIntegral(const dvec3& a, const dvec3& along, double length, const dvec3& b, const dvec3& edge) {
  constexpr OfPoints place = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                              0.93056815579702629};
  constexpr OfPoints weight = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                               0.17392742256872693};
  constexpr double nothing = 1e-300;
  OfPoints start;
  OfPoints off2;
  OfPoints toStart2;
  OfPoints toEnd2;
  for (std::size_t i = 0; i < place.size(); ++i) {
    const dvec3 way = a - (b + place[i] * edge);
    start[i] = glm::dot(way, along);
    off2[i] = std::max(glm::dot(way, way) - start[i] * start[i], 0.0);
    toStart2[i] = off2[i] + start[i] * start[i] + nothing;
    toEnd2[i] = off2[i] + (start[i] + length) * (start[i] + length) + nothing;
  }
  OfPoints off;
  OfPoints x;
  OfPoints y;
  for (std::size_t i = 0; i < place.size(); ++i) {
    off[i] = std::sqrt(off2[i]);
    x[i] = off2[i] + start[i] * (start[i] + length);
    y[i] = off[i] * length;
  }
  const OfPoints logOfStart = logOf(toStart2);
  const OfPoints logOfEnd = logOf(toEnd2);
  const OfPoints angle = angleOf(x, y);
  double sum = 0.0;
  for (std::size_t i = 0; i < place.size(); ++i)
    sum += weight[i] *
           (0.5 * ((start[i] + length) * logOfEnd[i] - start[i] * logOfStart[i]) + off[i] * angle[i]);
  return sum;
}

}  // namespace

float meanFormFactor(std::span<const glm::vec3> receiver, const glm::vec3& receiverNormal, float area_m2,
                     std::span<const glm::vec3> sender, const glm::vec3& senderNormal) {
  const dvec3 origin(receiver[0]);
  const Outline own = cutInFront(receiver, origin, dvec3(sender[0]), dvec3(senderNormal));
  const Outline other = cutInFront(sender, origin, dvec3(receiver[0]), dvec3(receiverNormal));
  if (own.count < 3 || other.count < 3) return 0.0F;
  double sum = 0.0;
  for (std::size_t i = 0; i < own.count; ++i) {
    const dvec3& a = own.corner[i];
    const dvec3 edgeA = own.corner[i + 1 < own.count ? i + 1 : 0] - a;
    const double lengthA = glm::length(edgeA);
    for (std::size_t j = 0; j < other.count; ++j) {
      const dvec3& b = other.corner[j];
      const dvec3 edgeB = other.corner[j + 1 < other.count ? j + 1 : 0] - b;
      const double lengthB = glm::length(edgeB);
      const double product = glm::dot(edgeA, edgeB);
      if (std::abs(product) <= 1e-9 * lengthA * lengthB) continue;
      // The shorter edge outside, so that the longer one's ends, where ln r is steep, are not within it.
      const double integral = lengthA >= lengthB
                                  ? pairIntegral(a, edgeA / lengthA, lengthA, b, edgeB) / lengthA
                                  : pairIntegral(b, edgeB / lengthB, lengthB, a, edgeA) / lengthB;
      sum += product * integral;
    }
  }
  const double formFactor = std::abs(sum) / (2.0 * std::numbers::pi * static_cast<double>(area_m2));
  return static_cast<float>(std::min(formFactor, 1.0));
}

}  // namespace clerestory
