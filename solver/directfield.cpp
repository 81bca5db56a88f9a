// SPDX-License-Identifier: GPL-3.0-or-later
// Rays to points on luminous polygons, all of one receiver's in packets.
#include "directfield.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <geometry/sampling.hpp>
#include <solver/formfactor.hpp>

namespace clerestory {
namespace {

constexpr std::uint32_t raysOfPortal = 256;  // for its mean luminance
constexpr float raysLeast = 2.0F;            // of a polygon
constexpr int roundsMost = 3;                // of twice as many
constexpr float missedBetween = 0.5F;        // samples: of one sample's share of a pane's mean light
constexpr float grainLeast = 2.0F;           // times the mean of a pane's rays
constexpr float nearFormFactor = 0.08F;      // above it a polygon's points are chosen by solid angle

/// Mean luminance that a portal shows inside, by cosine over its area.
template <int K>
Columns<K> meanLuminance(const SolvedLight<K>& light, const Portal& portal, const glm::vec3& inward) {
  const Sequence sequence(mixKeys(0xf10d, portal.piece));
  Columns<K> sum;
  for (std::uint32_t i = 0; i < raysOfPortal; ++i) {
    const glm::vec3 point =
        pointOnPolygon<glm::vec3>(light.world().polygon(portal.piece), sequence(i, 0), sequence(i, 1));
    const glm::vec3 direction = cosineDirection(-inward, sequence(i, 2), sequence(i, 3));
    sum += light.behindPortal(portal, point - 1e-3F * direction, point);
  }
  return (1.0F / static_cast<float>(raysOfPortal)) * sum;
}

/// Mean luminance of a bright part. [cd/m²]
template <int K>
Columns<K> meanLuminance(const SolvedLight<K>& light, std::uint32_t side, std::span<const glm::vec3> polygon,
                         std::uint64_t key) {
  constexpr std::uint32_t points = 64;
  const Sequence sequence(key);
  const RayScene::Hit hit{side / 2, 0.0F, side % 2 == 0};
  Columns<K> sum;
  for (std::uint32_t i = 0; i < points; ++i)
    sum += light.exitance(hit, pointOnPolygon<glm::vec3>(polygon, sequence(i, 0), sequence(i, 1)), false);
  return (std::numbers::inv_pi_v<float> / static_cast<float>(points)) * sum;
}

bool isParallelogram(std::span<const glm::vec3> polygon) {
  if (polygon.size() != 4) return false;
  const glm::vec3 side = polygon[1] - polygon[0];
  const glm::vec3 rise = polygon[3] - polygon[0];
  return glm::distance(polygon[2], polygon[1] + rise) < 1e-3F * glm::length(side + rise);
}

/// A point of the convex `polygon`, uniform by area for uniform u, v in [0, 1). In a parallelogram u and v
/// run along its sides, so that points are even along each by itself: of a strip along a side, as the sky
/// between an overhang and a sill, n of them are off by about 1/n, and not by the n^(-3/4) of a fan of
/// triangles.
glm::vec3 pointOf(std::span<const glm::vec3> polygon, bool isParallelogram, float u, float v) {
  if (isParallelogram) return polygon[0] + u * (polygon[1] - polygon[0]) + v * (polygon[3] - polygon[0]);
  return pointOnPolygon<glm::vec3>(polygon, u, v);
}

}  // namespace

template <int K>
DirectField<K>::DirectField(const SolvedLight<K>& light, std::int32_t domain)
    : light_(light), world_(light.world()), domain_(domain) {
  const auto add = [&](Shiner shiner) {
    shiner.isParallelogram = isParallelogram(shiner.polygon);
    shiner.strength = world_.layout.strength(shiner.luminance_cd_m2);
    if (shiner.strength > 0.0F) shiners_.push_back(shiner);
  };
  for (const Portal& portal : world_.building.portals) {
    if (portal.inside != domain) continue;
    const std::uint32_t side = 2 * portal.piece + (portal.frontIsInside ? 0U : 1U);
    const glm::vec3 inward = world_.normalOf(side);
    add({world_.polygon(portal.piece), false, inward, side, &portal, false, mixKeys(0xd1f, side),
         meanLuminance(light, portal, inward), 0.0F});
  }
  const Radiosity<K>* radiosity = light.of(domain);
  if (radiosity == nullptr) return;
  const Hierarchy& tree = radiosity->tree;
  for (const std::uint32_t i : radiosity->emitters) {
    const std::uint32_t side = tree.sides[i].side;
    add({world_.polygon(side / 2), false, tree.sides[i].normal, side, nullptr, false, mixKeys(0xd1f, side),
         std::numbers::inv_pi_v<float> * radiosity->exitance_lm_m2[i], 0.0F});
  }
  for (const BrightPart& part : radiosity->brightParts) {
    const std::uint32_t side = tree.sides[tree.treeSide[part.node]].side;
    const std::uint64_t key = mixKeys(0xd20, tree.key[part.node]);
    add({tree.polygon(part.node), false, tree.normal(part.node), side, nullptr, true, key,
         meanLuminance(light, side, tree.polygon(part.node), key), 0.0F});
  }
}

template <int K>
std::vector<typename DirectField<K>::Part> DirectField<K>::partsOf(std::span<const float> formFactors) const {
  std::vector<Part> parts;
  parts.reserve(shiners_.size());
  for (std::size_t i = 0; i < shiners_.size(); ++i) {
    if (formFactors[i] > 0.0F) parts.push_back({&shiners_[i], formFactors[i], 0, {}, 0.0F, 0.0F, 0.0F});
  }
  return parts;
}

template <int K>
Columns<K> DirectField<K>::unhidden(const glm::vec3& point, const glm::vec3& normal,
                                    std::span<float> formFactors) const {
  Columns<K> sum_lx;
  for (std::size_t i = 0; i < shiners_.size(); ++i) {
    const Shiner& shiner = shiners_[i];
    const bool mayShine = glm::dot(point - shiner.polygon[0], shiner.inward) > 0.0F;
    formFactors[i] = mayShine ? pointToPolygon(point, normal, shiner.polygon) : 0.0F;
    if (formFactors[i] > 0.0F) sum_lx += std::numbers::pi_v<float> * formFactors[i] * shiner.luminance_cd_m2;
  }
  for (const Lamp& lamp : world_.lamps) {
    if (lamp.domain() != domain_) continue;
    sum_lx += world_.layout.template light<K>(
        world_.layout.electricColumn(),
        static_cast<double>(lamp.illuminance_lx(point, normal)) * lamp.color());
  }
  return sum_lx;
}

// Points are even over the polygon's area and weighed by what it sends from there to the receiver, so an
// unhidden even polygon comes out exact; where one is so near that few points would weigh most, they are even
// by solid angle instead.
template <int K>
void DirectField<K>::sample(std::vector<Part>& parts, std::span<const std::uint32_t> counts,
                            const glm::vec3& point, const glm::vec3& normal, std::uint64_t key) const {
  Probes toPortals;
  Probes toEmitters;
  Probes toBrightParts;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    Part& part = parts[p];
    if (counts[p] <= part.rays) continue;
    const Shiner& shiner = *part.shiner;
    Probes& probes = shiner.portal != nullptr ? toPortals : shiner.isBrightPart ? toBrightParts : toEmitters;
    const Sequence sequence(mixKeys(key, shiner.key));
    const float height_m = glm::dot(shiner.polygon[0] - point, shiner.inward);
    std::optional<SphericalPolygon> seen;
    if (part.formFactor > nearFormFactor) {
      seen.emplace(point, normal, shiner.polygon);
      if (!(seen->solidAngle_sr() > 0.0)) seen.reset();
    }
    for (std::uint32_t i = part.rays; i < counts[p]; ++i) {
      glm::vec3 onPolygon;
      float weight = 0.0F;
      if (seen) {
        const glm::vec3 direction = seen->direction(sequence(i, 0), sequence(i, 1));
        const float approach = glm::dot(direction, shiner.inward);
        weight = approach < 0.0F ? glm::dot(direction, normal) : 0.0F;
        onPolygon = point + (height_m / approach) * direction;
      } else {
        onPolygon = pointOf(shiner.polygon, shiner.isParallelogram, sequence(i, 0), sequence(i, 1));
        const glm::vec3 way = onPolygon - point;
        const float square = glm::dot(way, way);
        weight = -glm::dot(way, normal) * glm::dot(way, shiner.inward) / (square * square);
      }
      if (!(weight > 0.0F)) continue;
      part.weights += weight;
      probes.part.push_back(p);
      probes.weight.push_back(weight);
      probes.ray.push_back({point, onPolygon});
    }
    part.rays = counts[p];
  }
  const auto add = [&](const Probes& probes, std::size_t i, const Columns<K>& luminance) {
    Part& part = parts[probes.part[i]];
    const float weight = probes.weight[i];
    const float strength = world_.layout.strength(luminance);
    part.sum += weight * luminance;
    part.strengths += weight * strength;
    part.squares += weight * strength * strength;
    part.most = std::max(part.most, weight * strength);
  };
  const auto shinerOf = [&](const Probes& probes, std::size_t i) -> const Shiner& {
    return *parts[probes.part[i]].shiner;
  };
  std::vector<std::uint8_t> blocked(std::max(toPortals.ray.size(), toEmitters.ray.size()));
  world_.rays.occluded(toPortals.ray, RayScene::Barrier::opaque,
                       std::span(blocked).first(toPortals.ray.size()));
  std::vector<std::size_t> open;
  std::vector<typename SolvedLight<K>::PanePoint> panes;
  open.reserve(toPortals.ray.size());
  panes.reserve(toPortals.ray.size());
  for (std::size_t i = 0; i < toPortals.ray.size(); ++i) {
    if (blocked[i] != 0) continue;
    open.push_back(i);
    panes.push_back({shinerOf(toPortals, i).portal, toPortals.ray[i].to});
  }
  std::vector<Columns<K>> seen(panes.size());
  light_.behindPortals(point, panes, seen);
  for (std::size_t j = 0; j < open.size(); ++j) add(toPortals, open[j], seen[j]);
  std::vector<float> visible(toEmitters.ray.size());
  world_.visibility(toEmitters.ray, std::span(blocked).first(toEmitters.ray.size()), visible);
  for (std::size_t i = 0; i < toEmitters.ray.size(); ++i) {
    if (visible[i] > 0.0F) add(toEmitters, i, visible[i] * shinerOf(toEmitters, i).luminance_cd_m2);
  }
  for (std::size_t i = 0; i < toBrightParts.ray.size(); ++i)
    add(toBrightParts, i, seenOfBrightPart(shinerOf(toBrightParts, i), toBrightParts.ray[i]));
}

