// SPDX-License-Identifier: GPL-3.0-or-later
// Coplanar neighbours of one object and material become maximal planar polygons with holes.
//
// Faces are gathered by plane, their shared edges cancel, and what is left bounds the region. Where the
// outline is not one convex ring, a constrained triangulation says how often each part is covered: parts that
// are drawn twice count once, and bridges of keyhole polygons vanish by themselves.
#include "merge.hpp"

#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "triangulate.hpp"

namespace clerestory {
namespace {

struct Face {
  std::uint32_t index;
  glm::dvec3 normal;  ///< unit, drawn
  glm::dvec3 middle;
  double area_m2;
  double thickness_m;
};

struct Cluster {
  std::uint32_t seed;  ///< the largest face, as place in the list of faces
  std::uint32_t parent;
  glm::dvec3 low{1e300}, high{-1e300};
};

Face describe(const Soup& soup, std::uint32_t index) {
  const auto corners = soup.faces[index];
  const glm::dvec3 vector = doubleAreaVector(soup.points, corners);
  Face face{index, glm::normalize(vector), glm::dvec3(0.0), 0.5 * glm::length(vector), 0.0};
  double longest_m = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    face.middle += soup.points[corners[i]] / static_cast<double>(corners.size());
    longest_m = std::max(
        longest_m, glm::length(soup.points[corners[(i + 1) % corners.size()]] - soup.points[corners[i]]));
  }
  face.thickness_m = 2.0 * face.area_m2 / longest_m;
  return face;
}

/// Gathers the faces of one object and material by plane: a face joins the plane of a larger one that it
/// touches.
class PlaneClusters {
 public:
  PlaneClusters(const Soup& soup, const Tolerances& tolerances)
      : soup_(soup), tolerances_(tolerances), atPoint_(soup.points.size()) {}

  /// `faces` by falling area. Returns the groups, each by falling area.
  std::vector<std::vector<std::uint32_t>> gather(std::span<const Face> faces) {
    clusters_.clear();
    std::vector<std::uint32_t> clusterOf(faces.size());
    for (std::uint32_t i = 0; i < faces.size(); ++i) clusterOf[i] = assign(faces, i);
    for (const Face& face : faces) {
      for (const std::uint32_t corner : soup_.faces[face.index]) atPoint_[corner].clear();
    }
    joinOverlapping(faces, clusterOf);
    std::map<std::uint32_t, std::vector<std::uint32_t>> groups;
    for (std::uint32_t i = 0; i < faces.size(); ++i) groups[find(clusterOf[i])].push_back(i);
    std::vector<std::vector<std::uint32_t>> result;
    for (auto& [root, members] : groups) result.push_back(std::move(members));
    return result;
  }

 private:
  std::uint32_t find(std::uint32_t cluster) {
    while (clusters_[cluster].parent != cluster) {
      cluster = clusters_[cluster].parent = clusters_[clusters_[cluster].parent].parent;
    }
    return cluster;
  }

  [[nodiscard]] bool fits(const Face& face, const Face& seed) const {
    // Thin faces have uncertain normals; faces that the weld has bent are taken for the planes they were.
    const double thickness_m = std::max(face.thickness_m, 1e-9);
    double angle_rad = std::min(0.5, tolerances_.coplanarAngle_rad + 4.0 * tolerances_.grid_m / thickness_m);
    double height_m = tolerances_.coplanar_m;
    if (soup_.displaced[face.index] || soup_.displaced[seed.index]) {
      angle_rad = std::max(angle_rad,
                           std::min(tolerances_.displacedAngle_rad, 4.0 * tolerances_.weld_m / thickness_m));
      height_m = 2.0 * tolerances_.weld_m;
    }
    if (glm::length(glm::cross(face.normal, seed.normal)) > angle_rad) return false;
    return std::ranges::all_of(soup_.faces[face.index], [&](std::uint32_t corner) {
      return std::abs(glm::dot(soup_.points[corner] - seed.middle, seed.normal)) <= height_m;
    });
  }

  std::uint32_t assign(std::span<const Face> faces, std::uint32_t i) {
    const auto corners = soup_.faces[faces[i].index];
    std::vector<std::uint32_t> candidates;
    for (const std::uint32_t corner : corners) {
      for (const std::uint32_t cluster : atPoint_[corner]) candidates.push_back(find(cluster));
    }
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());

