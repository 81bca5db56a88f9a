// SPDX-License-Identifier: GPL-3.0-or-later
// Looks light up along rays.
#include "radiosity.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace clerestory {

template <int K>
void SolvedLight<K>::add(std::int32_t domain, Radiosity<K> radiosity) {
  for (const TreeSide& side : radiosity.tree.sides) rootOfSide_[side.side] = side.root;
  domains_[static_cast<std::size_t>(domain)] = std::move(radiosity);
}

template <int K>
Columns<K> SolvedLight<K>::exitance(const RayScene::Hit& hit, const glm::vec3& point,
                                    bool withEmission) const {
  const std::uint32_t side = hit.side();
  if (rootOfSide_[side] == noNode) return {};
  const Radiosity<K>& own = *of(world_.building.sideDomain[side]);
  const NodeIndex leaf = own.tree.leafAt(rootOfSide_[side], point);
  const std::uint32_t treeSide = own.tree.treeSide[leaf];
  Columns<K> irradiance_lx = own.irradianceAt(leaf, point);
  if (!own.sunlight.empty() && own.sunlight.mayReach[leaf] != 0) {
    const glm::vec3& normal = own.tree.normal(leaf);
    irradiance_lx += world_.layout.template light<K>(
        world_.layout.sunColumn(), glm::dvec3(sunlightAt(world_, point + rayOffset_m * normal, normal)));
  }
  Columns<K> result = own.reflectance[treeSide] * irradiance_lx;
  if (withEmission) result += own.exitance_lm_m2[treeSide];
  return result;
}

template <int K>
Columns<K> SolvedLight<K>::skyLuminance(const glm::vec3& direction) const {
  Columns<K> luminance = world_.layout.template light<K>(
      world_.layout.skyColumn(), glm::dvec3(static_cast<double>(world_.sky.luminance_cd_m2(direction))));
  if (world_.sun && direction.z < 0.0F) {
    luminance +=
        world_.layout.template light<K>(world_.layout.sunColumn(), glm::dvec3(world_.sun->ground_cd_m2));
  }
  return luminance;
}

template <int K>
Columns<K> SolvedLight<K>::outsideLuminance(const glm::vec3& from, const glm::vec3& direction) const {
  const glm::vec3 start = from + rayOffset_m * direction;
  const auto hit = world_.rays.nearest(start, direction, RayScene::Barrier::opaqueAndGlass);
  if (!hit) return skyLuminance(direction);
  return std::numbers::inv_pi_v<float> * exitance(hit, start + hit.distance_m * direction, true);
}

template <int K>
Columns<K> SolvedLight<K>::throughPortal(const Portal& portal, const glm::vec3& receiver,
                                         const glm::vec3& onPane) const {
  if (world_.rays.occluded(receiver, onPane, RayScene::Barrier::opaque)) return {};
  return behindPortal(portal, receiver, onPane);
}

template <int K>
Columns<K> SolvedLight<K>::behindPortal(const Portal& portal, const glm::vec3& receiver,
                                        const glm::vec3& onPane) const {
  const glm::vec3 direction = glm::normalize(onPane - receiver);
  const float cosine = std::abs(glm::dot(direction, world_.normalOf(2 * portal.piece)));
  const float transmittance = world_.portalFactor() * world_.glassOf(portal.piece).transmittance(cosine) *
                              world_.innerTransmittance(receiver, onPane);
  return transmittance * (world_.layout.template property<K>(world_.tintOf(portal.piece)) *
                          outsideLuminance(onPane, direction));
}

#define CLERESTORY_INSTANTIATE(K) template class SolvedLight<K>;
CLERESTORY_TRANSPORT_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
