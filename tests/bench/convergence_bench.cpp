// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's section 4 and Figures 2 to 5: the global error of shooting and gathering against the threshold,
// what both take for it, the two oracles, and the error of each step beside equation 9. Writes CSV.
#include <CLI/CLI.hpp>

#include <fstream>
#include <iostream>

#include <geometry/parallel.hpp>

#include "probes.hpp"
#include "tableroom.hpp"

namespace clerestory {
namespace {

struct Options {
  std::filesystem::path folder = ".";
  std::size_t points = 2000;
  std::uint32_t rays = 1024;
  std::size_t cachedLinks = 1 << 20;  ///< 16 MiB, as a study has
  double longest_s = 2.0;             ///< CPU time of a run that ends a sweep
  double shortest_s = 0.3;            ///< runs that take less are timed three times
  double stepsEpsilon = 3e-5;
};

struct Tables {
  std::ofstream runs, steps, bound;

  explicit Tables(const std::filesystem::path& folder)
      : runs(folder / "convergence.csv"), steps(folder / "steps.csv"), bound(folder / "bound.csv") {
    runs << "scene,oracle,method,epsilon,error_pct,surfaces_pct,cpu_seconds,links,links_largest_step,"
            "visibility_tests,"
            "elements,iterations,link_bytes\n";
    steps << "scene,method,epsilon,iteration,links_required,links_reused,reused_pct\n";
    bound << "scene,method,epsilon,iteration,quantity,percent\n";
  }
};

struct Scene {
  std::string name;
  const LitRoom& room;
  const Probes& probes;
  PartialSums truth;

