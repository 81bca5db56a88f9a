// SPDX-License-Identifier: GPL-3.0-or-later
// Cosine rays from all over a receiver, counted where they meet one of the senders asked for.
#include "weak.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

#include <geometry/sampling.hpp>

namespace clerestory {
namespace {

struct Start {
  glm::vec3 point, normal;
};

/// A point of a receiver, even by area for even u, v, w.
Start startOn(const Hierarchy& tree, const Receiver& receiver, float u, float v, float w) {
  if (!receiver.isCluster()) return {pointOnPolygon<glm::vec3>(receiver.corners, v, w), receiver.normal};
  NodeIndex node = receiver.node;
  while (tree.isCluster(node)) {
    const NodeIndex first = tree.firstChild[node];
    const float share = tree.area_m2[first] / tree.area_m2[node];
    const bool isFirst = u < share || share >= 1.0F;
    u = isFirst ? u / share : (u - share) / (1.0F - share);
    node = isFirst ? first : first + 1;
  }
  return {pointOnPolygon<glm::vec3>(tree.polygon(node), v, w), tree.normal(node)};
}

/// The place of a node's first side.
std::uint32_t firstPlace(const Hierarchy& tree, NodeIndex node) {
  return node < tree.trunkSize() ? tree.places[node][0] : tree.placeOfSide[tree.treeSide[node]];
}

/// Senders with the places of their first sides, in the order of these: place in the upper half, node below.
using ByPlace = std::vector<std::uint64_t>;

ByPlace byPlace(const Hierarchy& tree, std::span<const NodeIndex> senders) {
  ByPlace order;
  order.reserve(senders.size());
  for (const NodeIndex sender : senders)
    order.push_back(std::uint64_t{firstPlace(tree, sender)} << 32U | sender);
  if (!std::ranges::is_sorted(order)) std::ranges::sort(order);
  return order;
}

/// The leaf of a side at a point if it is one of the senders or below one, else noNode.
NodeIndex leafOfSenders(const Hierarchy& tree, const ByPlace& senders, std::uint32_t treeSide,
                        const glm::vec3& point) {
  const std::uint32_t place = tree.placeOfSide[treeSide];
  const auto after = std::ranges::lower_bound(senders, (std::uint64_t{place} + 1U) << 32U);
  if (after == senders.begin()) return noNode;
  const auto last = static_cast<NodeIndex>(*(after - 1));
  const NodeIndex root = tree.sides[treeSide].root;
  if (last < tree.trunkSize()) return place < tree.places[last][1] ? tree.leafAt(root, point) : noNode;
  // Elements of one side: the point's way down the tree meets the sender that holds it.
  const std::uint64_t ofPlace = std::uint64_t{place} << 32U;
  const auto before = std::lower_bound(senders.begin(), after, ofPlace);
  NodeIndex node = root;
  while (!std::binary_search(before, after, ofPlace | node)) {
    if (tree.isLeaf(node)) return noNode;
    node = tree.childAt(node, point);
  }
  return tree.leafAt(node, point);
}

}  // namespace

template <int K>
void receiveFromWeak(const World& world, const Hierarchy& tree, const Unshot<K>& unshot,
                     std::span<const std::uint32_t> treeSideOf, const Receiver& receiver,
                     std::span<const NodeIndex> senders, std::uint32_t rays, Incoming<K>& incoming) {
  const ByPlace order = byPlace(tree, senders);
  const Sequence sequence(mixKeys(receiver.key, 0x3ea4));
  const bool hasChildren = receiver.node != noNode && !receiver.isCluster() && !tree.isLeaf(receiver.node);
  std::array<Received<K>, 2> sums;
  std::array<float, 2> counts{};
  for (std::uint32_t i = 0; i < rays; ++i) {
    // Point and way in four dimensions of one sequence: in the same two of two sequences they would go
    // together.
    const auto pick = static_cast<float>(mixKeys(receiver.key, i) >> 40U) * 0x1p-24F;
    const Start start = startOn(tree, receiver, pick, sequence(i, 0), sequence(i, 1));
    const glm::vec3 from = start.point + rayOffset_m * start.normal;
    const glm::vec3 direction = cosineDirection(start.normal, sequence(i, 2), sequence(i, 3));
    const std::size_t child = hasChildren ? tree.whichChild(receiver.node, start.point) : 0;
    counts[child] += 1.0F;
    const auto hit = world.rays.nearest(from, direction, RayScene::Barrier::opaqueAndGlass);
    if (!hit || treeSideOf[hit.side()] == noNode) continue;
    const glm::vec3 to = from + hit.distance_m * direction;
    const NodeIndex leaf = leafOfSenders(tree, order, treeSideOf[hit.side()], to);
    if (leaf == noNode) continue;
    sums[child] += world.innerTransmittance(from, to) * Received<K>{unshot.radiosity_lm_m2[leaf], 1.0F};
  }
  if (hasChildren && counts[0] > 0.0F && counts[1] > 0.0F) {
    for (std::size_t child = 0; child < 2; ++child)
      incoming.ofChildren[child] += (1.0F / counts[child]) * sums[child];
  } else {
    sums[0] += sums[1];
    incoming.own += (1.0F / static_cast<float>(rays)) * sums[0];
  }
}

#define CLERESTORY_INSTANTIATE(K)                                                    \
  template void receiveFromWeak<K>(const World&, const Hierarchy&, const Unshot<K>&, \
                                   std::span<const std::uint32_t>, const Receiver&,  \
                                   std::span<const NodeIndex>, std::uint32_t, Incoming<K>&);
CLERESTORY_TRANSPORT_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
