// SPDX-License-Identifier: GPL-3.0-or-later
// Exact form factors of small parts of luminous polygons, times what is seen of them.
#include "direct.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include <geometry/sampling.hpp>
#include <solver/formfactor.hpp>

namespace clerestory {
namespace {

constexpr float partSize = 0.6F;      // of its distance, radius of the largest part that is not parted
constexpr float partFactor = 0.003F;  // form factor below which a part is small enough anyhow
constexpr int partDepth = 10;
constexpr float samplesOfPart = 128.0F;  // at most

/// Calls use(part, form factor, centre) for the parts of a polygon as seen from a receiver.
template <class Use>
void forEachPart(const glm::vec3& receiver, const glm::vec3& normal, const ElementShape& part,
                 const glm::vec3& partNormal, int depth, const Use& use) {
  const float formFactor = pointToPolygon(receiver, normal, part.corners);
  if (formFactor <= 0.0F) return;
  const float distance_m = glm::length(part.centre - receiver);
  if (depth == 0 || formFactor < partFactor || part.radius_m < partSize * distance_m) {
    use(part, formFactor);
    return;
  }
  const Halves halves = halve(part, partNormal);
  forEachPart(receiver, normal, halves.first, partNormal, depth - 1, use);
  forEachPart(receiver, normal, halves.second, partNormal, depth - 1, use);
}

/// Points of a part with the density of the form factor's kernel: a few times as many are laid evenly, and
/// drawn from by their kernel, so that a mean over them needs no weights. (With one even point a part, the
/// mean would lean to what is seen at its far end.)
class KernelPoints {
 public:
  KernelPoints(const glm::vec3& receiver, const glm::vec3& normal, std::span<const glm::vec3> part,
               const glm::vec3& partNormal, std::uint32_t count, std::uint64_t key) {
    const std::uint32_t candidates = std::max(candidatesOfPart, 2 * count);
    const Sequence sequence(key);
    std::array<glm::vec3, candidatesMax> laid;
    std::array<float, candidatesMax> upTo;  // running sum of the kernel
    float total = 0.0F;
    for (std::uint32_t i = 0; i < candidates; ++i) {
      laid[i] = pointOnPolygon<glm::vec3>(part, sequence(i, 0), sequence(i, 1));
      const glm::vec3 way = laid[i] - receiver;
      const float squared = std::max(glm::dot(way, way), 1e-12F);
      total +=
          std::max(glm::dot(way, normal), 0.0F) * std::abs(glm::dot(way, partNormal)) / (squared * squared);
      upTo[i] = total;
    }
    if (total <= 0.0F) return;
    const float shift = sequence(0, 2);
    std::uint32_t candidate = 0;
    for (; size_ < count; ++size_) {
      const float target = (static_cast<float>(size_) + shift) * total / static_cast<float>(count);
      while (candidate + 1 < candidates && upTo[candidate] <= target) ++candidate;
      points_[size_] = laid[candidate];
    }
  }
  [[nodiscard]] std::uint32_t size() const { return size_; }
  const glm::vec3& operator[](std::uint32_t i) const { return points_[i]; }

 private:
  static constexpr std::uint32_t candidatesOfPart = 8;
  static constexpr std::uint32_t candidatesMax = 2 * static_cast<std::uint32_t>(samplesOfPart);
  std::array<glm::vec3, static_cast<std::size_t>(samplesOfPart)> points_;
  std::uint32_t size_ = 0;
};

ElementShape wholeShape(std::span<const glm::vec3> polygon) {
  ElementShape shape;
  shape.corners.assign(polygon.begin(), polygon.end());
  for (const glm::vec3& corner : polygon) shape.centre += corner / static_cast<float>(polygon.size());
  for (const glm::vec3& corner : polygon) {
    shape.radius_m = std::max(shape.radius_m, glm::length(corner - shape.centre));
  }
  return shape;
}

}  // namespace

template <int K>
DirectLight<K> directFromPolygon(const ColumnLayout& layout, const glm::vec3& receiver,
                                 const glm::vec3& normal, std::span<const glm::vec3> polygon,
                                 DirectSamples samples, std::uint64_t key, const Luminance<K>& luminance) {
  DirectLight<K> result;
  const float whole = pointToPolygon(receiver, normal, polygon);
  if (whole <= 0.0F) return result;
  const float density = std::max(samples.perFormFactor, samples.least / whole);
  const glm::vec3 polygonNormal =
      glm::normalize(glm::cross(polygon[1] - polygon[0], polygon[polygon.size() - 1] - polygon[0]));
  float variance = 0.0F;
  float lastMean = -1.0F;
  std::uint64_t partNumber = 0;
  const auto usePart = [&](const ElementShape& part, float formFactor) {
    const auto count =
        static_cast<std::uint32_t>(std::clamp(std::ceil(density * formFactor), 1.0F, samplesOfPart));
    const KernelPoints points(receiver, normal, part.corners, polygonNormal, count,
                              mixKeys(key, partNumber++));
    if (points.size() == 0) return;
    Columns<K> sum;
    float strengths = 0.0F;
    float squares = 0.0F;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const Columns<K> seen = luminance(points[i]);
      const float strength = layout.strength(seen);
      sum += seen;
      strengths += strength;
      squares += strength * strength;
    }
    const auto number = static_cast<float>(points.size());
    result.rays += points.size();
    const float scale = std::numbers::pi_v<float> * formFactor;
    result.illuminance_lx += (scale / number) * sum;
    const float mean = strengths / number;
    // A single sample says nothing of its own spread; half the squared step from the part before does.
    const float step = lastMean < 0.0F ? 0.0F : mean - lastMean;
    const float spread =
        points.size() > 1 ? std::max(squares / number - mean * mean, 0.0F) : 0.5F * step * step;
    lastMean = mean;
    variance += scale * scale * spread / number;
  };
  forEachPart(receiver, normal, wholeShape(polygon), polygonNormal, partDepth, usePart);
  result.deviation_lx = std::sqrt(variance);
  return result;
}

