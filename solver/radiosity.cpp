// SPDX-License-Identifier: GPL-3.0-or-later
// Looks light up along rays.
#include "radiosity.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

#include <geometry/sampling.hpp>

namespace clerestory {

template <int K>
void SolvedLight<K>::add(std::int32_t domain, Radiosity<K> radiosity) {
  for (const TreeSide& side : radiosity.tree.sides) rootOfSide_[side.side] = side.root;
  showsGaps_ = showsGaps_ || radiosity.tree.isOverGap(0);
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
    if (world_.building.domains[static_cast<std::size_t>(world_.building.sideDomain[side])].open) {
      irradiance_lx += world_.layout.template light<K>(
          world_.layout.sunColumn(),
          glm::dvec3(mirroredSunlightAt(world_, point + rayOffset_m * normal, normal)));
    }
  }
  Columns<K> result = own.reflectance[treeSide] * irradiance_lx;
  if (withEmission) result += own.exitance_lm_m2[treeSide];
  return result;
}

template <int K>
bool SolvedLight<K>::isInBrightPart(const RayScene::Hit& hit, const glm::vec3& point) const {
  if (!isSolved(hit)) return false;
  const Radiosity<K>& own = *of(world_.building.sideDomain[hit.side()]);
  return !own.isInBrightPart.empty() &&
         own.isInBrightPart[own.tree.leafAt(rootOfSide_[hit.side()], point)] != 0;
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
  return alongOutdoors(start, direction, outdoors(start, direction), true);
}

// A sill before a pane sees the pane at a grazing angle, and in it the sky: 13 % of its light.
template <int K>
Columns<K> SolvedLight<K>::alongOutdoors(glm::vec3 from, glm::vec3 direction, RayScene::Hit hit,
                                         bool withSurfaces) const {
  float weight = 1.0F;
  for (int depth = 0; depth < mirrorDepth; ++depth) {
    const glm::vec3 point = from + (hit ? hit.distance_m : 1e4F) * direction;
    weight *= world_.innerTransmittance(from, point);
    if (!hit) return weight * skyLuminance(direction);
    if (!world_.isMirror(hit.piece)) {
      if (!withSurfaces) return {};
      return (weight * std::numbers::inv_pi_v<float>)*exitance(hit, point, true);
    }
    const glm::vec3 normal = world_.normalOf(hit.side());
    weight *= world_.glassOf(hit.piece).reflectance(std::abs(glm::dot(direction, normal)));
    direction = glm::reflect(direction, normal);
    from = point + rayOffset_m * normal;
    hit = outdoors(from, direction);
  }
  return {};
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
  return world_.innerTransmittance(receiver, onPane) * paneLuminance(portal.piece, onPane, direction);
}

template <int K>
void SolvedLight<K>::behindPortals(const glm::vec3& receiver, std::span<const PanePoint> points,
                                   std::span<Columns<K>> seen) const {
  std::vector<RayScene::Ray> rays;
  rays.reserve(points.size());
  for (const PanePoint& point : points) {
    const glm::vec3 direction = glm::normalize(point.place - receiver);
    rays.push_back({point.place + rayOffset_m * direction, direction});
  }
  std::vector<RayScene::Hit> hits(rays.size());
  world_.rays.nearest(rays, RayScene::Barrier::opaqueAndGlass, hits);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [from, direction] = rays[i];
    const std::uint32_t piece = points[i].portal->piece;
    seen[i] = world_.innerTransmittance(receiver, points[i].place) *
              (world_.materialOf(piece).diffusing
                   ? diffused_cd_m2_[piece]
                   : throughGlass(piece, direction, alongOutdoors(from, direction, hits[i], true)));
  }
}

template <int K>
Columns<K> SolvedLight<K>::paneLuminance(std::uint32_t piece, const glm::vec3& onPane,
                                         const glm::vec3& direction) const {
  if (world_.materialOf(piece).diffusing) return diffused_cd_m2_[piece];
  return throughGlass(piece, direction, outsideLuminance(onPane, direction));
}

template <int K>
Columns<K> SolvedLight<K>::throughGlass(std::uint32_t piece, const glm::vec3& direction,
                                        const Columns<K>& outside_cd_m2) const {
  const float cosine = std::abs(glm::dot(direction, world_.normalOf(2 * piece)));
  return world_.glassOf(piece).transmittance(cosine) * (paneFactor_[piece] * outside_cd_m2);
}

// What passes is scattered evenly over directions and over the pane: a mean over both.
template <int K>
void SolvedLight<K>::lightDiffusingPanes() {
  constexpr std::uint32_t rays = 4096;
  for (const Portal& portal : world_.building.portals) {
    if (!world_.materialOf(portal.piece).diffusing) continue;
    const Glass& glass = world_.glassOf(portal.piece);
    const glm::vec3 outward = world_.normalOf(2 * portal.piece + (portal.frontIsInside ? 1U : 0U));
    const Sequence sequence(mixKeys(0xd1f, portal.piece));
    Columns<K> sum;
    for (std::uint32_t i = 0; i < rays; ++i) {
      const glm::vec3 onPane =
          pointOnPolygon<glm::vec3>(world_.polygon(portal.piece), sequence(i, 0), sequence(i, 1));
      const glm::vec3 direction = cosineDirection(outward, sequence(i, 2), sequence(i, 3));
      sum += glass.transmittance(glm::dot(direction, outward)) * outsideLuminance(onPane, direction);
      if (!world_.sun) continue;
      const glm::vec3 beam_lx = sunlightAt(world_, onPane + rayOffset_m * outward, outward);
      sum += std::numbers::inv_pi_v<float> * glass.transmittance(glm::dot(world_.sun->towards, outward)) *
             world_.layout.template light<K>(world_.layout.sunColumn(), glm::dvec3(beam_lx));
    }
    diffused_cd_m2_[portal.piece] = world_.portalFactor(portal.piece) / static_cast<float>(rays) *
                                    (world_.layout.template property<K>(world_.tintOf(portal.piece)) * sum);
  }
}

#define CLERESTORY_INSTANTIATE(K) template class SolvedLight<K>;
CLERESTORY_TRANSPORT_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
