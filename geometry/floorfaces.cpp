// SPDX-License-Identifier: GPL-3.0-or-later
// Edges that pieces share cancel; a constrained triangulation of the rest and the lines says what hangs
// together.
#include "floorfaces.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include <geometry/sampling.hpp>

#include "planeedges.hpp"
#include "soup.hpp"

namespace clerestory {
namespace {

constexpr double same_m = 1e-6;  // points of a plan nearer than this are one

/// Points of a plan by place, in cells that a point's equals lie in or beside.
class PlanPoints {
 public:
  std::uint32_t indexOf(const glm::dvec2& place) {
    const auto x = std::llround(place.x / cell_m);
    const auto y = std::llround(place.y / cell_m);
    for (long long i = x - 1; i <= x + 1; ++i) {
      for (long long j = y - 1; j <= y + 1; ++j) {
        const auto found = cells_.find({i, j});
        if (found == cells_.end()) continue;
        for (const std::uint32_t point : found->second) {
          if (glm::length(points_[point] - place) <= same_m) return point;
        }
      }
    }
    points_.push_back(place);
    cells_[{x, y}].push_back(static_cast<std::uint32_t>(points_.size() - 1));
    return static_cast<std::uint32_t>(points_.size() - 1);
  }
  [[nodiscard]] const std::vector<glm::dvec2>& all() const { return points_; }

 private:
  static constexpr double cell_m = 0.01;
  std::vector<glm::dvec2> points_;
  std::map<std::pair<long long, long long>, std::vector<std::uint32_t>> cells_;
};

/// Edges of the pieces, the covered side on their left, and lines.
std::vector<PlaneEdge> edgesOf(const Pieces& pieces, std::span<const std::uint32_t> level,
                               std::span<const PlanLine> lines, PlanPoints& points) {
  EdgeSum sum;
  for (const std::uint32_t piece : level) {
    Loop loop;
    for (const std::uint32_t corner : pieces.polygons[piece])
      loop.push_back(points.indexOf(glm::dvec2(pieces.points[corner])));
    if (pieces.normal[piece].z < 0.0) std::reverse(loop.begin(), loop.end());
    for (std::size_t i = 0; i < loop.size(); ++i) sum.add(loop[i], loop[(i + 1) % loop.size()], 1);
  }
  for (const PlanLine& line : lines) sum.add(points.indexOf(line.from_m), points.indexOf(line.to_m), 0);
  return sum.take();
}

/// Empty where the edges cannot be parted.
Triangulation triangulateAll(std::vector<PlaneEdge> edges, PlanPoints& points) {
  constexpr int attempts = 4;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    edges = splitAtPoints(points.all(), edges, same_m);
    Triangulation triangulation = triangulate(points.all(), edges);
    if (!triangulation.crossing) return triangulation;
    edges =
        splitAtCrossings(points.all(), edges, [&](const glm::dvec2& place) { return points.indexOf(place); });
  }
  return {};
}

}  // namespace

glm::dvec2 FloorFace::sample(std::uint32_t index, std::uint32_t count) const {
  double target_m2 = area_m2 * (index + 0.5) / count;
  std::size_t chosen = 0;
  for (; chosen + 1 < triangles.size(); ++chosen) {
    const auto& [a, b, c] = triangles[chosen];
    const double own_m2 = 0.5 * cross2(b - a, c - a);
    if (target_m2 < own_m2) break;
    target_m2 -= own_m2;
  }
  const auto& [a, b, c] = triangles[chosen];
  const Sequence sequence(0xf100);
  const double out = std::sqrt(static_cast<double>(sequence(index, 0)));
  const double along = static_cast<double>(sequence(index, 1));
  return a + out * (b - a) + out * along * (c - b);
}

std::vector<FloorFace> floorFaces(const Pieces& pieces, std::span<const std::uint32_t> level,
                                  std::span<const PlanLine> lines) {
  PlanPoints points;
  const Triangulation triangulation = triangulateAll(edgesOf(pieces, level, lines, points), points);
  const auto& triangles = triangulation.triangles;
  std::vector<bool> seen(triangles.size(), false);
  std::vector<FloorFace> faces;
  for (std::uint32_t first = 0; first < triangles.size(); ++first) {
    if (seen[first] || triangles[first].winding == 0) continue;
    FloorFace face;
    std::vector<std::uint32_t> open{first};
    seen[first] = true;
    while (!open.empty()) {
      const Triangulation::Triangle& triangle = triangles[open.back()];
      open.pop_back();
      std::array<glm::dvec2, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = points.all()[triangle.corner[i]];
        const std::uint32_t next = triangle.neighbour[i];
        if (triangle.constrained[i] || next == Triangulation::none || seen[next]) continue;
        seen[next] = true;
        open.push_back(next);
      }
      face.area_m2 += 0.5 * cross2(corners[1] - corners[0], corners[2] - corners[0]);
      face.triangles.push_back(corners);
    }
    if (face.area_m2 > 0.0) faces.push_back(std::move(face));
  }
  return faces;
}

}  // namespace clerestory
