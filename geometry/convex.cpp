// SPDX-License-Identifier: GPL-3.0-or-later
// Planar polygons with holes become few, plump convex pieces.
//
// S. Hertel, K. Mehlhorn: Fast triangulation of simple polygons, 1983 (removing diagonals that are not
// needed; here the longest first, on a constrained Delaunay triangulation).
#include "convex.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "merge.hpp"
#include "triangulate.hpp"

namespace clerestory {
namespace {

/// The polygon in its plane, wound counterclockwise there. Local indices are places in `globals`.
struct FlatPolygon {
  Loop globals;
  std::vector<glm::dvec2> flat;
  std::vector<Loop> rings;  ///< local indices
};

glm::dvec3 unitNormal(std::span<const glm::dvec3> points, const PlanarPolygon& polygon) {
  glm::dvec3 sum = doubleAreaVector(points, polygon.outer);
  for (const Loop& hole : polygon.holes) sum += doubleAreaVector(points, hole);
  return glm::normalize(sum);
}

FlatPolygon flatten(std::span<const glm::dvec3> points, const PlanarPolygon& polygon,
                    const PlaneFrame& frame) {
  FlatPolygon result;
  std::unordered_map<std::uint32_t, std::uint32_t> localOf;
  const auto addRing = [&](const Loop& ring) {
    Loop loop;
    for (const std::uint32_t corner : ring) {
      const auto [found, isNew] =
          localOf.try_emplace(corner, static_cast<std::uint32_t>(result.globals.size()));
      if (isNew) {
        result.globals.push_back(corner);
        result.flat.push_back(frame.project(points[corner]));
      }
      loop.push_back(found->second);
    }
    result.rings.push_back(std::move(loop));
  };
  addRing(polygon.outer);
  for (const Loop& hole : polygon.holes) addRing(hole);
  return result;
}

bool isConvex(const FlatPolygon& polygon, double tolerance_m) {
  if (polygon.rings.size() != 1) return false;
  const Loop& ring = polygon.rings[0];
  double turning = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const glm::dvec2& before = polygon.flat[ring[(i + ring.size() - 1) % ring.size()]];
    const glm::dvec2& corner = polygon.flat[ring[i]];
    const glm::dvec2& after = polygon.flat[ring[(i + 1) % ring.size()]];
    if (convexity_m(before, corner, after) < -tolerance_m) return false;
    turning += std::atan2(cross2(corner - before, after - corner), glm::dot(corner - before, after - corner));
  }
  return turning < 7.0;  // one turn, not two
}

// ---------------------------------------------------------------------------------------------- rectangles

/// Values that differ by less than the tolerance are one line of the raster.
std::vector<double> rasterLines(std::vector<double> values, double tolerance_m) {
  std::sort(values.begin(), values.end());
  std::vector<double> lines;
  for (const double value : values) {
    if (lines.empty() || value - lines.back() > tolerance_m) lines.push_back(value);
  }
  return lines;
}

std::size_t lineOf(const std::vector<double>& lines, double value, double tolerance_m) {
  const auto next = std::upper_bound(lines.begin(), lines.end(), value + tolerance_m);
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, next - lines.begin() - 1));
}

struct Rectangle {
  std::size_t left, bottom, right, top;  ///< raster lines
};

/// The cells of a polygon whose edges are square to each other, in the frame of its longest edge.
class Raster {
 public:
  /// Empty where an edge is oblique or the raster is too large to pay.
  Raster(const FlatPolygon& polygon, double tolerance_m) : polygon_(polygon), tolerance_m_(tolerance_m) {
    turn_ = longestDirection();
    std::vector<double> x;
    std::vector<double> y;
    for (const glm::dvec2& point : polygon.flat) {
      const glm::dvec2 turned = turn(point);
      x.push_back(turned.x);
      y.push_back(turned.y);
    }
    x_ = rasterLines(std::move(x), tolerance_m);
    y_ = rasterLines(std::move(y), tolerance_m);
    constexpr std::size_t mostCells = 40000;
    square_ = x_.size() >= 2 && y_.size() >= 2 && x_.size() * y_.size() <= mostCells && edgesAreSquare();
    if (square_) fill();
  }

  explicit operator bool() const { return square_; }

