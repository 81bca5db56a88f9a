// SPDX-License-Identifier: GPL-3.0-or-later
// Light that a point receives straight from portals, emitting surfaces and luminaires.
#pragma once

#include <functional>
#include <limits>

#include "radiosity.hpp"

namespace clerestory {

/// How many samples a luminous polygon gets: `perFormFactor` times its form factor, but `least` in all. Where
/// the deviation that they tell is above `deviationMost` of the light of all polygons together, it gets four
/// times as many, and so once more.
struct DirectSamples {
  float perFormFactor;
  float least;
  float deviationMost = std::numeric_limits<float>::infinity();
};

/// Illuminance of a point and how sure it is.
template <int K>
struct DirectLight {
  Columns<K> illuminance_lx;
  float deviation_lx = 0.0F;  ///< standard deviation of the quadrature, estimated from its own samples
  std::uint32_t rays = 0;
};

/// What a luminous polygon sends towards a receiver from a point on it; black where it is hidden.
template <int K>
using Luminance = std::function<Columns<K>(const glm::vec3& onPolygon)>;

/// Illuminance of a point with unit `normal` from a convex planar polygon, whose luminance is asked for at
/// points. The polygon's form factor is exact (Lambert) and its luminance a mean over directions that are
/// even by solid angle, weighed by their cosine, so an unhidden even polygon comes out exact. `key` seeds
/// them.
template <int K>
DirectLight<K> directFromPolygon(const ColumnLayout& layout, const glm::vec3& receiver,
                                 const glm::vec3& normal, std::span<const glm::vec3> polygon,
                                 DirectSamples samples, std::uint64_t key, const Luminance<K>& luminance);

/// Illuminance of a point in `domain` from all of its portals.
template <int K>
DirectLight<K> directFromPortals(const SolvedLight<K>& light, std::int32_t domain, const glm::vec3& receiver,
                                 const glm::vec3& normal, DirectSamples samples, std::uint64_t key);

/// Illuminance of a point from the emitting sides of its domain.
template <int K>
DirectLight<K> directFromEmitters(const SolvedLight<K>& light, std::int32_t domain, const glm::vec3& receiver,
                                  const glm::vec3& normal, DirectSamples samples, std::uint64_t key);

/// Illuminance of a point in `domain` from its luminaires, in all by `samples.least` rays or somewhat more.
template <int K>
DirectLight<K> directFromLamps(const World& world, std::int32_t domain, const glm::vec3& receiver,
                               const glm::vec3& normal, DirectSamples samples, std::uint64_t key);

}  // namespace clerestory
