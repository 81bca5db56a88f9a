// SPDX-License-Identifier: GPL-3.0-or-later
// Makes up a building and its light.
#include "fake.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace clerestory::fake {
namespace {

enum : std::uint32_t { paint, carpet, pane };

std::uint32_t addPiece(CleanModel& model, const std::vector<glm::dvec3>& corners, const glm::dvec3& normal,
                       double area_m2, std::uint32_t surface) {
  Pieces& pieces = model.pieces;
  std::vector<std::uint32_t> indices;
  for (const glm::dvec3& corner : corners) {
    indices.push_back(static_cast<std::uint32_t>(pieces.points.size()));
    pieces.points.push_back(corner);
  }
  pieces.polygons.add(indices);
  pieces.normal.push_back(normal);
  pieces.area_m2.push_back(area_m2);
  pieces.surface.push_back(surface);
  pieces.material.push_back(model.surfaces[surface].material);
  pieces.isDrawnForBack.push_back(false);
  return static_cast<std::uint32_t>(pieces.size() - 1);
}

CleanModel cleanModel() {
  CleanModel model;
  Material wall;
  wall.name = "white paint";
  wall.reflectance = glm::dvec3(0.8);
  Material floor;
  floor.name = "carpet, \"sand\"";
  floor.reflectance = {0.42, 0.31, 0.2};
  Material glass;
  glass.name = "glass";
  glass.reflectance = glm::dvec3(0.08);
  glass.glazing = true;
  glass.transmittance = glm::dvec3(0.65);
  glass.transmittanceIsAssumed = true;
  glass.panes = 2;
  model.materials = {wall, floor, glass};
  model.surfaces = {{"Walls", paint}, {"Floor", carpet}, {"Window south", pane}, {"Walls", carpet}};
  addPiece(model, {{0, 0, 0}, {6, 0, 0}, {6, 4, 0}, {0, 4, 0}}, {0, 0, 1}, 24, 1);
  addPiece(model, {{0, 4, 0}, {3.5, 4, 0}, {3.5, 7, 0}, {0, 7, 0}}, {0, 0, 1}, 10.5, 1);
  addPiece(model, {{3.8, 4.3, 0}, {6, 4.3, 0}, {6, 7, 0}, {3.8, 7, 0}}, {0, 0, 1}, 5.94, 1);
  addPiece(model, {{1, 0, 1}, {5, 0, 1}, {5, 0, 2.4}, {1, 0, 2.4}}, {0, -1, 0}, 5.6, 2);
  model.counts.facesRead = 96;
  model.counts.pointsRead = 288;
  model.counts.pointsWelded = 224;
  model.counts.polygons = 22;
  model.counts.pieces = 31;
  return model;
}

void addGrid(Case& made, const std::string& name, std::int32_t room, const glm::dvec2& low,
             const glm::dvec2& high, double spacing_m) {
  SensorGrid grid;
  grid.name = name;
  grid.room = room;
  grid.spacing_m = spacing_m;
  GridValues values;
  for (double y = low.y + 0.5 * spacing_m; y < high.y; y += spacing_m) {
    for (double x = low.x + 0.5 * spacing_m; x < high.x; x += spacing_m) {
      if (room == 0 && y > 4.0 && x > 3.5) continue;  // the L's missing corner
      grid.points.emplace_back(x, y, 0.85);
      grid.normals.emplace_back(0.0, 0.0, 1.0);
      SensorValue value;
      const double dx = x - std::clamp(x, 1.0, 5.0);
      value.direct_lx = room == 0 ? 2600.0 / (1.0 + std::pow((y + std::abs(dx)) / 1.1, 2.3)) : 0.0;
      value.reflected_lx = (room == 0 ? 105.0 : 11.0) * (1.0 + 0.3 * std::sin(x) + 0.1 * y / 7.0);
      value.sky_lx = value.illuminance_lx = value.direct_lx + value.reflected_lx;
      value.error_lx = 0.021 * value.illuminance_lx;
      values.sensors.push_back(value);
    }
  }
  made.building.grids.push_back(grid);
  made.solution.grids.push_back(values);
}

void addSurfaceValues(Solution& solution) {
  const std::vector<std::pair<std::uint32_t, std::int32_t>> rows = {{0, 0}, {3, 0}, {1, 0}, {2, 0},
                                                                    {0, 1}, {1, 1}, {0, -1}};
  double mean_lx = 412.0;
  for (const auto& [surface, room] : rows) {
    SurfaceValue value;
    value.surface = surface;
    value.room = room;
    value.area_m2 = 12.3 + mean_lx / 100.0;
    value.illuminanceMean_lx = mean_lx;
    value.illuminanceMin_lx = 0.3 * mean_lx;
    value.illuminanceMax_lx = 4.7 * mean_lx;
    value.exitanceMean_lm_m2 = {0.8 * mean_lx, 0.7 * mean_lx, 0.6 * mean_lx};
    value.error_lx = 0.02 * mean_lx;
    value.elements = 40;
    solution.surfaces.push_back(value);
    mean_lx *= 0.71;
  }
}

void addStatistics(Solution& solution) {
  for (std::int32_t domain = 0; domain < 2; ++domain) {
    for (int step = 0; step < 9; ++step) {
      IterationStatistics of;
      of.domain = domain;
      of.iteration = step;
      of.linksRequired = static_cast<std::uint64_t>(48'211.0 * std::pow(0.45, step));
      of.linksCached = of.linksRequired / 2;
      of.linksReused = step == 0 ? 0 : of.linksCached;
      of.visibilityTests = of.linksRequired * 9;
      of.unshotPower_lm = (domain == 0 ? 8400.0 : 95.0) * std::pow(0.44, step);
      of.elements = 2200;
      of.seconds = 0.01;
      solution.iterations.push_back(of);
    }
    const double emitted_lm = domain == 0 ? 8412.7 : 95.1;
    solution.balances.push_back({domain, emitted_lm, 0.97 * emitted_lm, 0.02996 * emitted_lm, 0.0042});
  }
  solution.elements = 2345;
}

LuminanceImage picture() {
  LuminanceImage image;
  image.width = 32;
  image.height = 18;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float value = 3.0F + 2.0F * static_cast<float>(x) + 5.0F * static_cast<float>(y);
      image.pixels_cd_m2.emplace_back(value, 0.9F * value, 0.7F * value);
      image.illuminance_lx.push_back(y < 2 ? std::nanf("") : 6.0F * value);
    }
  }
  return image;
}

}  // namespace

