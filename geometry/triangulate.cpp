// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's constrained Delaunay triangulation behind plain arrays; the only file that knows it.
#include "triangulate.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <unordered_map>

namespace clerestory {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<std::uint32_t, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>, CGAL::Exact_predicates_tag>;
using Edges = std::unordered_map<std::uint64_t, int>;

std::uint64_t key(std::uint32_t from, std::uint32_t to) {
  return (std::uint64_t{from} << 32U) | to;
}

/// Inserts points and edges by their coordinates: what is cocircular is decided the same way in every run.
void insert(Delaunay& delaunay, std::span<const glm::dvec2> points, std::span<const PlaneEdge> edges) {
  std::vector<std::uint32_t> used;
  for (const PlaneEdge& edge : edges) {
    used.push_back(edge.from);
    used.push_back(edge.to);
  }
  const auto less = [&](std::uint32_t a, std::uint32_t b) {
    if (points[a].x != points[b].x) return points[a].x < points[b].x;
    if (points[a].y != points[b].y) return points[a].y < points[b].y;
    return a < b;
  };
  std::sort(used.begin(), used.end(), less);
  used.erase(std::unique(used.begin(), used.end()), used.end());

  std::unordered_map<std::uint32_t, std::uint32_t> place;
  std::vector<Delaunay::Vertex_handle> vertices;
  Delaunay::Face_handle hint;
  for (const std::uint32_t point : used) {
    const auto vertex = delaunay.insert(Delaunay::Point(points[point].x, points[point].y), hint);
    vertex->info() = point;
    hint = vertex->face();
    place[point] = static_cast<std::uint32_t>(vertices.size());
    vertices.push_back(vertex);
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> constraints;
  for (const PlaneEdge& edge : edges) constraints.push_back(std::minmax(place[edge.from], place[edge.to]));
  std::sort(constraints.begin(), constraints.end());
  for (const auto& [a, b] : constraints) {
    if (vertices[a] != vertices[b]) delaunay.insert_constraint(vertices[a], vertices[b]);
  }
}

/// Whether every constrained edge is one that was given, so none was cut by another or by a point.
bool keepsEdges(const Delaunay& delaunay, const Edges& given, std::size_t points) {
  if (delaunay.number_of_vertices() != points) return false;
  std::size_t constrained = 0;
  for (const auto& [face, side] : delaunay.finite_edges()) {
    if (!face->is_constrained(side)) continue;
    ++constrained;
    if (!given.contains(
            key(face->vertex(Delaunay::cw(side))->info(), face->vertex(Delaunay::ccw(side))->info()))) {
      return false;
    }
  }
  return 2 * constrained == given.size();
}

/// Winding numbers from the outside inwards: each given edge that is crossed changes it.
void floodWinding(const Delaunay& delaunay, const Edges& given, Triangulation& result) {
  constexpr std::uint32_t outside = Triangulation::none;
  std::vector<Delaunay::Face_handle> open;
  std::vector<bool> seen(result.triangles.size(), false);
  const auto enter = [&](Delaunay::Face_handle face, int side, int windingBefore) {
    const Delaunay::Face_handle next = face->neighbor(side);
    const std::uint32_t index = next->info();
    if (index == outside || seen[index]) return;
    int winding = windingBefore;
    // `next` lies on the left of the way from cw(side) to ccw(side) as `face` sees it.
    const auto found =
        given.find(key(face->vertex(Delaunay::cw(side))->info(), face->vertex(Delaunay::ccw(side))->info()));
    if (found != given.end()) winding += found->second;
    seen[index] = true;
    result.triangles[index].winding = winding;
    open.push_back(next);
  };
  for (const auto& face : delaunay.all_face_handles()) {
    if (delaunay.is_infinite(face)) enter(face, face->index(delaunay.infinite_vertex()), 0);
  }
  while (!open.empty()) {
    const Delaunay::Face_handle face = open.back();
    open.pop_back();
    for (int side = 0; side < 3; ++side) enter(face, side, result.triangles[face->info()].winding);
  }
}

}  // namespace

Triangulation triangulate(std::span<const glm::dvec2> points, std::span<const PlaneEdge> edges) {
  Edges given;
  for (const PlaneEdge& edge : edges) {
    given[key(edge.from, edge.to)] += edge.times;
    given[key(edge.to, edge.from)] -= edge.times;
  }
  std::vector<std::uint32_t> used;
  for (const PlaneEdge& edge : edges) {
    used.push_back(edge.from);
    used.push_back(edge.to);
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());

  Delaunay delaunay;
  insert(delaunay, points, edges);
  Triangulation result;
  result.crossing = !keepsEdges(delaunay, given, used.size());
  if (result.crossing || delaunay.dimension() < 2) return result;

  for (const auto& face : delaunay.all_face_handles()) face->info() = Triangulation::none;
  std::uint32_t count = 0;
  for (const auto& face : delaunay.finite_face_handles()) face->info() = count++;
  for (const auto& face : delaunay.finite_face_handles()) {
    Triangulation::Triangle triangle{};
    for (int i = 0; i < 3; ++i) {
      const int opposite = Delaunay::cw(i);  // the edge from corner i to i + 1 lies opposite to corner i + 2
      const auto place = static_cast<std::size_t>(i);
      triangle.corner[place] = face->vertex(i)->info();
      triangle.neighbour[place] = face->neighbor(opposite)->info();
      triangle.constrained[place] = face->is_constrained(opposite);
    }
    result.triangles.push_back(triangle);
  }
  floodWinding(delaunay, given, result);
  return result;
}

}  // namespace clerestory
