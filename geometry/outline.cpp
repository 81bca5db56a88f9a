// SPDX-License-Identifier: GPL-3.0-or-later
// Edges that faces share cancel, and what is left bounds the region. Where that is not one convex ring, a
// constrained triangulation says how often each part is covered: parts that are drawn twice count once, and
// bridges of keyhole polygons vanish by themselves.
#include "outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "triangulate.hpp"

namespace clerestory {
namespace {

/// Directed edges in a plane; opposite ones cancel.
class EdgeSum {
 public:
  void add(std::uint32_t from, std::uint32_t to, int times) {
    if (from < to) edges_.push_back({from, to, times});
    if (from > to) edges_.push_back({to, from, -times});
  }

  /// What is left, each with positive `times`, by rising indices.
  std::vector<PlaneEdge> take() {
    std::sort(edges_.begin(), edges_.end(), [](const PlaneEdge& a, const PlaneEdge& b) {
      return a.from != b.from ? a.from < b.from : a.to < b.to;
    });
    std::vector<PlaneEdge> result;
    for (std::size_t i = 0; i < edges_.size();) {
      PlaneEdge sum = edges_[i];
      for (++i; i < edges_.size() && edges_[i].from == sum.from && edges_[i].to == sum.to; ++i) {
        sum.times += edges_[i].times;
      }
      if (sum.times > 0) result.push_back(sum);
      if (sum.times < 0) result.push_back({sum.to, sum.from, -sum.times});
    }
    edges_.clear();
    return result;
  }

 private:
  std::vector<PlaneEdge> edges_;
};

/// A plane's points for looking up which lie near a segment.
class FlatPoints {
 public:
  FlatPoints(std::span<const glm::dvec2> flat, std::vector<std::uint32_t> members)
      : flat_(flat), members_(std::move(members)) {
    std::sort(members_.begin(), members_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return flat_[a].x != flat_[b].x ? flat_[a].x < flat_[b].x : flat_[a].y < flat_[b].y;
    });
    for (const std::uint32_t member : members_) x_.push_back(flat_[member].x);
    // Upright edges meet every point above the same x in the sorted list: keep a second list by y for them.
    byY_ = members_;
    std::sort(byY_.begin(), byY_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return flat_[a].y != flat_[b].y ? flat_[a].y < flat_[b].y : flat_[a].x < flat_[b].x;
    });
    for (const std::uint32_t member : byY_) y_.push_back(flat_[member].y);
  }

  /// Points strictly inside the segment from a to b, in its order.
  [[nodiscard]] std::vector<std::uint32_t> on(std::uint32_t a, std::uint32_t b, double tolerance_m) const {
    const glm::dvec2 way = flat_[b] - flat_[a];
    const double length = glm::length(way);
    std::vector<std::pair<double, std::uint32_t>> found;
    const auto look = [&](const std::vector<std::uint32_t>& list, const std::vector<double>& place,
                          double low, double high) {
      const auto begin = std::lower_bound(place.begin(), place.end(), low - tolerance_m) - place.begin();
      const auto end = std::upper_bound(place.begin(), place.end(), high + tolerance_m) - place.begin();
      for (auto i = begin; i < end; ++i) {
        const std::uint32_t point = list[static_cast<std::size_t>(i)];
        if (point == a || point == b) continue;
        const glm::dvec2 offset = flat_[point] - flat_[a];
        const double along = glm::dot(offset, way) / length;
        if (along <= 0.0 || along >= length || std::abs(cross2(offset, way)) > tolerance_m * length) continue;
        found.emplace_back(along, point);
      }
    };
    const auto range = [](double p, double q) { return std::pair(std::min(p, q), std::max(p, q)); };
    const auto [lowX, highX] = range(flat_[a].x, flat_[b].x);
    const auto [lowY, highY] = range(flat_[a].y, flat_[b].y);
    if (highX - lowX <= highY - lowY) {
      look(members_, x_, lowX, highX);
    } else {
      look(byY_, y_, lowY, highY);
    }
    std::sort(found.begin(), found.end());
    std::vector<std::uint32_t> result;
    for (const auto& [along, point] : found) result.push_back(point);
    return result;
  }