Case office() {
  Case made;
  made.study.modelFile = "/nowhere/that/exists/office.obj";
  made.study.modelFileAsWritten = "office.obj";
  made.study.site.north_deg = 20.0;
  made.study.assumptions = {"The sky is CIE overcast with 10,000 lx: the study names none."};
  ViewSettings view;
  view.name = "entrance";
  made.study.views = {view};
  made.building.model = cleanModel();
  made.building.sideDomain = {0, -1, 0, -1, 1, -1, -1, 0};
  made.building.domains.resize(2);
  made.building.portals = {{3, false, 0, -1, 0}};
  made.building.innerGlass.assign(4, false);
  made.building.rooms = {{"Office", 0, 34.5, 96.6, 0.0, 2.8, {0, 1}},
                         {"Store", 1, 5.94, 16.6, 0.0, 2.8, {2}}};
  made.building.sideRoom = {0, -1, 0, -1, 1, -1, -1, 0};
  addGrid(made, "Desks", 0, {0, 0}, {6, 7}, 0.25);
  addGrid(made, "Shelves", 1, {3.8, 4.3}, {6, 7}, 0.5);
  addSurfaceValues(made.solution);
  addStatistics(made.solution);
  made.solution.views = {picture()};
  made.diagnoses = {{"G203", "a polygon is not planar by 4 mm; it was triangulated", "Walls", 3}};
  return made;
}

TemporaryFolder::TemporaryFolder() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::string name =
      test == nullptr ? "demo" : std::string(test->test_suite_name()) + "-" + test->name();
  path_ = std::filesystem::temp_directory_path() /
          ("clerestory-" + name + "-" + std::to_string(std::random_device()()));
  std::filesystem::remove_all(path_);
  std::filesystem::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::vector<std::string> TemporaryFolder::entries() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path_))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace clerestory::fake
