// SPDX-License-Identifier: GPL-3.0-or-later
// Follows rays over panes to what these mirror.
#include "mirrored.hpp"

#include <glm/geometric.hpp>

#include <cmath>

#include <geometry/sampling.hpp>

namespace clerestory {
namespace {

struct Ray {
  glm::vec3 from, direction;
};

/// What a surface sends along a ray, if that is met over at least one pane. [lm/m²]
template <int K>
Columns<K> overPanes(const World& world, const Hierarchy& tree, const Unshot<K>& unshot,
                     std::span<const std::uint32_t> treeSideOf, Ray ray) {
  float share = 1.0F;
  for (int panes = 0; panes <= mirrorDepth; ++panes) {
    const auto hit = world.rays.nearest(ray.from, ray.direction, RayScene::Barrier::opaqueAndGlass);
    if (!hit || treeSideOf[hit.side()] == noNode) return {};
    const glm::vec3 point = ray.from + hit.distance_m * ray.direction;
    share *= world.innerTransmittance(ray.from, point);
    if (!world.isMirror(hit.piece)) {
      if (panes == 0) return {};
      const NodeIndex root = tree.sides[treeSideOf[hit.side()]].root;
      return share * unshot.radiosity_lm_m2[tree.leafAt(root, point)];
    }
    const glm::vec3 normal = world.normalOf(hit.side());
    share *= world.glassOf(hit.piece).reflectance(std::abs(glm::dot(ray.direction, normal)));
    ray = {point + rayOffset_m * normal, glm::reflect(ray.direction, normal)};
  }
  return {};
}

}  // namespace

template <int K>
void receiveMirrored(const World& world, const Hierarchy& tree, const Unshot<K>& unshot,
                     std::span<const std::uint32_t> treeSideOf, const Receiver& receiver, std::uint32_t rays,
                     Columns<K>& incoming_lx) {
  const Sequence sequence(mixKeys(receiver.key, 0x3177));
  Columns<K> sum;
  for (std::uint32_t i = 0; i < rays; ++i) {
    const glm::vec3 point = pointOnPolygon<glm::vec3>(receiver.corners, sequence(i, 0), sequence(i, 1));
    const Ray ray{point + rayOffset_m * receiver.normal,
                  cosineDirection(receiver.normal, sequence(i, 2), sequence(i, 3))};
    sum += overPanes(world, tree, unshot, treeSideOf, ray);
  }
  incoming_lx += (1.0F / static_cast<float>(rays)) * sum;
}

#define CLERESTORY_INSTANTIATE(K)                                                                  \
  template void receiveMirrored<K>(const World&, const Hierarchy&, const Unshot<K>&,               \
                                   std::span<const std::uint32_t>, const Receiver&, std::uint32_t, \
                                   Columns<K>&);
CLERESTORY_TRANSPORT_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
