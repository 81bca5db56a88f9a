// SPDX-License-Identifier: GPL-3.0-or-later
// Ways between two polygons, a packet of rays at a time, until one is as asked.
#include "otherways.hpp"

#include <algorithm>
#include <array>

#include <geometry/sampling.hpp>

namespace clerestory {

// A part v of the light is missed by n looks in (1 - v)^n of all cases, and v (1 - v)^n is 1 / (e n) at most.
bool findsWay(const World& world, const Receiver& receiver, const Target& target, Way asked, float looks,
              std::uint64_t& rays) {
  constexpr std::uint32_t together = 32;
  constexpr float looksMost = 4096.0F;
  const auto count = static_cast<std::uint32_t>(std::min(looks, looksMost));
  const Sequence sequence(mixKeys(receiver.key, target.key));
  const glm::vec3 lift = rayOffset_m * receiver.normal;
  std::array<RayScene::Segment, together> ways;
  std::array<std::uint8_t, together> blocked;
  for (std::uint32_t first = 0; first < count; first += together) {
    const std::uint32_t size = std::min(together, count - first);
    for (std::uint32_t i = 0; i < size; ++i) {
      const std::uint32_t n = first + i;
      ways[i] = {pointOnPolygon<glm::vec3>(receiver.corners, sequence(n, 0), sequence(n, 1)) + lift,
                 pointOnPolygon<glm::vec3>(target.polygon, sequence(n, 2), sequence(n, 3)) + target.lift};
    }
    const auto seen = std::span(blocked).first(size);
    world.rays.occluded(std::span(ways).first(size), RayScene::Barrier::opaque, seen);
    rays += size;
    const bool isFound = std::ranges::any_of(
        seen, [&](std::uint8_t isBlocked) { return (isBlocked == 0) == (asked == Way::open); });
    if (isFound) return true;
  }
  return false;
}

}  // namespace clerestory
