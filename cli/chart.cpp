// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a study by several methods and settings against a reference, keeps each run as soon as it is done, and
// draws error against time, memory and links.
#include "chart.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <limits>
#include <memory>
#include <set>
#include <sstream>

#include <geometry/parallel.hpp>
#include <import/sensortable.hpp>
#include <report/chart.hpp>
#include <report/report.hpp>
#include <solver/solution.hpp>

#include "input.hpp"
#include "machine.hpp"
#include "progress.hpp"
#include "texttable.hpp"

namespace clerestory {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double smallestSurface_m2 = 0.1;
constexpr double bytesOfLink = 16.0;

struct ChartArguments {
  InputArguments input;
  fs::path folder;  ///< empty: STEM-chart in the working directory
  std::optional<fs::path> reference, points;
  double finest = 0.02;
  double longest_s = 60.0;
  int threads = 0;
  bool quiet = false;
};

/// What is computed of a study, as far as errors are taken of it.
struct Values {
  std::vector<double> sensors_lx, surfaces_lx, areas_m2;
};

Values valuesOf(const Solution& solution) {
  Values values;
  for (const GridValues& grid : solution.grids) {
    for (const SensorValue& sensor : grid.sensors) values.sensors_lx.push_back(sensor.illuminance_lx);
  }
  for (const SurfaceValue& surface : solution.surfaces) {
    if (surface.area_m2 <= smallestSurface_m2 || surface.room < 0) continue;
    values.surfaces_lx.push_back(surface.illuminanceMean_lx);
    values.areas_m2.push_back(surface.area_m2);
  }
  return values;
}

/// Area-weighted RMS of relative errors; what is darker than 5 % of the mean counts as that.
double surfacesError(const Values& ours, const Values& truth) {
  double area_m2 = 0.0;
  double mean_lx = 0.0;
  for (std::size_t i = 0; i < truth.areas_m2.size(); ++i) {
    area_m2 += truth.areas_m2[i];
    mean_lx += truth.areas_m2[i] * truth.surfaces_lx[i];
  }
  if (!(mean_lx > 0.0)) return unknown;
  mean_lx /= area_m2;
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.areas_m2.size(); ++i) {
    const double error =
        (ours.surfaces_lx[i] - truth.surfaces_lx[i]) / std::max(truth.surfaces_lx[i], 0.05 * mean_lx);
    sum += truth.areas_m2[i] * error * error;
  }
  return std::sqrt(sum / area_m2);
}

SensorTable tableOf(const Building& building, const Values& values) {
  SensorTable table;
  table.hasGrids = building.grids.size() > 1;
  std::size_t next = 0;
  for (const SensorGrid& grid : building.grids) {
    for (std::size_t i = 0; i < grid.points.size(); ++i)
      table.readings.push_back(
          {grid.points[i], std::nullopt, values.sensors_lx[next++], table.hasGrids ? grid.name : ""});
  }
  return table;
}

/// A run to be made.
struct Setting {
  std::string series, text;
  double value;
  Method method;
  double accuracy;
  SolveOptions options;
  double expected;  ///< what it takes, against a run at 5 %
};

const char* nameOf(Method method) {
  return method == Method::shooting ? "shooting" : method == Method::gathering ? "gathering" : "plain";
}

std::string percent(double fraction) {
  std::ostringstream text;
  text << 100.0 * fraction << " %";
  return text.str();
}

class Settings {
 public:
  Settings(const ChartArguments& arguments, bool knowsPlain)
      : arguments_(arguments), methods_{Method::shooting, Method::gathering} {
    if (knowsPlain) methods_.push_back(Method::plain);
    addAccuracies();
    addThreads();
    addCaches();
    addThresholds();
    addRays();
  }
  [[nodiscard]] const std::vector<Setting>& all() const { return settings_; }

 private:
  Setting& add(const std::string& series, const std::string& text, double value, Method method,
               double accuracy) {
    SolveOptions options;
    options.threads = arguments_.threads;
    options.pictures = false;
    options.method = method;
    return settings_.emplace_back(
        Setting{series, text, value, method, accuracy, options, std::pow(0.05 / accuracy, 1.3)});
  }

