// SPDX-License-Identifier: GPL-3.0-or-later
// Exact form factors of luminous polygons, times the mean of what is seen of them by even solid angle.
#include "direct.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <geometry/sampling.hpp>
#include <solver/formfactor.hpp>

#include "sphericalpolygon.hpp"

namespace clerestory {
namespace {

constexpr float samplesMost = 1024.0F;  // at first
constexpr float samplesMoreOften = 4.0F;
constexpr int roundsOfMore = 2;
constexpr float lampRaysLeast = 8.0F;  // of a luminaire

/// A sample's place in its sequence, its weight and what it saw.
struct Seen {
  float u, v, weight, strength;
};

/// Variance of the weighted mean, from what differs within cells that hold two samples each on average: the
/// sequence is even, so what differs between cells is no error.
float varianceWithinCells(std::span<const Seen> samples, float mean, float weights) {
  constexpr std::size_t sideMost = 64;
  struct Cell {
    float count = 0.0F, sum = 0.0F, squares = 0.0F;
  };
  const auto side = std::clamp(static_cast<std::size_t>(std::sqrt(0.5F * static_cast<float>(samples.size()))),
                               std::size_t{1}, sideMost);
  std::vector<Cell> cells(side * side);
  for (const Seen& sample : samples) {
    const auto column = static_cast<std::size_t>(sample.u * static_cast<float>(side));
    const auto row = static_cast<std::size_t>(sample.v * static_cast<float>(side));
    Cell& cell = cells[std::min(row, side - 1) * side + std::min(column, side - 1)];
    const float value = sample.weight * (sample.strength - mean) / weights;
    cell.count += 1.0F;
    cell.sum += value;
    cell.squares += value * value;
  }
  float variance = 0.0F;
  float counted = 0.0F;
  for (const Cell& cell : cells) {
    if (cell.count < 2.0F) continue;
    counted += cell.count;
    const float within = std::max(cell.squares - cell.sum * cell.sum / cell.count, 0.0F);  // but for rounding
    variance += within * cell.count / (cell.count - 1.0F);
  }
  return counted > 0.0F ? variance * static_cast<float>(samples.size()) / counted : 0.0F;
}

}  // namespace

template <int K>
DirectLight<K> directFromPolygon(const ColumnLayout& layout, const glm::vec3& receiver,
                                 const glm::vec3& normal, std::span<const glm::vec3> polygon,
                                 DirectSamples samples, std::uint64_t key, const Luminance<K>& luminance) {
  DirectLight<K> result;
  const float whole = pointToPolygon(receiver, normal, polygon);
  if (whole <= 0.0F) return result;
  const SphericalPolygon seenPolygon(receiver, normal, polygon);
  if (seenPolygon.solidAngle_sr() <= 0.0) return result;
  const glm::vec3 polygonNormal =
      glm::normalize(glm::cross(polygon[1] - polygon[0], polygon[polygon.size() - 1] - polygon[0]));
  const float height_m = glm::dot(polygon[0] - receiver, polygonNormal);
  const float most = samplesMost * std::max(1.0F, samples.least / samplesMost);
  const auto count = static_cast<std::uint32_t>(
      std::clamp(std::ceil(std::max(samples.perFormFactor * whole, samples.least)), 1.0F, most));
  const Sequence sequence(key);
  std::vector<Seen> seen(count);
  Columns<K> sum;
  float weights = 0.0F;
  float strengths = 0.0F;
  for (std::uint32_t i = 0; i < count; ++i) {
    Seen& own = seen[i];
    own = {sequence(i, 0), sequence(i, 1), 0.0F, 0.0F};
    const glm::vec3 direction = seenPolygon.direction(own.u, own.v);
    const float approach = glm::dot(direction, polygonNormal);
    own.weight = std::max(glm::dot(direction, normal), 0.0F);
    if (approach * height_m <= 0.0F || own.weight <= 0.0F) continue;
    const Columns<K> light = luminance(receiver + (height_m / approach) * direction);
    own.strength = layout.strength(light);
    sum += own.weight * light;
    weights += own.weight;
    strengths += own.weight * own.strength;
    ++result.rays;
  }
  if (weights <= 0.0F) return result;
  const float scale = std::numbers::pi_v<float> * whole;
  result.illuminance_lx = (scale / weights) * sum;
  result.deviation_lx = scale * std::sqrt(varianceWithinCells(seen, strengths / weights, weights));
  return result;
}

namespace {

/// Light of all polygons (number, samples -> DirectLight), those that are uneven by more samples.
template <int K, class Polygon>
DirectLight<K> sumOf(const ColumnLayout& layout, std::size_t count, DirectSamples samples,
                     const Polygon& polygon) {
  std::vector<DirectLight<K>> lights;
  lights.reserve(count);
  for (std::size_t i = 0; i < count; ++i) lights.push_back(polygon(i, samples));
  const auto added = [&] {
    DirectLight<K> sum;
    float variance = 0.0F;
    for (const DirectLight<K>& light : lights) {
      sum.illuminance_lx += light.illuminance_lx;
      variance += light.deviation_lx * light.deviation_lx;
      sum.rays += light.rays;
    }
    sum.deviation_lx = std::sqrt(variance);
    return sum;
  };
  DirectLight<K> sum = added();
  for (int round = 0; round < roundsOfMore; ++round) {
    const float allowed_lx = samples.deviationMost * layout.strength(sum.illuminance_lx);
    if (!(sum.deviation_lx > allowed_lx)) break;
    for (std::size_t i = 0; i < count; ++i) {
      const auto rays = static_cast<float>(lights[i].rays);
      if (lights[i].deviation_lx > allowed_lx)
        lights[i] = polygon(i, {samples.perFormFactor, samplesMoreOften * rays, samples.deviationMost});
    }
    sum = added();
  }
  return sum;
}

}  // namespace

template <int K>
DirectLight<K> directFromPortals(const SolvedLight<K>& light, std::int32_t domain, const glm::vec3& receiver,
                                 const glm::vec3& normal, DirectSamples samples, std::uint64_t key) {
  const World& world = light.world();
  std::vector<const Portal*> facing;
  for (const Portal& portal : world.building.portals) {
    if (portal.inside != domain) continue;
    const glm::vec3 inward = world.normalOf(2 * portal.piece + (portal.frontIsInside ? 0U : 1U));
    if (glm::dot(receiver - world.polygon(portal.piece)[0], inward) > 0.0F) facing.push_back(&portal);
  }
  return sumOf<K>(world.layout, facing.size(), samples, [&](std::size_t i, DirectSamples own) {
    const Portal& portal = *facing[i];
    return directFromPolygon<K>(
        world.layout, receiver, normal, world.polygon(portal.piece), own, mixKeys(key, portal.piece),
        [&](const glm::vec3& onPane) { return light.throughPortal(portal, receiver, onPane); });
  });
}

template <int K>
DirectLight<K> directFromEmitters(const SolvedLight<K>& light, std::int32_t domain, const glm::vec3& receiver,
                                  const glm::vec3& normal, DirectSamples samples, std::uint64_t key) {
  const World& world = light.world();
  const Radiosity<K>* radiosity = light.of(domain);
  if (radiosity == nullptr || !world.layout.electric) return {};
  std::vector<std::uint32_t> facing;
  for (const std::uint32_t i : radiosity->emitters) {
    const TreeSide& side = radiosity->tree.sides[i];
    if (glm::dot(receiver - world.polygon(side.side / 2)[0], side.normal) > 0.0F) facing.push_back(i);
  }
  return sumOf<K>(world.layout, facing.size(), samples, [&](std::size_t i, DirectSamples own) {
    const std::uint32_t side = radiosity->tree.sides[facing[i]].side;
    const Columns<K> luminance = std::numbers::inv_pi_v<float> * radiosity->exitance_lm_m2[facing[i]];
    return directFromPolygon<K>(
        world.layout, receiver, normal, world.polygon(side / 2), own, mixKeys(key, side),
        [&](const glm::vec3& point) { return world.visibility(receiver, point) * luminance; });
  });
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
  template DirectLight<K> directFromPolygon<K>(const ColumnLayout&, const glm::vec3&, const glm::vec3&,      \
                                               std::span<const glm::vec3>, DirectSamples, std::uint64_t,     \
                                               const Luminance<K>&);                                         \
  template DirectLight<K> directFromPortals<K>(const SolvedLight<K>&, std::int32_t, const glm::vec3&,        \
                                               const glm::vec3&, DirectSamples, std::uint64_t);              \
  template DirectLight<K> directFromEmitters<K>(const SolvedLight<K>&, std::int32_t, const glm::vec3&,       \
                                                const glm::vec3&, DirectSamples, std::uint64_t);             \
  template DirectLight<K> directFromLamps<K>(const World&, std::int32_t, const glm::vec3&, const glm::vec3&, \
                                             DirectSamples, std::uint64_t);
CLERESTORY_TRANSPORT_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
