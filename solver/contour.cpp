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
#include <cmath>
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

/// Integral of ln |point - x| over the edge from a, `length` long along the unit vector `along`; but for the
/// term -length, which cancels around an outline.
double innerIntegral(const dvec3& point, const dvec3& a, const dvec3& along, double length) {
  constexpr double nothing = 1e-300;
  const dvec3 way = a - point;
  const double start = glm::dot(way, along);
  const double end = start + length;
  const double off2 = std::max(glm::dot(way, way) - start * start, 0.0);
  const double logs =
      end * std::log(off2 + end * end + nothing) - start * std::log(off2 + start * start + nothing);
  const double off = std::sqrt(off2);
  return 0.5 * logs + off * std::atan2(off * length, off2 + start * end);
}

/// The outer integral, over the edge from b.
double pairIntegral(const dvec3& a, const dvec3& along, double length, const dvec3& b, const dvec3& edge) {
  constexpr std::array<double, 4> place = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                                           0.93056815579702629};
  constexpr std::array<double, 4> weight = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                            0.17392742256872693};
  double sum = 0.0;
  for (std::size_t i = 0; i < place.size(); ++i)
    sum += weight[i] * innerIntegral(b + place[i] * edge, a, along, length);
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