template <int K>
Columns<K> DirectField<K>::seenOfBrightPart(const Shiner& shiner, const RayScene::Segment& ray) const {
  const auto hit =
      world_.rays.nearest(ray.from, glm::normalize(ray.to - ray.from), RayScene::Barrier::opaqueAndGlass);
  if (!hit || hit.side() != shiner.side) return {};
  return (world_.innerTransmittance(ray.from, ray.to) * std::numbers::inv_pi_v<float>)*light_.exitance(
      hit, ray.to, false);
}

// Even points miss the area beyond an edge by less than random ones: n^(-3/4) in two dimensions. What all of
// them have missed is not in their variance: a bright sliver at the edge of what a pane shows.
template <int K>
DirectLight<K> DirectField<K>::lightOf(const Part& part) const {
  if (!(part.weights > 0.0F)) return {{}, 0.0F, part.rays};
  const float scale = std::numbers::pi_v<float> * part.formFactor;
  const float mean = part.strengths / part.weights;
  const float variance = std::max(part.squares / part.weights - mean * mean, 0.0F);
  const auto rays = static_cast<float>(part.rays);
  const float missed = part.shiner->portal != nullptr ? missedBetween * part.shiner->strength / rays : 0.0F;
  return {(scale / part.weights) * part.sum,
          scale * std::hypot(std::sqrt(variance / rays) / std::sqrt(std::sqrt(rays)), missed), part.rays};
}