 private:
  std::span<const glm::dvec2> flat_;
  std::vector<std::uint32_t> members_, byY_;
  std::vector<double> x_, y_;
};

std::vector<std::uint32_t> endsOf(std::span<const PlaneEdge> edges) {
  std::vector<std::uint32_t> ends;
  for (const PlaneEdge& edge : edges) {
    ends.push_back(edge.from);
    ends.push_back(edge.to);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

/// Divides edges at the ends of others that lie on them, so that neighbours with T-junctions cancel too.
std::vector<PlaneEdge> splitAtPoints(std::span<const glm::dvec2> flat, std::span<const PlaneEdge> edges,
                                     double tolerance_m) {
  const FlatPoints points(flat, endsOf(edges));
  EdgeSum sum;
  for (const PlaneEdge& edge : edges) {
    std::uint32_t last = edge.from;
    for (const std::uint32_t point : points.on(edge.from, edge.to, tolerance_m)) {
      sum.add(last, point, edge.times);
      last = point;
    }
    sum.add(last, edge.to, edge.times);
  }
  return sum.take();
}

/// One cluster on its way to polygons. Local indices are places in `globals`.
class Region {
 public:
  Region(Soup& soup, const Tolerances& tolerances, const PlaneFrame& frame)
      : soup_(soup), tolerances_(tolerances), frame_(frame) {}

  void addFace(std::span<const std::uint32_t> corners) {
    double area = 0.0;
    Loop loop;
    for (const std::uint32_t corner : corners) loop.push_back(local(corner));
    if (visitsTwice(loop) && addByParity(loop)) return;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      area += cross2(flat_[loop[i]] - flat_[loop[0]], flat_[loop[(i + 1) % loop.size()]] - flat_[loop[0]]);
    }
    if (area < 0.0) std::reverse(loop.begin(), loop.end());
    for (std::size_t i = 0; i < loop.size(); ++i) edges_.add(loop[i], loop[(i + 1) % loop.size()], 1);
  }

  /// Rings of the region (indices of the soup's points), the region on their left; false where it fails.
  bool outline(std::vector<Loop>& rings, bool& overlaps) {
    std::vector<PlaneEdge> edges = splitAtPoints(flat_, edges_.take(), tolerances_.collinear_m);
    rings = trace(edges);
    if (rings.size() == 1 && isConvex(rings[0])) {
      toGlobal(rings);
      return true;
    }
    Triangulation triangulation = triangulate(flat_, edges);
    for (int attempt = 0; triangulation.crossing && attempt < 3; ++attempt) {
      edges = splitAtCrossings(edges);  // adds points, so that flat_ moves
      edges = splitAtPoints(flat_, edges, tolerances_.collinear_m);
      triangulation = triangulate(flat_, edges);
    }
    if (triangulation.crossing) return false;
    EdgeSum covered;
    for (const auto& triangle : triangulation.triangles) {
      if (triangle.winding == 0) continue;
      overlaps = overlaps || std::abs(triangle.winding) > 1;
      for (std::size_t i = 0; i < 3; ++i) covered.add(triangle.corner[i], triangle.corner[(i + 1) % 3], 1);
    }
    rings = trace(covered.take());
    toGlobal(rings);
    return true;
  }

  [[nodiscard]] bool isConvex(const Loop& ring) const {
    double turning = 0.0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const glm::dvec2& before = flat_[ring[(i + ring.size() - 1) % ring.size()]];
      const glm::dvec2& corner = flat_[ring[i]];
      const glm::dvec2& after = flat_[ring[(i + 1) % ring.size()]];
      if (convexity_m(before, corner, after) < -tolerances_.collinear_m) return false;
      turning +=
          std::atan2(cross2(corner - before, after - corner), glm::dot(corner - before, after - corner));
    }
    return turning > 0.0 && turning < 3.0 * std::numbers::pi;
  }

 private:
  static bool visitsTwice(Loop loop) {
    std::sort(loop.begin(), loop.end());
    return std::adjacent_find(loop.begin(), loop.end()) != loop.end();
  }

  /// Adds a keyhole polygon: what its outline goes round twice is a hole, whichever way that is wound.
  bool addByParity(const Loop& loop) {
    EdgeSum own;
    for (std::size_t i = 0; i < loop.size(); ++i) own.add(loop[i], loop[(i + 1) % loop.size()], 1);
    const Triangulation triangulation =
        triangulate(flat_, splitAtPoints(flat_, own.take(), tolerances_.collinear_m));
    if (triangulation.triangles.empty()) return false;
    for (const auto& triangle : triangulation.triangles) {
      if (triangle.winding % 2 == 0) continue;
      for (std::size_t i = 0; i < 3; ++i) own.add(triangle.corner[i], triangle.corner[(i + 1) % 3], 1);
    }
    for (const PlaneEdge& edge : own.take()) edges_.add(edge.from, edge.to, edge.times);
    return true;
  }

  std::uint32_t local(std::uint32_t global) {
    const auto [found, isNew] = localOf_.try_emplace(global, static_cast<std::uint32_t>(globals_.size()));
    if (isNew) {
      globals_.push_back(global);
      flat_.push_back(frame_.project(soup_.points[global]));
    }
    return found->second;
  }

  void toGlobal(std::vector<Loop>& rings) const {
    for (Loop& ring : rings) {
      for (std::uint32_t& corner : ring) corner = globals_[corner];
    }
  }

  /// Follows the edges with the region on the left; where rings touch, parts that only touch come apart.
  [[nodiscard]] std::vector<Loop> trace(std::span<const PlaneEdge> edges) const {
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> leaving;
    for (const PlaneEdge& edge : edges) {
      for (int i = 0; i < edge.times; ++i) leaving[edge.from].push_back(edge.to);
    }
    std::vector<Loop> rings;
    for (const PlaneEdge& edge : edges) {
      for (;;) {
        Loop ring = follow(leaving, edge.from);
        if (ring.size() < 3) break;
        splitAtRepeats(std::move(ring), rings);
      }
    }
    return rings;
  }

  Loop follow(std::unordered_map<std::uint32_t, std::vector<std::uint32_t>>& leaving,
              std::uint32_t start) const {
    Loop ring;
    std::uint32_t at = start;
    do {
      auto& choices = leaving[at];
      if (choices.empty()) return {};
      std::size_t best = 0;
      if (choices.size() > 1 && !ring.empty()) {
        double bestAngle = 1e300;
        const glm::dvec2 back = flat_[ring.back()] - flat_[at];
        for (std::size_t i = 0; i < choices.size(); ++i) {
          const glm::dvec2 out = flat_[choices[i]] - flat_[at];
          double clockwise = std::atan2(-cross2(back, out), glm::dot(back, out));
          if (clockwise <= 0.0) clockwise += 2.0 * std::numbers::pi;
          if (clockwise < bestAngle) {
            bestAngle = clockwise;
            best = i;
          }
        }
      }
      ring.push_back(at);
      at = choices[best];
      choices.erase(choices.begin() + static_cast<std::ptrdiff_t>(best));
    } while (at != start);
    return ring;
  }

  /// A ring that visits a point twice is two rings that touch.
  static void splitAtRepeats(Loop ring, std::vector<Loop>& rings) {
    std::unordered_map<std::uint32_t, std::size_t> placeOf;
    Loop open;
    for (const std::uint32_t corner : ring) {
      const auto found = placeOf.find(corner);
      if (found != placeOf.end()) {
        const std::size_t place = found->second;
        Loop loop(open.begin() + static_cast<std::ptrdiff_t>(place), open.end());
        for (const std::uint32_t closed : loop) placeOf.erase(closed);
        open.resize(place);
        if (loop.size() >= 3) rings.push_back(std::move(loop));
      }
      placeOf[corner] = open.size();
      open.push_back(corner);
    }
    if (open.size() >= 3) rings.push_back(std::move(open));
  }

  /// Divides edges where they cross; new points go to the soup.
  std::vector<PlaneEdge> splitAtCrossings(std::span<const PlaneEdge> edges) {
    std::vector<std::vector<std::pair<double, std::uint32_t>>> cuts(edges.size());
    std::vector<std::uint32_t> order(edges.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto lowX = [&](std::uint32_t e) { return std::min(flat_[edges[e].from].x, flat_[edges[e].to].x); };
    const auto highX = [&](std::uint32_t e) {
      return std::max(flat_[edges[e].from].x, flat_[edges[e].to].x);
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return lowX(a) != lowX(b) ? lowX(a) < lowX(b) : a < b;
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (std::size_t j = i + 1; j < order.size() && lowX(order[j]) <= highX(order[i]); ++j) {
        cut(edges, order[i], order[j], cuts);
      }
    }
    EdgeSum sum;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      std::sort(cuts[e].begin(), cuts[e].end());
      std::uint32_t last = edges[e].from;
      for (const auto& [along, point] : cuts[e]) {
        sum.add(last, point, edges[e].times);
        last = point;
      }
      sum.add(last, edges[e].to, edges[e].times);
    }
    return sum.take();
  }

  void cut(std::span<const PlaneEdge> edges, std::uint32_t first, std::uint32_t second,
           std::vector<std::vector<std::pair<double, std::uint32_t>>>& cuts) {
    const PlaneEdge& e = edges[first];
    const PlaneEdge& f = edges[second];
    if (e.from == f.from || e.from == f.to || e.to == f.from || e.to == f.to) return;
    const glm::dvec2 start = flat_[e.from];
    const glm::dvec2 way = flat_[e.to] - start;
    const glm::dvec2 otherStart = flat_[f.from];
    const glm::dvec2 otherWay = flat_[f.to] - otherStart;
    const double scale = cross2(way, otherWay);
    if (std::abs(scale) < 1e-12) return;
    const double t = cross2(otherStart - start, otherWay) / scale;
    const double s = cross2(otherStart - start, way) / scale;
    if (t <= 0.0 || t >= 1.0 || s <= 0.0 || s >= 1.0) return;
    const glm::dvec3 position = onGrid(frame_.lift(start + t * way), tolerances_.grid_m);
    const std::uint32_t point = crossingPoint(position);
    cuts[first].emplace_back(t, point);
    cuts[second].emplace_back(s, point);
  }

  /// The region's point at `position`, or a new one.
  std::uint32_t crossingPoint(const glm::dvec3& position) {
    for (std::uint32_t i = 0; i < globals_.size(); ++i) {
      if (glm::length(soup_.points[globals_[i]] - position) <= tolerances_.collinear_m) return i;
    }
    soup_.points.push_back(position);
    return local(static_cast<std::uint32_t>(soup_.points.size() - 1));
  }

  Soup& soup_;
  const Tolerances& tolerances_;
  PlaneFrame frame_;
  std::vector<std::uint32_t> globals_;
  std::vector<glm::dvec2> flat_;
  std::unordered_map<std::uint32_t, std::uint32_t> localOf_;
  EdgeSum edges_;
};

}  // namespace

std::optional<Outline> outlineOf(Soup& soup, const Tolerances& tolerances, const PlaneFrame& frame,
                                 std::span<const Face> faces) {
  Region region(soup, tolerances, frame);
  for (const Face& face : faces) region.addFace(soup.faces[face.index]);
  Outline outline;
  if (!region.outline(outline.rings, outline.overlaps)) return std::nullopt;
  return outline;
}

}  // namespace clerestory
