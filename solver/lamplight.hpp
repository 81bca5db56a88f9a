// SPDX-License-Identifier: GPL-3.0-or-later
// Luminaires as senders of a domain: the light that a receiver gets from one in the first step.
#pragma once

#include <array>

#include "hierarchy.hpp"
#include "lamps.hpp"
#include "receiver.hpp"

namespace clerestory {

/// What of a luminaire's light has to be known to judge an interaction with it.
struct LampSight {
  float light_lx = 0.0F;  ///< mean over an element, unshadowed; clusters: a bound
  float rise_lx = 0.0F;   ///< of that light over the receiver
};

/// Light without shadows; no ray is cast.
LampSight lookAtLamp(const Lamp& lamp, const Receiver& receiver);

/// Share of the luminaire that the receiver's spots see, by one ray from each. [0, 1]
float seenOfLamp(const World& world, const Lamp& lamp, const Receiver& receiver, std::uint64_t key);

/// What samples between an element and a luminaire have told.
struct LampLight {
  float illuminance_lx = 0.0F;  ///< mean over the element
  float visible = 0.0F;         ///< share of `sight` that nothing stands in the way of
};

/// Light of an element from a luminaire, by `samples` pairs of points.
LampLight elementLightFromLamp(const World& world, const Lamp& lamp, const Receiver& element,
                               const LampSight& sight, std::uint32_t samples, std::uint64_t key);

/// Mean illuminances of a cluster's contents by the six directions that it keeps its light by.
std::array<float, 6> clusterLightFromLamp(const World& world, const Lamp& lamp, const Hierarchy& tree,
                                          NodeIndex cluster);

}  // namespace clerestory