  void addAccuracies() {
    for (const double accuracy : {0.4, 0.28, 0.2, 0.14, 0.1, 0.07, 0.05, 0.035, 0.02, 0.014, 0.01}) {
      if (accuracy < 0.999 * arguments_.finest) break;
      for (const Method method : methods_) add("accuracy", percent(accuracy), accuracy, method, accuracy);
    }
  }
  void addThreads() {
    for (int threads = 1; threads <= processorCount(); threads *= 2)
      add("threads", std::to_string(threads), threads, Method::shooting, standard).options.threads = threads;
  }
  void addCaches() {
    for (const std::size_t kibibytes : {0, 64, 1024, 16384, 262144})
      add("cache", std::to_string(kibibytes) + " KiB", static_cast<double>(kibibytes), Method::shooting,
          standard)
          .options.linkCacheBytes = kibibytes << 10U;
  }
  /// Sensors are as fine as they get, so that what is left is the threshold's.
  void addThresholds() {
    const double finest = 5e-4 * arguments_.finest * arguments_.finest;  // well below what --finest sets
    for (float epsilon = 1e-3F; static_cast<double>(epsilon) > finest; epsilon *= 0.25F) {
      for (const Method method : {Method::shooting, Method::gathering}) {
        Setting& own =
            add("epsilon", shortest(epsilon), static_cast<double>(epsilon), method, arguments_.finest);
        own.options.epsilon = epsilon;
        own.expected *= std::pow(1e-5 / static_cast<double>(epsilon), 0.5);
      }
    }
  }
  void addRays() {
    for (std::uint32_t rays = 16; rays <= 4096; rays *= 4)
      add("rays", std::to_string(rays), rays, Method::shooting, arguments_.finest).options.sensorRays = rays;
  }
  static std::string shortest(float value) {
    std::ostringstream text;
    text << value;
    return text.str();
  }

  static constexpr double standard = 0.05;
  const ChartArguments& arguments_;
  std::vector<Method> methods_;
  std::vector<Setting> settings_;
};

/// The folder of a chart: what has been run is kept there as soon as it is known.
class ChartFolder {
 public:
  /// Opens or makes it. Throws InputError where it holds something else, or the chart of another study.
  ChartFolder(fs::path folder, const std::string& key) : folder_(std::move(folder)) {
    const std::set<std::string> own{"chart.json", "chart.csv", "chart.html", "chart.svg"};
    std::error_code failure;
    if (fs::exists(folder_) && !fs::is_directory(folder_))
      throw InputError(folder_.string() +
                       ": is a file, and a chart needs a folder; choose another name with -o");
    fs::create_directories(folder_, failure);
    if (failure)
      throw InputError(folder_.string() + ": cannot be made: " + failure.message() +
                       "; choose another with -o");
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_, failure)) {
      const std::string name = entry.path().filename().string();
      if (!own.contains(name))
        throw InputError(folder_.string() + ": holds something else than a chart (" + printable(name) +
                         "); choose another folder with -o");
    }
    state_ = Json::parse(read("chart.json"), nullptr, false);
    if (state_.is_object() && state_.value("key", "") != key)
      throw InputError(folder_.string() +
                       ": holds a chart of another study, model, reference or version; remove it, or choose "
                       "another folder with -o");
    if (!state_.is_object()) state_ = {{"key", key}};
    if (hasReference()) runs_ = readChartCsv(read("chart.csv"));
    if (runs_.empty()) write("chart.csv", chartCsvHeader());
  }

  [[nodiscard]] bool hasReference() const { return state_.contains("sensors_lx"); }
  [[nodiscard]] Values truth() const {
    return {state_.at("sensors_lx").get<std::vector<double>>(),
            state_.at("surfaces_lx").get<std::vector<double>>(),
            state_.at("areas_m2").get<std::vector<double>>()};
  }
  [[nodiscard]] ChartReference reference() const {
    return {state_.at("reference").get<std::string>(),
            state_.at("sensors_error").is_number() ? state_["sensors_error"].get<double>() : unknown};
  }
  void setReference(const ChartReference& reference, const Values& truth) {
    state_["reference"] = reference.text;
    state_["sensors_error"] = reference.sensorsError;  // NaN becomes null
    state_["sensors_lx"] = truth.sensors_lx;
    state_["surfaces_lx"] = truth.surfaces_lx;
    state_["areas_m2"] = truth.areas_m2;
    write("chart.json", state_.dump());
  }

  [[nodiscard]] const std::vector<ChartRun>& runs() const { return runs_; }
  [[nodiscard]] const ChartRun* find(const Setting& setting) const {
    const auto found = std::find_if(runs_.begin(), runs_.end(), [&](const ChartRun& run) {
      return run.series == setting.series && run.method == nameOf(setting.method) &&
             run.setting == setting.text;
    });
    return found == runs_.end() ? nullptr : &*found;
  }
  void add(const ChartRun& run) {
    runs_.push_back(run);
    std::ofstream file(folder_ / "chart.csv", std::ios::app);
    file << chartCsvRow(run) << std::flush;
    if (!file) fail("chart.csv");
  }
  /// Draws what is there, with what other programs need.
  void draw(const std::string& study, const std::vector<ChartRun>& given) const {
    std::vector<ChartRun> all = runs_;
    all.insert(all.end(), given.begin(), given.end());
    write("chart.html", chartPage(study, reference(), all));
    write("chart.svg", chartSvg(study, reference(), all));
  }
  [[nodiscard]] fs::path page() const { return folder_ / "chart.html"; }

 private:
  [[noreturn]] void fail(const std::string& name) const {
    throw MachineError((folder_ / name).string() + ": could not be written");
  }
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Whole or not at all: into a file beside it that then takes its place.
  void write(const std::string& name, const std::string& text) const {
    const fs::path partial = folder_.string() + "." + name + ".partial";
    std::ofstream file(partial, std::ios::binary | std::ios::trunc);
    file << text << std::flush;
    file.close();
    std::error_code failure;
    if (file) fs::rename(partial, folder_ / name, failure);
    if (!file || failure) {
      fs::remove(partial, failure);
      fail(name);
    }
  }

  fs::path folder_;
  Json state_;
  std::vector<ChartRun> runs_;
};

