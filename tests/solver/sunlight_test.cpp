// SPDX-License-Identifier: GPL-3.0-or-later
// Sunlight in a room: patches that end where they should, all of the beam's power, and reflections of it.
#include <glm/trigonometric.hpp>

#include <numbers>

#include <solver/glass.hpp>

#include "solved.hpp"

namespace clerestory {
namespace {

using namespace drawn;

constexpr double beam_lx = 60000.0;
constexpr double altitude_deg = 45.0;

/// A room of 4 x 6 x 3 m with an opening of 2 x 1.4 m to the south; the sun stands there at 45 deg, so the
/// patch lies on the floor from y = 0.8 to 2.2 m, and x = 1 to 3 m.
Drawing sunnyRoom(double reflectance, double transmittance = 1.0) {
  Drawing drawing;
  drawing.scene.materials[plaster].reflectance = glm::dvec3(reflectance);
  drawing.scene.materials[glass].transmittance = glm::dvec3(transmittance);
  const std::uint32_t floor = addObject(drawing, "floor");
  addBox(drawing, {0, 0, 0}, {4, 6, 3}, plaster, 0, {0, 2});
  drawing.face(box({0, 0, 0}, {4, 6, 3})[0], plaster, floor);
  addWallWithHole(drawing, 0, 0, 4, 3, 0, {1, 0.8, 3, 2.2});
  drawing.face(upright(1, 0.8, 3, 2.2), glass);
  return drawing;
}

Study sunnyStudy(const std::vector<glm::dvec3>& points = {{2, 3, 0.85}}) {
  Study study;
  study.groundReflectance = 0.0;
  study.sky.diffuseHorizontal_lx = 1.0;
  study.sky.directNormal_lx = beam_lx;
  study.sky.sun_deg = glm::dvec2(altitude_deg, 180.0);
  study.grids = {gridOf(points)};
  return study;
}

double floorPower_lm(const Solved& room) {
  for (const SurfaceValue& row : room.solution.surfaces) {
    if (room.building.model.surfaces[row.surface].name == "floor")
      return row.illuminanceMean_lx * row.area_m2;
  }
  ADD_FAILURE() << "no floor";
  return 0.0;
}

// What enters is the beam times the opening's area that it sees, and all of it falls on the floor; the sky,
// of 1 lx, adds less than 3 lm. Rays start 0.1 mm off the floor, so a strip as wide is lost at the opening's
// edge: 2.4e-4 of the power.
TEST(Sunlight, AllOfTheBeamArrives) {
  const double entering_lm = beam_lx * std::cos(glm::radians(altitude_deg)) * 2.8;
  EXPECT_NEAR(floorPower_lm(solved(sunnyRoom(0.0).scene, sunnyStudy())), entering_lm,
              3.0 + 3e-4 * entering_lm);
}

// Glass of 0.5 at normal incidence passes what its model says at 45 deg.
TEST(Sunlight, GlassTakesItsShareByAngle) {
  const double entering_lm = beam_lx * std::cos(glm::radians(altitude_deg)) * 2.8;
  const double passed = Glass(0.5).transmittance(std::cos(glm::radians(altitude_deg)));
  EXPECT_LT(passed, 0.49);
  EXPECT_NEAR(floorPower_lm(solved(sunnyRoom(0.0, 0.5).scene, sunnyStudy())), passed * entering_lm,
              3.0 + 1e-3 * entering_lm);
}

// A bar across the opening takes the share of its width, though it is narrower than any element: within a
// twentieth of itself.
TEST(Sunlight, MullionTakesItsWidth) {
  Drawing drawing = sunnyRoom(0.0);
  addBox(drawing, {1.97, 0.05, 0.7}, {2.03, 0.06, 2.3}, wood, addObject(drawing, "mullion"));
  drawing.scene.materials[wood].reflectance = glm::dvec3(0.0);
  const double entering_lm = beam_lx * std::cos(glm::radians(altitude_deg)) * 2.8;
  const double taken_lm = 0.06 / 2.0 * entering_lm;
  EXPECT_NEAR(floorPower_lm(solved(drawing.scene, sunnyStudy())), entering_lm - taken_lm,
              3.0 + 0.05 * taken_lm);
}

// A patch is sharp: 2 cm inside it a sensor has the whole beam, 2 cm outside nothing. The sun's disc is
// 0.53 deg wide, which at 3 m makes a penumbra of 1.4 cm to either side.
TEST(Sunlight, PatchesAreSharp) {
  const double full_lx = beam_lx * std::sin(glm::radians(altitude_deg));
  const std::vector<glm::dvec3> points = {{1.03, 1.5, 1e-3}, {0.97, 1.5, 1e-3}, {2, 0.83, 1e-3},
                                          {2, 0.77, 1e-3},   {2, 2.15, 1e-3},   {2, 2.25, 1e-3}};
  const Solved room = solved(sunnyRoom(0.0).scene, sunnyStudy(points));
  const auto& sensors = room.solution.grids.at(0).sensors;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(sensors[i].sun_lx, i % 2 == 0 ? full_lx : 0.0, 0.002 * full_lx) << "point " << i;
    EXPECT_NEAR(sensors[i].sun_lx + sensors[i].sky_lx, sensors[i].illuminance_lx, 1e-3);
    EXPECT_NEAR(sensors[i].direct_lx + sensors[i].reflected_lx, sensors[i].illuminance_lx, 1e-3);
  }
}

// What is reflected ends somewhere: in the walls, or out by the opening again. The beam itself is exact, and
// what the links miss is mended, so the balance closes to float's rounding.
TEST(Sunlight, LightIsKept) {
  const Solved room = solved(sunnyRoom(0.7).scene, sunnyStudy());
  const EnergyBalance balance = room.balanceOf(room.building.rooms.at(0).domain);
  EXPECT_GT(balance.emitted_lm, 1e5);
  EXPECT_NEAR(balance.absorbed_lm + balance.escaped_lm, balance.emitted_lm, 1e-3 * balance.emitted_lm);
}

// The strip of ceiling above the window sees the patch on the floor twice: straight, and at grazing angles in
// the pane. All but the floor is black, so a sum over both, the patch's image weighed by what glass reflects
// at the angle, is all its light.
TEST(Sunlight, PanesMirrorThePatch) {
  constexpr double floorReflectance = 0.8;
  constexpr double height_m = 3.0;
  constexpr double stripDepth_m = 1.0;
  Drawing drawing;
  drawing.scene.materials[plaster].reflectance = glm::dvec3(0.0);
  drawing.scene.materials[glass].transmittance = glm::dvec3(0.65);
  const std::uint32_t pale =
      addMaterial(drawing, {.name = "pale", .reflectance = glm::dvec3(floorReflectance)});
  addBox(drawing, {0, 0, 0}, {4, 6, height_m}, plaster, 0, {0, 1, 2});
  drawing.face(box({0, 0, 0}, {4, 6, height_m})[0], pale, addObject(drawing, "floor"));
  drawing.face(box({0, 0, 0}, {4, stripDepth_m, height_m})[1], plaster, addObject(drawing, "strip"));
  drawing.face(box({0, stripDepth_m, 0}, {4, 6, height_m})[1], plaster, addObject(drawing, "ceiling"));
  const Hole hole{1, 0.8, 3, 2.2};
  addWallWithHole(drawing, 0, 0, 4, height_m, 0, hole);
  drawing.face(upright(hole.x0, hole.z0, hole.x1, hole.z1), glass);
  Study study = sunnyStudy();
  study.accuracy = 0.0025;  // a tenth of the image is a quarter of a per cent of all
  const Solved room = solved(drawing.scene, study);

  const Glass pane(0.65);
  const double cosine = std::cos(glm::radians(altitude_deg));
  const double patch_lm_m2 =
      floorReflectance * beam_lx * std::sin(glm::radians(altitude_deg)) * pane.transmittance(cosine);
  const double patchArea_m2 = 2.0 * 1.4;  // x from 1 to 3, y from 0.8 to 2.2
  constexpr int steps = 24;
  double straight_lx = 0.0;
  double mirrored_lx = 0.0;
  for (int i = 0; i < steps * steps * steps * steps; ++i) {
    const auto part = [&](int divisor) { return ((i / divisor) % steps + 0.5) / steps; };
    const double x = 4.0 * part(1);
    const double y = stripDepth_m * part(steps);
    const double patchX = 1.0 + 2.0 * part(steps * steps);
    const double patchY = 0.8 + 1.4 * part(steps * steps * steps);
    const auto kernel = [&](double dy) {
      const double squared = (x - patchX) * (x - patchX) + dy * dy + height_m * height_m;
      return height_m * height_m / (std::numbers::pi * squared * squared);
    };
    straight_lx += kernel(y - patchY);
    const double share = y / (y + patchY);  // of the way from the strip to the image, where it meets the wall
    const double paneX = x + share * (patchX - x);
    const double paneZ = height_m * (1.0 - share);
    if (paneX < hole.x0 || paneX > hole.x1 || paneZ < hole.z0 || paneZ > hole.z1) continue;
    const double length_m = std::hypot(x - patchX, y + patchY, height_m);
    mirrored_lx += kernel(y + patchY) * pane.reflectance((y + patchY) / length_m);
  }
  const double weight = patch_lm_m2 * patchArea_m2 / std::pow(steps, 4);
  EXPECT_GT(mirrored_lx, 0.02 * straight_lx);
  bool isFound = false;
  for (const SurfaceValue& row : room.solution.surfaces) {
    if (room.building.model.surfaces[row.surface].name != "strip" || row.room < 0) continue;
    isFound = true;
    EXPECT_NEAR(row.illuminanceMean_lx, weight * (straight_lx + mirrored_lx), 0.1 * weight * mirrored_lx);
  }
  EXPECT_TRUE(isFound);
}

// The ground's sunlight comes in through the opening: seen from the ceiling, the outside below the horizon is
// a uniform lamp. Half the ground's reflectance is half the light.
TEST(Sunlight, GroundReflectsIt) {
  Study study = sunnyStudy();
  study.grids[0].points = {{2, 2, 2.95, 0, 0, -1}};
  const auto sun_lx = [&](double reflectance) {
    study.groundReflectance = reflectance;
    return solved(sunnyRoom(0.0).scene, study).solution.grids.at(0).sensors.at(0).sun_lx;
  };
  EXPECT_EQ(sun_lx(0.0), 0.0);
  const double half = sun_lx(0.2);
  EXPECT_GT(half, 10.0);
  EXPECT_NEAR(sun_lx(0.4), 2.0 * half, 1e-4 * half);
}

// What panes mirror of patches is their receivers' and is not sent by the panes as well.
TEST(Sunlight, MirroredLightIsCountedOnce) {
  const Solved room = solved(sunnyRoom(0.7, 0.65).scene, sunnyStudy());
  const EnergyBalance balance = room.balanceOf(room.building.rooms.at(0).domain);
  EXPECT_NEAR(balance.absorbed_lm + balance.escaped_lm, balance.emitted_lm, 1e-3 * balance.emitted_lm);
}

// North and the sun's azimuth turned against each other leave the sun where it was.
TEST(Sunlight, NorthTurnsWithTheSun) {
  Study turned = sunnyStudy();
  turned.site.north_deg = 40.0;
  turned.sky.sun_deg = glm::dvec2(altitude_deg, 140.0);
  const std::vector<double> first = solved(sunnyRoom(0.5).scene, sunnyStudy()).sensors_lx();
  const std::vector<double> second = solved(sunnyRoom(0.5).scene, turned).sensors_lx();
  EXPECT_NEAR(first.at(0), second.at(0), 1e-3 * first.at(0));
}

// Sunlight that a wall outdoors throws back into a room on its other side.
TEST(Sunlight, NeighboursReflectIt) {
  Study study = sunnyStudy();
  study.sky.sun_deg = glm::dvec2(30.0, 0.0);  // behind the room, onto the wall that its window looks at
  const auto lit_lx = [&](bool withWall) {
    Drawing drawing = sunnyRoom(0.0);
    const std::uint32_t bright = addMaterial(drawing, {.name = "bright", .reflectance = glm::dvec3(0.6)});
    if (withWall) drawing.face(upright(-20, -8, 24, 12, -12.0), bright, addObject(drawing, "neighbour"));
    return solved(drawing.scene, study).solution.grids.at(0).sensors.at(0).sun_lx;
  };
  EXPECT_EQ(lit_lx(false), 0.0);
  // The wall fills what the sensor sees of the outside, at the luminance 0.6 E / pi of a wall in the sun.
  const double luminance = 0.6 * beam_lx * std::cos(glm::radians(30.0)) / std::numbers::pi;
  Study patch = study;
  patch.sky = {};
  patch.sky.cieType = 5;
  patch.sky.diffuseHorizontal_lx = std::numbers::pi * luminance;
  const double seen_lx = solved(sunnyRoom(0.0).scene, patch).solution.grids.at(0).sensors.at(0).sky_lx;
  const double wall_lx = lit_lx(true);
  std::cout << "from the wall " << wall_lx << " lx, from as bright a sky " << seen_lx << " lx\n";
  EXPECT_NEAR(wall_lx, seen_lx, 0.02 * seen_lx);
}

}  // namespace
}  // namespace clerestory
