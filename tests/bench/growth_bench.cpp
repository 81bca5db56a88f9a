// SPDX-License-Identifier: GPL-3.0-or-later
// The same room with coarser and finer furniture (make_furniture.py): how interactions, time and the error of
// sensors at one accuracy change with the number of polygons. The truth of each model is its own, by paths.
#include <CLI/CLI.hpp>

#include <fstream>
#include <iostream>

#include <solver/solution.hpp>

#include "direct.hpp"
#include "paths.hpp"
#include "runs.hpp"

namespace clerestory {
namespace {

struct Options {
  std::vector<std::filesystem::path> models;
  std::filesystem::path folder = ".";
  double accuracy = 0.1;
  double spacing_m = 0.5;
  std::uint32_t paths = 16384;  ///< of a sensor, twice
};

/// Illuminance of a point: direct light in many samples, and reflected light by paths. [lx]
double illuminanceByPaths(const Paths<1>& paths, const LitRoom& room, const glm::vec3& point,
                          const glm::vec3& normal, std::uint32_t count, std::uint64_t key) {
  double sum_lx = 0.0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (const auto own = paths.along(point, normal, i, key)) sum_lx += static_cast<double>((*own)[0]);
  }
  const DirectLight<1> direct =
      directFromPortals(room.stage.outside, room.domain(), point, normal, {500.0F, 100.0F}, key);
  return static_cast<double>(direct.illuminance_lx[0]) + sum_lx / count;
}

/// 95th percentile and RMS of (ours − true) / max(true, 5 % of the mean), and the truth's standard error. [%]
struct SensorErrors {
  double p95 = 0.0, rms = 0.0, truth = 0.0;
};

SensorErrors errorsOfSensors(const LitRoom& room, const GridValues& ours, const Options& options) {
  const SensorGrid& grid = room.building.grids[0];
  const Paths<1> paths(room.stage.outside, room.domain(), room.tree());
  std::vector<double> halves[2];
  for (std::size_t half = 0; half < 2; ++half) {
    halves[half].resize(grid.points.size());
    forEachIndex(grid.points.size(), 1, [&](std::size_t i) {
      halves[half][i] =
          illuminanceByPaths(paths, room, room.world.local(grid.points[i]), glm::vec3(grid.normals[i]),
                             options.paths, mixKeys(0x6a1 + half, i));
    });
  }
  std::vector<double> truth, values;
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    truth.push_back(0.5 * (halves[0][i] + halves[1][i]));
    values.push_back(ours.sensors[i].illuminance_lx);
  }
  const std::vector<double> even(truth.size(), 1.0);
  SensorErrors errors;
  errors.rms = 100.0 * rmsError(values, truth, even, 0.05, &errors.p95);
  errors.p95 *= 100.0;
  errors.truth = 50.0 * rmsError(halves[0], halves[1], even, 0.05);
  return errors;
}

/// CPU time of all steps, the least of three runs.
double stepsCpu_s(const LitRoom& room, const TransportSettings& settings) {
  double least_s = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i)
    least_s = std::min(least_s, shoot(room, settings, std::size_t{1} << 20).seconds.cpu);
  return least_s;
}

void measureModel(const std::filesystem::path& file, const Options& options, std::ofstream& table) {
  Study study = studyOfModel(file);
  study.accuracy = options.accuracy;
  for (GridSettings& grid : study.grids) grid.spacing_m = options.spacing_m;
  const Watch reading;
  const Scene scene = readModel(file, {});
  const LitRoom room(scene, study, LitRoom::Light::sky, 0);
  const double before_s = reading.elapsed().cpu;
  SolveOptions solveOptions;
  solveOptions.pictures = false;
  solveOptions.threads = 1;
  const Solution solution = solve(room.building, room.study, solveOptions);
  const SensorErrors errors = errorsOfSensors(room, solution.grids.at(0), options);
  const Run run = shoot(room, transportFor(options.accuracy), std::size_t{1} << 20);
  const IterationStatistics sum = run.total();
  table << scene.faces.size() << ',' << room.building.model.pieces.size() << ',' << before_s << ','
        << sum.linksRequired << ',' << run.solved.statistics.at(0).linksRequired << ',' << sum.visibilityTests
        << ',' << sum.elements << ',' << stepsCpu_s(room, transportFor(options.accuracy)) << ',' << errors.p95
        << ',' << errors.rms << ',' << errors.truth << std::endl;
}

}  // namespace
}  // namespace clerestory

int main(int argc, char** argv) {
  using namespace clerestory;
  Options options;
  CLI::App app("growth with finer furniture");
  app.add_option("models", options.models, "of make_furniture.py")->required();
  app.add_option("--folder", options.folder, "where growth.csv is written");
  app.add_option("--accuracy", options.accuracy, "of all models; 0.1 is draft");
  app.add_option("--spacing", options.spacing_m, "of the sensors [m]");
  app.add_option("--paths", options.paths, "of a sensor, for the truth, twice");
  CLI11_PARSE(app, argc, argv);
  std::ofstream table(options.folder / "growth.csv");
  table << "polygons,pieces,before_cpu_seconds,links_required,links_first_step,visibility_tests,elements,"
           "steps_cpu_seconds,sensors_p95_pct,sensors_rms_pct,truth_pct\n";
  withThreads(1, [&] {
    for (const std::filesystem::path& model : options.models) measureModel(model, options, table);
  });
  return table ? 0 : 1;
}