/// Solves with a setting and takes its times: the least of a few, where it is short.
Values timed(const Building& building, const Study& asked, const Setting& setting, ChartRun& run) {
  constexpr int runsMost = 3;
  constexpr double enough_s = 1.0;
  Study study = asked;
  study.accuracy = setting.accuracy;
  run = {setting.series,
         nameOf(setting.method),
         setting.text,
         setting.value,
         1e300,
         1e300,
         0.0,
         0.0,
         0.0,
         0.0,
         1,
         {},
         0.0};
  Solution solution;
  double spent_s = 0.0;
  for (int i = 0; i < runsMost && spent_s < enough_s; ++i) {
    const std::clock_t cpu = std::clock();
    const auto wall = std::chrono::steady_clock::now();
    solution = solve(building, study, setting.options);
    run.cpu_s = std::min(run.cpu_s, static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC);
    const double own_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
    run.wall_s = std::min(run.wall_s, own_s);
    spent_s += own_s;
  }
  double linksHeld = 0.0;
  for (const IterationStatistics& step : solution.iterations) {
    run.links += static_cast<double>(step.linksRequired);
    run.rays += static_cast<double>(step.visibilityTests);
    linksHeld = std::max(linksHeld, static_cast<double>(step.linksCached));
  }
  run.memory_MiB = (static_cast<double>(solution.hierarchyBytes) + bytesOfLink * linksHeld) / 0x1p20;
  run.elements = static_cast<double>(solution.elements);
  run.columns = solution.columns;
  return valuesOf(solution);
}

/// The reference of a chart's own making: shooting four times finer than its finest run. Another method at
/// the same accuracy tells how far it may be off at sensors, unless a table is given for these.
void makeReference(const Building& building, const Study& study, const ChartArguments& arguments,
                   bool knowsPlain, ChartFolder& folder, Progress& progress) {
  const double accuracy = 0.25 * arguments.finest;
  Setting setting{"reference", percent(accuracy), accuracy, Method::shooting, accuracy, {}, 0.0};
  setting.options.threads = arguments.threads;
  setting.options.pictures = false;
  setting.options.progress = [&](const std::string& stage, double fraction) {
    progress.update("the reference: " + stage, fraction);
  };
  ChartRun run;
  const Values truth = timed(building, study, setting, run);
  if (arguments.reference) {
    folder.setReference({"Reference of sensors: " + arguments.reference->filename().string() +
                             ". Of surfaces: this program's own at " + percent(accuracy) + ".",
                         unknown},
                        truth);
    return;
  }
  setting.method = setting.options.method = knowsPlain ? Method::plain : Method::gathering;
  setting.accuracy = knowsPlain ? accuracy : arguments.finest;
  const Values other = timed(building, study, setting, run);
  const double apart = errorsAgainst(other.sensors_lx, truth.sensors_lx).rms;
  folder.setReference(
      {"Reference: this program's own, by shooting at " + percent(accuracy) + "; " +
           (knowsPlain ? "plain radiosity" : "gathering") + " at " + percent(setting.accuracy) + " is " +
           percent(std::round(1e4 * apart) / 1e4) + " off it (RMS over sensors).",
       apart},
      truth);
}

