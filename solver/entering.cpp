// SPDX-License-Identifier: GPL-3.0-or-later
// Judges interactions with portals, luminaires and the open sky as the oracle does those between nodes, and
// adds up their light.
#include "entering.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <geometry/sampling.hpp>

#include "lamplight.hpp"
#include "otherways.hpp"

namespace clerestory {

template <int K>
EnteringLight<K>::EnteringLight(const SolvedLight<K>& light, std::int32_t domain, const Hierarchy& tree,
                                const TransportSettings& settings, bool mirrorsPatches)
    : light_(light),
      world_(light.world()),
      tree_(tree),
      skyRays_(settings.skyRays),
      domain_(domain),
      isOpen_(world_.building.domains[static_cast<std::size_t>(domain)].open) {
  if (!isOpen_) portals_ = portalsOf(light, domain, settings.portalFluxRays, mirrorsPatches);
}

template <int K>
std::vector<Sender> EnteringLight<K>::senders() const {
  std::vector<Sender> senders;
  if (isOpen_ && world_.layout.sky) senders.push_back(openSky);
  for (std::uint32_t i = 0; i < portals_.size(); ++i) senders.push_back(firstPortal + i);
  for (std::uint32_t i = 0; i < world_.lamps.size(); ++i) {
    if (world_.lamps[i].domain() == domain_) senders.push_back(firstLamp + i);
  }
  return senders;
}

template <int K>
Columns<K> EnteringLight<K>::lampFlux_lm() const {
  glm::dvec3 flux_lm(0.0);
  for (const Lamp& lamp : world_.lamps) {
    if (lamp.domain() == domain_) flux_lm += lamp.flux_lm() * lamp.color();
  }
  return world_.layout.template light<K>(world_.layout.electricColumn(), flux_lm);
}

template <int K>
Columns<K> EnteringLight<K>::portalFlux_lm() const {
  Columns<K> flux;
  for (const PortalSender<K>& portal : portals_) flux += portal.flux_lm;
  return flux;
}

template <int K>
Verdict EnteringLight<K>::receive(const Receiver& receiver, Sender sender, const Limits& limits,
                                  Incoming<K>& incoming, Tally& tally) const {
  if (sender == openSky) return receiveFromSky(receiver, incoming, tally);
  if (sender >= firstLamp) return receiveFromLamp(receiver, sender - firstLamp, limits, incoming, tally);
  return receiveFromPortal(receiver, portals_[sender - firstPortal], limits, incoming, tally);
}

template <int K>
Verdict EnteringLight<K>::receiveFromSky(const Receiver& receiver, Incoming<K>& incoming,
                                         Tally& tally) const {
  if (receiver.isCluster() || (receiver.node != noNode && !tree_.isLeaf(receiver.node)))
    return Verdict::refineReceiver;
  const Sequence sequence(mixKeys(receiver.key, 0x5c1));
  // An element that nothing asks for is lit by a few rays, for the little that it reflects.
  const std::uint32_t count = receiver.weight > 0.0F ? skyRays_ : 32;
  Columns<K> sum;
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::vec3 from = pointOnPolygon<glm::vec3>(receiver.corners, sequence(i, 0), sequence(i, 1)) +
                           rayOffset_m * receiver.normal;
    const glm::vec3 direction = cosineDirection(receiver.normal, sequence(i, 2), sequence(i, 3));
    sum += light_.skyAlong(from, direction);
  }
  tally.rays += count;
  incoming.own.irradiance_lx += (std::numbers::pi_v<float> / static_cast<float>(count)) * sum;
  return Verdict::accept;
}

