// SPDX-License-Identifier: GPL-3.0-or-later
// Reads study.toml: one function a table, every key known, every value checked.
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <import/study.hpp>

#include "sensorpoints.hpp"
#include "studyluminaires.hpp"
#include "studytext.hpp"
#include "textfile.hpp"
#include "tomlsection.hpp"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxStudyBytes = 16U << 20U;
constexpr Range kReflectance{0.0, 1.0, true, false};
constexpr Range kFraction{0.0, 1.0};
constexpr Range kFactor{0.0, 1.0, false, true};
constexpr Range kExitance{0.0, 1e9};

void readModelSection(const TomlSection& file, const std::filesystem::path& folder, Study& study) {
  const auto section = file.section("model");
  if (!section) {
    file.fail("model", "names no model; begin with [model] and file = \"building.obj\"");
  }
  section->allowOnly({"file", "units", "up", "subdivide"});
  const auto name = section->text("file");
  if (!name || name->empty()) {
    section->fail("file", "names no model; state file = \"building.obj\"");
  }
  study.modelFileAsWritten = *name;
  study.modelFile = folder / std::filesystem::path(*name);
  study.model.units = section->text("units");
  if (study.model.units && !isUnit(*study.model.units)) {
    section->fail("units", "units \"" + cleanName(*study.model.units) + "\" is not m, cm, mm, ft or in");
  }
  study.model.upAxis = section->text("up");
  if (study.model.upAxis && *study.model.upAxis != "y" && *study.model.upAxis != "z") {
    section->fail("up", "up \"" + cleanName(*study.model.upAxis) + "\" is not \"y\" or \"z\"");
  }
  for (const auto& [glob, rule] : section->named("subdivide")) {
    rule.allowOnly({"scheme", "tolerance_m"});
    const std::string scheme = rule.text("scheme").value_or("catmark");
    if (scheme != "catmark" && scheme != "loop" && scheme != "bilinear" && scheme != "none") {
      rule.fail("scheme", "scheme \"" + cleanName(scheme) + "\" is not catmark, loop, bilinear or none");
    }
    study.model.subdivide.push_back({glob, scheme, rule.number("tolerance_m", {0.0, 10.0, false})});
  }
}

void readSite(const TomlSection& file, Study& study) {
  const auto section = file.section("site");
  if (!section) {
    return;
  }
  section->allowOnly({"latitude", "longitude", "time_zone", "north", "external_diffuse_lx"});
  Site& site = study.site;
  site.latitude_deg = section->number("latitude", {-90, 90}).value_or(site.latitude_deg);
  site.longitude_deg = section->number("longitude", {-180, 180}).value_or(site.longitude_deg);
  site.timeZone_h = section->number("time_zone", {-12, 14}).value_or(site.timeZone_h);
  site.north_deg = section->number("north", {-360, 360}).value_or(site.north_deg);
  site.externalDiffuse_lx =
      section->number("external_diffuse_lx", {0, 200000, false}).value_or(site.externalDiffuse_lx);
}

/// Reflectance has a message of its own: stating 1 or more is the commonest slip.
std::optional<glm::dvec3> statedReflectance(const TomlSection& section) {
  const auto value = section.color("reflectance", {-1e9, 1e9});
  for (int i = 0; value && i < 3; ++i) {
    if ((*value)[i] >= 1.0) {
      section.fail("reflectance", "reflectance " + numberText((*value)[i]) +
                                      " is not below 1; a white wall has about 0.85 (85 % is written 0.85)");
    }
    if ((*value)[i] < 0.0) {
      section.fail("reflectance", "reflectance " + numberText((*value)[i]) + " is below 0");
    }
  }
  return value;
}

void readMaterials(const TomlSection& file, Study& study) {
  for (const auto& [glob, section] : file.named("materials")) {
    section.allowOnly({"reflectance", "transmittance", "panes", "diffusing", "glass", "exitance"});
    MaterialRule rule;
    rule.glob = glob;
    rule.reflectance = statedReflectance(section);
    rule.transmittance = section.color("transmittance", kFraction);
    rule.diffusing = section.boolean("diffusing");
    if (const auto preset = section.text("glass")) {
      rule.glass = glassPreset(*preset);
      if (!rule.glass) {
        section.fail("glass", "glass \"" + cleanName(*preset) + "\" is no preset; there is \"cie171-6mm\"");
      }
      if (rule.transmittance || section.has("panes")) {
        section.fail("glass", "states a preset and a transmittance or panes; the preset has its own");
      }
    }
    if (const auto panes = section.integer("panes", 1, 10)) {
      rule.panes = static_cast<int>(*panes);
    }
    rule.exitance_lm_m2 = section.color("exitance", kExitance);
    study.materials.push_back(rule);
  }
}

