// SPDX-License-Identifier: GPL-3.0-or-later
// A scene set up for methods to be compared on: its outside solved, its rooms' trees bare, and the places
// where a solution is looked up.
#pragma once

#include <cmath>
#include <iostream>
#include <numbers>
#include <set>

#include <geometry/parallel.hpp>
#include <geometry/sampling.hpp>

#include "outside.hpp"
#include "shooting.hpp"
#include "surfaces.hpp"

namespace clerestory {

/// A point on a side of a room's tree.
struct Place {
  std::size_t domain;  ///< index into Stage::domains
  std::uint32_t treeSide;
  glm::vec3 point;
};

/// Smaller surfaces are not compared.
inline constexpr double smallestSurface_m2 = 0.1;

/// Illuminances that two solutions of one stage are compared by.
struct Measured {
  std::vector<std::uint32_t> surface;       ///< those of more than that, by number
  std::vector<double> area_m2, surface_lx;  ///< theirs; area 0: not compared
  std::vector<double> place_lx;
};

template <int K>
struct Stage {
  SolvedLight<K> outside;
  std::vector<std::int32_t> domains;
  std::vector<Hierarchy> trees;  ///< #domains
  std::vector<Place> places;

  [[nodiscard]] const World& world() const { return outside.world(); }
};

inline std::vector<std::uint32_t> sidesOf(const Building& building, std::int32_t domain) {
  std::vector<std::uint32_t> sides;
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
    if (building.sideDomain[side] == domain && !building.innerGlass[side / 2]) sides.push_back(side);
  }
  return sides;
}

/// Whether a point of a side is open to its air: at most half of its rays end in something that stands on it.
inline bool isOpenTo(const World& world, std::int32_t domain, const glm::vec3& point, const glm::vec3& normal,
                     std::uint64_t key) {
  constexpr std::uint32_t count = 64;
  const Sequence sequence(key);
  std::uint32_t inDomain = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::vec3 direction = cosineDirection(normal, sequence(i, 0), sequence(i, 1));
    const auto hit =
        world.rays.nearest(point + rayOffset_m * normal, direction, RayScene::Barrier::opaqueAndGlass);
    if (hit && world.building.sideDomain[hit.side()] == domain) ++inDomain;
  }
  return 2 * inDomain >= count;
}

/// Places spread evenly by area over the sides of a tree. Those that furniture stands on are left out: nobody
/// sees them, and their light is next to nothing.
inline void spreadPlaces(const World& world, std::int32_t domain, const Hierarchy& tree, std::size_t number,
                         std::size_t count, std::vector<Place>& places) {
  double total_m2 = 0.0;
  for (const TreeSide& side : tree.sides) total_m2 += static_cast<double>(tree.area_m2[side.root]);
  const Sequence sequence(0xbe5c);
  double upTo_m2 = 0.0;
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < tree.sides.size(); ++i) {
    const TreeSide& side = tree.sides[i];
    upTo_m2 += static_cast<double>(tree.area_m2[side.root]);
    for (; (next + 0.5) * total_m2 < upTo_m2 * static_cast<double>(count); ++next) {
      const auto point =
          pointOnPolygon<glm::vec3>(tree.polygon(side.root), sequence(next, 0), sequence(next, 1));
      if (isOpenTo(world, domain, point, side.normal, next)) places.push_back({number, i, point});
    }
  }
}

/// Solves the outside by the program's own shooting and builds the trees of the lit rooms.
template <int K>
Stage<K> makeStage(const World& world, const Study& study, std::size_t placesPerDomain) {
  Stage<K> stage{SolvedLight<K>(world), {}, {}, {}};
  std::set<std::int32_t> rooms;
  for (const Room& room : world.building.rooms) rooms.insert(room.domain);
  for (std::int32_t domain = 0; domain < static_cast<std::int32_t>(world.building.domains.size()); ++domain) {
    const Domain& air = world.building.domains[static_cast<std::size_t>(domain)];
    const std::vector<std::uint32_t> sides = sidesOf(world.building, domain);
    if (!air.lit || sides.empty()) continue;
    if (air.open) {
      LinkCache cache(std::size_t{16} << 20);
      stage.outside.add(domain, shootingHR(stage.outside, domain, outsideTree(world, study, domain, sides),
                                           transportFor(0.01), cache)
                                    .radiosity);
    } else if (rooms.contains(domain)) {
      stage.domains.push_back(domain);
      stage.trees.emplace_back(world.pieces(), sides, world.rays.origin(), std::span<const float>());
      spreadPlaces(world, domain, stage.trees.back(), stage.domains.size() - 1, placesPerDomain,
                   stage.places);
    }
  }
  return stage;
}

