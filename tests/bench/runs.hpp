// SPDX-License-Identifier: GPL-3.0-or-later
// Shooting and gathering in the one room of a model, and what they took.
#pragma once

#include <limits>
#include <optional>
#include <stdexcept>

#include "gathering.hpp"
#include "stage.hpp"
#include "watch.hpp"

namespace clerestory {

/// A model with one room, lit by the sky or by its luminous panels alone, in luminance: one column, whatever
/// colours it has. The stage points into the other members.
struct LitRoom {
  enum class Light { sky, panels };

  Study study;
  Building building;
  World world;
  Stage<1> stage;

  LitRoom(const Scene& scene, const Study& studyIn, Light light, std::size_t places)
      : study(litBy(light, studyIn)),
        building(makeBuilding(cleanScene(scene), study)),
        world(building, study),
        stage(makeStage<1>(world, study, places)) {
    if (stage.domains.size() != 1)
      throw std::runtime_error(std::to_string(stage.domains.size()) + " lit rooms instead of one");
  }
  LitRoom(const std::filesystem::path& model, Light light, std::size_t places)
      : LitRoom(readModel(model, {}), withoutGrids(studyOfModel(model)), light, places) {}
  LitRoom(const LitRoom&) = delete;

  [[nodiscard]] std::int32_t domain() const { return stage.domains[0]; }
  [[nodiscard]] const Hierarchy& tree() const { return stage.trees[0]; }

 private:
  static Study withoutGrids(Study study) {
    study.grids.clear();
    return study;
  }
  static Study litBy(Light light, Study study) {
    if (light == Light::panels) study.sky.diffuseHorizontal_lx = 0.0;
    return study;
  }
};

/// A solved room, and what that took.
struct Run {
  SolvedDomain<1> solved;
  Seconds seconds;

  [[nodiscard]] IterationStatistics total() const {
    IterationStatistics sum;
    for (const IterationStatistics& row : solved.statistics) {
      sum.linksRequired += row.linksRequired;
      sum.linksReused += row.linksReused;
      sum.linksCached = std::max(sum.linksCached, row.linksCached);
      sum.visibilityTests += row.visibilityTests;
      sum.elements = std::max(sum.elements, row.elements);
    }
    return sum;
  }
};

inline constexpr std::size_t unlimitedLinks = std::numeric_limits<std::uint32_t>::max();

inline Run shoot(const LitRoom& room, const TransportSettings& settings, std::size_t cachedLinks) {
  Hierarchy tree = room.tree();
  const Watch watch;
  LinkCache cache(cachedLinks * sizeof(CachedLink));
  Run run{shootingHR(room.stage.outside, room.domain(), std::move(tree), settings, cache), {}};
  run.seconds = watch.elapsed();
  return run;
}

inline Run gatherByLinks(const LitRoom& room, const TransportSettings& settings) {
  Hierarchy tree = room.tree();
  const Watch watch;
  Run run{gatheringHR(room.stage.outside, room.domain(), std::move(tree), settings), {}};
  run.seconds = watch.elapsed();
  return run;
}

/// The threshold at which shooting takes about so many interactions, from one that takes about as many.
inline float epsilonFor(const LitRoom& room, TransportSettings settings, double interactions,
                        double tolerance) {
  for (int round = 0; round < 8; ++round) {
    const auto own = static_cast<double>(shoot(room, settings, 0).total().linksRequired);
    if (std::abs(own / interactions - 1.0) <= tolerance) break;
    settings.epsilon *= static_cast<float>(own / interactions);
  }
  return settings.epsilon;
}

}  // namespace clerestory