  [[nodiscard]] double percent(double distance_lm_m2) const {
    return 100.0 * distance_lm_m2 / norm(truth.limit);
  }
};

struct Method {
  const char* name;
  std::function<Run(const TransportSettings&)> run;
};

/// The sweep's elements end where the threshold ends them, not at a least size.
TransportSettings settingsFor(Oracle oracle, double epsilon) {
  TransportSettings settings;
  settings.oracle = oracle;
  settings.epsilon = static_cast<float>(epsilon);
  settings.elementMin_m = 0.01F;
  settings.endShare = 1e-3;
  return settings;
}

void writeRun(const Scene& scene, const char* oracle, const Method& method, double epsilon, const Run& run,
              double cpu_s, Tables& tables) {
  const double error =
      scene.percent(distance(scene.probes.reflected(run.solved.radiosity), scene.truth.limit));
  const Errors means = errorsOf(measure(scene.room.stage, {run.solved.radiosity}), scene.truth.surfaces);
  const IterationStatistics sum = run.total();
  std::uint64_t largest = 0;
  std::uint64_t stored = sum.linksCached;
  for (const IterationStatistics& row : run.solved.statistics) largest = std::max(largest, row.linksRequired);
  if (method.name == std::string("gathering")) stored = largest;  // the last step's are stored too
  tables.runs << scene.name << ',' << oracle << ',' << method.name << ',' << epsilon << ',' << error << ','
              << 100.0 * means.surfaces << ',' << cpu_s << ',' << sum.linksRequired << ',' << largest << ','
              << sum.visibilityTests << ',' << sum.elements << ',' << run.solved.statistics.size() << ','
              << stored * sizeof(CachedLink) << std::endl;
  for (const IterationStatistics& row : run.solved.statistics) {
    if (std::string(oracle) != "transported power" || row.linksRequired <= 1) continue;
    tables.steps << scene.name << ',' << method.name << ',' << epsilon << ',' << row.iteration << ','
                 << row.linksRequired << ',' << row.linksReused << ','
                 << 100.0 * static_cast<double>(row.linksReused) / static_cast<double>(row.linksRequired)
                 << std::endl;
  }
}

void sweep(const Scene& scene, Oracle oracle, const Method& method, const Options& options, Tables& tables) {
  const char* name = oracle == Oracle::error ? "error" : "transported power";
  for (double epsilon = 1e-2; epsilon > 1e-8; epsilon *= 0.5) {
    Run run = method.run(settingsFor(oracle, epsilon));
    double cpu_s = run.seconds.cpu;
    for (int again = 0; again < 2 && cpu_s < options.shortest_s; ++again)
      cpu_s = std::min(cpu_s, method.run(settingsFor(oracle, epsilon)).seconds.cpu);
    writeRun(scene, name, method, epsilon, run, cpu_s, tables);
    if (run.seconds.cpu > options.longest_s) return;
  }
}

/// One transport of an iteration as the probes see it. All in lm/m².
struct Step {
  double error;       ///< of HR(ε, B) against T B of the same B, by rays
  double sumError;    ///< of the iterate against the sum over as many reflections
  double limitError;  ///< of the iterate against the limit
};

/// Iterates B <- B + HR(ε, ΔB) (shooting, equations 5 to 7) or B <- E + HR(ε, B) (gathering, section 4.2)
/// and looks at each step.
std::vector<Step> followSteps(const Scene& scene, bool isShooting, const TransportSettings& settings) {
  const LitRoom& room = scene.room;
  SolvedDomain<1> solved(room.world, room.domain(), room.tree());
  const Hierarchy& tree = solved.radiosity.tree;
  LinkCache cache(unlimitedLinks * sizeof(CachedLink));
  Transport<1> transport(room.stage.outside, room.domain(), solved.radiosity, settings, cache,
                         Links::madeAnew);
  std::vector<Columns<1>> sent = solved.emission();
  transport.setFirstLight((transport.powerOf(sent) + transport.enteringPower_lm())[0]);

  std::vector<Step> steps;
  PointValues sum(scene.probes.size());
  for (std::size_t n = 1; n < scene.truth.partial.size(); ++n) {
    // The light from outside comes with the first step of shooting and with every step of gathering.
    const bool isFirst = n == 1;
    Twice truth = isFirst ? scene.probes.direct() : scene.probes.transported(tree, sent);
    if (!isFirst && !isShooting) {
      for (std::size_t half = 0; half < 2; ++half) {
        for (std::size_t i = 0; i < sum.size(); ++i) truth[half][i] += scene.probes.direct()[half][i];
      }
      const std::vector<Columns<1>> emission = solved.emission();
      for (std::size_t i = 0; i < sent.size(); ++i) sent[i] += emission[i];
    }
    transport.send(sent, isFirst || !isShooting);
    transport.handOverLinks(1.0F);
    const auto& received = transport.received();
    const PointValues brought =
        scene.probes.reflected(tree, [&](NodeIndex leaf) { return received[leaf].irradiance_lx[0]; });
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = (isShooting ? sum[i] : 0.0) + brought[i];
    sent.assign(tree.size(), {});
    for (NodeIndex node = 0; node < tree.size(); ++node) {
      if (tree.isLeaf(node)) sent[node] = solved.reflected(node, received[node].irradiance_lx);
    }
    steps.push_back(
        {distance(brought, truth), distance(sum, scene.truth.partial[n]), distance(sum, scene.truth.limit)});
  }
  return steps;
}

/// Equation 9 (shooting) and 8 (gathering) with the largest error of a step as δ_HR and the largest
/// reflectance as τ, which bounds the norm of T in the mean square. Emission is even over a side, so δ_E is
/// 0.
void writeBound(const Scene& scene, const Method& method, const Options& options, Tables& tables) {
  const bool isShooting = method.name == std::string("shooting");
  const std::vector<Step> steps =
      followSteps(scene, isShooting, settingsFor(Oracle::transportedPower, options.stepsEpsilon));
  const double series = 1.0 / (1.0 - scene.probes.largestReflectance());
  double largest = 0.0;
  double allSteps = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    largest = std::max(largest, steps[i].error);
    allSteps = isShooting ? allSteps + steps[i].error : largest;
    const double bound = (isShooting ? static_cast<double>(i + 1) : 1.0) * largest * series;
    const auto write = [&](const char* quantity, double distance_lm_m2) {
      tables.bound << scene.name << ',' << method.name << ',' << options.stepsEpsilon << ',' << i + 1 << ','
                   << quantity << ',' << scene.percent(distance_lm_m2) << std::endl;
    };
    write("bound by the largest step", bound);
    write("bound by the sum of the steps", allSteps * series);
    write("error against the partial sum", steps[i].sumError);
    write("error of the step alone", steps[i].error);
    write("error against the limit", steps[i].limitError);
  }
}

void measureScene(const std::string& name, const LitRoom& room, const Options& options, Tables& tables) {
  const Probes probes(room, options.rays);
  const PlainSettings rival{0.15F, 512, 4, {60.0F, 4.0F}, 1e-5};
  const Scene scene{name, room, probes, truthAt(probes, room, rival, 12)};
  std::cout << name << ": " << room.building.model.pieces.size() << " polygons, " << probes.size()
            << " points; largest reflectance " << probes.largestReflectance() << std::endl;
  const Method shooting{"shooting", [&](const TransportSettings& settings) {
                          return shoot(room, settings, options.cachedLinks);
                        }};
  const Method gathering{"gathering",
                         [&](const TransportSettings& settings) { return gatherByLinks(room, settings); }};
  sweep(scene, Oracle::transportedPower, shooting, options, tables);
  sweep(scene, Oracle::transportedPower, gathering, options, tables);
  sweep(scene, Oracle::error, shooting, options, tables);
  writeBound(scene, shooting, options, tables);
  writeBound(scene, gathering, options, tables);
}

}  // namespace
}  // namespace clerestory

int main(int argc, char** argv) {
  using namespace clerestory;
  Options options;
  int threads = 0;
  CLI::App app("error, time and links of shooting and gathering");
  app.add_option("--folder", options.folder, "where convergence.csv, steps.csv and bound.csv are written");
  app.add_option("--points", options.points, "where the error is measured");
  app.add_option("--rays", options.rays, "of each point, for the truth, twice");
  app.add_option("--longest", options.longest_s, "CPU seconds of a run that ends a sweep");
  app.add_option("--bound-epsilon", options.stepsEpsilon, "threshold of the runs beside equation 9");
  app.add_option("--threads", threads, "0: all");
  CLI11_PARSE(app, argc, argv);
  Tables tables(options.folder);
  withThreads(threads, [&] {
    const std::filesystem::path furnished =
        std::filesystem::path(CLERESTORY_TEST_DATA) / "reference/furnished/furnished.obj";
    const std::filesystem::path office = std::filesystem::path(CLERESTORY_SAMPLES) / "office/office.glb";
    measureScene("room with a table", LitRoom(tableRoom(), {}, LitRoom::Light::panels, options.points),
                 options, tables);
    measureScene("furnished office by day", LitRoom(furnished, LitRoom::Light::sky, options.points), options,
                 tables);
    measureScene("sample office by its panels", LitRoom(office, LitRoom::Light::panels, options.points),
                 options, tables);
  });
  return tables.runs && tables.steps && tables.bound ? 0 : 1;
}
