// SPDX-License-Identifier: GPL-3.0-or-later
// Light that a point receives straight from portals, emitting surfaces and luminaires.
#pragma once

#include <functional>
#include <vector>

#include <geometry/sampling.hpp>

#include "evensamples.hpp"
#include "radiosity.hpp"
#include "sphericalpolygon.hpp"

namespace clerestory {

/// How many samples luminous polygons get: each `perFormFactor` times its form factor, and its share of
/// `least` by form factor.
struct DirectSamples {
  float perFormFactor;
  float least;
};

/// Illuminance of a point and how sure it is.
template <int K>
struct DirectLight {
  Columns<K> illuminance_lx;
  float deviation_lx = 0.0F;  ///< standard deviation of the quadrature, estimated from its own samples
  std::uint32_t rays = 0;

  DirectLight& operator+=(const DirectLight& other) {
    illuminance_lx += other.illuminance_lx;
    deviation_lx = std::hypot(deviation_lx, other.deviation_lx);
    rays += other.rays;
    return *this;
  }
};

/// What a luminous polygon sends towards a receiver from a point on it; black where it is hidden.
template <int K>
using Luminance = std::function<Columns<K>(const glm::vec3& onPolygon)>;

/// Light at a point with unit `normal` from a convex planar polygon, whose luminance is asked for at points.
/// The polygon's form factor is exact (Lambert) and its luminance a mean over directions that are even by
/// solid angle, weighed by their cosine, so an unhidden even polygon comes out exact. `key` seeds them.
template <int K>
class PolygonLight {
 public:
  PolygonLight(const ColumnLayout& layout, const glm::vec3& receiver, const glm::vec3& normal,
               std::span<const glm::vec3> polygon, std::uint64_t key, Luminance<K> luminance,
               float exitance_lm_m2 = 0.0F);

  /// Light of the polygon, were nothing in its way, by the mean exitance that it was made with. [lx]
  [[nodiscard]] float unhidden_lx() const { return formFactor_ * exitance_lm_m2_; }
  [[nodiscard]] float formFactor() const { return formFactor_; }
  [[nodiscard]] std::uint32_t size() const { return samples_.size(); }
  /// Carries the samples on to `count` in all.
  void sampleTo(std::uint32_t count);
  [[nodiscard]] const DirectLight<K>& light() const { return light_; }

 private:
  const ColumnLayout& layout_;
  glm::vec3 receiver_, normal_;
  SphericalPolygon seen_;
  float formFactor_;
  glm::vec3 polygonNormal_;
  float height_m_;  ///< of the polygon's plane over the receiver, along polygonNormal_
  Sequence sequence_;
  Luminance<K> luminance_;
  float exitance_lm_m2_;
  EvenSamples<K> samples_;
  DirectLight<K> light_;  ///< of these
};

/// Portals of `domain` that shine on a point, unsampled.
template <int K>
std::vector<PolygonLight<K>> portalsAt(const SolvedLight<K>& light, std::int32_t domain,
                                       const glm::vec3& receiver, const glm::vec3& normal, std::uint64_t key);

/// Emitting sides of `domain` that shine on a point, unsampled.
template <int K>
std::vector<PolygonLight<K>> emittersAt(const SolvedLight<K>& light, std::int32_t domain,
                                        const glm::vec3& receiver, const glm::vec3& normal,
                                        std::uint64_t key);

/// Bright parts of `domain` whose reflected light falls on a point, unsampled.
template <int K>
std::vector<PolygonLight<K>> brightPartsAt(const SolvedLight<K>& light, std::int32_t domain,
                                           const glm::vec3& receiver, const glm::vec3& normal,
                                           std::uint64_t key);

/// Samples polygons and adds their light up.
template <int K>
DirectLight<K> lightOf(std::span<PolygonLight<K>> polygons, DirectSamples samples);

/// Illuminance of a point in `domain` from all of its portals.
template <int K>
DirectLight<K> directFromPortals(const SolvedLight<K>& light, std::int32_t domain, const glm::vec3& receiver,
                                 const glm::vec3& normal, DirectSamples samples, std::uint64_t key) {
  std::vector<PolygonLight<K>> polygons = portalsAt(light, domain, receiver, normal, key);
  return lightOf<K>(polygons, samples);
}

/// Illuminance of a point from the emitting sides of its domain.
template <int K>
DirectLight<K> directFromEmitters(const SolvedLight<K>& light, std::int32_t domain, const glm::vec3& receiver,
                                  const glm::vec3& normal, DirectSamples samples, std::uint64_t key) {
  std::vector<PolygonLight<K>> polygons = emittersAt(light, domain, receiver, normal, key);
  return lightOf<K>(polygons, samples);
}

/// Illuminance of a point in `domain` from its luminaires, in all by `samples.least` rays or somewhat more.
template <int K>
DirectLight<K> directFromLamps(const World& world, std::int32_t domain, const glm::vec3& receiver,
                               const glm::vec3& normal, DirectSamples samples, std::uint64_t key);

}  // namespace clerestory