  /// Takes the largest rectangle of free cells away until none is left.
  std::vector<Rectangle> rectangles() {
    std::vector<Rectangle> result;
    for (;;) {
      const Rectangle best = largestFree();
      if (best.right == best.left) return result;
      for (std::size_t j = best.bottom; j < best.top; ++j) {
        for (std::size_t i = best.left; i < best.right; ++i) free_[j * columns() + i] = false;
      }
      result.push_back(best);
    }
  }

  [[nodiscard]] std::uint64_t node(std::size_t i, std::size_t j) const { return j * x_.size() + i; }
  [[nodiscard]] std::uint64_t nodeOf(const glm::dvec2& point) const {
    const glm::dvec2 turned = turn(point);
    return node(lineOf(x_, turned.x, tolerance_m_), lineOf(y_, turned.y, tolerance_m_));
  }
  [[nodiscard]] glm::dvec2 place(std::size_t i, std::size_t j) const {
    return {x_[i] * turn_.x - y_[j] * turn_.y, x_[i] * turn_.y + y_[j] * turn_.x};
  }

 private:
  [[nodiscard]] std::size_t columns() const { return x_.size() - 1; }
  [[nodiscard]] std::size_t rows() const { return y_.size() - 1; }
  [[nodiscard]] glm::dvec2 turn(const glm::dvec2& p) const {
    return {p.x * turn_.x + p.y * turn_.y, p.y * turn_.x - p.x * turn_.y};
  }

  /// Unit direction of the longest edge, within a quarter turn of the first axis.
  [[nodiscard]] glm::dvec2 longestDirection() const {
    glm::dvec2 longest(0.0);
    for (const Loop& ring : polygon_.rings) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2 edge = polygon_.flat[ring[(i + 1) % ring.size()]] - polygon_.flat[ring[i]];
        if (glm::length(edge) > glm::length(longest) + tolerance_m_) longest = edge;
      }
    }
    longest /= glm::length(longest);
    while (longest.x <= 1e-9 || longest.y < -1e-9) longest = {-longest.y, longest.x};
    if (std::abs(longest.y) < 1e-12) return {1.0, 0.0};
    return longest;
  }

  [[nodiscard]] bool edgesAreSquare() const {
    for (const Loop& ring : polygon_.rings) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2 a = turn(polygon_.flat[ring[i]]);
        const glm::dvec2 b = turn(polygon_.flat[ring[(i + 1) % ring.size()]]);
        const bool sameX = lineOf(x_, a.x, tolerance_m_) == lineOf(x_, b.x, tolerance_m_);
        const bool sameY = lineOf(y_, a.y, tolerance_m_) == lineOf(y_, b.y, tolerance_m_);
        if (sameX == sameY) return false;
      }
    }
    return true;
  }

  /// Marks the cells inside: upright edges to the left of a cell count by their direction.
  void fill() {
    std::vector<int> change(x_.size() * y_.size(), 0);
    for (const Loop& ring : polygon_.rings) {
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const glm::dvec2 a = turn(polygon_.flat[ring[k]]);
        const glm::dvec2 b = turn(polygon_.flat[ring[(k + 1) % ring.size()]]);
        const std::size_t i = lineOf(x_, a.x, tolerance_m_);
        if (lineOf(x_, b.x, tolerance_m_) != i) continue;
        const std::size_t from = lineOf(y_, a.y, tolerance_m_);
        const std::size_t to = lineOf(y_, b.y, tolerance_m_);
        // The region lies on the left: an edge downwards begins it, one upwards ends it.
        for (std::size_t j = std::min(from, to); j < std::max(from, to); ++j)
          change[node(i, j)] += to < from ? 1 : -1;
      }
    }
    free_.assign(columns() * rows(), false);
    for (std::size_t j = 0; j < rows(); ++j) {
      int winding = 0;
      for (std::size_t i = 0; i < columns(); ++i) {
        winding += change[node(i, j)];
        free_[j * columns() + i] = winding > 0;
      }
    }
  }

  /// Largest rectangle of free cells, the first of equals; left == right where none is free.
  [[nodiscard]] Rectangle largestFree() const {
    Rectangle best{0, 0, 0, 0};
    double bestArea = 0.0;
    std::vector<std::size_t> depth(columns(), 0);  // free cells below, this row included
    std::vector<std::size_t> stack;
    for (std::size_t j = 0; j < rows(); ++j) {
      for (std::size_t i = 0; i < columns(); ++i) depth[i] = free_[j * columns() + i] ? depth[i] + 1 : 0;
      stack.clear();
      for (std::size_t i = 0; i <= columns(); ++i) {
        const std::size_t here = i < columns() ? depth[i] : 0;
        while (!stack.empty() && depth[stack.back()] >= here) {
          const std::size_t tall = depth[stack.back()];
          stack.pop_back();
          const std::size_t left = stack.empty() ? 0 : stack.back() + 1;
          const double area = (x_[i] - x_[left]) * (y_[j + 1] - y_[j + 1 - tall]);
          // Equal but for rounding: the first stays, so that noise does not choose.
          if (tall > 0 && area > bestArea * (1.0 + 1e-6)) {
            bestArea = area;
            best = {left, j + 1 - tall, i, j + 1};
          }
        }
        if (i < columns()) stack.push_back(i);
      }
    }
    return best;
  }

  const FlatPolygon& polygon_;
  double tolerance_m_;
  glm::dvec2 turn_{1.0, 0.0};
  std::vector<double> x_, y_;
  std::vector<bool> free_;
  bool square_ = false;
};

