// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's own measurements on a model lit by its luminous panels: what the cache saves (Tables 1 and 2),
// links and their reuse in shooting and gathering (Figures 4 and 5), and how far the two differ. Prints them.
#include <CLI/CLI.hpp>

#include <iostream>
#include <limits>
#include <map>

#include <geometry/parallel.hpp>

#include "../scenes.hpp"
#include "gathering.hpp"
#include "shooting.hpp"

namespace clerestory {
namespace {

/// The domain that the panels light: the one with most emitted power.
std::int32_t litDomain(const World& world) {
  std::map<std::int32_t, double> power_lm;
  for (std::uint32_t side = 0; side < world.building.sideDomain.size(); ++side) {
    const std::int32_t domain = world.building.sideDomain[side];
    const Material& material = world.materialOf(side / 2);
    if (domain >= 0)
      power_lm[domain] += luminanceOf(material.exitance_lm_m2) * world.pieces().area_m2[side / 2];
  }
  std::int32_t best = 0;
  for (const auto& [domain, power] : power_lm) {
    if (power > power_lm[best]) best = domain;
  }
  return best;
}

Hierarchy treeOf(const World& world, std::int32_t domain) {
  std::vector<std::uint32_t> sides;
  for (std::uint32_t side = 0; side < world.building.sideDomain.size(); ++side) {
    if (world.building.sideDomain[side] == domain && !world.building.innerGlass[side / 2])
      sides.push_back(side);
  }
  return Hierarchy(world.pieces(), sides, world.rays.origin(), {});
}

struct Run {
  SolvedDomain<1> solved;
  double seconds = 0.0;

  [[nodiscard]] IterationStatistics total() const {
    IterationStatistics sum;
    for (const IterationStatistics& row : solved.statistics) {
      sum.linksRequired += row.linksRequired;
      sum.linksReused += row.linksReused;
      sum.linksCached = std::max(sum.linksCached, row.linksCached);
      sum.visibilityTests += row.visibilityTests;
      sum.elements = std::max(sum.elements, row.elements);
      sum.seconds += row.seconds;
    }
    return sum;
  }
};

struct LitScene {
  const World& world;
  SolvedLight<1> light;
  std::int32_t domain;

  explicit LitScene(const World& worldIn) : world(worldIn), light(worldIn), domain(litDomain(worldIn)) {}

  [[nodiscard]] Run shooting(const TransportSettings& settings, std::size_t cachedLinks) const {
    const Stopwatch watch;
    LinkCache cache(cachedLinks * sizeof(CachedLink));
    Run run{shootingHR(light, domain, treeOf(world, domain), settings, cache)};
    run.seconds = watch.seconds();
    return run;
  }
  [[nodiscard]] Run gathering(const TransportSettings& settings) const {
    const Stopwatch watch;
    Run run{gatheringHR(light, domain, treeOf(world, domain), settings)};
    run.seconds = watch.seconds();
    return run;
  }
};

/// Area-weighted root mean square error of the radiosity over the leaves of the finer solution, as a share of
/// the reference's area-weighted root mean square.
double globalError(const SolvedDomain<1>& coarse, const SolvedDomain<1>& reference) {
  const Hierarchy& tree = reference.radiosity.tree;
  double errors = 0.0;
  double squares = 0.0;
  for (NodeIndex node = 0; node < tree.size(); ++node) {
    if (!tree.isLeaf(node)) continue;
    const NodeIndex own = coarse.radiosity.tree.leafAt(coarse.radiosity.tree.sides[tree.treeSide[node]].root,
                                                       tree.centre[node]);
    const auto truth = static_cast<double>(reference.radiosity.reflected(node)[0]);
    const auto ours = static_cast<double>(coarse.radiosity.reflected(own)[0]);
    const auto area_m2 = static_cast<double>(tree.area_m2[node]);
    errors += area_m2 * (ours - truth) * (ours - truth);
    squares += area_m2 * truth * truth;
  }
  return std::sqrt(errors / squares);
}

void print(const std::string& what, const Run& run) {
  const IterationStatistics sum = run.total();
  std::cout << what << ": " << sum.linksRequired << " interactions, " << sum.linksReused << " reused, "
            << sum.visibilityTests << " visibility tests, " << sum.elements << " elements, "
            << run.solved.statistics.size() << " steps, " << run.seconds << " s\n";
}

void printSteps(const Run& run) {
  for (const IterationStatistics& row : run.solved.statistics)
    std::cout << row.iteration << ' ' << row.linksRequired << ' ' << row.linksCached << ' ' << row.linksReused
              << ' ' << row.visibilityTests << ' ' << row.unshotPower_lm << ' ' << row.elements << ' '
              << row.seconds << '\n';
}

}  // namespace
}  // namespace clerestory

int main(int argc, char** argv) {
  using namespace clerestory;
  std::string model = std::string(CLERESTORY_SAMPLES) + "/office/office.glb";
  double epsilon = 1e-6;
  double elementMin_m = 0.1;
  int threads = 0;
  CLI::App app("the paper's measurements");
  app.add_option("--model", model);
  app.add_option("--epsilon", epsilon);
  app.add_option("--element", elementMin_m);
  app.add_option("--threads", threads);
  CLI11_PARSE(app, argc, argv);

  Study study = studyOfModel(model);
  study.sky.diffuseHorizontal_lx = 0.0;
  study.grids.clear();
  const Building building = makeBuilding(cleanScene(readModel(model, {})), study);
  const World world(building, study);
  const LitScene scene(world);
  TransportSettings settings;
  settings.oracle = Oracle::transportedPower;
  settings.epsilon = static_cast<float>(epsilon);
  settings.elementMin_m = static_cast<float>(elementMin_m);
  settings.endShare = 1e-3;
  withThreads(threads, [&] {
    const std::size_t unlimited = std::numeric_limits<std::uint32_t>::max();
    for (const std::size_t links :
         {std::size_t{0}, std::size_t{100'000}, std::size_t{1'000'000}, unlimited}) {
      const Run run = scene.shooting(settings, links);
      print("shooting, cache " + std::to_string(links), run);
      if (links == 100'000 || links == unlimited) printSteps(run);
    }
    const Run gathered = scene.gathering(settings);
    print("gathering", gathered);
    printSteps(gathered);
    std::cout << "difference " << globalError(scene.shooting(settings, 0).solved, gathered.solved) << '\n';
  });
}
