// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's section 5.4 on a large hall (make_station.py): time and memory of a given number of
// interactions with its oracle and a cache of 1,000,000 links; and the time to an error with the program's
// own settings.
#include <CLI/CLI.hpp>

#include <array>
#include <fstream>
#include <iostream>

#include <geometry/parallel.hpp>

#include "runs.hpp"
#include "truth.hpp"

namespace clerestory {
namespace {

constexpr std::size_t paperCache = 1'000'000;

/// Memory of this process from Linux's own account; 0 elsewhere. [MiB]
class Memory {
 public:
  /// The peak is that since now.
  static void forgetPeak() { std::ofstream("/proc/self/clear_refs") << 5; }
  static double now_MiB() { return read_MiB("VmRSS:"); }
  static double peak_MiB() { return read_MiB("VmHWM:"); }

 private:
  static double read_MiB(const std::string& key) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with(key)) return std::stod(line.substr(key.size())) / 1024.0;
    }
    return 0.0;
  }
};

struct Table {
  std::ofstream file;

  explicit Table(const std::filesystem::path& folder) : file(folder / "station.csv") {
    file << "oracle,setting,cpu_seconds,wall_seconds,before_mib,peak_mib,links_required,links_reused,"
            "visibility_tests,elements,iterations,surfaces_pct,elements_pct\n";
  }
  void add(const char* oracle, const std::string& setting, const Run& run, double before_MiB, double peak_MiB,
           const std::string& errors) {
    const IterationStatistics sum = run.total();
    file << oracle << ',' << setting << ',' << run.seconds.cpu << ',' << run.seconds.wall << ',' << before_MiB
         << ',' << peak_MiB << ',' << sum.linksRequired << ',' << sum.linksReused << ','
         << sum.visibilityTests << ',' << sum.elements << ',' << run.solved.statistics.size() << ',' << errors
         << std::endl;
  }
};

/// A run, with the memory that the process held before it and at most during it.
Run runInMemory(const LitRoom& room, const TransportSettings& settings, double& before_MiB,
                double& peak_MiB) {
  Memory::forgetPeak();
  before_MiB = Memory::now_MiB();
  Run run = shoot(room, settings, paperCache);
  peak_MiB = Memory::peak_MiB();
  return run;
}

void measurePaper(const LitRoom& room, TransportSettings settings, double interactions, Table& table) {
  settings.epsilon = epsilonFor(room, settings, interactions, 0.05);
  double before_MiB = 0.0;
  double peak_MiB = 0.0;
  const Run run = runInMemory(room, settings, before_MiB, peak_MiB);
  std::ostringstream setting;
  setting << settings.epsilon;
  table.add("transported power", setting.str(), run, before_MiB, peak_MiB, ",");
}

/// RMS over the finer run's leaves of the difference of radiosity, as a share of the radiosity's RMS.
double elementsError(const SolvedDomain<1>& coarse, const SolvedDomain<1>& fine) {
  const Hierarchy& tree = fine.radiosity.tree;
  double errors = 0.0;
  double squares = 0.0;
  for (NodeIndex node = 0; node < tree.size(); ++node) {
    if (!tree.isLeaf(node)) continue;
    const Hierarchy& own = coarse.radiosity.tree;
    const NodeIndex leaf = own.leafAt(own.sides[tree.treeSide[node]].root, tree.centre[node]);
    const auto truth = static_cast<double>(fine.radiosity.reflected(node)[0]);
    const double error = static_cast<double>(coarse.radiosity.reflected(leaf)[0]) - truth;
    errors += static_cast<double>(tree.area_m2[node]) * error * error;
    squares += static_cast<double>(tree.area_m2[node]) * truth * truth;
  }
  return std::sqrt(errors / squares);
}