ErrorFigures sensorErrors(const Building& building, const Values& own, const Values& truth,
                          const std::optional<SensorTable>& given) {
  if (!given) return errorsAgainst(own.sensors_lx, truth.sensors_lx);
  return compareTables("the study", tableOf(building, own), "the reference", *given).errors;
}

/// Runs all settings that are not there yet. A method's finer settings are left out once it has taken longer
/// than asked.
void runAll(const Building& building, const Study& study, const ChartArguments& arguments, bool knowsPlain,
            const std::optional<SensorTable>& given, ChartFolder& folder, Progress& progress) {
  const Settings settings(arguments, knowsPlain);
  const Values truth = folder.truth();
  double all = 0.0;
  for (const Setting& setting : settings.all()) all += setting.expected;
  double done = 0.0;
  std::set<std::pair<std::string, Method>> tooLong;
  for (const Setting& setting : settings.all()) {
    const auto line = std::pair(setting.series, setting.method);
    progress.update(std::string(nameOf(setting.method)) + ", " + setting.series + " " + setting.text,
                    done / all);
    done += setting.expected;
    const ChartRun* known = folder.find(setting);
    if (known == nullptr && !tooLong.contains(line)) {
      ChartRun run;
      const Values own = timed(building, study, setting, run);
      run.sensors = sensorErrors(building, own, truth, given);
      run.surfaces = surfacesError(own, truth);
      folder.add(run);
      known = &folder.runs().back();
    }
    if (known != nullptr && known->wall_s > arguments.longest_s) tooLong.insert(line);
  }
}

