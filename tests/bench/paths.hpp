// SPDX-License-Identifier: GPL-3.0-or-later
// Light by paths, without elements or links: what elements of any size cannot tell, since in a narrow gap
// they mix what is open with what is covered.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

#include <geometry/parallel.hpp>
#include <geometry/sampling.hpp>
#include <solver/formfactor.hpp>

#include "shooting.hpp"
#include "sphericalpolygon.hpp"
#include "stage.hpp"

namespace clerestory {

/// Light at a point from a luminous polygon by one direction to it, whose luminance is asked for at the point
/// where it meets the polygon. Drawn by its cosine, so the mean over keys is right: a ratio of means over a
/// few samples of each polygon is some tenths of a per cent too bright or too dark. [lx]
template <int K, class Luminance>
Columns<K> byOneDirection(const glm::vec3& point, const glm::vec3& normal, std::span<const glm::vec3> polygon,
                          std::uint64_t key, Luminance&& luminance) {
  constexpr std::uint64_t drawsMost = 10000;
  const SphericalPolygon seen(point, normal, polygon);
  if (seen.solidAngle_sr() <= 0.0) return {};
  const glm::vec3 across = glm::normalize(glm::cross(polygon[1] - polygon[0], polygon.back() - polygon[0]));
  for (std::uint64_t draw = 0; draw < drawsMost; ++draw) {
    const Sequence chance(mixKeys(key, draw));
    const glm::vec3 direction = seen.direction(chance(0, 0), chance(0, 1));
    if (chance(0, 2) >= glm::dot(direction, normal)) continue;
    const float distance_m = glm::dot(polygon[0] - point, across) / glm::dot(direction, across);
    if (!(distance_m > 0.0F)) return {};
    const float perLuminance = std::numbers::pi_v<float> * pointToPolygon(point, normal, polygon);
    return perLuminance * luminance(point + distance_m * direction);
  }
  return {};
}

/// Light at points of one domain by paths that end in light from portals and emitters at each of their
/// corners. Glass reflects evenly, as in the solver. [lx]
template <int K>
class Paths {
 public:
  Paths(const SolvedLight<K>& outside, std::int32_t domain, const Hierarchy& tree)
      : outside_(outside), domain_(domain) {
    const World& world = outside.world();
    for (const Portal& portal : world.building.portals) {
      if (portal.inside == domain) portals_.push_back(portal);
    }
    for (const TreeSide& side : tree.sides) {
      const Columns<K> exitance = world.layout.template light<K>(
          world.layout.electricColumn(), world.materialOf(side.side / 2).exitance_lm_m2);
      if (world.layout.strength(exitance) > 0.0F)
        emitters_.push_back({side, std::numbers::inv_pi_v<float> * exitance});
    }
  }

  /// Light straight from portals and emitters by one ray to each, without bias.
  [[nodiscard]] Columns<K> entering(const glm::vec3& point, const glm::vec3& normal,
                                    std::uint64_t key) const {
    const World& world = outside_.world();
    Columns<K> sum;
    for (const Portal& portal : portals_) {
      const glm::vec3 inward = world.normalOf(2 * portal.piece + (portal.frontIsInside ? 0U : 1U));
      const auto polygon = world.polygon(portal.piece);
      if (glm::dot(point - polygon[0], inward) <= 0.0F) continue;
      sum += byOneDirection<K>(
          point, normal, polygon, mixKeys(key, portal.piece),
          [&](const glm::vec3& onPane) { return outside_.throughPortal(portal, point, onPane); });
    }
    for (const auto& [side, luminance] : emitters_) {
      const auto polygon = world.polygon(side.side / 2);
      if (glm::dot(point - polygon[0], side.normal) <= 0.0F) continue;
      sum += byOneDirection<K>(point, normal, polygon, mixKeys(~key, side.side), [&](const glm::vec3& there) {
        return world.visibility(point, there) * luminance;
      });
    }
    return sum;
  }

  /// Reflected light by the path of a number, which goes on with the probability of the reflectance. Nothing
  /// where no way leads to the domain's air: within something that stands there.
  [[nodiscard]] std::optional<Columns<K>> along(glm::vec3 point, glm::vec3 normal, std::uint32_t number,
                                                std::uint64_t key) const {
    const World& world = outside_.world();
    const ColumnLayout& layout = world.layout;
    Columns<K> sum;
    Columns<K> weight = layout.template property<K>(glm::dvec3(1.0));
    Sequence sequence(key);  // the first direction even over all paths, later ones by chance
    std::uint32_t index = number;
    for (std::uint32_t corner = 1; corner < 1000; ++corner) {
      glm::vec3 direction = cosineDirection(normal, sequence(index, 0), sequence(index, 1));
      auto hit = world.rays.nearest(point, direction, RayScene::Barrier::opaqueAndGlass);
      const std::uint64_t own = mixKeys(mixKeys(key, number), corner);
      const Sequence again(mixKeys(own, 7));
      // As rays in the solver, those that end in cracks are drawn again.
      for (std::uint32_t draw = 0; draw < 32 && !isInAir(hit); ++draw) {
        direction = cosineDirection(normal, again(draw, 0), again(draw, 1));
        hit = world.rays.nearest(point, direction, RayScene::Barrier::opaqueAndGlass);
      }
      if (!isInAir(hit)) return corner == 1 ? std::nullopt : std::optional(sum);
      const glm::vec3 to = point + hit.distance_m * direction;
      weight = world.innerTransmittance(point, to) * weight;
      normal = world.normalOf(hit.side());
      point = to + rayOffset_m * normal;
      weight *= layout.template property<K>(world.reflectanceOf(hit.piece));
      sum += weight * entering(point, normal, own);
      sequence = Sequence(own);
      index = 0;
      const float goesOn = std::min(layout.strength(weight), 1.0F);
      if (sequence(0, 3) >= goesOn) break;
      weight = (1.0F / goesOn) * weight;
    }
    return sum;
  }

