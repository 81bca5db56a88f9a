// SPDX-License-Identifier: GPL-3.0-or-later
// Edges that pieces share cancel; a constrained triangulation of the rest and the lines says what hangs
// together.
#include "floorfaces.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

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

/// Where a triangle meets a line of a frame.
struct Stretch {
  double line;  ///< its number
  double from_m, to_m;
};

void addStretches(const std::array<glm::dvec2, 3>& triangle, double first_m, double step_m,
                  std::vector<Stretch>& stretches) {
  const auto [low, high] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
  for (double line = std::ceil((low - first_m) / step_m); first_m + line * step_m < high; ++line) {
    const double y = first_m + line * step_m;
    Stretch stretch{line, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec2& a = triangle[i];
      const glm::dvec2& b = triangle[(i + 1) % 3];
      if ((a.y <= y) == (b.y <= y)) continue;
      const double x = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
      stretch.from_m = std::min(stretch.from_m, x);
      stretch.to_m = std::max(stretch.to_m, x);
    }
    if (stretch.to_m > stretch.from_m) stretches.push_back(stretch);
  }
}

/// Edges of the pieces, the covered side on their left; those of each surface stay, though it goes on in
/// another.
std::vector<PlaneEdge> edgesOf(const Pieces& pieces, std::span<const std::uint32_t> level,
                               std::span<const PlanLine> lines, PlanPoints& points) {
  std::map<std::uint32_t, EdgeSum> bySurface;
  for (const std::uint32_t piece : level) {
    Loop loop;
    for (const std::uint32_t corner : pieces.polygons[piece])
      loop.push_back(points.indexOf(glm::dvec2(pieces.points[corner])));
    if (pieces.normal[piece].z < 0.0) std::reverse(loop.begin(), loop.end());
    EdgeSum& own = bySurface[pieces.surface[piece]];
    for (std::size_t i = 0; i < loop.size(); ++i) own.add(loop[i], loop[(i + 1) % loop.size()], 1);
  }
  std::vector<PlaneEdge> edges;
  const auto stay = [&](std::uint32_t from, std::uint32_t to) {
    if (from != to) edges.push_back({std::min(from, to), std::max(from, to), 0});
  };
  for (auto& [surface, own] : bySurface) {
    for (const PlaneEdge& edge : splitAtPoints(points.all(), own.take(), same_m)) {
      edges.push_back(edge);
      stay(edge.from, edge.to);
    }
  }
  for (const PlanLine& line : lines) stay(points.indexOf(line.from_m), points.indexOf(line.to_m));
  return edges;
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

std::vector<glm::dvec2> FloorFace::samples(const PlanFrame& frame, std::uint32_t count) const {
  constexpr double linesLeast = 3.0;
  constexpr double offset = 0.382;  // of the way between lines: edges lie on round shares of a face
  double low_m = std::numeric_limits<double>::infinity();
  double high_m = -low_m;
  std::vector<std::array<glm::dvec2, 3>> framed = triangles;
  for (auto& triangle : framed) {
    for (glm::dvec2& corner : triangle) {
      corner = frame.toFrame(corner);
      low_m = std::min(low_m, corner.y);
      high_m = std::max(high_m, corner.y);
    }
  }
  const double lines = std::max(linesLeast, std::ceil((high_m - low_m) / std::sqrt(area_m2 / count)));
  const double step_m = (high_m - low_m) / lines;
  std::vector<Stretch> stretches;
  for (const auto& triangle : framed) addStretches(triangle, low_m + offset * step_m, step_m, stretches);
  std::sort(stretches.begin(), stretches.end(), [](const Stretch& a, const Stretch& b) {
    return a.line != b.line ? a.line < b.line : a.from_m < b.from_m;
  });
  double total_m = 0.0;
  for (const Stretch& stretch : stretches) total_m += stretch.to_m - stretch.from_m;
  std::vector<glm::dvec2> points;
  double passed_m = 0.0;
  for (const Stretch& stretch : stretches) {
    const double end_m = passed_m + stretch.to_m - stretch.from_m;
    for (; points.size() < count;) {
      const double way_m = total_m * (static_cast<double>(points.size()) + offset) / count;
      if (way_m >= end_m) break;
      points.push_back(
          frame.toPlan({stretch.from_m + way_m - passed_m, low_m + (stretch.line + offset) * step_m}));
    }
    passed_m = end_m;
  }
  return points;
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
      for (std::size_t i = 0; i < 3; ++i) corners[i] = points.all()[triangle.corner[i]];
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t next = triangle.neighbour[i];
        if (triangle.constrained[i] || next == Triangulation::none) {
          face.outline_m += glm::length(corners[(i + 1) % 3] - corners[i]);
        } else if (!seen[next]) {
          seen[next] = true;
          open.push_back(next);
        }
      }
      face.area_m2 += 0.5 * cross2(corners[1] - corners[0], corners[2] - corners[0]);
      face.triangles.push_back(corners);
    }
    if (face.area_m2 > 0.0) faces.push_back(std::move(face));
  }
  return faces;
}

}  // namespace clerestory
