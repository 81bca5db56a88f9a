// SPDX-License-Identifier: GPL-3.0-or-later
// Judges light from luminaires at a few points of a receiver, and brings it by rays to points of their
// openings.
#include "lamplight.hpp"

#include <algorithm>
#include <limits>

#include <geometry/sampling.hpp>

#include "world.hpp"

namespace clerestory {
namespace {

/// Radius / distance of an element above which points of it may miss a beam: then the beam's greatest
/// intensity counts as its rise.
constexpr float beamApart = 0.12F;
constexpr float gapLeast_m = 1e-3F;

/// A bound of the light of anything in the receiver's sphere, whichever way it looks.
float bound_lx(const Lamp& lamp, const Receiver& receiver) {
  const float distance_m = glm::length(lamp.position() - receiver.centre);
  const float gap_m = std::max(distance_m - receiver.radius_m - lamp.radius_m(), gapLeast_m);
  return lamp.intensityBound_cd(receiver.centre, receiver.radius_m, {}) / (gap_m * gap_m);
}

}  // namespace

LampSight lookAtLamp(const Lamp& lamp, const Receiver& receiver) {
  LampSight sight;
  if (receiver.isCluster()) {
    sight.light_lx = sight.rise_lx = bound_lx(lamp, receiver);
    return sight;
  }
  const auto isAbove = [&](const glm::vec3& corner) {
    return glm::dot(lamp.position() - corner, receiver.normal) > -lamp.radius_m();
  };
  if (!isAbove(receiver.corners[0])) return sight;
  float low = std::numeric_limits<float>::max();
  float high = 0.0F;
  const std::size_t count = quadratureCount(receiver.corners);
  for (std::size_t i = 0; i < count; ++i) {
    const float own =
        lamp.illuminance_lx(quadraturePoint(receiver.corners, receiver.centre, i), receiver.normal);
    low = std::min(low, own);
    high = std::max(high, own);
    sight.light_lx += own / static_cast<float>(count);
  }
  const float middle = lamp.illuminance_lx(receiver.centre, receiver.normal);
  const float distance_m = std::max(glm::length(lamp.position() - receiver.centre), gapLeast_m);
  sight.rise_lx = cornerRise * (std::max(high, middle) - std::min(low, middle));
  if (receiver.radius_m + lamp.radius_m() > beamApart * distance_m) {
    const float reach_m = std::max(distance_m - receiver.radius_m, 0.5F * distance_m);
    sight.rise_lx =
        std::max(sight.rise_lx, lamp.intensityBound_cd(receiver.centre, receiver.radius_m, receiver.corners) /
                                        (reach_m * reach_m) -
                                    middle);
  }
  return sight;
}

float seenOfLamp(const World& world, const Lamp& lamp, const Receiver& receiver, std::uint64_t key) {
  const Sequence sequence(mixKeys(receiver.key, key));
  float seen = 0.0F;
  for (std::uint32_t i = 0; i < spotsOfNode; ++i) {
    const glm::vec3& spot = (*receiver.spots)[i];
    const Lamp::Ray ray = lamp.ray(spot, receiver.normal, sequence(i, 0), sequence(i, 1));
    seen += world.visibility(spot, ray.from) / static_cast<float>(spotsOfNode);
  }
  return seen;
}

LampLight elementLightFromLamp(const World& world, const Lamp& lamp, const Receiver& element,
                               const LampSight& sight, std::uint32_t samples, std::uint64_t key) {
  const Sequence onLamp(mixKeys(element.key, key));
  const Sequence onElement(mixKeys(element.key, key + 1));
  const glm::vec3 lift = rayOffset_m * element.normal;
  float weights = 0.0F;
  LampLight light;
  for (std::uint32_t i = 0; i < samples; ++i) {
    const glm::vec3 point =
        pointOnPolygon<glm::vec3>(element.corners, onElement(i, 2), onElement(i, 3)) + lift;
    const Lamp::Ray ray = lamp.ray(point, element.normal, onLamp(i, 0), onLamp(i, 1));
    if (ray.weight <= 0.0F) continue;
    weights += ray.weight;
    light.visible += ray.weight * world.visibility(point, ray.from);
  }
  if (weights <= 0.0F) return light;
  light.visible /= weights;
  light.illuminance_lx = light.visible * sight.light_lx;
  return light;
}

std::array<float, 6> clusterLightFromLamp(const World& world, const Lamp& lamp, const Hierarchy& tree,
                                          NodeIndex cluster) {
  const Spots& spots = tree.spots[cluster];
  float count = 0.0F;
  float seen = 0.0F;
  for (std::size_t i = 0; i < spotsOfNode; ++i) {
    const glm::vec3& normal = tree.spotNormal(cluster, i);
    if (glm::dot(lamp.position() - spots[i], normal) <= 0.0F) continue;
    count += 1.0F;
    seen += world.visibility(spots[i] + rayOffset_m * normal, lamp.position());
  }
  std::array<float, 6> six{};
  if (count == 0.0F) return six;
  for (std::size_t k = 0; k < 6; ++k)
    six[k] = seen / count * lamp.illuminance_lx(tree.centre[cluster], sixDirections[k]);
  return six;
}

}  // namespace clerestory