    std::uint32_t own = none;
    for (const std::uint32_t cluster : candidates) {  // by falling area of the seeds
      if (!fits(faces[i], faces[clusters_[cluster].seed])) continue;
      if (own == none) {
        own = cluster;
      } else if (fits(faces[clusters_[cluster].seed], faces[clusters_[own].seed])) {
        clusters_[cluster].parent = own;
      }
    }
    if (own == none) {
      own = static_cast<std::uint32_t>(clusters_.size());
      clusters_.push_back({.seed = i, .parent = own});
    }
    for (const std::uint32_t corner : corners) {
      auto& list = atPoint_[corner];
      if (std::find(list.begin(), list.end(), own) == list.end()) list.push_back(own);
    }
    return own;
  }

  /// Joins clusters of one plane that share no corner but whose boxes meet: their edges may.
  void joinOverlapping(std::span<const Face> faces, std::span<const std::uint32_t> clusterOf) {
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
      Cluster& cluster = clusters_[find(clusterOf[i])];
      for (const std::uint32_t corner : soup_.faces[faces[i].index]) {
        cluster.low = glm::min(cluster.low, soup_.points[corner] - tolerances_.coplanar_m);
        cluster.high = glm::max(cluster.high, soup_.points[corner] + tolerances_.coplanar_m);
      }
    }
    glm::dvec3 low(1e300);
    glm::dvec3 high(-1e300);
    for (const Cluster& cluster : clusters_) {
      low = glm::min(low, cluster.low);
      high = glm::max(high, cluster.high);
    }
    const glm::dvec3 centre = 0.5 * (low + high);
    const double offsetSlack_m = 2.0 * tolerances_.coplanar_m + normalSlack * glm::length(high - low);
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> byPlane;
    for (std::uint32_t c = 0; c < clusters_.size(); ++c) {
      if (find(c) != c) continue;
      const Face& seed = faces[clusters_[c].seed];
      for (const double sign : {1.0, -1.0}) {
        const glm::dvec3 normal = sign * seed.normal;
        const glm::dvec4 plane(normal / normalSlack, glm::dot(normal, seed.middle - centre) / offsetSlack_m);
        forCellsAround(plane, [&](std::uint64_t cell) {
          const auto found = byPlane.find(cell);
          if (found != byPlane.end()) joinWith(faces, c, found->second);
        });
      }
      const glm::dvec4 plane(seed.normal / normalSlack,
                             glm::dot(seed.normal, seed.middle - centre) / offsetSlack_m);
      byPlane[cellKey(glm::floor(plane / cellWidth))].push_back(c);
    }
  }

  // Planes are looked up in cells that are wide against the slack, so that mostly one cell is looked at.
  static constexpr double normalSlack = 2.5e-3;
  static constexpr double cellWidth = 20.0;  ///< in units of the slack

  /// Planes that fall together by chance are told apart by their boxes and `fits`.
  static std::uint64_t cellKey(const glm::dvec4& cell) {
    std::uint64_t key = 0;
    for (int i = 0; i < 4; ++i) {
      key = (key + static_cast<std::uint64_t>(static_cast<std::int64_t>(cell[i]))) * 0x9e3779b97f4a7c15U;
      key ^= key >> 29U;
    }
    return key;
  }

  template <class Visit>
  static void forCellsAround(const glm::dvec4& plane, Visit visit) {
    const glm::dvec4 low = glm::floor((plane - 1.0) / cellWidth);
    const glm::dvec4 high = glm::floor((plane + 1.0) / cellWidth);
    for (double x = low.x; x <= high.x; ++x) {
      for (double y = low.y; y <= high.y; ++y) {
        for (double z = low.z; z <= high.z; ++z) {
          for (double w = low.w; w <= high.w; ++w) visit(cellKey({x, y, z, w}));
        }
      }
    }
  }

  void joinWith(std::span<const Face> faces, std::uint32_t cluster, std::span<const std::uint32_t> others) {
    const Face& seed = faces[clusters_[cluster].seed];
    for (const std::uint32_t other : others) {
      const Cluster& a = clusters_[cluster];
      const Cluster& b = clusters_[other];
      if (a.low.x > b.high.x || a.low.y > b.high.y || a.low.z > b.high.z || b.low.x > a.high.x ||
          b.low.y > a.high.y || b.low.z > a.high.z || !fits(seed, faces[b.seed])) {
        continue;
      }
      const std::uint32_t first = std::min(find(cluster), find(other));  // the one of the larger seed
      clusters_[std::max(find(cluster), find(other))].parent = first;
    }
  }

  static constexpr std::uint32_t none = 0xffffffffU;
  const Soup& soup_;
  const Tolerances& tolerances_;
  std::vector<std::vector<std::uint32_t>> atPoint_;
  std::vector<Cluster> clusters_;
};

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