/// Of each surface the share that something lies on: most rays from there end within 5 cm. #surfaces
std::vector<double> coveredShares(const LitRoom& room) {
  constexpr std::uint32_t points = 8;
  constexpr std::uint32_t rays = 16;
  constexpr float near_m = 0.05F;
  const Hierarchy& tree = room.stage.trees[0];
  const World& world = room.stage.world();
  std::vector<double> covered(tree.sides.size());
  forEachIndex(tree.sides.size(), 64, [&](std::size_t i) {
    const TreeSide& side = tree.sides[i];
    for (std::uint32_t n = 0; n < points; ++n) {
      const Sequence onSide(mixKeys(i, 1));
      const glm::vec3 from = pointOnPolygon<glm::vec3>(tree.polygon(side.root), onSide(n, 0), onSide(n, 1)) +
                             rayOffset_m * side.normal;
      const Sequence sequence(mixKeys(i, 2 + n));
      std::uint32_t ended = 0;
      for (std::uint32_t ray = 0; ray < rays; ++ray) {
        const auto hit =
            world.rays.nearest(from, cosineDirection(side.normal, sequence(ray, 0), sequence(ray, 1)),
                               RayScene::Barrier::opaqueAndGlass);
        ended += hit && hit.distance_m < near_m ? 1U : 0U;
      }
      covered[i] += 2 * ended > rays ? 1.0 / points : 0.0;
    }
  });
  std::map<std::uint32_t, std::array<double, 2>> sums;  // covered area, area
  for (std::size_t i = 0; i < tree.sides.size(); ++i) {
    const auto area_m2 = static_cast<double>(tree.area_m2[tree.sides[i].root]);
    auto& [own_m2, all_m2] = sums[world.pieces().surface[tree.sides[i].side / 2]];
    own_m2 += covered[i] * area_m2;
    all_m2 += area_m2;
  }
  std::vector<double> shares(sums.empty() ? 0 : sums.rbegin()->first + 1);
  for (const auto& [surface, areas] : sums) shares[surface] = areas[0] / areas[1];
  return shares;
}

/// The program's own settings, finer and finer, each against one four times finer, until surfaces agree.
/// Those of which more than a twentieth lies under others are left out: their light is a mean of what is open
/// and what is in a gap of 5 mm.
void measureAccuracy(const LitRoom& room, double asked, Table& table) {
  constexpr double coveredMost = 0.05;
  const std::vector<double> covered = coveredShares(room);
  for (const double accuracy : {0.4, 0.2, 0.1, 0.07, 0.05, 0.04, 0.03, 0.02, 0.01}) {
    double before_MiB = 0.0;
    double peak_MiB = 0.0;
    const Run run = runInMemory(room, transportFor(accuracy), before_MiB, peak_MiB);
    const Run fine = shoot(room, transportFor(accuracy / 4.0), paperCache);
    Measured truth = measure(room.stage, {fine.solved.radiosity});
    double compared_m2 = 0.0;
    double all_m2 = 0.0;
    for (std::size_t i = 0; i < truth.surface.size(); ++i) {
      all_m2 += truth.area_m2[i];
      if (covered[truth.surface[i]] > coveredMost) truth.area_m2[i] = 0.0;
      compared_m2 += truth.area_m2[i];
    }
    const double error = errorsOf(measure(room.stage, {run.solved.radiosity}), truth).surfaces;
    std::cerr << 100.0 * accuracy << " %: surfaces with " << 100.0 * compared_m2 / all_m2
              << " % of the area compared, error " << 100.0 * error << " %\n";
    std::ostringstream setting;
    setting << 100.0 * accuracy << " %";
    std::ostringstream errors;
    errors << 100.0 * error << ',' << 100.0 * elementsError(run.solved, fine.solved);
    table.add("error", setting.str(), run, before_MiB, peak_MiB, errors.str());
    if (error <= asked) return;
  }
}

}  // namespace
}  // namespace clerestory

int main(int argc, char** argv) {
  using namespace clerestory;
  std::filesystem::path model;
  std::filesystem::path folder = ".";
  double interactions = 35e6;
  double asked = 0.05;
  TransportSettings settings;
  settings.oracle = Oracle::transportedPower;
  settings.epsilon = 2e-6F;
  settings.elementMin_m = 0.3F;
  settings.endShare = 1e-3;
  int threads = 2;
  bool paperAlone = false;
  CLI::App app("time and memory of a large scene");
  app.add_option("model", model, "station.obj of make_station.py")->required();
  app.add_option("--folder", folder, "where station.csv is written");
  app.add_option("--interactions", interactions, "the threshold is chosen so that it takes about as many");
  app.add_option("--epsilon", settings.epsilon, "where the search for it starts");
  app.add_option("--element", settings.elementMin_m, "elements of a smaller radius are not divided [m]");
  app.add_option("--error", asked, "of surfaces of more than 0.1 m², area-weighted RMS");
  app.add_option("--threads", threads, "0: all");
  app.add_flag("--paper-alone", paperAlone, "not the time to an error");
  CLI11_PARSE(app, argc, argv);

  Table table(folder);
  withThreads(threads, [&] {
    const LitRoom room(model, LitRoom::Light::panels, 0);
    std::cout << room.building.model.pieces.size() << " polygons after cleaning, " << room.tree().sides.size()
              << " of them in the hall\n";
    measurePaper(room, settings, interactions, table);
    if (!paperAlone) measureAccuracy(room, asked, table);
  });
  return table.file ? 0 : 1;
}