void readSun(const TomlSection& sky, Study& study) {
  study.sky.time = sky.time("time");
  const auto sun = sky.section("sun");
  if (!sun) {
    return;
  }
  if (study.sky.time) {
    sky.fail("sun", "states both time and sun; the time gives the sun's place already");
  }
  sun->allowOnly({"altitude", "azimuth"});
  const auto altitude = sun->number("altitude", {0, 90});
  const auto azimuth = sun->number("azimuth", {-360, 360});
  if (!altitude || !azimuth) {
    sun->fail("", "needs altitude and azimuth, in degrees");
  }
  study.sky.sun_deg = glm::dvec2(*altitude, *azimuth);
}

/// How bright the sky and the beam are: illuminances, or irradiances for Perez' model.
void readBrightness(const TomlSection& section, SkySettings& sky) {
  const auto direct_W = section.number("direct_normal_w_m2", {0, 1500});
  const auto diffuse_W = section.number("diffuse_horizontal_w_m2", {0, 1500, false});
  if (direct_W || diffuse_W) {
    if (!sky.isPerez) {
      section.fail("direct_normal_w_m2",
                   "states irradiances, which only type = \"perez\" reads; state direct_normal_lx and "
                   "diffuse_horizontal_lx");
    }
    if (!direct_W || !diffuse_W || section.has("direct_normal_lx") || section.has("diffuse_horizontal_lx")) {
      section.fail(
          "direct_normal_w_m2",
          "needs both direct_normal_w_m2 and diffuse_horizontal_w_m2, or both in lux, not a mixture");
    }
    sky.irradiance = Irradiance{*direct_W, *diffuse_W};
    return;
  }
  sky.diffuseHorizontal_lx =
      section.number("diffuse_horizontal_lx", {0, 1e6}).value_or(sky.diffuseHorizontal_lx);
  sky.directNormal_lx = section.number("direct_normal_lx", {0, 1e6}).value_or(0.0);
}

void readSky(const TomlSection& file, Study& study) {
  const auto section = file.section("sky");
  if (!section) {
    return;
  }
  section->allowOnly({"type", "diffuse_horizontal_lx", "direct_normal_lx", "time", "sun",
                      "direct_normal_w_m2", "diffuse_horizontal_w_m2"});
  const std::string type = section->text("type").value_or("cie-overcast");
  study.sky.isPerez = type == "perez";
  if (!study.sky.isPerez) {
    const auto number = skyTypeNumber(type);
    if (!number) {
      section->fail("type",
                    "type \"" + cleanName(type) +
                        "\" is no sky; use cie-1 to cie-15, cie-overcast, cie-clear, uniform or perez");
    }
    study.sky.cieType = *number;
  }
  readBrightness(*section, study.sky);
  readSun(*section, study);
  const bool isPlaced = study.sky.sun_deg || study.sky.time;
  if (skyNeedsSun(study.sky) && !isPlaced) {
    section->fail("type", "type \"" + type +
                              "\" depends on the sun; add time = 2026-03-21T10:00:00 or "
                              "sun = { altitude = 40, azimuth = 180 }");
  }
  if (study.sky.directNormal_lx > 0.0 && !isPlaced) {
    section->fail("direct_normal_lx",
                  "direct_normal_lx needs the sun's place; add time = 2026-03-21T10:00:00 or "
                  "sun = { altitude = 40, azimuth = 180 }");
  }
}

void readSunlight(const TomlSection& file, Study& study) {
  const auto section = file.section("sunlight");
  if (!section) {
    return;
  }
  section->allowOnly({"date", "altitude_min"});
  study.sunlight.date = section->date("date").value_or(study.sunlight.date);
  study.sunlight.leastAltitude_deg =
      section->number("altitude_min", {0, 90}).value_or(study.sunlight.leastAltitude_deg);
}

void readGround(const TomlSection& file, Study& study) {
  const auto section = file.section("ground");
  if (!section) {
    return;
  }
  section->allowOnly({"reflectance", "model"});
  study.groundReflectance = section->number("reflectance", kReflectance).value_or(study.groundReflectance);
  const std::string model = section->text("model").value_or("uniform");
  if (model != "uniform" && model != "shaded") {
    section->fail("model", "model \"" + cleanName(model) + "\" is not known; use \"uniform\" or \"shaded\"");
  }
  study.groundIsShaded = model == "shaded";
}

