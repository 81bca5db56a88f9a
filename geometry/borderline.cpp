// SPDX-License-Identifier: GPL-3.0-or-later
// A walk from end to end; then corners are left out that the straight way passes within a cell or so.
//
// D. Douglas, T. Peucker: Algorithms for the reduction of the number of points required to represent a
// digitized line, 1973.
#include "borderline.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace clerestory {
namespace {

using Node = std::array<long, 2>;

double distanceToWay(const glm::dvec2& point, const glm::dvec2& from, const glm::dvec2& to) {
  const glm::dvec2 way = to - from;
  const double share =
      std::clamp(glm::dot(point - from, way) / std::max(glm::dot(way, way), 1e-18), 0.0, 1.0);
  return glm::length(point - from - share * way);
}

/// Adds what stays of the points after `first` up to `last`.
void addCorners(std::span<const glm::dvec2> points, std::size_t first, std::size_t last, double off_m,
                std::vector<glm::dvec2>& line) {
  std::size_t farthest = first;
  double most_m = off_m;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double distance_m = distanceToWay(points[i], points[first], points[last]);
    if (distance_m <= most_m) continue;
    most_m = distance_m;
    farthest = i;
  }
  if (farthest == first) {
    line.push_back(points[last]);
    return;
  }
  addCorners(points, first, farthest, off_m, line);
  addCorners(points, farthest, last, off_m, line);
}

}  // namespace

std::vector<glm::dvec2> lineAlong(std::span<const std::array<glm::dvec2, 2>> edges, double cell_m) {
  constexpr double stepsOfCell = 10.0;
  constexpr double offInCells = 1.2;
  const auto nodeOf = [&](const glm::dvec2& place) {
    return Node{std::lround(stepsOfCell * place.x / cell_m), std::lround(stepsOfCell * place.y / cell_m)};
  };
  std::map<Node, std::vector<glm::dvec2>> leaving;
  for (const auto& [from, to] : edges) {
    leaving[nodeOf(from)].push_back(to);
    leaving[nodeOf(to)].push_back(from);
  }
  std::vector<glm::dvec2> longest;
  for (const auto& [start, ways] : leaving) {
    if (ways.size() != 1) continue;
    auto left = leaving;
    std::vector<glm::dvec2> way;
    for (Node at = start; !left[at].empty();) {
      const glm::dvec2 next = left[at].back();
      left[at].pop_back();
      auto& back = left[nodeOf(next)];
      const auto same = std::ranges::find_if(back, [&](const glm::dvec2& p) { return nodeOf(p) == at; });
      if (way.empty() && same != back.end()) way.push_back(*same);
      if (same != back.end()) back.erase(same);
      way.push_back(next);
      at = nodeOf(next);
    }
    if (way.size() > longest.size()) longest = std::move(way);
  }
  if (longest.empty()) return {};
  std::vector<glm::dvec2> line{longest.front()};
  addCorners(longest, 0, longest.size() - 1, offInCells * cell_m, line);
  return line;
}

}  // namespace clerestory
