// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a study, solves its light and writes the report, saying on the way what it does.
#include "study.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <memory>
#include <sstream>

#include <geometry/defaultview.hpp>
#include <geometry/parallel.hpp>
#include <report/report.hpp>
#include <solver/solution.hpp>

#include "input.hpp"
#include "machine.hpp"
#include "progress.hpp"

namespace clerestory {

namespace {

constexpr int kMaxThreads = 1024;
constexpr std::size_t kMinMemoryBytes = std::size_t{1} << 20;

struct StudyArguments {
  InputArguments input;
  std::filesystem::path folder;  ///< empty: STEM-report in the working directory
  std::optional<double> accuracy;
  std::size_t memoryBytes = SolveOptions{}.memoryBytes;
  std::optional<std::size_t> linkCacheBytes;
  int threads = 0;
  bool noPictures = false;
  bool quiet = false;
  bool json = false;
  std::string commandLine;
};

/// How long each stage of a run took.
class StageClock {
 public:
  /// Ends the stage that runs and begins the next.
  void begin(const std::string& stage) {
    end();
    stage_ = stage;
    start_ = std::chrono::steady_clock::now();
  }
  void end() {
    if (!stage_.empty()) {
      const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start_;
      stageSeconds_.emplace_back(stage_, time.count());
      stage_.clear();
    }
  }
  [[nodiscard]] const std::vector<std::pair<std::string, double>>& stageSeconds() const {
    return stageSeconds_;
  }

 private:
  std::string stage_;
  std::chrono::steady_clock::time_point start_;
  std::vector<std::pair<std::string, double>> stageSeconds_;
};

// "512", "64K", "16M", "4G" or "1.5G" in bytes, by powers of 1024.
std::size_t parseSize(const std::string& option, const std::string& text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  auto [rest, error] = std::from_chars(text.data(), end, number, std::chars_format::fixed);
  double unit = 1.0;
  if (error == std::errc{} && rest + 1 == end) {
    const std::size_t power = std::string_view("KkMmGg").find(*rest);
    unit = power == std::string_view::npos ? 0.0 : std::ldexp(1.0, 10 * (static_cast<int>(power) / 2 + 1));
    ++rest;
  }
  if (error != std::errc{} || rest != end || unit == 0.0 || !std::isfinite(number) || number < 0.0) {
    throw CLI::ValidationError(option,
                               "\"" + text + "\" is no size; write bytes, or a number with K, M or G: 4G");
  }
  const double bytes = number * unit;
  if (bytes > 0x1p60) {
    throw CLI::ValidationError(option, "\"" + text + "\" is more than any machine has");
  }
  return static_cast<std::size_t>(bytes);
}

int parseThreads(const std::string& text) {
  int threads = -1;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, threads);
  if (error != std::errc{} || rest != end || threads < 0 || threads > kMaxThreads) {
    throw CLI::ValidationError("--threads", "\"" + text + "\" is no number of threads; write 1 to " +
                                                std::to_string(kMaxThreads) + ", or 0 for all");
  }
  return threads;
}

// One grid of study.json in a line for the person who waits.
std::string gridSummary(const nlohmann::json& grid) {
  const bool daylightFactor = grid.contains("daylight_factor_pct");
  const nlohmann::json& figures = grid.at(daylightFactor ? "daylight_factor_pct" : "illuminance_lx");
  if (!figures.at("mean").is_number() || !figures.at("median").is_number()) {
    return "no figures";
  }
  std::ostringstream text;
  text << std::fixed << std::setprecision(daylightFactor ? 2 : 0)
       << (daylightFactor ? "daylight factor" : "illuminance") << " mean " << figures["mean"].get<double>()
       << (daylightFactor ? " %" : " lx") << ", median " << figures["median"].get<double>()
       << (daylightFactor ? " %" : " lx") << ", " << grid.at("sensors").get<std::size_t>() << " sensors";
  return text.str();
}

// Tells each room's figures as study.json has them.
void showSummary(const std::string& studyJson, Progress& progress) {
  const nlohmann::json study = nlohmann::json::parse(studyJson);
  for (const nlohmann::json& room : study.at("rooms")) {
    for (const nlohmann::json& grid : room.at("grids")) {
      progress.line(room.at("name").get<std::string>() + ", " + grid.at("name").get<std::string>() + ": " +
                    gridSummary(grid));
    }
  }
  for (const nlohmann::json& grid : study.at("grids_outside_rooms")) {
    progress.line(grid.at("name").get<std::string>() + ": " + gridSummary(grid));
  }
}

SolveOptions solveOptionsOf(const StudyArguments& arguments, Progress& progress) {
  SolveOptions options;
  options.threads = arguments.threads;
  options.memoryBytes = arguments.memoryBytes;
  options.linkCacheBytes =
      arguments.linkCacheBytes.value_or(std::min(options.linkCacheBytes, arguments.memoryBytes / 2));
  options.pictures = !arguments.noPictures;
  options.progress = [&progress](const std::string& stage, double fraction) {
    progress.update(stage, fraction);
  };
  return options;
}

// A model alone gets a picture too.
void assumeView(Study& study, const Building& building, Progress& progress) {
  const std::optional<ViewSettings> view = defaultView(building);
  if (!view) return;
  study.views.push_back(*view);
  study.assumptions.push_back("The view into \"" + view->name +
                              "\" is from where most of it is seen, at eye height.");
  progress.line("assumed: " + study.assumptions.back());
}

void runStudy(const StudyArguments& arguments) {
  const std::filesystem::path folder =
      arguments.folder.empty() ? arguments.input.file.stem().concat("-report") : arguments.folder;
  checkReportFolder(folder);
  if (!arguments.noPictures) {
    checkDisplay();
  }

  Progress progress(arguments.quiet);
  StageClock clock;
  const auto begin = [&](const std::string& stage) {
    clock.begin(stage);
    progress.update(stage, 0.0);
  };
  std::vector<Diagnosis> diagnoses;
  std::size_t shown = 0;
  const auto showWarnings = [&] {
    for (; shown < diagnoses.size(); ++shown) {
      progress.line("warning: " + warningText(diagnoses[shown]));
    }
  };

  Study study = readInput(arguments.input);
  if (arguments.accuracy) {
    study.accuracy = *arguments.accuracy;
  }
  for (const std::string& assumption : study.assumptions) {
    progress.line("assumed: " + assumption);
  }
  Building building;
  withThreads(arguments.threads, [&] { building = readBuilding(study, diagnoses, begin); });
  showWarnings();
  if (!isStudyFile(arguments.input.file) && !arguments.noPictures) assumeView(study, building, progress);

  clock.begin("solving");
  const SolveOptions options = solveOptionsOf(arguments, progress);
  const Solution solution = solve(building, study, options);
  for (const Diagnosis& diagnosis : solution.diagnoses) {
    addDiagnosis(diagnoses, diagnosis);
  }
  showWarnings();
  clock.end();

  progress.update("writing the report", 1.0);
  const ReportInput report{.study = study,
                           .building = building,
                           .solution = solution,
                           .diagnoses = diagnoses,
                           .run = {.version = CLERESTORY_VERSION,
                                   .commandLine = arguments.commandLine,
                                   .threads = options.threads > 0 ? options.threads : processorCount(),
                                   .linkCacheBytes = options.linkCacheBytes,
                                   .stageSeconds = clock.stageSeconds(),
                                   .peakMemoryBytes = peakMemoryBytes()},
                           .pictures = options.pictures};
  writeReport(folder, report);

  const std::string result = studyJson(report);
  showSummary(result, progress);
  if (!diagnoses.empty()) {
    progress.line(std::to_string(diagnoses.size()) + (diagnoses.size() == 1 ? " warning" : " warnings") +
                  ", listed in the report");
  }
  progress.line("the report is " + (folder / "index.html").string());
  if (arguments.json) {
    printResult(result);
  }
}

void checkAgreement(const StudyArguments& arguments) {
  if (arguments.memoryBytes < kMinMemoryBytes) {
    throw CLI::ValidationError("--memory", "at least 1M is needed");
  }
  if (arguments.linkCacheBytes && *arguments.linkCacheBytes > arguments.memoryBytes) {
    throw CLI::ValidationError("--link-cache", "the cache is part of --memory and cannot be larger");
  }
}

}  // namespace

