// SPDX-License-Identifier: GPL-3.0-or-later
// Counts by sorting: places, faces' corners, edges.
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

#include <geometry/faults.hpp>

#include "soup.hpp"

namespace clerestory {
namespace {

constexpr double none_m2 = 1e-14;  // what rounding leaves of corners on a line
constexpr double onEdge_m = 1e-5;

/// Faces with area, their corners numbered by place.
struct Places {
  std::vector<glm::dvec3> points;
  PolygonList faces;
};

Places placesOf(const Scene& scene, DrawnFaults& faults) {
  Loop used;
  PolygonList drawn;
  for (std::size_t face = 0; face < scene.faces.size(); ++face) {
    const auto corners = scene.faces[face];
    used.insert(used.end(), corners.begin(), corners.end());
    if (glm::length(doubleAreaVector(scene.points, corners)) <= none_m2) {
      ++faults.facesWithoutArea;
    } else {
      drawn.add(corners);
    }
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::sort(used.begin(), used.end(), [&](std::uint32_t a, std::uint32_t b) {
    return lexicographicallyLess(scene.points[a], scene.points[b]);
  });
  Places places;
  Loop placeOf(scene.points.size());
  for (const std::uint32_t point : used) {
    if (places.points.empty() || places.points.back() != scene.points[point])
      places.points.push_back(scene.points[point]);
    placeOf[point] = static_cast<std::uint32_t>(places.points.size() - 1);
  }
  faults.repeatedPoints = used.size() - places.points.size();
  places.faces = std::move(drawn);
  for (std::uint32_t& corner : places.faces.corners) corner = placeOf[corner];
  return places;
}

std::size_t repeatedFaces(const PolygonList& faces) {
  std::vector<Loop> corners;
  for (std::size_t face = 0; face < faces.size(); ++face) {
    Loop& loop = corners.emplace_back(faces[face].begin(), faces[face].end());
    std::sort(loop.begin(), loop.end());
    loop.erase(std::unique(loop.begin(), loop.end()), loop.end());
  }
  std::sort(corners.begin(), corners.end());
  const auto end = std::unique(corners.begin(), corners.end());
  return static_cast<std::size_t>(corners.end() - end);
}

/// How often faces run along an edge from its lower place to its higher one, and back.
using Edges = std::map<std::pair<std::uint32_t, std::uint32_t>, std::array<std::size_t, 2>>;

Edges edgesOf(const PolygonList& faces) {
  Edges edges;
  for (std::size_t face = 0; face < faces.size(); ++face) {
    const auto corners = faces[face];
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t from = corners[i];
      const std::uint32_t to = corners[(i + 1) % corners.size()];
      if (from != to) ++edges[std::minmax(from, to)][from < to ? 0 : 1];
    }
  }
  return edges;
}

/// Points by their coordinate along one axis.
struct Sorted {
  std::vector<double> place;
  Loop point;
};

std::array<Sorted, 3> sortedByAxis(const std::vector<glm::dvec3>& points) {
  std::array<Sorted, 3> sorted;
  for (int axis = 0; axis < 3; ++axis) {
    Sorted& list = sorted[static_cast<std::size_t>(axis)];
    list.point.resize(points.size());
    std::iota(list.point.begin(), list.point.end(), 0U);
    std::sort(list.point.begin(), list.point.end(),
              [&](std::uint32_t a, std::uint32_t b) { return points[a][axis] < points[b][axis]; });
    for (const std::uint32_t point : list.point) list.place.push_back(points[point][axis]);
  }
  return sorted;
}

std::size_t tJunctions(const std::vector<glm::dvec3>& points, const Edges& edges) {
  const std::array<Sorted, 3> sorted = sortedByAxis(points);
  std::vector<bool> isJunction(points.size(), false);
  for (const auto& [ends, times] : edges) {
    if (times[0] + times[1] != 1) continue;
    const glm::dvec3& from = points[ends.first];
    const glm::dvec3 way = points[ends.second] - from;
    const double length = glm::length(way);
    int axis = 0;  // along which the edge is shortest, so that few points are looked at
    for (const int other : {1, 2}) {
      if (std::abs(way[other]) < std::abs(way[axis])) axis = other;
    }
    const Sorted& list = sorted[static_cast<std::size_t>(axis)];
    const double low = std::min(from[axis], from[axis] + way[axis]) - onEdge_m;
    const double high = std::max(from[axis], from[axis] + way[axis]) + onEdge_m;
    const auto first = std::lower_bound(list.place.begin(), list.place.end(), low) - list.place.begin();
    const auto end = std::upper_bound(list.place.begin(), list.place.end(), high) - list.place.begin();
    for (auto i = first; i < end; ++i) {
      const std::uint32_t point = list.point[static_cast<std::size_t>(i)];
      const glm::dvec3 offset = points[point] - from;
      const double along = glm::dot(offset, way) / length;
      if (along <= onEdge_m || along >= length - onEdge_m) continue;
      if (glm::length(glm::cross(offset, way)) <= onEdge_m * length) isJunction[point] = true;
    }
  }
  return static_cast<std::size_t>(std::count(isJunction.begin(), isJunction.end(), true));
}

}  // namespace

DrawnFaults countFaults(const Scene& scene) {
  DrawnFaults faults;
  const Places places = placesOf(scene, faults);
  faults.repeatedFaces = repeatedFaces(places.faces);
  const Edges edges = edgesOf(places.faces);
  for (const auto& [ends, times] : edges) {
    faults.nonManifoldEdges += times[0] + times[1] > 2 ? 1 : 0;
    faults.edgesWoundApart += (times[0] == 2 && times[1] == 0) || (times[0] == 0 && times[1] == 2) ? 1 : 0;
  }
  faults.tJunctions = tJunctions(places.points, edges);
  return faults;
}

}  // namespace clerestory