/// The tree of a room whose random numbers are others for every seed; 0 leaves the program's own.
template <int K>
Hierarchy seededTree(const Stage<K>& stage, std::size_t domain, std::uint64_t seed) {
  Hierarchy tree = stage.trees[domain];
  if (seed == 0) return tree;
  // The lower half of a key is the path of division.
  for (std::uint64_t& key : tree.key) key ^= mixKey(seed) & 0xffffffff00000000U;
  return tree;
}

/// What solutions of all rooms say of surfaces and places.
template <int K>
Measured measure(const Stage<K>& stage, std::vector<Radiosity<K>> rooms) {
  const ColumnLayout& layout = stage.world().layout;
  Measured measured;
  for (const Place& place : stage.places) {
    const Radiosity<K>& room = rooms[place.domain];
    const NodeIndex leaf = room.tree.leafAt(room.tree.sides[place.treeSide].root, place.point);
    measured.place_lx.push_back(luminanceOf(layout.totalColour(room.irradiance_lx[leaf])));
  }
  SolvedLight<K> inside(stage.world());
  for (std::size_t i = 0; i < rooms.size(); ++i) inside.add(stage.domains[i], std::move(rooms[i]));
  ElementMesh mesh;
  for (const SurfaceValue& row : measureSurfaces(inside, mesh)) {
    if (row.area_m2 <= smallestSurface_m2) continue;
    measured.surface.push_back(row.surface);
    measured.area_m2.push_back(row.area_m2);
    measured.surface_lx.push_back(row.illuminanceMean_lx);
  }
  return measured;
}

/// Illuminance at a place itself: its direct light in many samples and a gather from a solution.
template <int K>
double gatherAt(const SolvedLight<K>& light, const Stage<K>& stage, const Place& place, std::uint32_t rays,
                std::uint64_t key) {
  const World& world = stage.world();
  const glm::vec3& normal = stage.trees[place.domain].sides[place.treeSide].normal;
  const std::int32_t domain = stage.domains[place.domain];
  const glm::vec3 from = place.point + rayOffset_m * normal;
  const DirectSamples samples{2000.0F, 100.0F};
  Columns<K> sum = directFromPortals(light, domain, from, normal, samples, key).illuminance_lx +
                   directFromEmitters(light, domain, from, normal, samples, key).illuminance_lx;
  const Sequence sequence(key);
  Columns<K> reflected;
  float count = 0.0F;
  for (std::uint32_t i = 0; i < rays; ++i) {
    const glm::vec3 direction = cosineDirection(normal, sequence(i, 0), sequence(i, 1));
    const auto hit = world.rays.nearest(from, direction, RayScene::Barrier::opaqueAndGlass);
    if (!hit || world.building.sideDomain[hit.side()] != domain) continue;
    const glm::vec3 to = from + hit.distance_m * direction;
    reflected += world.innerTransmittance(from, to) * light.exitance(hit, to, false);
    count += 1.0F;
  }
  if (count > 0.0F) sum += (1.0F / count) * reflected;
  return luminanceOf(world.layout.totalColour(sum));
}

/// RMS errors as fractions: of surfaces of max(true, 5 % of the mean), weighted by area; of places of
/// max(true, mean), since a place in a crack is dark and its element is not.
struct Errors {
  double surfaces = 0.0, surfacesP95 = 0.0, places = 0.0;
};

inline double rmsError(const std::vector<double>& ours, const std::vector<double>& truth,
                       const std::vector<double>& weight, double floorShare, double* p95 = nullptr) {
  double mean = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    mean += weight[i] * truth[i];
    total += weight[i];
  }
  mean /= total;
  double squares = 0.0;
  std::vector<std::pair<double, double>> sizes;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double error = (ours[i] - truth[i]) / std::max(truth[i], floorShare * mean);
    squares += weight[i] * error * error;
    sizes.emplace_back(std::abs(error), weight[i]);
  }
  if (p95 != nullptr) {
    std::sort(sizes.begin(), sizes.end());
    double upTo = 0.0;
    for (const auto& [size, own] : sizes) {
      *p95 = size;
      upTo += own;
      if (upTo >= 0.95 * total) break;
    }
  }
  return std::sqrt(squares / total);
}

inline Errors errorsOf(const Measured& ours, const Measured& truth) {
  Errors errors;
  errors.surfaces = rmsError(ours.surface_lx, truth.surface_lx, truth.area_m2, 0.05, &errors.surfacesP95);
  errors.places =
      rmsError(ours.place_lx, truth.place_lx, std::vector<double>(truth.place_lx.size(), 1.0), 1.0);
  return errors;
}

}  // namespace clerestory