struct FlatRing {
  Loop loop;
  std::vector<glm::dvec2> flat;
  double area_m2;
  glm::dvec2 low, high;
};

FlatRing flatten(const Soup& soup, const PlaneFrame& frame, Loop loop) {
  FlatRing ring{std::move(loop), {}, 0.0, glm::dvec2(1e300), glm::dvec2(-1e300)};
  for (const std::uint32_t corner : ring.loop) {
    ring.flat.push_back(frame.project(soup.points[corner]));
    ring.low = glm::min(ring.low, ring.flat.back());
    ring.high = glm::max(ring.high, ring.flat.back());
  }
  for (std::size_t i = 2; i < ring.flat.size(); ++i) {
    ring.area_m2 += 0.5 * cross2(ring.flat[i - 1] - ring.flat[0], ring.flat[i] - ring.flat[0]);
  }
  return ring;
}

bool holds(const FlatRing& ring, const glm::dvec2& point) {
  if (point.x < ring.low.x || point.y < ring.low.y || point.x > ring.high.x || point.y > ring.high.y)
    return false;
  bool inside = false;
  for (std::size_t i = 0, j = ring.flat.size() - 1; i < ring.flat.size(); j = i++) {
    const glm::dvec2& a = ring.flat[i];
    const glm::dvec2& b = ring.flat[j];
    if ((a.y > point.y) != (b.y > point.y) && point.x < (b.x - a.x) * (point.y - a.y) / (b.y - a.y) + a.x) {
      inside = !inside;
    }
  }
  return inside;
}

/// Gives each hole to the smallest outer ring around it.
std::vector<PlanarPolygon> nest(std::vector<FlatRing> rings) {
  std::vector<PlanarPolygon> result;
  std::vector<const FlatRing*> outers;
  for (FlatRing& ring : rings) {
    if (ring.area_m2 <= 0.0) continue;
    outers.push_back(&ring);
    result.push_back({.outer = ring.loop});
  }
  for (FlatRing& ring : rings) {
    if (ring.area_m2 > 0.0) continue;
    std::size_t best = outers.size();
    const glm::dvec2 sample = 0.5 * (ring.flat[0] + ring.flat[1]);
    for (std::size_t i = 0; i < outers.size(); ++i) {
      if (outers[i]->area_m2 > -ring.area_m2 && holds(*outers[i], sample) &&
          (best == outers.size() || outers[i]->area_m2 < outers[best]->area_m2)) {
        best = i;
      }
    }
    if (best < outers.size()) result[best].holes.push_back(std::move(ring.loop));
  }
  return result;
}

struct MergeCounts {
  std::size_t overlapping = 0, unmerged = 0;
};

/// Corners where rings touch: each of these rings needs its own.
Loop sharedCorners(const std::vector<Loop>& rings) {
  Loop all;
  for (const Loop& ring : rings) all.insert(all.end(), ring.begin(), ring.end());
  std::sort(all.begin(), all.end());
  Loop shared;
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (all[i] == all[i - 1]) shared.push_back(all[i]);
  }
  return shared;
}

/// Winds each polygon as most of the area of the faces at its corners is drawn.
void windAsDrawn(const Soup& soup, std::span<const Face> faces, std::span<const std::uint32_t> members,
                 const glm::dvec3& normal, std::vector<PlanarPolygon>& polygons) {
  std::unordered_map<std::uint32_t, double> drawnAlong_m2;  // by corner
  for (const std::uint32_t member : members) {
    const Face& face = faces[member];
    for (const std::uint32_t corner : soup.faces[face.index]) {
      drawnAlong_m2[corner] += face.area_m2 * (glm::dot(face.normal, normal) > 0.0 ? 1.0 : -1.0);
    }
  }
  for (PlanarPolygon& polygon : polygons) {
    double vote_m2 = 0.0;
    for (const std::uint32_t corner : polygon.outer) vote_m2 += drawnAlong_m2[corner];
    if (vote_m2 >= 0.0) continue;
    std::reverse(polygon.outer.begin(), polygon.outer.end());
    for (Loop& hole : polygon.holes) std::reverse(hole.begin(), hole.end());
  }
}