void readOpenings(const TomlSection& file, Study& study) {
  constexpr double offPlaneMost_m = 0.01;
  for (const TomlSection& section : file.list("opening")) {
    section.allowOnly({"polygon"});
    const std::vector<glm::dvec3> outline = section.outline("polygon");
    glm::dvec3 normal(0.0);
    for (std::size_t i = 2; i < outline.size(); ++i)
      normal += glm::cross(outline[i - 1] - outline[0], outline[i] - outline[0]);
    const double length = glm::length(normal);
    if (!(length > 1e-4)) {
      section.fail("polygon", "polygon has no area");
    }
    for (const glm::dvec3& corner : outline) {
      if (std::abs(glm::dot(corner - outline[0], normal)) > offPlaneMost_m * length) {
        section.fail("polygon",
                     "polygon is not flat: a corner lies more than 1 cm off the plane of the others");
      }
    }
    study.openings.push_back(outline);
  }
}

void readGlazing(const TomlSection& file, Study& study) {
  if (const auto section = file.section("glazing")) {
    section->allowOnly({"dirt", "frame"});
    study.dirtFactor = section->number("dirt", kFactor).value_or(study.dirtFactor);
    study.frameFactor = section->number("frame", kFactor).value_or(study.frameFactor);
  }
}

/// A name that no earlier one of its kind has: `Grid 2` where none is stated.
std::string nameOf(const TomlSection& section, const std::string& kind, std::set<std::string>& taken) {
  const std::string name = section.text("name").value_or(kind + " " + std::to_string(taken.size() + 1));
  if (name.empty() || !taken.insert(name).second) {
    section.fail("name", "name \"" + cleanName(name) + "\" is empty or taken already; give each one its own");
  }
  return name;
}

GridSettings readGrid(const TomlSection& section, const std::filesystem::path& folder,
                      std::set<std::string>& taken) {
  section.allowOnly({"name", "room", "polygon", "surface", "points", "height", "spacing", "inset"});
  GridSettings grid;
  grid.name = nameOf(section, "Grid", taken);
  grid.room = section.text("room");
  grid.polygon_m = section.polygon("polygon");
  grid.surface = section.text("surface");
  grid.pointsFile = section.text("points").value_or("");
  if (section.has("room") + section.has("polygon") + section.has("surface") + section.has("points") > 1) {
    section.fail("name",
                 "states more than one of room, polygon, surface and points; write a [[grid]] for each");
  }
  grid.height_m = section.number("height", {grid.surface ? 0.0 : -100.0, 1000})
                      .value_or(grid.surface ? 0.0 : grid.height_m);
  grid.spacing_m = section.number("spacing", {0.001, 1000}).value_or(grid.spacing_m);
  grid.inset_m = section.number("inset", {0, 1000}).value_or(grid.inset_m);
  if (section.has("points")) {
    const auto file = fileInside(folder, grid.pointsFile);
    if (!file) {
      section.fail("points",
                   "points \"" + cleanName(grid.pointsFile) + "\" has to lie in the study's folder");
    }
    grid.points = readSensorPoints(*file);
  }
  return grid;
}

void readGrids(const TomlSection& file, const std::filesystem::path& folder, Study& study) {
  std::set<std::string> taken;
  for (const TomlSection& section : file.list("grid")) {
    study.grids.push_back(readGrid(section, folder, taken));
  }
}

void readExposure(const TomlSection& section, ViewSettings& view) {
  if (!section.has("exposure_ev")) {
    return;
  }
  if (section.isText("exposure_ev")) {
    if (section.text("exposure_ev") != "auto") {
      section.fail("exposure_ev", "exposure_ev has to be \"auto\" or a number");
    }
    return;
  }
  view.exposure_ev = section.number("exposure_ev", {-50, 50});
}

Projection readProjection(const TomlSection& section) {
  const std::string name = section.text("projection").value_or("perspective");
  if (name == "perspective") {
    return Projection::perspective;
  }
  if (name == "fisheye") {
    return Projection::fisheye;
  }
  if (name != "panorama") {
    section.fail("projection", "projection \"" + cleanName(name) +
                                   "\" is not known; use \"perspective\", \"fisheye\" or \"panorama\"");
  }
  if (section.has("field_of_view")) {
    section.fail("field_of_view", "a panorama shows all round and has no field_of_view");
  }
  return Projection::panorama;
}

void readPictureSize(const TomlSection& section, ViewSettings& view) {
  const bool isPanorama = view.projection == Projection::panorama;
  view.size_px = view.projection == Projection::fisheye ? std::array{720, 720}
                 : isPanorama                           ? std::array{1440, 720}
                                                        : view.size_px;
  if (const auto size = section.pair("size")) {
    if (std::min((*size)[0], (*size)[1]) < 1 || std::max((*size)[0], (*size)[1]) > 16384) {
      section.fail("size", "size goes from 1 to 16384 pixels each way");
    }
    view.size_px = {static_cast<int>((*size)[0]), static_cast<int>((*size)[1])};
  }
  if (isPanorama && view.size_px[0] != 2 * view.size_px[1]) {
    section.fail("size", "a panorama is twice as wide as high");
  }
}