// A portal is a sender like others, but shows the sky instead of a radiosity. Clusters take it whole where
// all that it could bring, or what that varies over them, is below what may be missed. Elements are divided
// while its light rises over them; then as many rays bring it as hold their noise below the threshold.
template <int K>
Verdict EnteringLight<K>::receiveFromPortal(const Receiver& receiver, const PortalSender<K>& portal,
                                            const Limits& limits, Incoming<K>& incoming, Tally& tally) const {
  // Of what a pane shows a receiver, as a share of the mean: that varies less than all that it lets in, but
  // strips of sky between blades are as narrow from everywhere.
  const float deviation = std::max(0.35F, 0.25F * portal.deviation);
  constexpr float fewest = 2.0F;
  constexpr float most = 64.0F;
  constexpr float looksLeast = 32.0F, looksPerThreshold = 4.0F;
  const PortalSight sight = lookAtPortal(light_, portal, receiver);
  if (sight.light_lx <= 0.0F) return Verdict::nothing;
  const float power_lm = sight.light_lx * receiver.weight;
  if (receiver.isCluster()) {
    if (power_lm > limits.threshold_lm && 0.5F * sight.rise_lx * receiver.weight > limits.threshold_lm)
      return Verdict::refineReceiver;
    const auto six = clusterLightFromPortal(light_, portal, tree_, receiver.node, tally.rays);
    for (std::size_t k = 0; k < 6; ++k) (*incoming.six)[k].irradiance_lx += six[k];
    return Verdict::accept;
  }
  const auto isUneven = [&](float visible) {
    const float riseError_lm = linearDeviation * sight.rise_lx * receiver.weight * visible;
    const float shadowError_lm = 0.5F * power_lm * std::sqrt(visible * (1.0F - visible));
    return std::max(riseError_lm, shadowError_lm) > limits.threshold_lm && limits.mayDivide;
  };
  if (power_lm > limits.threshold_lm) {
    tally.rays += spotsOfNode;
    if (isUneven(seenOfPortal(world_, portal, receiver))) return Verdict::refineReceiver;
  }
  const float excess = deviation * power_lm / (rayNoise * limits.threshold_lm);
  const float samples = std::clamp(excess * excess, fewest, most);
  const PortalLight<K> light = elementLightFromPortal(light_, portal, receiver, sight, samples);
  tally.rays += light.rays;
  // A shadow that slips between the few spots does not slip between the samples.
  if (isUneven(light.visible)) return Verdict::refineReceiver;
  // Where no sample meets the pane, so many more look that what all of them miss is little.
  if (light.visible <= 0.0F && light.rays > 0 && isUneven(1.0F / static_cast<float>(light.rays))) {
    const Target pane{portal.polygon, glm::vec3(0.0F), 0x5ee5 + std::uint64_t{portal.portal}};
    const float looks = looksLeast + looksPerThreshold * power_lm / limits.threshold_lm;
    if (findsWay(world_, receiver, pane, Way::open, looks, tally.rays)) return Verdict::refineReceiver;
  }
  incoming.own.irradiance_lx += light.illuminance_lx;
  return Verdict::accept;
}

// As from a portal, but by the intensities of a luminaire, whose unshadowed light is known at any point.
template <int K>
Verdict EnteringLight<K>::receiveFromLamp(const Receiver& receiver, std::uint32_t number,
                                          const Limits& limits, Incoming<K>& incoming, Tally& tally) const {
  constexpr float fewest = 4.0F;
  constexpr float most = 64.0F;
  const Lamp& lamp = world_.lamps[number];
  const auto light = [&](float illuminance_lx) {
    return world_.layout.template light<K>(world_.layout.electricColumn(),
                                           static_cast<double>(illuminance_lx) * lamp.color());
  };
  const LampSight sight = lookAtLamp(lamp, receiver);
  const float power_lm = sight.light_lx * receiver.weight;
  if (receiver.isCluster()) {
    if (sight.light_lx <= 0.0F) return Verdict::nothing;
    if (0.5F * power_lm > limits.threshold_lm) return Verdict::refineReceiver;
    const auto six = clusterLightFromLamp(world_, lamp, tree_, receiver.node);
    for (std::size_t k = 0; k < 6; ++k) (*incoming.six)[k].irradiance_lx += light(six[k]);
    tally.rays += spotsOfNode;
    return Verdict::accept;
  }
  const float riseError_lm = linearDeviation * sight.rise_lx * receiver.weight;
  const auto isUneven = [&](float visible) {
    const float shadowError_lm = 0.5F * power_lm * std::sqrt(visible * std::max(1.0F - visible, 0.0F));
    return std::max(visible * riseError_lm, shadowError_lm) > limits.threshold_lm && limits.mayDivide;
  };
  if (std::max(power_lm, riseError_lm) > limits.threshold_lm) {
    tally.rays += spotsOfNode;
    if (isUneven(seenOfLamp(world_, lamp, receiver, firstLamp + number))) return Verdict::refineReceiver;
  }
  if (sight.light_lx <= 0.0F) return Verdict::nothing;
  const float samples = std::clamp(power_lm / limits.threshold_lm, fewest, most);
  const LampLight own = elementLightFromLamp(world_, lamp, receiver, sight,
                                             static_cast<std::uint32_t>(samples), firstLamp + number);
  tally.rays += static_cast<std::uint64_t>(samples);
  // A shadow that slips between the few spots does not slip between the samples.
  if (isUneven(own.visible)) return Verdict::refineReceiver;
  incoming.own.irradiance_lx += light(own.illuminance_lx);
  return Verdict::accept;
}

#define CLERESTORY_INSTANTIATE(K) template class EnteringLight<K>;
CLERESTORY_TRANSPORT_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
