// SPDX-License-Identifier: GPL-3.0-or-later
// Outside first and then each room, as the program solves, beside one hierarchy of outside and rooms that is
// linked through the glass: errors of sensors against a table, and CPU time of the whole solve.
#include <CLI/CLI.hpp>

#include <filesystem>
#include <iostream>
#include <limits>
#include <vector>

#include <import/scene.hpp>
#include <solver/solution.hpp>

#include "../reference.hpp"
#include "watch.hpp"

namespace clerestory {
namespace {

struct Options {
  std::filesystem::path model, table;
  std::vector<double> accuracies{0.1, 0.05, 0.02};
  int runs = 3;
};

/// The building as one air: panes are glass within it, which passes light by its angle and mirrors none.
Building joinedThroughGlass(Building building) {
  for (const Portal& portal : building.portals) {
    building.innerGlass[portal.piece] = true;
    for (std::int32_t& domain : building.sideDomain) {
      if (domain == portal.inside) domain = portal.outside;
    }
    for (Room& room : building.rooms) {
      if (room.domain == portal.inside) room.domain = portal.outside;
    }
    Domain& outside = building.domains[static_cast<std::size_t>(portal.outside)];
    Domain& inside = building.domains[static_cast<std::size_t>(portal.inside)];
    outside.area_m2 += inside.area_m2;
    inside = {};
  }
  building.portals.clear();
  return building;
}

void measure(const std::string& name, const Building& building, const Study& study,
             const std::vector<double>& truth, int runs) {
  SolveOptions options;
  options.pictures = false;
  options.threads = 1;
  double least_s = std::numeric_limits<double>::infinity();
  std::vector<double> ours;
  for (int run = 0; run < runs; ++run) {
    const Watch watch;
    const Solution solution = solve(building, study, options);
    least_s = std::min(least_s, watch.elapsed().cpu);
    ours.clear();
    for (const SensorValue& sensor : solution.grids.at(0).sensors) ours.push_back(sensor.illuminance_lx);
  }
  const GridErrors errors = errorsOf(ours, truth);
  std::cout << "| " << name << " | " << 100.0 * study.accuracy << " % | " << least_s << " | "
            << 100.0 * errors.rms << " | " << 100.0 * errors.bias << " | " << 100.0 * errors.p95 << " |"
            << std::endl;
}

void compare(const Options& options) {
  Study study = studyOfModel(options.model);
  GridSettings grid;
  grid.name = "table";
  std::vector<double> truth;
  for (const ReferencePoint& point : readReference(options.table)) {
    grid.points.push_back({point.place_m[0], point.place_m[1], point.place_m[2], 0.0, 0.0, 1.0});
    truth.push_back(point.value);
  }
  study.grids = {grid};
  const Building parted = makeBuilding(cleanScene(readModel(options.model, study.model)), study);
  const Building joined = joinedThroughGlass(parted);
  std::cout << "| solve | asked | CPU s | RMS % | bias % | p95 % |\n|---|---|---|---|---|---|\n";
  for (const double accuracy : options.accuracies) {
    study.accuracy = accuracy;
    measure("outside first, then each room", parted, study, truth, options.runs);
    measure("one hierarchy through the glass", joined, study, truth, options.runs);
  }
}

}  // namespace
}  // namespace clerestory

int main(int argc, char** argv) {
  clerestory::Options options;
  CLI::App app("linking through the glass");
  app.add_option("model", options.model, "an OBJ in metres")->required();
  app.add_option("table", options.table, "x,y,z,lux under 10,000 lx of overcast sky")->required();
  app.add_option("--accuracy", options.accuracies, "to ask for, as fractions");
  app.add_option("--runs", options.runs, "of which the least CPU time counts");
  CLI11_PARSE(app, argc, argv);
  clerestory::compare(options);
}
