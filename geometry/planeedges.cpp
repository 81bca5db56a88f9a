// SPDX-License-Identifier: GPL-3.0-or-later
// Points on edges are looked up in sorted lists, crossings by a sweep along x.
#include "planeedges.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "soup.hpp"

namespace clerestory {
namespace {

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

using Cuts = std::vector<std::vector<std::pair<double, std::uint32_t>>>;  // by edge: how far along, where

void cut(const std::vector<glm::dvec2>& points, std::span<const PlaneEdge> edges, std::uint32_t first,
         std::uint32_t second, const std::function<std::uint32_t(const glm::dvec2&)>& pointAt, Cuts& cuts) {
  const PlaneEdge& e = edges[first];
  const PlaneEdge& f = edges[second];
  if (e.from == f.from || e.from == f.to || e.to == f.from || e.to == f.to) return;
  const glm::dvec2 start = points[e.from];
  const glm::dvec2 way = points[e.to] - start;
  const glm::dvec2 otherStart = points[f.from];
  const glm::dvec2 otherWay = points[f.to] - otherStart;
  const double scale = cross2(way, otherWay);
  if (std::abs(scale) < 1e-12) return;
  const double t = cross2(otherStart - start, otherWay) / scale;
  const double s = cross2(otherStart - start, way) / scale;
  if (t <= 0.0 || t >= 1.0 || s <= 0.0 || s >= 1.0) return;
  const std::uint32_t point = pointAt(start + t * way);
  cuts[first].emplace_back(t, point);
  cuts[second].emplace_back(s, point);
}

}  // namespace

std::vector<PlaneEdge> EdgeSum::take() {
  std::sort(edges_.begin(), edges_.end(), [](const PlaneEdge& a, const PlaneEdge& b) {
    return a.from != b.from ? a.from < b.from : a.to < b.to;
  });
  std::vector<PlaneEdge> result;
  for (std::size_t i = 0; i < edges_.size();) {
    PlaneEdge sum = edges_[i];
    bool stays = sum.times == 0;
    for (++i; i < edges_.size() && edges_[i].from == sum.from && edges_[i].to == sum.to; ++i) {
      sum.times += edges_[i].times;
      stays = stays || edges_[i].times == 0;
    }
    if (sum.times > 0 || (stays && sum.times == 0)) result.push_back(sum);
    if (sum.times < 0) result.push_back({sum.to, sum.from, -sum.times});
  }
  edges_.clear();
  return result;
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

std::vector<PlaneEdge> splitAtCrossings(const std::vector<glm::dvec2>& points,
                                        std::span<const PlaneEdge> edges,
                                        const std::function<std::uint32_t(const glm::dvec2&)>& pointAt) {
  Cuts cuts(edges.size());
  std::vector<std::uint32_t> order(edges.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto lowX = [&](std::uint32_t e) { return std::min(points[edges[e].from].x, points[edges[e].to].x); };
  const auto highX = [&](std::uint32_t e) {
    return std::max(points[edges[e].from].x, points[edges[e].to].x);
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return lowX(a) != lowX(b) ? lowX(a) < lowX(b) : a < b; });
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size() && lowX(order[j]) <= highX(order[i]); ++j) {
      cut(points, edges, order[i], order[j], pointAt, cuts);
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

}  // namespace clerestory
