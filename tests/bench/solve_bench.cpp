// SPDX-License-Identifier: GPL-3.0-or-later
// Whole solves of the reference rooms on one thread, by accuracy: from the cleaned model to the sensors'
// values.
#include <benchmark/benchmark.h>

#include <solver/solution.hpp>

#include "../reference.hpp"
#include "../scenes.hpp"

namespace clerestory {
namespace {

// Argument: the asked accuracy in per mille.
void solveRoom(benchmark::State& state, const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(CLERESTORY_TEST_DATA) / "reference" / name;
  Study study;
  study.accuracy = static_cast<double>(state.range(0)) / 1000.0;
  std::vector<glm::dvec3> places;
  std::vector<double> truth;
  for (const ReferencePoint& point : readReference(folder / (name + "_overcast.csv"))) {
    places.emplace_back(point.place_m[0], point.place_m[1], point.place_m[2]);
    truth.push_back(point.value);
  }
  study.grids = {drawn::gridOf(places)};
  const Building building = drawn::buildingOf(readModel(folder / (name + ".obj"), {}), study);
  SolveOptions options;
  options.threads = 1;
  options.pictures = false;
  std::vector<double> ours;
  for (auto _ : state) {
    const Solution solution = solve(building, study, options);
    ours.clear();
    for (const SensorValue& sensor : solution.grids[0].sensors) ours.push_back(sensor.illuminance_lx);
    state.counters["elements"] = static_cast<double>(solution.elements);
  }
  const GridErrors errors = errorsOf(ours, truth);
  state.counters["rms_pct"] = 100.0 * errors.rms;
  state.counters["p95_pct"] = 100.0 * errors.p95;
}
BENCHMARK_CAPTURE(solveRoom, refoffice, std::string("refoffice"))
    ->Arg(100)
    ->Arg(50)
    ->Arg(20)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(solveRoom, furnished, std::string("furnished"))
    ->Arg(100)
    ->Arg(50)
    ->Arg(20)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace clerestory
