// SPDX-License-Identifier: GPL-3.0-or-later
// What shooting is charted against: plain radiosity over uniform elements, cosine rays traced once, Jacobi
// iterations.
#pragma once

#include <functional>

#include "direct.hpp"
#include "radiosity.hpp"

namespace clerestory {

/// What decides how finely plain radiosity works.
struct PlainSettings {
  float elementSize_m = 0.4F;          ///< elements fit the circle about a square of this size
  std::uint32_t raysPerElement = 128;  ///< cosine rays, for the light between surfaces
  std::uint32_t directPoints = 1;      ///< of an element, for light from portals and emitters
  DirectSamples direct{15.0F, 1.0F};   ///< of each portal and emitter at each of these points
  double endShare = 1e-3;              ///< change of the mean illuminance that ends the iterations
};

/// A domain as it was solved, and what that took.
template <int K>
struct PlainSolution {
  Radiosity<K> radiosity;
  std::uint64_t elements = 0;
  std::uint64_t rays = 0;  ///< of both kinds
  double directSeconds = 0.0;
  double leakedShare = 0.0;  ///< of the cosine rays: those that met nothing of the domain
};

/// Told of the light after each Jacobi iteration; 0: the direct light alone.
template <int K>
using AfterIteration = std::function<void(int iteration, const Radiosity<K>& radiosity)>;

/// Solves a closed domain. It shares with the solver what lies around the transport: the tree and its
/// division, the light from portals and emitters at a point (direct.hpp), glass as a diffuse reflector.
/// Random numbers come from the tree's keys.
template <int K>
PlainSolution<K> plainRadiosity(const SolvedLight<K>& light, std::int32_t domain, Hierarchy tree,
                                const PlainSettings& settings, const AfterIteration<K>& after = {});

}  // namespace clerestory