std::vector<Loop> rectanglePieces(std::vector<glm::dvec3>& points, const FlatPolygon& polygon, Raster& raster,
                                  const PlaneFrame& frame, const Tolerances& tolerances) {
  std::unordered_map<std::uint64_t, std::uint32_t> pointAt;
  for (std::size_t i = 0; i < polygon.globals.size(); ++i) {
    pointAt[raster.nodeOf(polygon.flat[i])] = polygon.globals[i];
  }
  const auto corner = [&](std::size_t i, std::size_t j) {
    const auto [found, isNew] =
        pointAt.try_emplace(raster.node(i, j), static_cast<std::uint32_t>(points.size()));
    if (isNew) points.push_back(onGrid(frame.lift(raster.place(i, j)), tolerances.grid_m));
    return found->second;
  };
  std::vector<Loop> result;
  for (const Rectangle& r : raster.rectangles()) {
    result.push_back(
        {corner(r.left, r.bottom), corner(r.right, r.bottom), corner(r.right, r.top), corner(r.left, r.top)});
  }
  return result;
}

// ----------------------------------------------------------------------------------------- merged triangles

/// Triangles as rings of directed edges; edge 3t + i leaves corner i of triangle t.
class Diagonals {
 public:
  Diagonals(const FlatPolygon& polygon, const Triangulation& triangulation, double tolerance_m)
      : polygon_(polygon), tolerance_m_(tolerance_m) {
    const auto count = static_cast<std::uint32_t>(triangulation.triangles.size());
    origin_.resize(3 * std::size_t{count});
    next_.resize(origin_.size());
    previous_.resize(origin_.size());
    inside_.resize(origin_.size());
    for (std::uint32_t t = 0; t < count; ++t) {
      const auto& triangle = triangulation.triangles[t];
      for (std::uint32_t i = 0; i < 3; ++i) {
        origin_[3 * t + i] = triangle.corner[i];
        next_[3 * t + i] = 3 * t + (i + 1) % 3;
        previous_[3 * t + i] = 3 * t + (i + 2) % 3;
        inside_[3 * t + i] = triangle.winding > 0;
      }
    }
    collect(triangulation);
  }

  /// Removes diagonals, the longest first, while both their ends stay convex.
  /// Each removal only widens angles, so one that is needed once stays needed: a single pass is enough.
  void removeNeedless() {
    for (const auto& [edge, twin] : diagonals_) {
      if (opensReflex(edge, twin) || opensReflex(twin, edge)) continue;
      join(previous_[edge], next_[twin]);
      join(previous_[twin], next_[edge]);
      inside_[edge] = inside_[twin] = false;
    }
  }

  [[nodiscard]] std::vector<Loop> loops() const {
    std::vector<Loop> result;
    std::vector<bool> seen(origin_.size(), false);
    for (std::uint32_t edge = 0; edge < origin_.size(); ++edge) {
      if (!inside_[edge] || seen[edge]) continue;
      Loop loop;
      for (std::uint32_t e = edge; !seen[e]; e = next_[e]) {
        seen[e] = true;
        loop.push_back(origin_[e]);
      }
      result.push_back(std::move(loop));
    }
    return result;
  }