 private:
  [[nodiscard]] bool isInAir(const RayScene::Hit& hit) const {
    return static_cast<bool>(hit) && outside_.world().building.sideDomain[hit.side()] == domain_;
  }

  struct Emitter {
    TreeSide side;
    Columns<K> luminance_cd_m2;
  };

  const SolvedLight<K>& outside_;
  std::int32_t domain_;
  std::vector<Portal> portals_;
  std::vector<Emitter> emitters_;
};

/// The room that a domain is, or holds first; -1: none.
inline std::int32_t roomOfDomain(const Building& building, std::int32_t domain) {
  const auto found = std::find_if(building.rooms.begin(), building.rooms.end(),
                                  [&](const Room& room) { return room.domain == domain; });
  return found == building.rooms.end() ? -1 : static_cast<std::int32_t>(found - building.rooms.begin());
}

/// A row of the surfaces' table by paths from points all over it.
struct PathSurface {
  double area_m2 = 0.0;
  double illuminance_lx = 0.0;
  double shut = 0.0;  ///< share of its points that see no air: something stands on them or holds them
};

/// The surfaces of all rooms in the order of their table; paths by area, about `count` in all.
template <int K>
std::vector<PathSurface> surfacesByPaths(const Stage<K>& stage, std::size_t count, std::uint64_t seed) {
  constexpr std::size_t fewest = 4096;
  const World& world = stage.world();
  std::vector<Paths<K>> rooms;
  double total_m2 = 0.0;
  std::map<std::pair<std::int32_t, std::uint32_t>, std::vector<std::array<std::uint32_t, 2>>> rows;
  for (std::uint32_t d = 0; d < stage.domains.size(); ++d) {
    const Hierarchy& tree = stage.trees[d];
    rooms.emplace_back(stage.outside, stage.domains[d], tree);
    const std::int32_t room = roomOfDomain(world.building, stage.domains[d]);
    for (std::uint32_t i = 0; i < tree.sides.size(); ++i) {
      rows[{room, world.pieces().surface[tree.sides[i].side / 2]}].push_back({d, i});
      total_m2 += static_cast<double>(tree.area_m2[tree.sides[i].root]);
    }
  }
  std::vector<PathSurface> surfaces;
  for (const auto& [row, sides] : rows) {
    PathSurface surface;
    std::vector<double> upTo_m2;
    for (const auto& [d, i] : sides) {
      surface.area_m2 += static_cast<double>(stage.trees[d].area_m2[stage.trees[d].sides[i].root]);
      upTo_m2.push_back(surface.area_m2);
    }
    const auto paths =
        std::max(fewest, static_cast<std::size_t>(static_cast<double>(count) * surface.area_m2 / total_m2));
    const std::uint64_t key = mixKeys(seed, surfaces.size());
    const Sequence sequence(key);
    std::vector<double> light_lx(paths);
    std::vector<std::uint8_t> isShut(paths);
    forEachIndex(paths, 64, [&](std::size_t n) {
      const double at_m2 = (static_cast<double>(n) + 0.5) / static_cast<double>(paths) * surface.area_m2;
      const auto place = std::lower_bound(upTo_m2.begin(), upTo_m2.end() - 1, at_m2) - upTo_m2.begin();
      const auto [d, i] = sides[static_cast<std::size_t>(place)];
      const TreeSide& side = stage.trees[d].sides[i];
      const auto number = static_cast<std::uint32_t>(n);
      const glm::vec3 point = pointOnPolygon<glm::vec3>(stage.trees[d].polygon(side.root),
                                                        sequence(number, 2), sequence(number, 3)) +
                              rayOffset_m * side.normal;
      const auto reflected = rooms[d].along(point, side.normal, number, key);
      isShut[n] = reflected ? 0 : 1;
      if (!reflected) return;
      const Columns<K> direct = rooms[d].entering(point, side.normal, mixKeys(~key, n));
      light_lx[n] = luminanceOf(world.layout.totalColour(*reflected + direct));
    });
    for (std::size_t n = 0; n < paths; ++n) {
      surface.illuminance_lx += light_lx[n] / static_cast<double>(paths);
      surface.shut += isShut[n] / static_cast<double>(paths);
    }
    surfaces.push_back(surface);
  }
  return surfaces;
}

}  // namespace clerestory
