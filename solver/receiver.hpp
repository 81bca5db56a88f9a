// SPDX-License-Identifier: GPL-3.0-or-later
// What receives light in a shooting step: a node of the tree, or an element that was made in this step.
#pragma once

#include <solver/formfactor.hpp>

#include "hierarchy.hpp"

namespace clerestory {

/// Geometry of a receiver, wherever it is stored.
struct Receiver {
  NodeIndex node = noNode;                   ///< of the tree, or …
  std::uint32_t grown = noNode;              ///< … number among those that its task has made in this step
  std::uint32_t treeSide = noNode;           ///< clusters: noNode
  std::span<const glm::vec3> corners;        ///< clusters: low and high of the box
  const Spots* spots = nullptr;              ///< points that stand for it
  const std::uint32_t* spotSides = nullptr;  ///< clusters: the sides that they lie on
  glm::vec3 centre{0.0F}, normal{0.0F};      ///< clusters have no normal
  float radius_m = 0.0F, area_m2 = 0.0F, weight = 0.0F;
  std::uint64_t key = 0;

  [[nodiscard]] bool isCluster() const { return treeSide == noNode; }
};

inline Receiver receiverOf(const Hierarchy& tree, NodeIndex node) {
  const bool isCluster = tree.isCluster(node);
  return {node,
          noNode,
          tree.treeSide[node],
          tree.polygon(node),
          &tree.spots[node],
          isCluster ? tree.spotSides[node].data() : nullptr,
          tree.centre[node],
          isCluster ? glm::vec3(0.0F) : tree.normal(node),
          tree.radius_m[node],
          tree.area_m2[node],
          tree.weight[node],
          tree.key[node]};
}

/// Points that integrate over an element, Gauss-like, towards each of its corners; of many corners, some.
inline constexpr std::size_t quadratureMost = 6;
inline std::size_t quadratureCount(std::span<const glm::vec3> corners) {
  return std::min(corners.size(), quadratureMost);
}
inline glm::vec3 quadraturePoint(std::span<const glm::vec3> corners, const glm::vec3& centre, std::size_t i) {
  const float share = corners.size() == 3 ? 0.5F : 0.57735F;
  const std::size_t corner = corners.size() <= quadratureMost ? i : i * corners.size() / quadratureMost;
  return centre + share * (corners[corner] - centre);
}

/// Such points of an element, and the form factor from each to a planar polygon; 0 from behind its plane.
struct SeenFromPoints {
  std::size_t count;
  std::array<glm::vec3, quadratureMost> points;
  std::array<float, quadratureMost> formFactors;

  SeenFromPoints(const Receiver& receiver, std::span<const glm::vec3> polygon, const glm::vec3& onPlane,
                 const glm::vec3& front)
      : count(quadratureCount(receiver.corners)) {
    for (std::size_t i = 0; i < count; ++i) points[i] = quadraturePoint(receiver.corners, receiver.centre, i);
    pointsToPolygon(std::span(points).first(count), receiver.normal, polygon, formFactors);
    for (std::size_t i = 0; i < count; ++i) {
      if (!(glm::dot(points[i] - onPlane, front) > 0.0F)) formFactors[i] = 0.0F;
    }
  }
};

inline constexpr float cornerRise = 1.7F;  ///< of the whole rise between such points
inline constexpr float touchingApart =
    0.5F;  ///< (radii) / distance above which such points may miss the rise

}  // namespace clerestory