 private:
  void collect(const Triangulation& triangulation) {
    for (std::uint32_t t = 0; t < triangulation.triangles.size(); ++t) {
      const auto& triangle = triangulation.triangles[t];
      for (std::uint32_t i = 0; i < 3; ++i) {
        const std::uint32_t other = triangle.neighbour[i];
        if (triangle.constrained[i] || other == Triangulation::none || other < t || triangle.winding <= 0)
          continue;
        for (std::uint32_t k = 0; k < 3; ++k) {
          if (triangulation.triangles[other].neighbour[k] == t)
            diagonals_.emplace_back(3 * t + i, 3 * other + k);
        }
      }
    }
    const auto ends = [&](std::uint32_t edge) {
      const glm::dvec2 a = polygon_.flat[origin_[edge]];
      const glm::dvec2 b = polygon_.flat[origin_[next_[edge]]];
      const bool swapped = b.x != a.x ? b.x < a.x : b.y < a.y;
      return swapped ? std::pair(b, a) : std::pair(a, b);
    };
    // Lengths in steps of 10 µm: equal diagonals of symmetric shapes are told apart by place, not by
    // rounding.
    const auto length = [&](std::uint32_t edge) {
      const auto [a, b] = ends(edge);
      return std::lround(glm::length(b - a) * 1e5);
    };
    std::sort(diagonals_.begin(), diagonals_.end(), [&](const auto& p, const auto& q) {
      const long longP = length(p.first);
      const long longQ = length(q.first);
      if (longP != longQ) return longP > longQ;
      const auto [a, b] = ends(p.first);
      const auto [c, d] = ends(q.first);
      return std::array{a.x, a.y, b.x, b.y} < std::array{c.x, c.y, d.x, d.y};
    });
  }

  /// Whether removing `edge` leaves a reflex corner at its origin.
  [[nodiscard]] bool opensReflex(std::uint32_t edge, std::uint32_t twin) const {
    const glm::dvec2& before = polygon_.flat[origin_[previous_[edge]]];
    const glm::dvec2& corner = polygon_.flat[origin_[edge]];
    const glm::dvec2& after = polygon_.flat[origin_[next_[next_[twin]]]];
    return convexity_m(before, corner, after) < -0.5 * tolerance_m_;
  }

  void join(std::uint32_t first, std::uint32_t second) {
    next_[first] = second;
    previous_[second] = first;
  }

  const FlatPolygon& polygon_;
  double tolerance_m_;
  std::vector<std::uint32_t> origin_, next_, previous_;
  std::vector<bool> inside_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> diagonals_;
};

std::vector<Loop> mergedTriangles(const FlatPolygon& polygon, const Tolerances& tolerances) {
  std::vector<PlaneEdge> edges;
  for (const Loop& ring : polygon.rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) edges.push_back({ring[i], ring[(i + 1) % ring.size()], 1});
  }
  const Triangulation triangulation = triangulate(polygon.flat, edges);
  Diagonals diagonals(polygon, triangulation, tolerances.collinear_m);
  diagonals.removeNeedless();
  std::vector<Loop> result = diagonals.loops();
  for (Loop& loop : result) {
    for (std::uint32_t& corner : loop) corner = polygon.globals[corner];
  }
  return result;
}

}  // namespace

std::vector<Loop> convexPieces(std::vector<glm::dvec3>& points, const PlanarPolygon& polygon,
                               const Tolerances& tolerances) {
  const glm::dvec3 normal = unitNormal(points, polygon);
  const PlaneFrame frame(normal, points[polygon.outer[0]]);
  const FlatPolygon flat = flatten(points, polygon, frame);
  if (isConvex(flat, tolerances.collinear_m)) return {polygon.outer};

  Raster raster(flat, tolerances.collinear_m);
  std::vector<Loop> result =
      raster ? rectanglePieces(points, flat, raster, frame, tolerances) : mergedTriangles(flat, tolerances);
  if (result.empty() && glm::length(polygon.normal) > 0.0) {
    // A slightly warped outline may cross itself in its mean plane but not in the one it was found in.
    const double sign = glm::dot(polygon.normal, normal) < 0.0 ? -1.0 : 1.0;
    const PlaneFrame other(sign * polygon.normal, points[polygon.outer[0]]);
    result = mergedTriangles(flatten(points, polygon, other), tolerances);
  }
  for (Loop& loop : result) dropCollinearCorners(points, tolerances.collinear_m, loop);
  std::erase_if(result, [&](const Loop& loop) {
    return loop.size() < 3 ||
           glm::length(doubleAreaVector(points, loop)) < 2.0 * tolerances.degenerateArea_m2;
  });
  return result;
}

}  // namespace clerestory