void addStudyCommand(CLI::App& program, const std::string& commandLine, std::function<void()>& run) {
  const auto arguments = std::make_shared<StudyArguments>();
  arguments->commandLine = commandLine;
  CLI::App& command =
      *program.add_subcommand("study", "Compute the light of a study or a model, and write the report.");
  addInputArguments(command, arguments->input);
  command
      .add_option("-o,--output", arguments->folder,
                  "the report's folder (STEM-report in the working directory)")
      ->option_text("DIR");
  command
      .add_option_function<std::string>(
          "--accuracy",
          [arguments](const std::string& text) {
            arguments->accuracy = parseAccuracy(text);
            if (!arguments->accuracy) {
              throw CLI::ValidationError(
                  "--accuracy", "\"" + text + "\" is none of draft, standard, fine or a percentage like 5%");
            }
          },
          "largest error of 95 in 100 sensors: 5%, or draft (10%),\nstandard (5%), fine (2%) (the study's, "
          "else standard)")
      ->option_text("ACCURACY");
  command
      .add_option_function<std::string>(
          "--threads", [arguments](const std::string& text) { arguments->threads = parseThreads(text); },
          "how many threads compute; the results do not depend on it (all)")
      ->option_text("N");
  command
      .add_option_function<std::string>(
          "--memory",
          [arguments](const std::string& text) { arguments->memoryBytes = parseSize("--memory", text); },
          "limit of the elements and the cache; past it the light is complete\nat the accuracy reached, and "
          "the report says so (4G)")
      ->option_text("SIZE");
  command
      .add_option_function<std::string>(
          "--link-cache",
          [arguments](const std::string& text) {
            arguments->linkCacheBytes = parseSize("--link-cache", text);
          },
          "memory for links that are kept; the results do not depend on it (16M)")
      ->option_text("SIZE");
  command.add_flag("--no-pictures", arguments->noPictures,
                   "leave out the views, and plans as files of their own");
  command.add_flag("--quiet", arguments->quiet, "say nothing on standard error but what went wrong");
  command.add_flag("--json", arguments->json, "print study.json on standard output too");
  command.footer(
      "The report holds index.html, sensors.csv, surfaces.csv, rooms.csv, iterations.csv, study.json, "
      "run.json\nand scene.glb; pictures in EXR and PNG, in the colours of the OpenColorIO config that OCIO "
      "names, where it\nnames one.\n"
      "A folder that holds something else than a report is refused; an older report is replaced when the new "
      "one\n"
      "is complete. SIZE is in bytes or with K, M or G.\n\n"
      "Examples:\n"
      "  clerestory study office.glb                     overcast sky of 10,000 lx, a grid 0.85 m above each "
      "floor\n"
      "  clerestory study plan.obj --units mm            a model that was drawn in millimetres\n"
      "  clerestory study study.toml --accuracy draft    a first look in a fraction of the time\n"
      "  clerestory study study.toml -o east --json --quiet > east.json");
  command.callback([arguments, &run] {
    checkAgreement(*arguments);
    run = [arguments] { runStudy(*arguments); };
  });
}

}  // namespace clerestory
