// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of a lit room: every pixel of it has light.
#include <glm/trigonometric.hpp>

#include <cmath>
#include <numbers>

#include <solver/glass.hpp>

#include "solved.hpp"

namespace clerestory {
namespace {

using namespace drawn;

TEST(View, NoPixelOfALitRoomIsBlackOrNoNumber) {
  Study study;
  ViewSettings view;
  view.eye_m = {1.8, 7.6, 1.6};
  view.target_m = {1.8, 0.0, 1.2};
  view.size_px = {160, 90};
  study.views = {view};
  const Building building = drawn::buildingOf(testModel("reference/furnished/furnished.obj", study), study);
  const Solution solution = solve(building, study, {});
  ASSERT_EQ(solution.views.size(), 1U);
  const LuminanceImage& image = solution.views[0];
  ASSERT_EQ(image.pixels_cd_m2.size(), 160U * 90U);
  std::size_t dark = 0;
  for (const glm::vec3& pixel : image.pixels_cd_m2) {
    ASSERT_TRUE(std::isfinite(pixel.r + pixel.g + pixel.b));
    dark += pixel.g > 0.1F ? 0U : 1U;  // a thousandth of what the walls have
  }
  EXPECT_LT(dark, image.pixels_cd_m2.size() / 500);  // gaps between books may be
}

// A board over a window, seen from below and aslant: two pixels high, and of very different light at its two
// edges. It alone is green. Each of its pixels is held against the nine of a picture of three times the size.
TEST(View, NarrowSurfaceSeenAslantHasNoDashes) {
  Drawing drawing;
  addRoomWithPane(drawing, {0, 0, 0}, {4, 8, 3}, {0.5, 1.0, 3.5, 2.5});
  const std::uint32_t green =
      addMaterial(drawing, {.name = "board", .reflectance = glm::dvec3(0.0, 0.5, 0.0)});
  drawing.face({{0.2, 0.0, 2.6}, {0.2, 0.2, 2.6}, {3.8, 0.2, 2.6}, {3.8, 0.0, 2.6}}, green);
  const Building building = buildingOf(drawing.scene);
  constexpr int width = 240;
  constexpr int height = 136;
  Study study;
  ViewSettings view;
  view.eye_m = {0.4, 7.6, 1.6};
  view.target_m = {2.4, 0.0, 2.6};
  view.fieldOfView_deg = 14.0;
  view.size_px = {width, height};
  study.views = {view, view};
  study.views[1].size_px = {3 * width, 3 * height};
  const Solution solution = solve(building, study, {});
  int onBoard = 0;
  double squares = 0.0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      glm::vec3 mean(0.0F);
      for (int i = 0; i < 9; ++i) {
        const int there = (3 * y + i / 3) * 3 * width + 3 * x + i % 3;
        mean += solution.views[1].pixels_cd_m2[static_cast<std::size_t>(there)] / 9.0F;
      }
      const glm::vec3& own = solution.views[0].pixels_cd_m2[static_cast<std::size_t>(y * width + x)];
      if (mean.r > 0.001F * mean.g || own.r > 0.001F * own.g) continue;
      const double ratio = static_cast<double>(own.g / mean.g) - 1.0;
      squares += ratio * ratio;
      ++onBoard;
    }
  }
  ASSERT_GT(onBoard, width / 2);
  // Rays are few, so each pixel has some per cent of noise: 0.05 was reached. Read from cells that lie before
  // the board's middle or behind it, light errs by 0.3.
  EXPECT_LT(std::sqrt(squares / onBoard), 0.1);
}

// In a closed room that glows and reflects alike everywhere, luminance is exitance / (1 - reflectance) / pi
// in every direction: edges and corners, where tiles hold several surfaces, must not show.
TEST(View, FurnaceIsOfOneLuminance) {
  Drawing drawing;
  const std::uint32_t glowing = addMaterial(
      drawing, {.name = "glowing", .reflectance = glm::dvec3(0.6), .exitance_lm_m2 = glm::dvec3(400.0)});
  addBox(drawing, {0, 0, 0}, {4, 6, 3}, glowing);
  addBox(drawing, {1.0, 2.0, 0.0}, {2.0, 3.0, 1.0}, glowing, 0, {0});
  Study study;
  ViewSettings view;
  view.eye_m = {3.5, 5.5, 1.6};
  view.target_m = {1.0, 0.0, 1.0};
  view.size_px = {160, 90};
  study.views = {view};
  const Solution solution = solve(buildingOf(drawing.scene), study, {});
  const double expected_cd_m2 = 400.0 / (1.0 - 0.6) * std::numbers::inv_pi;
  for (const glm::vec3& pixel : solution.views.at(0).pixels_cd_m2)
    ASSERT_NEAR(pixel.g, expected_cd_m2, 0.005 * expected_cd_m2);
}

