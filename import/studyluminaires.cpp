// SPDX-License-Identifier: GPL-3.0-or-later
// Reads luminaires from study.toml, each photometric file once, and lays arrays of them out.
#include "studyluminaires.hpp"

#include <glm/geometric.hpp>

#include <map>

#include "textfile.hpp"

namespace clerestory {
namespace {

constexpr std::int64_t kMostInArray = 1000;

using Files = std::map<std::string, std::shared_ptr<const Photometry>>;

void readPhotometryOf(const TomlSection& section, const std::filesystem::path& folder, Files& files,
                      LuminaireSettings& luminaire) {
  if (section.has("file") == section.has("intensity_cd")) {
    section.fail("file", "needs either file = \"lamp.ies\" (or .ldt) or intensity_cd = 1000");
  }
  luminaire.lambertian = section.boolean("lambertian").value_or(false);
  if (section.has("intensity_cd")) {
    luminaire.intensity_cd = *section.number("intensity_cd", {0.0, 1e9, false});
    luminaire.photometry =
        std::make_shared<const Photometry>(luminaire.lambertian ? lambertianPhotometry(luminaire.intensity_cd)
                                                                : uniformPhotometry(luminaire.intensity_cd));
    return;
  }
  if (section.has("lambertian")) {
    section.fail("lambertian", "goes with intensity_cd alone; a file states its own distribution");
  }
  luminaire.file = *section.text("file");
  const auto path = fileInside(folder, luminaire.file);
  if (!path) {
    section.fail("file", "file \"" + cleanName(luminaire.file) + "\" has to lie in the study's folder");
  }
  if (!std::filesystem::exists(*path)) {
    section.fail("file", "photometric file \"" + cleanName(luminaire.file) +
                             "\" not found; check the path and its spelling");
  }
  std::shared_ptr<const Photometry>& photometry = files[path->lexically_normal().string()];
  if (!photometry) photometry = std::make_shared<const Photometry>(readPhotometry(*path));
  luminaire.photometry = photometry;
}

void readArray(const TomlSection& section, LuminaireSettings& luminaire) {
  const auto array = section.section("array");
  if (!array) return;
  array->allowOnly({"count", "step"});
  const auto count = array->pair("count");
  const auto step = array->plan("step");
  if (!count || !step) array->fail("", "needs count = [4, 2] and step = [1.8, 2.4], along x and y in metres");
  for (std::size_t i = 0; i < 2; ++i) {
    if ((*count)[i] < 1 || (*count)[i] > kMostInArray) {
      array->fail("count", "count goes from 1 to " + std::to_string(kMostInArray) + " each way");
    }
    luminaire.count[i] = static_cast<int>((*count)[i]);
  }
  luminaire.step_m = *step;
}

LuminaireSettings readLuminaire(const TomlSection& section, const std::filesystem::path& folder, Files& files,
                                std::size_t number) {
  section.allowOnly(
      {"name", "file", "intensity_cd", "lambertian", "position", "aim", "rotation", "flux_factor", "array"});
  LuminaireSettings luminaire;
  luminaire.name = section.text("name").value_or("Luminaire " + std::to_string(number));
  readPhotometryOf(section, folder, files, luminaire);
  const auto position = section.point("position");
  if (!position) section.fail("position", "needs position = [x, y, z] in metres");
  luminaire.position_m = *position;
  if (const auto aim = section.point("aim")) {
    if (glm::length(*aim) < 1e-9) section.fail("aim", "aim has no length; straight down is [0, 0, -1]");
    luminaire.aim = *aim;
  }
  luminaire.rotation_deg = section.number("rotation", {-360, 360}).value_or(0.0);
  luminaire.fluxFactor = section.number("flux_factor", {0.0, 1000.0}).value_or(1.0);
  readArray(section, luminaire);
  return luminaire;
}

}  // namespace

void readLuminaires(const TomlSection& file, const std::filesystem::path& folder, Study& study) {
  Files files;
  for (const TomlSection& section : file.list("luminaire"))
    study.luminaires.push_back(readLuminaire(section, folder, files, study.luminaires.size() + 1));
}

std::vector<Luminaire> luminairesOf(const Study& study) {
  std::vector<Luminaire> luminaires;
  for (const LuminaireSettings& settings : study.luminaires) {
    Luminaire luminaire;
    luminaire.name = settings.name;
    luminaire.photometry = settings.photometry;
    luminaire.axes = luminaireAxes(glm::normalize(settings.aim), settings.rotation_deg);
    luminaire.factor = settings.fluxFactor * tiltFactor(settings.photometry->tilt, luminaire.axes);
    if (!(luminaire.factor > 0.0)) continue;  // switched off
    for (int j = 0; j < settings.count[1]; ++j) {
      for (int i = 0; i < settings.count[0]; ++i) {
        luminaire.position_m =
            settings.position_m + glm::dvec3(i * settings.step_m.x, j * settings.step_m.y, 0.0);
        luminaires.push_back(luminaire);
      }
    }
  }
  return luminaires;
}

}  // namespace clerestory
