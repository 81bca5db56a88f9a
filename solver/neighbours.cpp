// SPDX-License-Identifier: GPL-3.0-or-later
// Finds neighbours by looking the tree up at points just across an element's edges.
#include "neighbours.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace clerestory {
namespace {

constexpr float above_m = 0.01F;        // height over the surface at which neighbours see each other
constexpr float alikeInSize = 1.1F;     // a neighbour's radius, of the element's own
constexpr float across = 1e-3F;         // how far across an edge is looked, of the radius …
constexpr float acrossLeast_m = 1e-4F;  // … but at least

/// Whether a convex polygon holds a point of its plane.
bool holds(std::span<const glm::vec3> polygon, const glm::vec3& normal, const glm::vec3& point) {
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    if (glm::dot(glm::cross(polygon[i] - polygon[j], point - polygon[j]), normal) < 0.0F) return false;
  }
  return true;
}

}  // namespace

Neighbours::Neighbours(const World& world, const Hierarchy& tree)
    : world_(world), tree_(tree), firstContinuing_(tree.sides.size() + 1, 0) {
  // Sides that look the same way from parts of one polygon stand together.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
  for (std::uint32_t i = 0; i < tree.sides.size(); ++i) {
    const std::uint32_t side = tree.sides[i].side;
    order.emplace_back(2 * world.pieces().polygon[side / 2] + side % 2, i);
  }
  std::sort(order.begin(), order.end());
  const auto touch = [&](NodeIndex a, NodeIndex b) {
    return glm::length(tree.centre[a] - tree.centre[b]) <=
           tree.radius_m[a] + tree.radius_m[b] + acrossLeast_m;
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size() && order[j].first == order[i].first; ++j) {
      const std::uint32_t a = order[i].second;
      const std::uint32_t b = order[j].second;
      if (!touch(tree.sides[a].root, tree.sides[b].root)) continue;
      pairs.emplace_back(a, b);
      pairs.emplace_back(b, a);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [side, other] : pairs) {
    ++firstContinuing_[side + 1];
    continuing_.push_back(other);
  }
  std::partial_sum(firstContinuing_.begin(), firstContinuing_.end(), firstContinuing_.begin());
}

// The node that holds a point in the plane of a side, on that side or on one that continues it; of those
// about it the first that is small enough.
NodeIndex Neighbours::nodeAt(std::uint32_t treeSide, const glm::vec3& point, float radius_m) const {
  const auto isOn = [&](std::uint32_t side) {
    return holds(tree_.polygon(tree_.sides[side].root), tree_.sides[side].normal, point);
  };
  NodeIndex node = noNode;
  if (isOn(treeSide)) {
    node = tree_.sides[treeSide].root;
  } else {
    const auto others = continuing(treeSide);
    const auto found = std::find_if(others.begin(), others.end(), isOn);
    if (found == others.end()) return noNode;
    node = tree_.sides[*found].root;
  }
  while (!tree_.isLeaf(node) && tree_.radius_m[node] > radius_m) node = tree_.childAt(node, point);
  return node;
}

bool Neighbours::areParted(NodeIndex a, NodeIndex b) const {
  return world_.rays.occluded(tree_.centre[a] + above_m * tree_.normal(a),
                              tree_.centre[b] + above_m * tree_.normal(b), RayScene::Barrier::opaqueAndGlass);
}

Beside Neighbours::of(NodeIndex element) const {
  Beside beside;
  const auto polygon = tree_.polygon(element);
  const float radius_m = tree_.radius_m[element];
  const float step_m = std::max(across * radius_m, acrossLeast_m);
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const glm::vec3 edge = polygon[i] - polygon[j];
    const float length_m = glm::length(edge);
    if (length_m < acrossLeast_m) continue;
    const glm::vec3 outward = (step_m / length_m) * glm::cross(edge, tree_.normal(element));
    for (const float place : {0.25F, 0.75F}) {
      const glm::vec3 point = polygon[j] + place * edge + outward;
      const NodeIndex node = nodeAt(tree_.treeSide[element], point, alikeInSize * radius_m);
      const auto known = beside.all();
      if (node == element || std::find(known.begin(), known.end(), node) != known.end()) continue;
      if (node == noNode || areParted(element, node)) {
        if (i < beside.endsAt.size()) beside.endsAt.set(i);
      } else if (beside.count < beside.nodes.size()) {
        beside.nodes[beside.count++] = node;
      }
    }
  }
  return beside;
}

}  // namespace clerestory
