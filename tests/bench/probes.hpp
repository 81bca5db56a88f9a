// SPDX-License-Identifier: GPL-3.0-or-later
// Points of a room where methods are compared with the truth: the transport operator at each of them by rays,
// without links or elements of its own, and from it the partial sums of the light and their limit.
#pragma once

#include <array>
#include <vector>

#include "plain.hpp"
#include "runs.hpp"
#include "truth.hpp"

namespace clerestory {

/// A value of every point. [lm/m²]
using PointValues = std::vector<double>;

/// Two independent estimates of the same values.
using Twice = std::array<PointValues, 2>;

/// RMS over the points of ours − truth. The truth's two estimates are independent and without bias, so the
/// mean of (ours − a)(ours − b) is free of their noise.
inline double distance(const PointValues& ours, const Twice& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < ours.size(); ++i) sum += (ours[i] - truth[0][i]) * (ours[i] - truth[1][i]);
  return std::sqrt(std::max(sum, 0.0) / static_cast<double>(ours.size()));
}

/// Their root mean square.
inline double norm(const Twice& truth) {
  return distance(PointValues(truth[0].size(), 0.0), truth);
}

class Probes {
 public:
  /// At the places of the room's stage, which are spread evenly by area. Traces `rays` cosine rays from each,
  /// twice.
  Probes(const LitRoom& room, std::uint32_t rays) : room_(room), rays_(rays) {
    SolvedDomain<1> unlit(room.world, room.domain(), room.tree());
    reflectance_ = unlit.radiosity.reflectance;
    SolvedLight<1> emitting(room.world);
    emitting.add(room.domain(), std::move(unlit.radiosity));
    for (std::size_t half = 0; half < 2; ++half) {
      ends_[half].resize(places().size() * rays);
      direct_[half].resize(places().size());
      forEachIndex(places().size(), 8, [&](std::size_t i) {
        lightDirectly(emitting, half, i);
        trace(half, i);
      });
    }
  }

  [[nodiscard]] std::size_t size() const { return places().size(); }

  /// T E: light straight from emitters and portals, reflected once.
  [[nodiscard]] const Twice& direct() const { return direct_; }

  /// T B of the radiosity that the leaves of a tree hold, by one half of the rays.
  [[nodiscard]] PointValues transported(std::size_t half, const Hierarchy& tree,
                                        const std::vector<Columns<1>>& radiosity_lm_m2) const {
    PointValues values(size());
    forEachIndex(size(), 8, [&](std::size_t i) {
      double sum = 0.0;
      for (std::size_t ray = i * rays_; ray < (i + 1) * rays_; ++ray) {
        const RayEnd& end = ends_[half][ray];
        if (end.treeSide == noNode) continue;
        const NodeIndex leaf = tree.leafAt(tree.sides[end.treeSide].root, end.point);
        sum += static_cast<double>(end.transmittance * radiosity_lm_m2[leaf][0]);
      }
      values[i] = reflectanceAt(i) * sum / rays_;
    });
    return values;
  }
  [[nodiscard]] Twice transported(const Hierarchy& tree,
                                  const std::vector<Columns<1>>& radiosity_lm_m2) const {
    return {transported(0, tree, radiosity_lm_m2), transported(1, tree, radiosity_lm_m2)};
  }

  /// What a solution on a tree's leaves says: their irradiance, reflected.
  template <class IrradianceOf>
  [[nodiscard]] PointValues reflected(const Hierarchy& tree, const IrradianceOf& irradianceOf) const {
    PointValues values(size());
    for (std::size_t i = 0; i < size(); ++i) {
      const Place& place = places()[i];
      const NodeIndex leaf = tree.leafAt(tree.sides[place.treeSide].root, place.point);
      values[i] = reflectanceAt(i) * static_cast<double>(irradianceOf(leaf));
    }
    return values;
  }
  [[nodiscard]] PointValues reflected(const Radiosity<1>& radiosity) const {
    return reflected(radiosity.tree, [&](NodeIndex leaf) { return radiosity.irradiance_lx[leaf][0]; });
  }

  /// No reflectance in the room is larger: what bounds the transport operator's norm.
  [[nodiscard]] double largestReflectance() const {
    float largest = 0.0F;
    for (const Columns<1>& own : reflectance_) largest = std::max(largest, own[0]);
    return static_cast<double>(largest);
  }

 private:
  struct RayEnd {
    std::uint32_t treeSide = noNode;
    glm::vec3 point{0.0F};
    float transmittance = 1.0F;
  };

