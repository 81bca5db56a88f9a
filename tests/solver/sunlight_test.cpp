// SPDX-License-Identifier: GPL-3.0-or-later
// Sunlight in a room: patches that end where they should, all of the beam's power, and reflections of it.
#include <glm/trigonometric.hpp>

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