// What rays bring anyway is in the deviation; a single one stands out where it brings more than twice that.
template <int K>
float DirectField<K>::grainOf(const Part& part) const {
  if (part.shiner->portal == nullptr || !(part.weights > 0.0F)) return 0.0F;
  const float mean = part.strengths / static_cast<float>(part.rays);
  return std::numbers::pi_v<float> * part.formFactor * std::max(part.most - grainLeast * mean, 0.0F) /
         part.weights;
}

template <int K>
MeasuredLight<K> DirectField<K>::light(const glm::vec3& point, const glm::vec3& normal,
                                       std::span<const float> formFactors, float rays, float deviationMost,
                                       float known_lx, std::uint64_t key) const {
  std::vector<Part> parts = partsOf(formFactors);
  float all = 0.0F;
  for (const Part& part : parts) all += part.formFactor * part.shiner->strength;
  std::vector<std::uint32_t> counts;
  for (const Part& part : parts)
    counts.push_back(static_cast<std::uint32_t>(
        std::ceil(std::max(rays * part.formFactor * part.shiner->strength / all, raysLeast))));
  const DirectLight<K> fromLamps =
      directFromLamps<K>(world_, domain_, point, normal, {0.0F, rays}, mixKeys(key, 4));
  for (int round = 0;; ++round) {
    sample(parts, counts, point, normal, key);
    DirectLight<K> sum = fromLamps;
    for (const Part& part : parts) sum += lightOf(part);
    const float allowed_lx = deviationMost * (known_lx + world_.layout.strength(sum.illuminance_lx));
    if (round == roundsMost || sum.deviation_lx <= allowed_lx) {
      float grain_lx = 0.0F;
      for (const Part& part : parts) grain_lx = std::max(grain_lx, grainOf(part));
      return {sum, grain_lx};
    }
    const float share_lx = allowed_lx / std::sqrt(static_cast<float>(parts.size() + 1));
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (lightOf(parts[p]).deviation_lx > share_lx) counts[p] *= 2;
    }
  }
}

#define CLERESTORY_INSTANTIATE(K) template class DirectField<K>;
CLERESTORY_STUDY_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
