// SPDX-License-Identifier: GPL-3.0-or-later
// Finds what is looked at outdoors by sending looks from where light is asked for.
#include "outside.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include <geometry/sampling.hpp>

#include "sensors.hpp"

namespace clerestory {
namespace {

constexpr std::uint32_t looksOfPortal = 1024;
constexpr std::uint32_t looksOfPoint = 64;
constexpr double elementShare = 0.002;  // of all looks, above which an element is divided
constexpr float elementMin_m = 0.05F;

using Looks = std::map<std::uint32_t, std::vector<glm::vec3>>;  // by side: where it was met

void look(const World& world, std::int32_t domain, const glm::vec3& from, const glm::vec3& direction,
          Looks& looks) {
  const auto hit =
      world.rays.nearest(from + rayOffset_m * direction, direction, RayScene::Barrier::opaqueAndGlass);
  if (hit && world.building.sideDomain[hit.side()] == domain) {
    looks[hit.side()].push_back(from + hit.distance_m * direction);
  }
}

Looks allLooks(const World& world, const Study& study, std::int32_t domain) {
  Looks looks;
  for (const Portal& portal : world.building.portals) {
    if (portal.outside != domain) continue;
    const glm::vec3 outward = world.normalOf(2 * portal.piece + (portal.frontIsInside ? 1U : 0U));
    const Sequence sequence(mixKeys(0x100c, portal.piece));
    for (std::uint32_t i = 0; i < looksOfPortal; ++i) {
      const glm::vec3 from =
          pointOnPolygon<glm::vec3>(world.polygon(portal.piece), sequence(i, 0), sequence(i, 1));
      look(world, domain, from, cosineDirection(outward, sequence(i, 2), sequence(i, 3)), looks);
    }
  }
  const auto lookAround = [&](const glm::dvec3& place, std::uint64_t key) {
    const Sequence sequence(key);
    for (std::uint32_t i = 0; i < looksOfPoint; ++i) {
      const float z = 2.0F * sequence(i, 0) - 1.0F;
      const float angle = 2.0F * std::numbers::pi_v<float> * sequence(i, 1);
      const float radius = std::sqrt(std::max(0.0F, 1.0F - z * z));
      look(world, domain, world.local(place), {radius * std::cos(angle), radius * std::sin(angle), z}, looks);
    }
  };
  for (const SensorGrid& grid : world.building.grids) {
    const bool isInside =
        grid.room >= 0 && world.building.rooms[static_cast<std::size_t>(grid.room)].domain != domain;
    if (isInside) continue;
    for (std::size_t i = 0; i < grid.points.size(); ++i) lookAround(grid.points[i], mixKeys(0x9a1d, i));
  }
  for (std::size_t i = 0; i < study.views.size(); ++i) lookAround(study.views[i].eye_m, mixKeys(0x71e5, i));
  return looks;
}

/// Divides an element until few looks meet each part.
void divideByLooks(Hierarchy& tree, NodeIndex node, std::vector<glm::vec3> looks, std::size_t mostLooks,
                   float weightOfLook) {
  if (looks.size() <= mostLooks || tree.radius_m[node] <= elementMin_m) return;
  Halves halves = halve(tree.shape(node), tree.normal(node));
  const auto middle = std::partition(looks.begin(), looks.end(), [&](const glm::vec3& point) {
    return glm::dot(glm::vec3(halves.plane), point) + halves.plane.w <= 0.0F;
  });
  std::vector<glm::vec3> first(looks.begin(), middle);
  std::vector<glm::vec3> second(middle, looks.end());
  halves.first.weight = weightOfLook * static_cast<float>(first.size());
  halves.second.weight = weightOfLook * static_cast<float>(second.size());
  const NodeIndex child = tree.divide(node, halves.first, halves.second, halves.plane);
  divideByLooks(tree, child, std::move(first), mostLooks, weightOfLook);
  divideByLooks(tree, child + 1, std::move(second), mostLooks, weightOfLook);
}

}  // namespace

Hierarchy outsideTree(const World& world, const Study& study, std::int32_t domain,
                      std::span<const std::uint32_t> sides) {
  const Looks looks = allLooks(world, study, domain);
  std::size_t total = 0;
  for (const auto& [side, points] : looks) total += points.size();
  const auto area_m2 = static_cast<float>(world.building.domains[static_cast<std::size_t>(domain)].area_m2);
  const float weightOfLook = total > 0 ? area_m2 / static_cast<float>(total) : 0.0F;

  std::vector<float> weights;
  for (const std::uint32_t side : sides) {
    const auto found = looks.find(side);
    weights.push_back(found == looks.end() ? 0.0F : weightOfLook * static_cast<float>(found->second.size()));
  }
  Hierarchy tree(world.pieces(), sides, world.rays.origin(), weights);
  const auto mostLooks = static_cast<std::size_t>(elementShare * static_cast<double>(total)) + 1;
  for (std::size_t i = 0; i < tree.sides.size(); ++i) {
    const auto found = looks.find(tree.sides[i].side);
    if (found != looks.end()) divideByLooks(tree, tree.sides[i].root, found->second, mostLooks, weightOfLook);
  }
  return tree;
}

}  // namespace clerestory