/// Other programs' runs: a table with the columns method,setting,cpu_s,bias_pct,rms_pct,p95_pct,max_pct.
std::vector<ChartRun> readPoints(const fs::path& file) {
  std::ifstream stream(file);
  if (!stream) throw InputError(file.string() + ": not found; check the path and its spelling");
  const std::string head = "method,setting,cpu_s,bias_pct,rms_pct,p95_pct,max_pct";
  std::string line;
  if (!std::getline(stream, line) || line.substr(0, head.size()) != head)
    throw InputError(file.string() + ": line 1: the columns have to be " + head);
  std::vector<ChartRun> runs;
  for (int number = 2; std::getline(stream, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    std::vector<std::string> fields;
    std::istringstream rest(line);
    for (std::string field; std::getline(rest, field, ',');) fields.push_back(field);
    fields.resize(7);
    // As a line of a chart's own table.
    const auto own = readChartCsv("given," + fields[0] + ',' + fields[1] + ",," + fields[2] + ",,,,,,," +
                                  fields[3] + ',' + fields[4] + ',' + fields[5] + ',' + fields[6] + ",\n");
    if (own.empty())
      throw InputError(file.string() + ": line " + std::to_string(number) + ": a number is not one");
    runs.push_back(own[0]);
  }
  return runs;
}

/// The least CPU time to an error over the runs of a method.
std::string summary(const std::vector<ChartRun>& runs) {
  TextTable table({"method", "to RMS 5 %", "2 %", "1 %", "p95 5 %", "2 %"});
  for (const char* method : {"shooting", "gathering", "plain"}) {
    std::vector<std::string> row{method};
    const auto least = [&](double asked, double ErrorFigures::*figure) {
      double found = unknown;
      for (const ChartRun& run : runs) {
        if (run.series == "accuracy" && run.method == method && run.sensors.*figure <= asked &&
            !(run.cpu_s >= found))
          found = run.cpu_s;
      }
      return found == found ? number(found, 3) + " s" : std::string("-");
    };
    for (const double asked : {0.05, 0.02, 0.01}) row.push_back(least(asked, &ErrorFigures::rms));
    for (const double asked : {0.05, 0.02}) row.push_back(least(asked, &ErrorFigures::p95));
    table.add(row);
  }
  return table.text();
}

/// What a chart's runs depend on, to know it again.
std::string keyOf(const Study& study, const ChartArguments& arguments) {
  std::ostringstream key;
  std::error_code failure;
  key << CLERESTORY_VERSION << ' ' << studyToml(study) << ' ' << fs::file_size(study.modelFile, failure)
      << ' ' << fs::last_write_time(study.modelFile, failure).time_since_epoch().count() << ' '
      << arguments.finest << ' ' << arguments.threads << ' '
      << (arguments.reference ? arguments.reference->string() : "");
  return key.str();
}

void runChart(const ChartArguments& arguments) {
  Progress progress(arguments.quiet);
  Study study = readInput(arguments.input);
  const fs::path place =
      arguments.folder.empty() ? arguments.input.file.stem().concat("-chart") : arguments.folder;
  const std::vector<ChartRun> points =
      arguments.points ? readPoints(*arguments.points) : std::vector<ChartRun>{};
  const std::optional<SensorTable> given =
      arguments.reference ? std::optional(readSensorTable(*arguments.reference)) : std::nullopt;
  ChartFolder folder(place, keyOf(study, arguments));

  std::vector<Diagnosis> diagnoses;
  Building building;
  withThreads(arguments.threads, [&] {
    building = readBuilding(study, diagnoses, [&](const std::string& step) { progress.update(step, 0.0); });
  });
  if (building.grids.empty()) throw InputError("the study has no sensors to chart; give it a [[grid]]");
  const bool knowsPlain = !study.sky.sun_deg && !study.sky.time && building.luminaires.empty();
  if (!folder.runs().empty())
    progress.line("going on: " + std::to_string(folder.runs().size()) + " runs are there already");
  if (!folder.hasReference()) makeReference(building, study, arguments, knowsPlain, folder, progress);
  runAll(building, study, arguments, knowsPlain, given, folder, progress);
  folder.draw(study.modelFile.stem().string(), points);
  progress.line("the chart is " + folder.page().string());
  printResult(folder.reference().text + "\n\n" + summary(folder.runs()));
}

}  // namespace

void addChartCommand(CLI::App& program, std::function<void()>& run) {
  const auto arguments = std::make_shared<ChartArguments>();
  CLI::App& command =
      *program.add_subcommand("chart", "Chart the error of a study against time, over methods and settings.");
  addInputArguments(command, arguments->input);
  command
      .add_option("-o,--output", arguments->folder,
                  "the chart's folder (STEM-chart in the working directory)")
      ->option_text("DIR");
  command
      .add_option(
          "--reference", arguments->reference,
          "a report or table of sensors that errors are taken against\n(the program's own finest run)")
      ->option_text("TABLE");
  command
      .add_option(
          "--points", arguments->points,
          "a table of other programs' runs to draw too, with the columns\nmethod,setting,cpu_s,bias_pct,"
          "rms_pct,p95_pct,max_pct")
      ->option_text("TABLE");
  command.add_option("--finest", arguments->finest, "the finest accuracy to run, as a fraction (0.02)")
      ->option_text("FRACTION")
      ->check(CLI::Range(0.002, 0.4));
  command
      .add_option("--longest", arguments->longest_s,
                  "a method is not run finer once a run took so many seconds (60)")
      ->option_text("SECONDS")
      ->check(CLI::PositiveNumber);
  command.add_option("--threads", arguments->threads, "how many threads compute (all)")
      ->option_text("N")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--quiet", arguments->quiet, "say nothing on standard error but what went wrong");
  command.footer(
      "Writes chart.html, chart.svg and chart.csv. Each run is kept as soon as it is done: stopped, the "
      "same\n"
      "command goes on where it was.\n\n"
      "Examples:\n"
      "  clerestory chart study.toml\n"
      "  clerestory chart study.toml --reference measured.csv --points radiance.csv");
  command.callback([arguments, &run] { run = [arguments] { runChart(*arguments); }; });
}

}  // namespace clerestory
