// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a report: every file into a new folder, which takes its place when all are there.
#include <functional>
#include <map>

#include <geometry/parallel.hpp>
#include <report/report.hpp>

#include "escape.hpp"
#include "falsepicture.hpp"
#include "folder.hpp"
#include "glb.hpp"
#include "image.hpp"
#include "json.hpp"
#include "page.hpp"
#include "plan.hpp"
#include "tables.hpp"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

/// What is written of a report, each in a task of its own.
using Tasks = std::vector<std::function<void()>>;

void run(const Tasks& tasks) {
  forEachIndex(tasks.size(), 1, [&](std::size_t i) { tasks[i](); });
}

/// The views that there are, exposed, before any file of them is written.
std::vector<PageView> exposedViews(const ReportInput& input) {
  std::vector<std::string> names;
  for (std::size_t v = 0; v < input.solution.views.size(); ++v) names.push_back(input.study.views.at(v).name);
  const std::vector<std::string> files = safeFileNames(names);
  std::vector<PageView> views;
  for (std::size_t v = 0; v < files.size(); ++v) {
    const LuminanceImage& image = input.solution.views[v];
    if (image.pixels_cd_m2.empty()) continue;
    const double scale = exposureScale(image, input.study.views[v].exposure_ev);
    PageView& view = views.emplace_back();
    view.index = v;
    view.name = names[v];
    view.fileName = files[v];
    view.white_cd_m2 = 1.0 / scale;
    view.exposure_ev = exposureValue(scale);
    view.width = image.width;
    view.height = image.height;
  }
  return views;
}

/// Writes a view for a display; puts the bytes of the picture with 8 bits into the page's view.
void writeDisplayed(const fs::path& folder, const ReportInput& input, const DisplayTransform& display,
                    PageView& view) {
  const fs::path png = folder / ("view-" + view.fileName + ".png");
  const std::vector<float> values =
      displayValues(input.solution.views[view.index], 1.0 / view.white_cd_m2, display);
  writePng(png, displayImage(values, view.width, view.height), Shades::smooth);
  view.png = readFile(png);
  if (input.study.views[view.index].pngBits == 16) writePng16(png, values, view.width, view.height);
}

/// A quantity in all views, in the colours of one scale.
struct FalseColours {
  std::string kind, title;
  std::vector<std::vector<float>> values;  ///< #views; empty where a view has none
  ValueScale scale;

  FalseColours(std::string file, std::string name, std::vector<std::vector<float>> ofViews, bool isLinear)
      : kind(std::move(file)), title(std::move(name)), values(std::move(ofViews)) {
    scale = valueScale({values.begin(), values.end()}, isLinear);
  }
  /// Writes it of a view; gives the file's bytes.
  [[nodiscard]] std::string write(const fs::path& folder, const PageView& view, std::size_t v) const {
    if (values[v].empty()) return {};
    const fs::path file = folder / (kind + "-" + view.fileName + ".png");
    writePng(file, falsePicture(values[v], view.width, view.height, scale, title), Shades::flat);
    return readFile(file);
  }
};

/// Writes the views as EXR and PNG with the config that leads from one to the other, and in false colours;
/// puts the PNGs' bytes into the page's views.
void writeViews(const fs::path& folder, const ReportInput& input, std::vector<PageView>& views) {
  if (views.empty()) return;
  const DisplayTransform display;
  if (display.isShipped()) writeFile(folder / "config.ocio", shippedConfig.text);
  std::vector<std::vector<float>> luminances;
  std::vector<std::vector<float>> illuminances;
  for (const PageView& view : views) {
    luminances.push_back(luminancesOf(input.solution.views[view.index]));
    illuminances.push_back(input.solution.views[view.index].illuminance_lx);
  }
  const bool isLinear = input.study.falseColoursAreLinear;
  const FalseColours luminance("luminance", "Luminance, cd/m2", std::move(luminances), isLinear);
  const FalseColours illuminance("illuminance", "Illuminance, lx", std::move(illuminances), isLinear);
  Tasks tasks;
  for (std::size_t v = 0; v < views.size(); ++v) {
    PageView& view = views[v];
    tasks.push_back([&, v] { view.luminancePng = luminance.write(folder, view, v); });
    tasks.push_back([&, v] { view.illuminancePng = illuminance.write(folder, view, v); });
    tasks.push_back([&] { writeDisplayed(folder, input, display, view); });
    tasks.push_back([&] {
      writeExr(folder / ("view-" + view.fileName + ".exr"), input.solution.views[view.index],
               input.study.views[view.index], 1.0 / view.white_cd_m2);
    });
  }
  run(tasks);
}