/// Luminance times cosine, added up over a fisheye of 180 degrees that looks up and fills a square. [lx]
double lightFromAbove_lx(const LuminanceImage& fisheye) {
  constexpr double pi = std::numbers::pi;
  const double middle = 0.5 * fisheye.width;
  const double pixel = pi / fisheye.width;
  double sum_lx = 0.0;
  for (int y = 0; y < fisheye.height; ++y) {
    for (int x = 0; x < fisheye.width; ++x) {
      const double angle = std::hypot(x + 0.5 - middle, y + 0.5 - middle) * pixel;
      if (angle > 0.5 * pi) continue;
      const auto luminance =
          static_cast<double>(fisheye.pixels_cd_m2[static_cast<std::size_t>(fisheye.width * y + x)].g);
      sum_lx += luminance * std::cos(angle) * std::sin(angle) / angle * pixel * pixel;
    }
  }
  return sum_lx;
}

// Luminance times cosine, added up over what a fisheye that looks up sees, is the illuminance of a sensor at
// its eye; so it is over the upper half of a panorama.
TEST(View, FisheyeAndPanoramaHoldTheLightThatASensorGets) {
  Drawing drawing;
  addRoomWithPane(drawing, {0, 0, 0}, {4, 6, 3}, {0.5, 1.0, 3.5, 2.5});
  Study study;
  study.grids = {};
  ViewSettings fisheye;
  fisheye.projection = Projection::fisheye;
  fisheye.eye_m = {2.0, 2.0, 0.9};
  fisheye.target_m = {2.0, 2.0, 2.0};
  fisheye.up = {0.0, 1.0, 0.0};
  fisheye.fieldOfView_deg = 180.0;
  fisheye.size_px = {180, 180};
  ViewSettings panorama;
  panorama.projection = Projection::panorama;
  panorama.eye_m = fisheye.eye_m;
  panorama.target_m = {3.0, 3.0, 2.0};  // its height does not tilt the horizon
  panorama.size_px = {320, 160};
  study.views = {fisheye, panorama};
  Building building = buildingOf(drawing.scene);
  SensorGrid grid;
  grid.points = {fisheye.eye_m};
  grid.normals = {{0.0, 0.0, 1.0}};
  building.grids = {grid};
  const Solution solution = solve(building, study, {});
  const double sensor_lx = solution.grids.at(0).sensors.at(0).illuminance_lx;

  constexpr double pi = std::numbers::pi;
  EXPECT_NEAR(lightFromAbove_lx(solution.views[0]), sensor_lx, 0.03 * sensor_lx);

  double around_lx = 0.0;
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 320; ++x) {
      const double altitude = pi * (80.0 - y - 0.5) / 160.0;
      const glm::vec3& pixel = solution.views[1].pixels_cd_m2[static_cast<std::size_t>(320 * y + x)];
      around_lx +=
          static_cast<double>(pixel.g) * std::sin(altitude) * std::cos(altitude) * pi / 160.0 * pi / 160.0;
    }
  }
  EXPECT_NEAR(around_lx, sensor_lx, 0.03 * sensor_lx);
}

// A patch of sun on the floor lights all else: what a fisheye sees of that is what a sensor in the shade
// gets, whose gather reads the solution where the picture looks at the patch anew.
TEST(View, SurfacesAreLitByAPatchOfSun) {
  Drawing drawing;
  addRoomWithPane(drawing, {0, 0, 0}, {4, 6, 3}, {0.5, 1.0, 3.5, 2.5});
  Study study;
  study.grids = {};
  study.sky.cieType = 12;
  study.sky.diffuseHorizontal_lx = 8000.0;
  study.sky.directNormal_lx = 70000.0;
  study.sky.sun_deg = glm::dvec2(45.0, 180.0);
  ViewSettings fisheye;
  fisheye.projection = Projection::fisheye;
  fisheye.eye_m = {2.0, 5.0, 0.9};
  fisheye.target_m = {2.0, 5.0, 2.0};
  fisheye.up = {0.0, 1.0, 0.0};
  fisheye.fieldOfView_deg = 180.0;
  fisheye.size_px = {180, 180};
  study.views = {fisheye};
  Building building = buildingOf(drawing.scene, study);
  SensorGrid grid;
  grid.points = {fisheye.eye_m};
  grid.normals = {{0.0, 0.0, 1.0}};
  building.grids = {grid};
  const Solution solution = solve(building, study, {});
  const SensorValue& sensor = solution.grids.at(0).sensors.at(0);
  ASSERT_GT(sensor.reflected_lx, 5.0 * sensor.direct_lx);
  EXPECT_NEAR(lightFromAbove_lx(solution.views[0]), sensor.illuminance_lx, 0.03 * sensor.illuminance_lx);
}

