// SPDX-License-Identifier: GPL-3.0-or-later
// Portals as senders of a closed domain: what each lets in, and the light that a receiver gets from one.
#pragma once

#include <vector>

#include "direct.hpp"
#include "hierarchy.hpp"
#include "radiosity.hpp"
#include "receiver.hpp"

namespace clerestory {

/// A portal as the oracle sees it.
template <int K>
struct PortalSender {
  std::uint32_t portal;  ///< of the building
  std::span<const glm::vec3> polygon;
  glm::vec3 inward, centre;
  float radius_m, area_m2;
  Columns<K> flux_lm;    ///< that enters
  float exitance_lm_m2;  ///< mean over the portal, of the strongest kind of light
  float deviation;       ///< of what single directions show, as a share of their mean
  float mirrored_lm_m2;  ///< mean exitance of patches of sun in the room that it mirrors; 0: of none
};

/// The portals of a domain; the flux of each by `rays` directions, or more if what it shows is uneven.
/// `mirrorsPatches`: clear panes show their receivers the patches of sun in the room mirrored, as a part of
/// their flux.
template <int K>
std::vector<PortalSender<K>> portalsOf(const SolvedLight<K>& light, std::int32_t domain, std::uint32_t rays,
                                       bool mirrorsPatches);

/// What of a portal's light has to be known to judge an interaction with it.
struct PortalSight {
  float formFactor = 0.0F;  ///< mean over the receiver; clusters: a bound of it
  float light_lx = 0.0F;    ///< unshadowed, by the sky that the portal shows from there; clusters: a bound
  float rise_lx = 0.0F;     ///< of that light over the receiver
};

/// Light without shadows, by exact form factors; no ray is cast.
template <int K>
PortalSight lookAtPortal(const SolvedLight<K>& light, const PortalSender<K>& portal,
                         const Receiver& receiver);

/// Share of the portal that the receiver's spots see, by one ray from each. [0, 1]
template <int K>
float seenOfPortal(const World& world, const PortalSender<K>& portal, const Receiver& receiver);

/// What samples between an element and a portal have told.
template <int K>
struct PortalLight {
  Columns<K> illuminance_lx;  ///< mean over the element
  float visible = 0.0F;       ///< share of what the portal could bring that nothing stands in the way of
  std::uint64_t rays = 0;
};

/// Light of an element from a portal, by `samples` (>= 2) pairs of points.
template <int K>
PortalLight<K> elementLightFromPortal(const SolvedLight<K>& light, const PortalSender<K>& portal,
                                      const Receiver& element, const PortalSight& sight, float samples);

/// Mean illuminances of a cluster's contents by the six directions that it keeps its light by.
template <int K>
std::array<Columns<K>, 6> clusterLightFromPortal(const SolvedLight<K>& light, const PortalSender<K>& portal,
                                                 const Hierarchy& tree, NodeIndex cluster,
                                                 std::uint64_t& rays);

}  // namespace clerestory
