// SPDX-License-Identifier: GPL-3.0-or-later
// What the steps of the clean-up hand from one to the next, and the tolerances they share.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

#include <geometry/building.hpp>
#include <import/scene.hpp>

namespace clerestory {

struct Tolerances {
  double grid_m = 1e-9;        ///< points lie on multiples of it, so that every file format gives equal bits
  double drawn_m = 1e-5;       ///< how exactly files give coordinates
  double weld_m = 1e-3;        ///< points nearer than this are one
  double planar_m = 1e-3;      ///< a polygon's corners keep to its plane
  double coplanar_m = 2.5e-4;  ///< corners of a face that joins another's plane
  double coplanarAngle_rad = 1e-3;   ///< between the normals of such faces, widened for thin ones
  double displacedAngle_rad = 0.02;  ///< at most, where the weld has moved a corner of the face
  double collinear_m = 2e-5;         ///< a corner nearer to the line of its neighbours is no corner
  double degenerateArea_m2 = 1e-8;   ///< smaller faces are dropped
  double paneGapLow_m = 2.5e-3;      ///< between two sheets of one pane unit
  double paneGapHigh_m = 40e-3;      ///< between two sheets of one pane unit
};

using Loop = std::vector<std::uint32_t>;  ///< indices of points, closed

/// The sides that a face is drawn for, of which the front is the one that it is wound counterclockwise about.
struct DrawnSides {
  bool front = true;
  bool back = false;

  [[nodiscard]] bool areBoth() const { return front && back; }
};

/// Faces with their provenance. They are wound about canonical normals, whichever way they were drawn, so
/// that this changes no digit. After welding, points are in lexicographic order.
struct Soup {
  std::vector<glm::dvec3> points;
  PolygonList faces;
  std::vector<std::uint32_t> material;  ///< #faces
  std::vector<std::uint32_t> object;    ///< #faces
  std::vector<DrawnSides> drawn;        ///< #faces
  /// #faces: the unit normal before the weld moved a corner, which may have warped the face a little; zero
  /// where it moved none.
  std::vector<glm::dvec3> bentFrom;

  [[nodiscard]] bool isBent(std::size_t face) const { return bentFrom[face] != glm::dvec3(0.0); }
};

/// A maximal planar region: an outer ring, counterclockwise about its normal, and holes, clockwise.
struct PlanarPolygon {
  Loop outer{};
  std::vector<Loop> holes{};
  std::uint32_t material = 0;
  std::uint32_t object = 0;
  DrawnSides drawn{};      ///< both where as much of it is drawn for one as for the other
  glm::dvec3 normal{0.0};  ///< unit, of the plane in which the outline was found; either sign
};

/// Places of materials and objects in the order of their names, which a file's order does not change.
struct NameRanks {
  std::vector<std::uint32_t> material;  ///< #materials
  std::vector<std::uint32_t> object;    ///< #objects
};

/// Lexicographic order of coordinates.
inline bool lexicographicallyLess(const glm::dvec3& a, const glm::dvec3& b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  return a.z < b.z;
}

/// A point on the grid. Dividing by the whole number of steps per metre gives the double nearest to the
/// decimal. Halves go up, also where rounding makes them a little less.
inline glm::dvec3 onGrid(const glm::dvec3& point, double grid_m) {
  constexpr double half = 0.51;
  const double perMetre = glm::round(1.0 / grid_m);
  return glm::floor(point * perMetre + half) / perMetre + 0.0;  // + 0.0 turns -0 into 0
}

/// Components of unit normals lie on multiples of it, so that turning a model changes none of their digits.
constexpr double normalGrid = 1e-9;

/// Twice the area of a loop along its normal (Newell).
inline glm::dvec3 doubleAreaVector(std::span<const glm::dvec3> points, std::span<const std::uint32_t> loop) {
  glm::dvec3 sum(0.0);
  const glm::dvec3& anchor = points[loop[0]];
  for (std::size_t i = 2; i < loop.size(); ++i) {
    sum += glm::cross(points[loop[i - 1]] - anchor, points[loop[i]] - anchor);
  }
  return sum;
}

/// Turns the loop so that it starts at its lexicographically smallest point.
void startAtSmallest(std::span<const glm::dvec3> points, Loop& loop);

/// The sign that makes a normal's first component that is not about nothing positive.
inline double canonicalSign(const glm::dvec3& normal) {
  constexpr double nothing = 1e-3;
  for (const double component : {normal.x, normal.y, normal.z}) {
    if (component > nothing) return 1.0;
    if (component < -nothing) return -1.0;
  }
  return 1.0;
}

/// Two axes in a plane: u level, v upwards; exact where the plane is perpendicular to an axis of the model.
struct PlaneFrame {
  glm::dvec3 u, v, normal;
  double offset_m = 0.0;

  PlaneFrame(const glm::dvec3& unitNormal, const glm::dvec3& pointOnPlane);
  [[nodiscard]] glm::dvec2 project(const glm::dvec3& p) const { return {glm::dot(p, u), glm::dot(p, v)}; }
  [[nodiscard]] glm::dvec3 lift(const glm::dvec2& q) const { return q.x * u + q.y * v + offset_m * normal; }
};

inline double cross2(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// Distance by which `corner` stands out to the right of the way from `before` to `after`: positive where the
/// turn is to the left (convex), negative where it is reflex. [m]
inline double convexity_m(const glm::dvec2& before, const glm::dvec2& corner, const glm::dvec2& after) {
  const glm::dvec2 way = after - before;
  const double length = glm::length(way);
  return length > 0.0 ? cross2(corner - before, way) / length : 0.0;
}

}  // namespace clerestory