// Who looks at the sun through a pane sees its disc: 0.53 deg across, and of as much light as the glass lets
// through of the beam.
TEST(View, ShowsTheSunsDisc) {
  Drawing drawing;
  addRoomWithPane(drawing, {0, 0, 0}, {4, 6, 3}, {0.5, 0.5, 3.5, 2.8});
  Study study;
  study.sky.cieType = 12;
  study.sky.directNormal_lx = 60000.0;
  study.sky.sun_deg = glm::dvec2(20.0, 170.0);
  ViewSettings view;
  view.eye_m = {2, 3, 1.0};
  const double altitude = glm::radians(20.0), azimuth = glm::radians(170.0);
  const glm::dvec3 towards(std::cos(altitude) * std::sin(azimuth), std::cos(altitude) * std::cos(azimuth),
                           std::sin(altitude));
  view.target_m = view.eye_m + towards;
  view.fieldOfView_deg = 1.0;
  view.size_px = {100, 100};
  study.views = {view};
  const Building building = buildingOf(drawing.scene, study);
  const Solution solution = solve(building, study, {});
  const double pixel_sr = std::pow(2.0 * std::tan(glm::radians(0.5)) / 100.0, 2);
  double beam_lx = 0.0;
  int bright = 0;
  for (const glm::vec3& pixel : solution.views.at(0).pixels_cd_m2) {
    if (pixel.g < 1e6F) continue;  // the sky has some thousands
    beam_lx += static_cast<double>(pixel.g) * pixel_sr;
    ++bright;
  }
  EXPECT_NEAR(bright, 0.25 * std::numbers::pi * 53.0 * 53.0, 0.1 * 2200.0);  // pixels at its edge count whole
  const double expected_lx = 60000.0 * Glass(0.7).transmittance(-towards.y);
  EXPECT_NEAR(beam_lx, expected_lx, 0.03 * expected_lx);
}

// A screen before the window leaves a strip of sky, which comes into view at a line on the wall behind. All
// is the same from left to right and from right to left, and so are the pixels: what differs is noise.
TEST(View, LightBeginsAtACleanLine) {
  Drawing drawing;
  addRoomWithPane(drawing, {0, 0, 0}, {4, 6, 3}, {0.5, 1.0, 3.5, 2.5});
  const std::uint32_t dark = addMaterial(drawing, {.name = "screen", .reflectance = glm::dvec3(0.02)});
  drawing.face({{-20.0, -1.5, 1.1}, {24.0, -1.5, 1.1}, {24.0, -1.5, 6.0}, {-20.0, -1.5, 6.0}}, dark);
  Study study;
  study.groundReflectance = 0.05;
  ViewSettings view;
  view.eye_m = {2.0, 1.0, 0.8};
  view.target_m = {2.0, 6.0, 0.8};
  view.fieldOfView_deg = 20.0;
  constexpr int width = 320;
  constexpr int height = 180;
  view.size_px = {width, height};
  study.views = {view};
  const Solution solution = solve(buildingOf(drawing.scene, study), study, {});
  const std::vector<glm::vec3>& pixels = solution.views.at(0).pixels_cd_m2;
  double squares = 0.0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width / 2; ++x) {
      const auto left = static_cast<std::size_t>(y * width + x);
      const auto right = static_cast<std::size_t>(y * width + width - 1 - x);
      squares += std::pow(std::log(static_cast<double>(pixels[left].g / pixels[right].g)), 2);
    }
  }
  EXPECT_LT(std::sqrt(squares / (width / 2 * height)), 0.02);  // the step that an eye begins to see
}

}  // namespace
}  // namespace clerestory
