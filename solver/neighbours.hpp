// SPDX-License-Identifier: GPL-3.0-or-later
// What lies beside a node on the same surface: nodes of like size across its edges, on its own side or on a
// coplanar one that continues it.
#pragma once

#include <array>
#include <bitset>
#include <span>
#include <vector>

#include "hierarchy.hpp"
#include "world.hpp"

namespace clerestory {

/// What lies beside an element.
struct Beside {
  std::array<NodeIndex, 16> nodes;
  std::size_t count = 0;
  std::bitset<64> endsAt;  ///< edges (the i-th ends at corner i) where its surface ends or something stands

  [[nodiscard]] std::span<const NodeIndex> all() const { return std::span(nodes).first(count); }
  /// Whether the surface ends at a corner, too.
  [[nodiscard]] bool endsAtCorner(std::size_t corner, std::size_t corners) const {
    const std::size_t next = (corner + 1) % corners;
    return (corner < endsAt.size() && endsAt[corner]) || (next < endsAt.size() && endsAt[next]);
  }
};

/// Finds what lies beside the nodes of a tree, while the tree does not grow.
class Neighbours {
 public:
  /// Parts of one planar polygon continue each other where they touch.
  Neighbours(const World& world, const Hierarchy& tree);

  /// Nodes across the edges of an element, no larger than it but for leaves.
  [[nodiscard]] Beside of(NodeIndex element) const;

  /// Whether something stands on a surface between the centroids of two elements of it.
  [[nodiscard]] bool areParted(NodeIndex a, NodeIndex b) const;

 private:
  [[nodiscard]] NodeIndex nodeAt(std::uint32_t treeSide, const glm::vec3& point, float radius_m) const;
  [[nodiscard]] std::span<const std::uint32_t> continuing(std::uint32_t treeSide) const {
    return std::span(continuing_)
        .subspan(firstContinuing_[treeSide], firstContinuing_[treeSide + 1] - firstContinuing_[treeSide]);
  }
  const World& world_;
  const Hierarchy& tree_;
  std::vector<std::uint32_t> firstContinuing_, continuing_;  // by side, the sides that continue it
};

}  // namespace clerestory
