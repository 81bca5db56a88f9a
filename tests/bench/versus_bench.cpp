// SPDX-License-Identifier: GPL-3.0-or-later
// Shooting hierarchical radiosity against the plain rival: error of surfaces against time over the settings
// of both, as CSV, and the least time of each to 5, 2 and 1 %.
#include <CLI/CLI.hpp>

#include <map>

#include "front.hpp"
#include "truth.hpp"
#include "watch.hpp"

namespace clerestory {
namespace {

struct Options {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path folder = ".";
  std::string table = "versus.csv";
  int threads = 1;
  int seeds = 8;
  double longest_s = 1.0;  ///< predicted CPU time past which a setting is left out
  bool quick = false;
  bool loose = false;
  double truthSize_m = 0.1;
  std::uint32_t truthRays = 1024;
  int truthRuns = 2;
};

/// One setting of one method: means over its seeds, the errors' RMS.
struct Run {
  std::string method, setting;
  Seconds seconds;
  double directSeconds = 0.0;  ///< of it for light from portals and emitters; shooting: its first step
  double elements = 0.0, links = 0.0, rays = 0.0;
  Errors errors;
};

/// What a method says of one room, and adds to its run.
template <int K>
using Method = std::function<Radiosity<K>(std::size_t room, Hierarchy tree, Run& run)>;

template <int K>
Method<K> rivalMethod(const Stage<K>& stage, const PlainSettings& settings) {
  return [&stage, settings](std::size_t room, Hierarchy tree, Run& run) {
    PlainSolution<K> solution = plainRadiosity(stage.outside, stage.domains[room], std::move(tree), settings);
    run.directSeconds += solution.directSeconds;
    run.elements += static_cast<double>(solution.elements);
    run.rays += static_cast<double>(solution.rays);
    return std::move(solution.radiosity);
  };
}

template <int K>
Method<K> shootingMethod(const Stage<K>& stage, const TransportSettings& settings) {
  return [&stage, settings](std::size_t room, Hierarchy tree, Run& run) {
    LinkCache cache(std::size_t{16} << 20);
    SolvedDomain<K> solved = shootingHR(stage.outside, stage.domains[room], std::move(tree), settings, cache);
    if (!solved.statistics.empty()) {
      run.directSeconds += solved.statistics.front().seconds;
      run.elements += static_cast<double>(solved.statistics.back().elements);
    }
    for (const IterationStatistics& step : solved.statistics) {
      run.links += static_cast<double>(step.linksRequired);
      run.rays += static_cast<double>(step.visibilityTests);
    }
    return std::move(solved.radiosity);
  };
}

/// Runs a setting with some seeds; one that takes long has fewer.
template <int K>
Run measureRun(const Stage<K>& stage, const Truth& truth, int seeds, const std::string& name,
               const std::string& setting, const Method<K>& method) {
  constexpr double enough_s = 1.0;
  Run run{name, setting, {}, 0.0, 0.0, 0.0, 0.0, {}};
  int done = 0;
  for (; done < seeds && (done == 0 || run.seconds.cpu < enough_s); ++done) {
    std::vector<Hierarchy> trees;
    for (std::size_t i = 0; i < stage.domains.size(); ++i)
      trees.push_back(seededTree(stage, i, static_cast<std::uint64_t>(done)));
    const Watch watch;
    std::vector<Radiosity<K>> rooms;
    for (std::size_t i = 0; i < trees.size(); ++i) rooms.push_back(method(i, std::move(trees[i]), run));
    const Seconds seconds = watch.elapsed();
    run.seconds.cpu += seconds.cpu;
    run.seconds.wall += seconds.wall;
    const Errors errors = errorsOf(measure(stage, std::move(rooms)), truth.mean);
    run.errors.surfaces += errors.surfaces * errors.surfaces;
    run.errors.surfacesP95 += errors.surfacesP95 * errors.surfacesP95;
    run.errors.places += errors.places * errors.places;
  }
  // Steps know their wall time alone; of a busy machine's wall time only the shares say something.
  if (run.seconds.wall > 0.0) run.directSeconds *= run.seconds.cpu / run.seconds.wall;
  const double count = done;
  for (double* value : {&run.seconds.cpu, &run.seconds.wall, &run.directSeconds, &run.elements, &run.links,
                        &run.rays, &run.errors.surfaces, &run.errors.surfacesP95, &run.errors.places})
    *value /= count;
  for (double* value : {&run.errors.surfaces, &run.errors.surfacesP95, &run.errors.places})
    *value = std::sqrt(*value);
  return run;
}

std::string named(std::initializer_list<std::pair<double, const char*>> parts) {
  std::ostringstream text;
  for (const auto& [value, unit] : parts) text << (text.tellp() > 0 ? " " : "") << value << unit;
  return text.str();
}

using Report = std::function<void(const Run&)>;

template <int K>
void sweepRival(const Stage<K>& stage, const Truth& truth, const Options& options, const Report& report) {
  struct Direct {
    std::uint32_t points;
    DirectSamples samples;
  };
  const std::vector<Direct> directs = {
      {1, {0.0F, 0.0F}}, {1, {15.0F, 1.0F}}, {1, {60.0F, 3.0F}}, {4, {15.0F, 1.0F}}, {4, {120.0F, 6.0F}}};
  const std::vector<float> sizes = {1.6F, 1.13F, 0.8F, 0.57F, 0.4F, 0.28F, 0.2F, 0.14F, 0.1F};
  double secondsPerRay = 0.0;
  double directPerArea = 0.0;  // seconds of the last setting's direct light times the elements' area
  for (const Direct& direct : directs) {
    directPerArea = 0.0;
    for (const float size_m : sizes) {
      double elements = 0.0;
      for (std::uint32_t rays = 8; rays <= 2048; rays *= 4) {
        const double predicted_s =
            directPerArea / (static_cast<double>(size_m) * static_cast<double>(size_m)) +
            secondsPerRay * elements * rays;
        if (predicted_s > options.longest_s) break;
        const PlainSettings settings{size_m, rays, direct.points, direct.samples, 1e-3};
        const Run run = measureRun(stage, truth, options.seeds, "rival",
                                   named({{static_cast<double>(size_m), "m"},
                                          {rays, "r"},
                                          {direct.points, "p"},
                                          {static_cast<double>(direct.samples.perFormFactor), "/F"},
                                          {static_cast<double>(direct.samples.least), "least"}}),
                                   rivalMethod(stage, settings));
        elements = run.elements;
        directPerArea = run.directSeconds * static_cast<double>(size_m) * static_cast<double>(size_m);
        secondsPerRay = (run.seconds.cpu - run.directSeconds) / (elements * rays);
        report(run);
        if (options.quick && rays == 128) break;
      }
    }
  }
}

template <int K>
void sweepShooting(const Stage<K>& stage, const Truth& truth, const Options& options, const Report& report) {
  for (const double accuracy : {0.4, 0.28, 0.2, 0.14, 0.1, 0.07, 0.05, 0.035, 0.02, 0.014, 0.01}) {
    const Run run = measureRun(stage, truth, options.seeds, "shooting", named({{100.0 * accuracy, "%"}}),
                               shootingMethod(stage, transportFor(accuracy)));
    report(run);
    if (run.seconds.cpu > 4.0 * options.longest_s || (options.quick && accuracy <= 0.05)) return;
  }
}

// What shooting could do were its settings chosen apart from each other.
template <int K>
void sweepShootingLoosely(const Stage<K>& stage, const Truth& truth, const Options& options,
                          const Report& report) {
  for (const float elementMin_m : {0.64F, 0.32F, 0.16F, 0.08F, 0.04F}) {
    for (float epsilon = 1e-2F; epsilon > 1e-7F; epsilon *= 0.25F) {
      TransportSettings settings = transportFor(0.05);
      settings.epsilon = epsilon;
      settings.elementMin_m = elementMin_m;
      const Run run =
          measureRun(stage, truth, options.seeds, "shooting loose",
                     named({{static_cast<double>(epsilon), "eps"}, {static_cast<double>(elementMin_m), "m"}}),
                     shootingMethod(stage, settings));
      report(run);
      if (run.seconds.cpu > 0.25 * options.longest_s) break;
    }
  }
}

void printTargets(const std::string& scene, const std::vector<Run>& runs) {
  std::map<std::string, std::vector<TimedError>> bySurfaces;
  std::map<std::string, std::vector<TimedError>> byPlaces;
  for (const Run& run : runs) {
    bySurfaces[run.method].push_back({run.seconds.cpu, run.errors.surfaces});
    byPlaces[run.method].push_back({run.seconds.cpu, run.errors.places});
  }
  const auto print = [&](const char* what, double target,
                         std::map<std::string, std::vector<TimedError>>& by) {
    const double rival_s = secondsTo(target, frontOf(by["rival"]));
    std::cout << scene << ", " << what << " to " << 100.0 * target << " %:";
    for (const auto& [method, timed] : by) {
      const double own_s = secondsTo(target, frontOf(timed));
      std::cout << ' ' << method << ' ';
      if (std::isfinite(own_s)) {
        std::cout << own_s << " s";
      } else {
        std::cout << "not reached";
      }
      if (method != "rival" && std::isfinite(own_s) && std::isfinite(rival_s))
        std::cout << " (rival / this: " << rival_s / own_s << ')';
      std::cout << ';';
    }
    std::cout << '\n';
  };
  for (const double target : {0.05, 0.02, 0.01}) print("surfaces", target, bySurfaces);
  for (const double target : {0.1, 0.05, 0.02}) print("places", target, byPlaces);
}

template <int K>
void compare(const World& world, const Study& study, const std::string& scene, const Options& options,
             std::ostream& table) {
  std::cerr << scene << ": the outside\n";
  const auto stage = makeStage<K>(world, study, 2000);
  std::cerr << scene << ": the truth\n";
  TruthSettings settings;
  settings.rival = {static_cast<float>(options.truthSize_m), options.truthRays, 4, {240.0F, 12.0F}, 1e-5};
  settings.runs = options.truthRuns;
  const Truth truth = makeTruth(stage, scene, options.folder, settings);
  const auto& areas_m2 = truth.mean.area_m2;
  std::cout << scene << ": "
            << std::count_if(areas_m2.begin(), areas_m2.end(), [](double own_m2) { return own_m2 > 0.0; })
            << " free surfaces over 0.1 m², standard error of the truth " << 100.0 * truth.surfacesError
            << " %; " << truth.mean.place_lx.size() << " places, " << 100.0 * truth.placesError << " %\n";
  std::vector<Run> runs;
  const Report report = [&](const Run& run) {
    runs.push_back(run);
    table << scene << ',' << run.method << ',' << run.setting << ',' << options.threads << ','
          << run.seconds.cpu << ',' << run.seconds.wall << ',' << run.directSeconds << ',' << run.elements
          << ',' << run.links << ',' << run.rays << ',' << 100.0 * run.errors.surfaces << ','
          << 100.0 * run.errors.surfacesP95 << ',' << 100.0 * run.errors.places << std::endl;
  };
  sweepShooting(stage, truth, options, report);
  if (options.loose) sweepShootingLoosely(stage, truth, options, report);
  sweepRival(stage, truth, options, report);
  printTargets(scene, runs);
}

void compareOn(const std::filesystem::path& input, const Options& options, std::ostream& table) {
  const bool isStudy = input.extension() == ".toml";
  const Study study = isStudy ? readStudy(input) : studyOfModel(input);
  Scene model = readModel(study.modelFile, study.model);
  applyMaterialRules(study, model);
  const Building building = makeBuilding(cleanScene(model), study);
  const World world(building, study);
  const std::string scene = isStudy ? study.modelFile.stem().string() : input.stem().string();
  withThreads(options.threads, [&] {
    const int used = world.layout.used();
    if (used <= 1) {
      compare<1>(world, study, scene, options, table);
    } else if (used <= 2) {
      compare<2>(world, study, scene, options, table);
    } else if (used <= 4) {
      compare<4>(world, study, scene, options, table);
    } else {
      compare<8>(world, study, scene, options, table);
    }
  });
}

int run(int argc, char** argv) {
  const std::filesystem::path data = std::filesystem::path(CLERESTORY_TEST_DATA) / "reference";
  Options options;
  CLI::App app("Shooting hierarchical radiosity against plain radiosity over uniform elements");
  app.add_option("inputs", options.inputs,
                 "studies or models; the two reference rooms and the sample office");
  app.add_option("--folder", options.folder, "where the table is written and the truth is kept");
  app.add_option("--table", options.table, "its name");
  app.add_option("--threads", options.threads, "0: all");
  app.add_option("--seeds", options.seeds, "runs of a setting that its error is the RMS of");
  app.add_option("--longest", options.longest_s,
                 "CPU seconds past which settings of the rival are left out; shooting: four times that");
  app.add_option("--truth-size", options.truthSize_m, "element size of the truth [m]");
  app.add_option("--truth-rays", options.truthRays, "rays of its elements");
  app.add_option("--truth-runs", options.truthRuns, "runs that it is the mean of");
  app.add_flag("--quick", options.quick, "few settings");
  app.add_flag("--loose", options.loose, "shooting with its settings apart from each other too");
  CLI11_PARSE(app, argc, argv);
  if (options.inputs.empty()) {
    options.inputs = {data / "refoffice/refoffice.obj", data / "furnished/furnished.obj",
                      std::filesystem::path(CLERESTORY_SAMPLES) / "office/study.toml"};
  }
  std::ofstream table(options.folder / options.table);
  table << "scene,method,setting,threads,seconds,wall_seconds,direct_seconds,elements,links,rays,error_pct,"
           "p95_pct,places_pct\n";
  for (const std::filesystem::path& input : options.inputs) compareOn(input, options, table);
  return table ? 0 : 1;
}

}  // namespace
}  // namespace clerestory

int main(int argc, char** argv) {
  return clerestory::run(argc, argv);
}