template <int K>
DirectLight<K> directFromPortals(const SolvedLight<K>& light, std::int32_t domain, const glm::vec3& receiver,
                                 const glm::vec3& normal, DirectSamples samples, std::uint64_t key) {
  const World& world = light.world();
  DirectLight<K> sum;
  float variance = 0.0F;
  for (const Portal& portal : world.building.portals) {
    if (portal.inside != domain) continue;
    const glm::vec3 inward = world.normalOf(2 * portal.piece + (portal.frontIsInside ? 0U : 1U));
    const auto polygon = world.polygon(portal.piece);
    if (glm::dot(receiver - polygon[0], inward) <= 0.0F) continue;
    const DirectLight<K> own = directFromPolygon<K>(
        world.layout, receiver, normal, polygon, samples, mixKeys(key, portal.piece),
        [&](const glm::vec3& onPane) { return light.throughPortal(portal, receiver, onPane); });
    sum.illuminance_lx += own.illuminance_lx;
    variance += own.deviation_lx * own.deviation_lx;
    sum.rays += own.rays;
  }
  sum.deviation_lx = std::sqrt(variance);
  return sum;
}

template <int K>
DirectLight<K> directFromEmitters(const SolvedLight<K>& light, std::int32_t domain, const glm::vec3& receiver,
                                  const glm::vec3& normal, DirectSamples samples, std::uint64_t key) {
  const World& world = light.world();
  const Radiosity<K>* radiosity = light.of(domain);
  DirectLight<K> sum;
  if (radiosity == nullptr || !world.layout.electric) return sum;
  float variance = 0.0F;
  for (const std::uint32_t i : radiosity->emitters) {
    const Columns<K>& exitance = radiosity->exitance_lm_m2[i];
    const TreeSide& side = radiosity->tree.sides[i];
    const auto polygon = world.polygon(side.side / 2);
    if (glm::dot(receiver - polygon[0], side.normal) <= 0.0F) continue;
    const Columns<K> luminance = std::numbers::inv_pi_v<float> * exitance;
    const DirectLight<K> own = directFromPolygon<K>(
        world.layout, receiver, normal, polygon, samples, mixKeys(key, side.side),
        [&](const glm::vec3& point) { return world.visibility(receiver, point) * luminance; });
    sum.illuminance_lx += own.illuminance_lx;
    variance += own.deviation_lx * own.deviation_lx;
    sum.rays += own.rays;
  }
  sum.deviation_lx = std::sqrt(variance);
  return sum;
}

#define CLERESTORY_INSTANTIATE(K)                                                                        \
  template DirectLight<K> directFromPolygon<K>(const ColumnLayout&, const glm::vec3&, const glm::vec3&,  \
                                               std::span<const glm::vec3>, DirectSamples, std::uint64_t, \
                                               const Luminance<K>&);                                     \
  template DirectLight<K> directFromPortals<K>(const SolvedLight<K>&, std::int32_t, const glm::vec3&,    \
                                               const glm::vec3&, DirectSamples, std::uint64_t);          \
  template DirectLight<K> directFromEmitters<K>(const SolvedLight<K>&, std::int32_t, const glm::vec3&,   \
                                                const glm::vec3&, DirectSamples, std::uint64_t);
CLERESTORY_INSTANTIATE(1)
CLERESTORY_INSTANTIATE(2)
CLERESTORY_INSTANTIATE(4)
CLERESTORY_INSTANTIATE(8)
#undef CLERESTORY_INSTANTIATE

}  // namespace clerestory