/// One of two numbers of bits.
int readBits(const TomlSection& section, const char* key, int usual, int other) {
  const auto bits = section.number(key, {0, 64});
  if (bits && *bits != usual && *bits != other) {
    section.fail(key,
                 std::string(key) + " has to be " + std::to_string(usual) + " or " + std::to_string(other));
  }
  return bits ? static_cast<int>(*bits) : usual;
}

ViewSettings readView(const TomlSection& section, std::set<std::string>& taken) {
  section.allowOnly({"name", "projection", "eye", "target", "up", "field_of_view", "size", "exposure_ev",
                     "exr_bits", "png_bits"});
  ViewSettings view;
  view.name = nameOf(section, "view", taken);
  view.projection = readProjection(section);
  const auto eye = section.point("eye");
  const auto target = section.point("target");
  if (!eye || !target) {
    section.fail("name", "needs eye and target, as [x, y, z] in metres");
  }
  view.eye_m = *eye;
  view.target_m = *target;
  view.up = section.point("up").value_or(view.up);
  const glm::dvec3 direction = view.target_m - view.eye_m;
  if (glm::length(glm::cross(direction, view.up)) <= 1e-9 * glm::length(direction) * glm::length(view.up)) {
    section.fail("target", "eye and target have to differ, and up must not point along the view");
  }
  const bool isFisheye = view.projection == Projection::fisheye;
  view.fieldOfView_deg = section.number("field_of_view", {1, isFisheye ? 360.0 : 170.0})
                             .value_or(isFisheye ? 180.0 : view.fieldOfView_deg);
  readPictureSize(section, view);
  readExposure(section, view);
  view.exrBits = readBits(section, "exr_bits", 16, 32);
  view.pngBits = readBits(section, "png_bits", 8, 16);
  return view;
}

void readViews(const TomlSection& file, Study& study) {
  std::set<std::string> taken;
  for (const TomlSection& section : file.list("view")) {
    study.views.push_back(readView(section, taken));
  }
}

void readAccuracy(const TomlSection& file, Study& study) {
  const auto section = file.section("accuracy");
  if (!section) {
    return;
  }
  section->allowOnly({"target", "time_limit_s"});
  if (const auto target = section->text("target")) {
    const auto accuracy = parseAccuracy(*target);
    if (!accuracy) {
      section->fail("target", "target \"" + cleanName(*target) +
                                  "\" is not \"5%\" (0.1 to 50), draft, standard or fine");
    }
    study.accuracy = *accuracy;
  }
  if (section->number("time_limit_s", {0, 1e9}).value_or(0.0) != 0.0) {
    section->fail("time_limit_s", "time_limit_s is not supported by this version; state 0 or take it out");
  }
}

void readReport(const TomlSection& file, Study& study) {
  const auto section = file.section("report");
  if (!section) {
    return;
  }
  section->allowOnly({"norms", "false_colours"});
  const std::string scale = section->text("false_colours").value_or("logarithmic");
  if (scale != "logarithmic" && scale != "linear") {
    section->fail("false_colours", "false_colours has to be \"logarithmic\" or \"linear\"");
  }
  study.falseColoursAreLinear = scale == "linear";
  for (const std::string& norm : section->texts("norms")) {
    if (norm != "en17037" && norm != "leed") {
      section->fail("norms",
                    "norm \"" + cleanName(norm) + "\" is not known; there are \"en17037\" and \"leed\"");
    }
    study.norms.push_back(norm);
  }
}

}  // namespace

Study readStudy(const std::filesystem::path& file) {
  const std::string bytes = readWholeFile(file, "study", kMaxStudyBytes);
  const std::string name = file.string();
  const toml::table table = parseToml(plainText(bytes, name), name);
  const TomlSection root(table, "", name);
  root.allowOnly({"model", "site", "materials", "sky", "sunlight", "ground", "glazing", "opening",
                  "luminaire", "grid", "view", "accuracy", "report"});
  const std::filesystem::path folder = file.parent_path();
  Study study;
  readModelSection(root, folder, study);
  readSite(root, study);
  readMaterials(root, study);
  readSky(root, study);
  readSunlight(root, study);
  readGround(root, study);
  readGlazing(root, study);
  readOpenings(root, study);
  readLuminaires(root, folder, study);
  readGrids(root, folder, study);
  readViews(root, study);
  readAccuracy(root, study);
  readReport(root, study);
  assumeWhatIsMissing(study,
                      {.sky = root.has("sky"), .ground = root.has("ground"), .north = root.has("site")});
  return study;
}

Study studyOfModel(const std::filesystem::path& modelFile) {
  Study study;
  study.modelFile = modelFile;
  study.modelFileAsWritten = modelFile.generic_string();
  assumeWhatIsMissing(study, {});
  return study;
}

}  // namespace clerestory
