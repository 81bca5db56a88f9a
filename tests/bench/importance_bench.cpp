// SPDX-License-Identifier: GPL-3.0-or-later
// Shooting with and without importance where few figures are asked for: the error of what the sensors get by
// reflection, against the links and the time that it takes. As CSV.
#include <CLI/CLI.hpp>

#include <algorithm>

#include "importance.hpp"
#include "plain.hpp"
#include "sensors.hpp"
#include "stage.hpp"
#include "watch.hpp"

namespace clerestory {
namespace {

/// A model, and the one grid that is asked for.
struct AskedScene {
  std::string name;
  std::filesystem::path model;
  GridSettings grid;
};

/// Illuminance of sensors by one gather, the same for every solution, so that it cancels in their
/// differences.
std::vector<double> sensed(const Stage<1>& stage, Radiosity<1> radiosity) {
  SolvedLight<1> light = stage.outside;
  light.add(stage.domains[0], std::move(radiosity));
  std::vector<double> all_lx;
  for (const SensorGrid& grid : stage.world().building.grids) {
    for (std::size_t i = 0; i < grid.points.size(); ++i) {
      const GatherSettings settings{{512.0F, 24.0F}, 2048};
      const Gathered<1> own = gather(light, stage.domains[0], stage.world().local(grid.points[i]),
                                     glm::vec3(grid.normals[i]), settings, i);
      all_lx.push_back(static_cast<double>(own.direct_lx[0] + own.reflected_lx[0]));
    }
  }
  return all_lx;
}

void measureOn(const AskedScene& scene, double truthSize_m, int seeds, std::ostream& table) {
  Study study = studyOfModel(scene.model);
  study.grids = {scene.grid};
  const Building building = makeBuilding(cleanScene(readModel(study.modelFile, study.model)), study);
  World world(building, study);
  world.layout = {true, true, false};  // daylight in luminance
  const auto stage = makeStage<1>(world, study, 0);
  if (stage.domains.size() != 1) throw std::runtime_error(scene.name + " has more rooms than one");
  const std::vector<std::uint32_t> sides = sidesOf(building, stage.domains[0]);

  const PlainSettings settings{static_cast<float>(truthSize_m), 512, 1, {120.0F, 6.0F}, 1e-4};
  const std::vector<double> truth_lx =
      sensed(stage, plainRadiosity(stage.outside, stage.domains[0], stage.trees[0], settings).radiosity);
  double mean_lx = 0.0;
  for (const double value_lx : truth_lx) mean_lx += value_lx / static_cast<double>(truth_lx.size());
  std::cerr << scene.name << ": " << truth_lx.size() << " sensors, mean " << mean_lx << " lx\n";

  for (const bool withImportance : {false, true}) {
    for (const double accuracy : {0.28, 0.2, 0.14, 0.1, 0.07, 0.05, 0.035}) {
      double squares = 0.0;
      double bias = 0.0;
      double links = 0.0;
      double elements = 0.0;
      double phase_s = 0.0;
      double cpu_s = 0.0;
      for (int seed = 0; seed < seeds; ++seed) {
        const Watch watch;
        const std::vector<float> weights =
            withImportance ? importanceOf(world, study, stage.domains[0], sides) : std::vector<float>();
        phase_s += watch.elapsed().cpu;
        Hierarchy tree(world.pieces(), sides, world.rays.origin(), weights);
        for (std::uint64_t& key : tree.key)
          key ^= seed == 0 ? 0 : mixKey(static_cast<std::uint64_t>(seed)) & 0xffffffff00000000U;
        const Watch solving;
        LinkCache cache(std::size_t{16} << 20);
        SolvedDomain<1> solved =
            shootingHR(stage.outside, stage.domains[0], std::move(tree), transportFor(accuracy), cache);
        cpu_s += solving.elapsed().cpu;
        for (const IterationStatistics& step : solved.statistics)
          links += static_cast<double>(step.linksRequired);
        elements += static_cast<double>(solved.statistics.back().elements);
        const std::vector<double> own_lx = sensed(stage, std::move(solved.radiosity));
        for (std::size_t i = 0; i < own_lx.size(); ++i) {
          const double error = (own_lx[i] - truth_lx[i]) / std::max(truth_lx[i], 0.05 * mean_lx);
          squares += error * error / static_cast<double>(own_lx.size());
          bias += error / static_cast<double>(own_lx.size());
        }
      }
      table << scene.name << ',' << (withImportance ? "with importance" : "by area") << ',' << accuracy << ','
            << links / seeds << ',' << elements / seeds << ',' << (cpu_s + phase_s) / seeds << ','
            << phase_s / seeds << ',' << 100.0 * std::sqrt(squares / seeds) << ',' << 100.0 * bias / seeds
            << std::endl;
    }
  }
}

int run(int argc, char** argv) {
  std::filesystem::path folder = ".";
  std::filesystem::path floor;
  double truthSize_m = 0.2;
  int seeds = 2;
  CLI::App app("Importance where few figures are asked for");
  app.add_option("--folder", folder, "where importance.csv is written");
  app.add_option("--floor", floor, "the model of the floor of twelve offices, if it is at hand");
  app.add_option("--truth-size", truthSize_m, "element size of the truth [m]");
  app.add_option("--seeds", seeds, "runs that a row is the mean of");
  CLI11_PARSE(app, argc, argv);
  const std::filesystem::path samples = CLERESTORY_SAMPLES;
  GridSettings table;
  table.name = "Table";
  table.spacing_m = 0.2;
  std::vector<AskedScene> scenes;
  table.polygon_m = {{8.0, 5.0}, {9.6, 5.0}, {9.6, 6.0}, {8.0, 6.0}};
  scenes.push_back({"a table in the sample office", samples / "office/office.glb", table});
  if (!floor.empty()) {
    GridSettings office;
    office.name = "One office";
    office.spacing_m = 0.5;
    office.polygon_m = {{0.5, 0.5}, {3.1, 0.5}, {3.1, 7.5}, {0.5, 7.5}};
    scenes.push_back({"one of twelve offices", floor, office});
  }
  std::ofstream csv(folder / "importance.csv");
  csv << "scene,weights,accuracy,links,elements,cpu_seconds,phase_cpu_seconds,error_pct,bias_pct\n";
  for (const AskedScene& scene : scenes) measureOn(scene, truthSize_m, seeds, csv);
  return csv ? 0 : 1;
}

}  // namespace
}  // namespace clerestory

int main(int argc, char** argv) {
  return clerestory::run(argc, argv);
}