  [[nodiscard]] const std::vector<Place>& places() const { return room_.stage.places; }
  [[nodiscard]] double reflectanceAt(std::size_t i) const {
    return static_cast<double>(reflectance_[places()[i].treeSide][0]);
  }
  [[nodiscard]] std::uint64_t keyOf(std::size_t half, std::size_t i) const {
    return mixKeys(0x9206 + half, i);
  }

  void lightDirectly(const SolvedLight<1>& emitting, std::size_t half, std::size_t i) {
    const glm::vec3& normal = room_.tree().sides[places()[i].treeSide].normal;
    const glm::vec3 from = places()[i].point + rayOffset_m * normal;
    const DirectSamples samples{1000.0F, 50.0F};
    const std::uint64_t key = keyOf(half, i);
    const Columns<1> sum =
        directFromPortals(room_.stage.outside, room_.domain(), from, normal, samples, key).illuminance_lx +
        directFromEmitters(emitting, room_.domain(), from, normal, samples, key).illuminance_lx;
    direct_[half][i] = reflectanceAt(i) * static_cast<double>(sum[0]);
  }

  void trace(std::size_t half, std::size_t i) {
    const Hierarchy& tree = room_.tree();
    const glm::vec3& normal = tree.sides[places()[i].treeSide].normal;
    const glm::vec3 from = places()[i].point + rayOffset_m * normal;
    const Sequence sequence(keyOf(half, i));
    for (std::uint32_t ray = 0; ray < rays_; ++ray) {
      const glm::vec3 direction = cosineDirection(normal, sequence(ray, 0), sequence(ray, 1));
      const auto hit = room_.world.rays.nearest(from, direction, RayScene::Barrier::opaqueAndGlass);
      if (!hit || treeSideOf(hit.side()) == noNode) continue;
      const glm::vec3 to = from + hit.distance_m * direction;
      ends_[half][i * rays_ + ray] = {treeSideOf(hit.side()), to, room_.world.innerTransmittance(from, to)};
    }
  }

  /// The sides of a tree are in the order of the building's.
  [[nodiscard]] std::uint32_t treeSideOf(std::uint32_t side) const {
    const std::vector<TreeSide>& sides = room_.tree().sides;
    const auto found = std::lower_bound(sides.begin(), sides.end(), side,
                                        [](const TreeSide& a, std::uint32_t b) { return a.side < b; });
    const bool isThere = found != sides.end() && found->side == side;
    return isThere ? static_cast<std::uint32_t>(found - sides.begin()) : noNode;
  }

  const LitRoom& room_;
  std::uint32_t rays_;
  std::vector<Columns<1>> reflectance_;
  Twice direct_;
  std::array<std::vector<RayEnd>, 2> ends_;
};

/// What is true at the probes: the sum over n reflections for n = 0, 1, …, and its limit. And of surfaces of
/// more than 0.1 m² the mean illuminance.
struct PartialSums {
  std::vector<Twice> partial;
  Twice limit;
  Measured surfaces;
};

/// By the rival on even elements, gathered at each probe: independent of hierarchies and links.
inline PartialSums truthAt(const Probes& probes, const LitRoom& room, const PlainSettings& settings,
                           std::size_t partialSums) {
  PartialSums truth;
  truth.partial.resize(partialSums, {PointValues(probes.size()), PointValues(probes.size())});
  if (partialSums > 1) truth.partial[1] = probes.direct();
  std::vector<Measured> solved;
  for (std::size_t half = 0; half < 2; ++half) {
    const auto gather = [&](const Radiosity<1>& radiosity) {
      std::vector<Columns<1>> reflected(radiosity.tree.size());
      for (NodeIndex node = 0; node < radiosity.tree.size(); ++node) {
        if (radiosity.tree.isLeaf(node)) reflected[node] = radiosity.reflected(node);
      }
      PointValues values = probes.transported(half, radiosity.tree, reflected);
      for (std::size_t i = 0; i < values.size(); ++i) values[i] += probes.direct()[half][i];
      return values;
    };
    const AfterIteration<1> keep = [&](int iteration, const Radiosity<1>& radiosity) {
      const auto reflections = static_cast<std::size_t>(iteration) + 2;
      if (reflections < partialSums) truth.partial[reflections][half] = gather(radiosity);
    };
    const PlainSolution<1> solution = plainRadiosity(
        room.stage.outside, room.domain(), seededTree(room.stage, 0, 0x7121 + half), settings, keep);
    truth.limit[half] = gather(solution.radiosity);
    solved.push_back(measure(room.stage, {solution.radiosity}));
  }
  truth.surfaces = truthOf(solved).mean;
  return truth;
}

}  // namespace clerestory
