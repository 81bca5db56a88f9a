// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a report: every file into a new folder, which takes its place when all are there.
#include <map>

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

PageView writeView(const fs::path& folder, const std::string& name, std::size_t index,
                   const ReportInput& input, const DisplayTransform& display) {
  const LuminanceImage& image = input.solution.views[index];
  const ViewSettings& view = input.study.views[index];
  const std::string stem = "view-" + name;
  const double scale = exposureScale(image, view.exposure_ev);
  const fs::path png = folder / (stem + ".png");
  writeExr(folder / (stem + ".exr"), image, view, scale);
  const std::vector<float> values = displayValues(image, scale, display);
  writePng(png, displayImage(values, image.width, image.height));
  PageView shown;
  shown.index = index;
  shown.name = view.name;
  shown.fileName = name;
  shown.png = readFile(png);
  shown.white_cd_m2 = 1.0 / scale;
  shown.exposure_ev = exposureValue(scale);
  shown.width = image.width;
  shown.height = image.height;
  if (view.pngBits == 16) writePng16(png, values, image.width, image.height);  // the page keeps the small one
  return shown;
}

/// Writes the views in false colours; puts the PNGs' bytes into the page's views.
void writeFalseColours(const fs::path& folder, const ReportInput& input, std::vector<PageView>& views) {
  std::vector<std::vector<float>> luminances;
  std::vector<std::span<const float>> luminancesShown;
  std::vector<std::span<const float>> illuminancesShown;
  for (const PageView& view : views) luminances.push_back(luminancesOf(input.solution.views[view.index]));
  for (std::size_t v = 0; v < views.size(); ++v) {
    luminancesShown.emplace_back(luminances[v]);
    illuminancesShown.emplace_back(input.solution.views[views[v].index].illuminance_lx);
  }
  const bool isLinear = input.study.falseColoursAreLinear;
  const ValueScale luminance = valueScale(luminancesShown, isLinear);
  const ValueScale illuminance = valueScale(illuminancesShown, isLinear);
  for (std::size_t v = 0; v < views.size(); ++v) {
    PageView& view = views[v];
    const auto paint = [&](const std::string& kind, std::span<const float> values, const ValueScale& scale,
                           const std::string& unit) -> std::string {
      if (values.empty()) return {};
      const fs::path file = folder / (kind + "-" + view.fileName + ".png");
      writePng(file, falsePicture(values, view.width, view.height, scale,
                                  (kind == "luminance" ? "Luminance, " : "Illuminance, ") + unit));
      return readFile(file);
    };
    view.luminancePng = paint("luminance", luminancesShown[v], luminance, "cd/m2");
    view.illuminancePng = paint("illuminance", illuminancesShown[v], illuminance, "lx");
  }
}

/// Writes the views as EXR and PNG with the config that leads from one to the other; gives the PNGs' bytes
/// for the page.
std::vector<PageView> writeViews(const fs::path& folder, const ReportInput& input) {
  std::vector<std::string> names;
  for (std::size_t v = 0; v < input.solution.views.size(); ++v) names.push_back(input.study.views.at(v).name);
  if (names.empty()) return {};
  const std::vector<std::string> files = safeFileNames(names);
  const DisplayTransform display;
  if (display.isShipped()) writeFile(folder / "config.ocio", shippedConfig);
  std::vector<PageView> pictures;
  for (std::size_t v = 0; v < files.size(); ++v) {
    if (input.solution.views[v].pixels_cd_m2.empty()) continue;
    pictures.push_back(writeView(folder, files[v], v, input, display));
  }
  writeFalseColours(folder, input, pictures);
  return pictures;
}

/// Writes the plans; gives the bytes of those that have too many sensors to be drawn in the page one by one.
/// Those are written even where no pictures are asked for: the page would show nothing else of their grid.
std::vector<std::string> writePlans(const fs::path& folder, const ReportInput& input) {
  constexpr std::size_t mostDrawnSensors = 12'000;
  std::vector<std::string> names;
  for (const SensorGrid& grid : input.building.grids) names.push_back(grid.name);
  const std::vector<std::string> files = safeFileNames(names);
  const PlanScale scale = planScale(input.solution);
  std::vector<std::string> pictures;
  for (std::size_t g = 0; g < files.size(); ++g) {
    const fs::path file = folder / ("plan-" + files[g] + ".png");
    const bool isDrawn = input.building.grids[g].points.size() <= mostDrawnSensors;
    if (input.pictures || !isDrawn) writePng(file, planPicture(input, g, scale));
    pictures.push_back(isDrawn ? std::string() : readFile(file));
  }
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
    writeFile(partial / "study.json", studyJson(input));
    writeFile(partial / "run.json", runJson(input));
    writeStudy(partial, folder, input.study);
    writeFile(partial / "sensors.csv", sensorsCsv(input));
    writeFile(partial / "surfaces.csv", surfacesCsv(input));
    writeFile(partial / "rooms.csv", roomsCsv(input));
    writeFile(partial / "iterations.csv", iterationsCsv(input));
    writeFile(partial / "scene.glb", sceneGlb(input));
    const PagePictures pictures = {writeViews(partial, input), writePlans(partial, input)};
    writeFile(partial / "index.html", pageHtml(input, pictures));
  });
}

}  // namespace clerestory