/// Writes the plans; gives the bytes of those that have too many sensors to be drawn in the page one by one.
/// Those are written even where no pictures are asked for: the page would show nothing else of their grid.
std::vector<std::string> writePlans(const fs::path& folder, const ReportInput& input) {
  constexpr std::size_t mostDrawnSensors = 12'000;
  std::vector<std::string> names;
  for (const SensorGrid& grid : input.building.grids) names.push_back(grid.name);
  const std::vector<std::string> files = safeFileNames(names);
  const PlanScale scale = planScale(input.solution);
  std::vector<std::string> pictures(files.size());
  forEachIndex(files.size(), 1, [&](std::size_t g) {
    const fs::path file = folder / ("plan-" + files[g] + ".png");
    const bool isDrawn = input.building.grids[g].points.size() <= mostDrawnSensors;
    if (input.pictures || !isDrawn) writePng(file, planPicture(input, g, scale), Shades::flat);
    if (!isDrawn) pictures[g] = readFile(file);
  });
  return pictures;
}

/// Writes the photometric files of a study beside it, each once and under a name of its own.
void writePhotometry(const fs::path& partial, Study& study) {
  std::map<std::string, std::string> written;  // by the study's name of it
  std::vector<std::string> stems;
  for (const LuminaireSettings& luminaire : study.luminaires) {
    if (!luminaire.file.empty() && written.emplace(luminaire.file, "").second)
      stems.push_back(fs::path(luminaire.file).stem().string());
  }
  const std::vector<std::string> files = safeFileNames(stems);
  std::size_t next = 0;
  for (LuminaireSettings& luminaire : study.luminaires) {
    if (luminaire.file.empty()) continue;
    std::string& name = written.at(luminaire.file);
    if (name.empty()) {
      const bool isIes = luminaire.photometry->format != "EULUMDAT";
      name = "photometry-" + files.at(next++) + (isIes ? ".ies" : ".ldt");
      writeFile(partial / name, luminaire.photometry->text);
    }
    luminaire.file = name;
  }
}

/// Writes a study.toml that works from the finished folder: the model seen from there, sensors' points and
/// photometric files beside it.
void writeStudy(const fs::path& partial, const fs::path& folder, const Study& study) {
  Study again = study;
  std::error_code failure;
  const fs::path model = fs::relative(study.modelFile, fs::absolute(folder).lexically_normal(), failure);
  if (!failure && !model.empty()) again.modelFileAsWritten = model.generic_string();
  std::vector<std::string> names;
  for (const GridSettings& grid : again.grids) names.push_back(grid.name);
  const std::vector<std::string> files = safeFileNames(names);
  for (std::size_t g = 0; g < again.grids.size(); ++g) {
    GridSettings& grid = again.grids[g];
    if (grid.points.empty()) continue;
    grid.pointsFile = "points-" + files[g] + ".csv";
    writeFile(partial / grid.pointsFile, pointsCsv(grid.points));
  }
  writePhotometry(partial, again);
  writeFile(partial / "study.toml", studyToml(again));
}

}  // namespace

void writeReport(const fs::path& folder, const ReportInput& input) {
  writeBeside(folder, [&](const fs::path& partial) {
    PagePictures pictures;
    withThreads(input.run.threads, [&] {
      pictures.views = exposedViews(input);
      run({[&] { writeViews(partial, input, pictures.views); },
           [&] { pictures.plans = writePlans(partial, input); },
           [&] { writeFile(partial / "scene.glb", sceneGlb(input)); },
           [&] { writeFile(partial / "study.json", studyJson(input)); },
           [&] {
             writeFile(partial / "run.json", runJson(input));
             writeStudy(partial, folder, input.study);
             writeFile(partial / "sensors.csv", sensorsCsv(input));
             writeFile(partial / "surfaces.csv", surfacesCsv(input));
             writeFile(partial / "rooms.csv", roomsCsv(input));
             writeFile(partial / "iterations.csv", iterationsCsv(input));
           }});
    });
    writeFile(partial / "index.html", pageHtml(input, pictures));
  });
}

}  // namespace clerestory
