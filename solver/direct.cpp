// SPDX-License-Identifier: GPL-3.0-or-later
// Exact form factors of luminous polygons, times the mean of what is seen of them by even solid angle.
#include "direct.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <geometry/sampling.hpp>
#include <solver/formfactor.hpp>

#include "hiding.hpp"

namespace clerestory {
namespace {

constexpr float samplesLeast = 2.0F;   // of a polygon
constexpr float lampRaysLeast = 8.0F;  // of a luminaire
constexpr float stripsOfSky = 0.1F;    // share of a pane that may show sky where samples have met none

}  // namespace

template <int K>
PolygonLight<K>::PolygonLight(const ColumnLayout& layout, const glm::vec3& receiver, const glm::vec3& normal,
                              std::span<const glm::vec3> polygon, std::uint64_t key, Luminance<K> luminance,
                              float exitance_lm_m2)
    : layout_(layout),
      receiver_(receiver),
      normal_(normal),
      seen_(receiver, normal, polygon),
      formFactor_(seen_.solidAngle_sr() > 0.0 ? pointToPolygon(receiver, normal, polygon) : 0.0F),
      polygonNormal_(
          glm::normalize(glm::cross(polygon[1] - polygon[0], polygon[polygon.size() - 1] - polygon[0]))),
      height_m_(glm::dot(polygon[0] - receiver, polygonNormal_)),
      sequence_(key),
      luminance_(std::move(luminance)),
      exitance_lm_m2_(exitance_lm_m2) {}

template <int K>
void PolygonLight<K>::sampleTo(std::uint32_t count) {
  if (formFactor_ <= 0.0F) return;
  for (std::uint32_t i = size(); i < count; ++i) {
    const float u = sequence_(i, 0);
    const float v = sequence_(i, 1);
    const glm::vec3 direction = seen_.direction(u, v);
    const float approach = glm::dot(direction, polygonNormal_);
    const float weight = glm::dot(direction, normal_);
    if (approach * height_m_ <= 0.0F || weight <= 0.0F) {
      samples_.add(u, v, 0.0F, {}, 0.0F);
      continue;
    }
    const Columns<K> light = luminance_(receiver_ + (height_m_ / approach) * direction);
    samples_.add(u, v, weight, light, layout_.strength(light));
  }
  const float scale = std::numbers::pi_v<float> * formFactor_;
  light_ = {scale * samples_.mean(), scale * std::sqrt(samples_.variance()), size()};
}

template <int K>
std::vector<PolygonLight<K>> portalsAt(const SolvedLight<K>& light, std::int32_t domain,
                                       const glm::vec3& receiver, const glm::vec3& normal,
                                       std::uint64_t key) {
  const World& world = light.world();
  std::vector<PolygonLight<K>> polygons;
  for (const Portal& portal : world.building.portals) {
    if (portal.inside != domain) continue;
    const glm::vec3 inward = world.normalOf(2 * portal.piece + (portal.frontIsInside ? 0U : 1U));
    const auto polygon = world.polygon(portal.piece);
    if (glm::dot(receiver - polygon[0], inward) <= 0.0F) continue;
    if (isBehindOnePiece(world, receiver, polygon)) continue;
    // What a pane shows by the strips of sky between blades, which few samples may all have missed.
    const glm::vec3 outward = glm::normalize(polygon[0] - receiver);
    const float open_lm_m2 =
        stripsOfSky * std::numbers::pi_v<float> *
        world.glassOf(portal.piece).transmittance(std::abs(glm::dot(outward, inward))) *
        world.layout.strength(light.skyLuminance(glm::vec3(outward.x, outward.y, std::abs(outward.z))));
    polygons.emplace_back(
        world.layout, receiver, normal, polygon, mixKeys(key, portal.piece),
        [&light, &portal, receiver](const glm::vec3& p) { return light.throughPortal(portal, receiver, p); },
        open_lm_m2);
    if (polygons.back().formFactor() <= 0.0F) polygons.pop_back();
  }
  return polygons;
}

template <int K>
std::vector<PolygonLight<K>> emittersAt(const SolvedLight<K>& light, std::int32_t domain,
                                        const glm::vec3& receiver, const glm::vec3& normal,
                                        std::uint64_t key) {
  const World& world = light.world();
  const Radiosity<K>* radiosity = light.of(domain);
  std::vector<PolygonLight<K>> polygons;
  if (radiosity == nullptr || !world.layout.electric) return polygons;
  for (const std::uint32_t i : radiosity->emitters) {
    const TreeSide& side = radiosity->tree.sides[i];
    const auto polygon = world.polygon(side.side / 2);
    if (glm::dot(receiver - polygon[0], side.normal) <= 0.0F) continue;
    const Columns<K> luminance = std::numbers::inv_pi_v<float> * radiosity->exitance_lm_m2[i];
    polygons.emplace_back(world.layout, receiver, normal, polygon, mixKeys(key, side.side),
                          [&world, luminance, receiver](const glm::vec3& p) {
                            return world.visibility(receiver, p) * luminance;
                          });
    if (polygons.back().formFactor() <= 0.0F) polygons.pop_back();
  }
  return polygons;
}

template <int K>
std::vector<PolygonLight<K>> brightPartsAt(const SolvedLight<K>& light, std::int32_t domain,
                                           const glm::vec3& receiver, const glm::vec3& normal,
                                           std::uint64_t key) {
  const World& world = light.world();
  const Radiosity<K>* radiosity = light.of(domain);
  std::vector<PolygonLight<K>> polygons;
  if (radiosity == nullptr) return polygons;
  const Hierarchy& tree = radiosity->tree;
  for (const auto& [part, exitance_lm_m2] : radiosity->brightParts) {
    const std::uint32_t side = tree.sides[tree.treeSide[part]].side;
    if (glm::dot(receiver - tree.centre[part], tree.normal(part)) <= 0.0F) continue;
    polygons.emplace_back(
        world.layout, receiver, normal, tree.polygon(part), mixKeys(key, tree.key[part]),
        [&light, &world, side, receiver](const glm::vec3& onPart) -> Columns<K> {
          const auto hit = world.rays.nearest(receiver, glm::normalize(onPart - receiver),
                                              RayScene::Barrier::opaqueAndGlass);
          if (!hit || hit.side() != side) return {};
          return (world.innerTransmittance(receiver, onPart) * std::numbers::inv_pi_v<float>)*light.exitance(
              hit, onPart, false);
        },
        exitance_lm_m2);
    if (polygons.back().formFactor() <= 0.0F) polygons.pop_back();
  }
  return polygons;
}

template <int K>
DirectLight<K> lightOf(std::span<PolygonLight<K>> polygons, DirectSamples samples) {
  float all = 0.0F;
  for (const PolygonLight<K>& polygon : polygons) all += polygon.formFactor();
  DirectLight<K> sum;
  for (PolygonLight<K>& polygon : polygons) {
    const float own = polygon.formFactor();
    const float count = samples.perFormFactor * own + samples.least * own / all;
    polygon.sampleTo(static_cast<std::uint32_t>(std::ceil(std::max(count, samplesLeast))));
    sum += polygon.light();
  }
  return sum;
}

template <int K>
DirectLight<K> directFromLamps(const World& world, std::int32_t domain, const glm::vec3& receiver,
                               const glm::vec3& normal, DirectSamples samples, std::uint64_t key) {
  DirectLight<K> result;
  std::vector<float> unhidden_lx(world.lamps.size(), 0.0F);
  float all_lx = 0.0F;
  for (std::size_t i = 0; i < world.lamps.size(); ++i) {
    if (world.lamps[i].domain() == domain) unhidden_lx[i] = world.lamps[i].illuminance_lx(receiver, normal);
    all_lx += unhidden_lx[i];
  }
  float variance = 0.0F;
  for (std::size_t i = 0; i < world.lamps.size(); ++i) {
    if (unhidden_lx[i] <= 0.0F) continue;
    const Lamp& lamp = world.lamps[i];
    const float rays = std::max(samples.least * unhidden_lx[i] / all_lx, lampRaysLeast);
    const auto count = lamp.radius_m() > 0.0F ? static_cast<std::uint32_t>(std::ceil(rays)) : 1U;
    const Sequence sequence(mixKeys(key, i));
    float weights = 0.0F;
    float visible = 0.0F;
    for (std::uint32_t r = 0; r < count; ++r) {
      const Lamp::Ray ray = lamp.ray(receiver, normal, sequence(r, 0), sequence(r, 1));
      if (ray.weight <= 0.0F) continue;
      weights += ray.weight;
      visible += ray.weight * world.visibility(receiver, ray.from);
      ++result.rays;
    }
    const float visibility = weights > 0.0F ? visible / weights : 0.0F;
    result.illuminance_lx += world.layout.template light<K>(
        world.layout.electricColumn(), static_cast<double>(visibility * unhidden_lx[i]) * lamp.color());
    // Even points miss the area beyond an edge by less than random ones: n^(-3/4) in two dimensions.
    const float deviation = unhidden_lx[i] * std::sqrt(visibility * std::max(1.0F - visibility, 0.0F)) /
                            std::pow(static_cast<float>(count), 0.75F);
    variance += deviation * deviation;
  }
  result.deviation_lx = std::sqrt(variance);
  return result;
}

#define CLERESTORY_INSTANTIATE(K)                                                                            \
  template class PolygonLight<K>;                                                                            \
  template std::vector<PolygonLight<K>> portalsAt<K>(const SolvedLight<K>&, std::int32_t, const glm::vec3&,  \
                                                     const glm::vec3&, std::uint64_t);                       \
  template std::vector<PolygonLight<K>> emittersAt<K>(const SolvedLight<K>&, std::int32_t, const glm::vec3&, \
                                                      const glm::vec3&, std::uint64_t);                      \
  template std::vector<PolygonLight<K>> brightPartsAt<K>(const SolvedLight<K>&, std::int32_t,                \
                                                         const glm::vec3&, const glm::vec3&, std::uint64_t); \
  template DirectLight<K> lightOf<K>(std::span<PolygonLight<K>>, DirectSamples);                             \
  template DirectLight<K> directFromLamps<K>(const World&, std::int32_t, const glm::vec3&, const glm::vec3&, \
                                             DirectSamples, std::uint64_t);
CLERESTORY_TRANSPORT_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