/// Turns one cluster into polygons.
void mergeCluster(Soup& soup, const Tolerances& tolerances, std::span<const Face> faces,
                  std::span<const std::uint32_t> members, std::vector<PlanarPolygon>& result,
                  MergeCounts& counts) {
  const Face& seed = faces[members[0]];
  const glm::dvec3 normal = seed.normal * canonicalSign(seed.normal);
  const PlaneFrame frame(normal, seed.middle);
  Region region(soup, tolerances, frame);
  for (const std::uint32_t member : members) region.addFace(soup.faces[faces[member].index]);
  std::vector<Loop> rings;
  bool overlaps = false;
  std::vector<PlanarPolygon> polygons;
  if (region.outline(rings, overlaps)) {
    const Loop shared = sharedCorners(rings);
    std::vector<FlatRing> flat;
    for (Loop& ring : rings) {
      dropCollinearCorners(soup.points, tolerances.collinear_m, ring, shared);
      if (ring.size() >= 3) flat.push_back(flatten(soup, frame, std::move(ring)));
    }
    polygons = nest(std::move(flat));
    counts.overlapping += overlaps ? 1 : 0;
    windAsDrawn(soup, faces, members, normal, polygons);
  } else {
    counts.unmerged += members.size();
    for (const std::uint32_t member : members) {
      const auto corners = soup.faces[faces[member].index];
      polygons.push_back({.outer = Loop(corners.begin(), corners.end())});
    }
  }
  for (PlanarPolygon& polygon : polygons) {
    polygon.material = soup.material[seed.index];
    polygon.object = soup.object[seed.index];
    polygon.mergedAlong = normal;
    result.push_back(std::move(polygon));
  }
}

}  // namespace

void dropCollinearCorners(std::span<const glm::dvec3> points, double tolerance_m, Loop& loop,
                          std::span<const std::uint32_t> needed) {
  for (bool changed = true; changed && loop.size() >= 3;) {
    startAtSmallest(points, loop);
    Loop kept{loop[0]};
    for (std::size_t i = 1; i < loop.size(); ++i) {
      const glm::dvec3& before = points[kept.back()];
      const glm::dvec3 way = points[loop[(i + 1) % loop.size()]] - before;
      const glm::dvec3 offset = points[loop[i]] - before;
      const double length = glm::length(way);
      const double along = glm::dot(offset, way);
      const bool onLine = along > 0.0 && along < length * length &&
                          glm::length(glm::cross(offset, way)) <= tolerance_m * length;
      if (!onLine || std::binary_search(needed.begin(), needed.end(), loop[i])) kept.push_back(loop[i]);
    }
    changed = kept.size() != loop.size();
    loop = std::move(kept);
  }
}

std::vector<PlanarPolygon> mergeCoplanar(Soup& soup, const Tolerances& tolerances,
                                         std::vector<Diagnosis>& diagnoses) {
  std::vector<Face> faces;
  for (std::uint32_t i = 0; i < soup.faces.size(); ++i) faces.push_back(describe(soup, i));
  const auto less = [&](const Face& a, const Face& b) {
    if (soup.object[a.index] != soup.object[b.index]) return soup.object[a.index] < soup.object[b.index];
    if (soup.material[a.index] != soup.material[b.index])
      return soup.material[a.index] < soup.material[b.index];
    if (a.area_m2 != b.area_m2) return a.area_m2 > b.area_m2;
    const auto p = soup.faces[a.index];
    const auto q = soup.faces[b.index];
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  std::sort(faces.begin(), faces.end(), less);

  PlaneClusters clusters(soup, tolerances);
  std::vector<PlanarPolygon> result;
  MergeCounts counts;
  for (std::size_t first = 0; first < faces.size();) {
    std::size_t end = first;
    while (end < faces.size() && soup.object[faces[end].index] == soup.object[faces[first].index] &&
           soup.material[faces[end].index] == soup.material[faces[first].index]) {
      ++end;
    }
    const std::span<const Face> group(faces.begin() + static_cast<std::ptrdiff_t>(first), end - first);
    for (const auto& members : clusters.gather(group)) {
      mergeCluster(soup, tolerances, group, members, result, counts);
    }
    first = end;
  }
  if (counts.overlapping > 0) {
    diagnoses.push_back(
        {"G204", "surfaces whose faces overlap in one plane; each part counts once", "", counts.overlapping});
  }
  if (counts.unmerged > 0) {
    diagnoses.push_back({"G205", "faces that cross in one plane were left as drawn", "", counts.unmerged});
  }
  return result;
}

}  // namespace clerestory
