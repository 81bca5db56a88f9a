// SPDX-License-Identifier: GPL-3.0-or-later
// Edges that faces share cancel, and what is left bounds the region. Where that is not one convex ring, a
// constrained triangulation says how often each part is covered: parts that are drawn twice count once, and
// bridges of keyhole polygons vanish by themselves.
#include "outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "planeedges.hpp"

namespace clerestory {
namespace {

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
    return clerestory::splitAtCrossings(flat_, edges, [this](const glm::dvec2& place) {
      return crossingPoint(onGrid(frame_.lift(place), tolerances_.grid_m));
    });
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
