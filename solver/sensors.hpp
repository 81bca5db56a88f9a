// SPDX-License-Identifier: GPL-3.0-or-later
// Final gather: what arrives at a point, from portals and emitters directly and from everything else by rays.
#pragma once

#include <limits>
#include <optional>

#include <solver/solution.hpp>

#include "direct.hpp"
#include "radiosity.hpp"

namespace clerestory {

/// How light at a point is sampled: at first so, then more until its standard deviation is at most
/// `deviationMost` of it.
struct GatherSettings {
  DirectSamples direct{512.0F, 24.0F};  ///< of portals and emitters
  std::uint32_t rays = 1024;            ///< over the hemisphere
  float deviationMost = std::numeric_limits<float>::infinity();
};

/// Light that arrives at a point.
template <int K>
struct Gathered {
  Columns<K> direct_lx, reflected_lx;
  /// Standard deviations of the quadrature, estimated from its own samples.
  float directDeviation_lx = 0.0F, reflectedDeviation_lx = 0.0F;
};

/// Light arriving at `point` (local coordinates) with unit `normal` in the air of `domain`, without the sun's
/// beam: that is as sharp as rays to its disc make it (sunlightByDisc). `known_lx` of that beam or the like
/// counts as light that is sure when the error allowed is a share of all. `key` seeds the rays.
template <int K>
Gathered<K> gather(const SolvedLight<K>& light, std::int32_t domain, const glm::vec3& point,
                   const glm::vec3& normal, const GatherSettings& settings, std::uint64_t key,
                   float known_lx = 0.0F);

/// What of the light along a ray is asked for.
enum class LightAsked {
  all,
  reflected,       ///< without surfaces' own emission and what is seen through portals
  reflectedEvenly  ///< without bright parts that the ray meets first, too
};

/// Luminance along a ray in the air of a domain, glass seen through and mirrored in. [cd/m²]
/// Nothing where the ray ends on a side that faces no solved air: in a crack.
template <int K>
std::optional<Columns<K>> luminanceAlong(const SolvedLight<K>& light, std::int32_t domain,
                                         const glm::vec3& from, const glm::vec3& direction, LightAsked what);

/// The same for a ray of which it is known what it meets first.
template <int K>
std::optional<Columns<K>> luminanceAlong(const SolvedLight<K>& light, std::int32_t domain,
                                         const glm::vec3& from, const glm::vec3& direction, LightAsked what,
                                         RayScene::Hit hit);

/// Values of a grid's sensors.
template <int K>
GridValues senseGrid(const SolvedLight<K>& light, const SensorGrid& grid, const GatherSettings& settings);

/// The domain of air that a point is in, by what is seen around it; -1 where nothing is.
std::int32_t domainAt(const World& world, const glm::vec3& point);

}  // namespace clerestory
