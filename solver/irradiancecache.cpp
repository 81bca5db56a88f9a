// SPDX-License-Identifier: GPL-3.0-or-later
// Gathers records of reflected light and fits planes through them.
#include "irradiancecache.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <geometry/sampling.hpp>

#include "sensors.hpp"

namespace clerestory {
namespace {

constexpr float holdsFor = 0.25F;      // of the harmonic mean distance of what a record sees
constexpr float offPlaneMost = 0.05F;  // of its radius
constexpr float sameFacing = 0.95F;    // cosine between normals
constexpr float slopeTie = 0.05F;      // of the squared radii
constexpr std::uint32_t raysFirst = 64;
constexpr std::uint32_t raysTogether = 32;
constexpr float unevenMost = 8.0F;  // times as many rays, at most
constexpr float evenVariance =
    1.0F;  // of what a record sees, by its squared mean; above it, it asks for more rays

}  // namespace

template <int K>
float IrradianceRecord<K>::weightAt(std::int32_t domainThere, const glm::vec3& there,
                                    const glm::vec3& normalThere) const {
  const glm::vec3 way = there - point;
  const float square = glm::dot(way, way);
  if (square >= radius_m * radius_m || domainThere != domain) return 0.0F;
  if (glm::dot(normal, normalThere) < sameFacing || std::abs(glm::dot(way, normal)) > offPlaneMost * radius_m)
    return 0.0F;
  const float rest = 1.0F - std::sqrt(square) / radius_m;
  return rest * rest;
}

template <int K>
IrradianceRecord<K> irradianceRecord(const SolvedLight<K>& light, std::int32_t domain, const glm::vec3& point,
                                     const glm::vec3& normal, const RecordReach& reach,
                                     std::uint32_t raysMost, std::uint64_t key) {
  const ColumnLayout& layout = light.world().layout;
  const Sequence sequence(key);
  const glm::vec3 from = point + rayOffset_m * normal;
  Columns<K> sum;
  float counted = 0.0F;
  float nearness = 0.0F;
  float squares = 0.0F;
  std::array<RayScene::Ray, raysTogether> rays;
  std::array<RayScene::Hit, raysTogether> hits;
  const auto castTogether = [&](std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i)
      rays[i] = {from, cosineDirection(normal, sequence(first + i, 0), sequence(first + i, 1))};
    light.world().rays.nearest(std::span(rays).first(count), RayScene::Barrier::opaqueAndGlass, hits,
                               RayScene::Course::scattered);
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto seen =
          luminanceAlong(light, domain, from, rays[i].direction, LightAsked::reflectedEvenly, hits[i]);
      nearness += 1.0F / std::max(hits[i].distance_m, 1e-3F);
      if (!seen) continue;
      sum += *seen;
      squares += layout.strength(*seen) * layout.strength(*seen);
      counted += 1.0F;
    }
  };
  const auto castTo = [&](std::uint32_t first, std::uint32_t last) {
    for (; first < last; first += raysTogether) castTogether(first, std::min(raysTogether, last - first));
  };
  const auto radiusAfter = [&](std::uint32_t count) {
    return std::clamp(holdsFor * static_cast<float>(count) / nearness, reach.least_m, reach.most_m);
  };
  castTo(0, raysFirst);
  const float share = radiusAfter(raysFirst) / reach.least_m;
  const float mean = layout.strength(sum) / std::max(counted, 1.0F);
  const float variance = squares / std::max(counted, 1.0F) - mean * mean;
  const float unevenness = mean > 0.0F ? variance / (evenVariance * mean * mean) : 1.0F;
  const float most = static_cast<float>(raysMost);
  const float wanted = std::min(static_cast<float>(raysFirst) * share * share, 0.5F * most) *
                       std::clamp(unevenness, 1.0F, unevenMost);
  const auto all = static_cast<std::uint32_t>(std::clamp(wanted, static_cast<float>(raysFirst), most));
  castTo(raysFirst, all);
  const Columns<K> irradiance = counted > 0.0F ? (std::numbers::pi_v<float> / counted) * sum : Columns<K>{};
  return {point, normal, domain, radiusAfter(all), irradiance};
}

template <int K>
IrradianceFit<K>::IrradianceFit(const glm::vec3& normal) {
  tangentFrame(normal, u_, v_);
}

template <int K>
void IrradianceFit<K>::add(float weight, const glm::vec3& way_m, float radius_m,
                           const Columns<K>& irradiance_lx) {
  const float x = glm::dot(way_m, u_);
  const float y = glm::dot(way_m, v_);
  for (int c = 0; c < K; ++c) {
    low_[c] = weights_ > 0.0F ? std::min(low_[c], irradiance_lx[c]) : irradiance_lx[c];
    high_[c] = std::max(high_[c], irradiance_lx[c]);
  }
  weights_ += weight;
  x_ += weight * x;
  y_ += weight * y;
  xx_ += weight * x * x;
  xy_ += weight * x * y;
  yy_ += weight * y * y;
  radii_ += weight * radius_m * radius_m;
  sum_ += weight * irradiance_lx;
  xSum_ += (weight * x) * irradiance_lx;
  ySum_ += (weight * y) * irradiance_lx;
}

// About the records' centroid, where level and slope are independent. What leads beyond all of them is cut
// off at their range.
template <int K>
Columns<K> IrradianceFit<K>::value() const {
  const float x = x_ / weights_;
  const float y = y_ / weights_;
  const float tie = slopeTie * radii_;
  const float xx = xx_ - x * x_ + tie;
  const float xy = xy_ - x * y_;
  const float yy = yy_ - y * y_ + tie;
  const float determinant = xx * yy - xy * xy;
  Columns<K> value;
  for (int c = 0; c < K; ++c) {
    const float mean = sum_[c] / weights_;
    const float alongX = xSum_[c] - x * sum_[c];
    const float alongY = ySum_[c] - y * sum_[c];
    const float slopeX = (yy * alongX - xy * alongY) / determinant;
    const float slopeY = (xx * alongY - xy * alongX) / determinant;
    const float range = high_[c] - low_[c];
    value[c] = std::clamp(mean - slopeX * x - slopeY * y, std::max(low_[c] - 0.5F * range, 0.0F),
                          high_[c] + 0.5F * range);
  }
  return value;
}

#define CLERESTORY_INSTANTIATE(K)                                                                         \
  template struct IrradianceRecord<K>;                                                                    \
  template IrradianceRecord<K> irradianceRecord<K>(const SolvedLight<K>&, std::int32_t, const glm::vec3&, \
                                                   const glm::vec3&, const RecordReach&, std::uint32_t,   \
                                                   std::uint64_t);                                        \
  template class IrradianceFit<K>;
CLERESTORY_STUDY_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
