// SPDX-License-Identifier: GPL-3.0-or-later
// The checks of a room beside its sensors, against the formula by hand and the hours of an equinox.
#include <glm/trigonometric.hpp>

#include <solver/daylight.hpp>
#include <solver/glass.hpp>

#include "solved.hpp"

namespace clerestory {
namespace {

using namespace drawn;

constexpr double reflectance = 0.5;

/// A room of 4 x 6 x 3 m with a pane of 3 x 1.8 m to the south, and a wall before it of a given height.
RoomValue roomBehind(double wall_m, const Site& site = {}, const SunlightSettings& sunlight = {}) {
  Drawing drawing;
  drawing.scene.materials[plaster].reflectance = glm::dvec3(reflectance);
  addRoomWithPane(drawing, {0, 0, 0}, {4, 6, 3}, {0.5, 0.8, 3.5, 2.6});
  if (wall_m > 0.0) drawing.face(upright(-500, 0, 504, wall_m, -10.0));
  Study study;
  study.site = site;
  study.sunlight = sunlight;
  const Solved room = solved(drawing.scene, study);
  EXPECT_EQ(room.solution.rooms.size(), 1U);
  return room.solution.rooms.at(0);
}

double formula_pct(double skyAngle_deg) {
  const Glass pane(0.7);  // what the drawing's glass passes
  constexpr double panes_m2 = 5.4, all_m2 = 2.0 * (4.0 * 6.0 + 4.0 * 3.0 + 6.0 * 3.0);
  const double mean =
      (panes_m2 * pane.hemisphericalReflectance() + (all_m2 - panes_m2) * reflectance) / all_m2;
  return pane.hemisphericalTransmittance() * panes_m2 * skyAngle_deg / (all_m2 * (1.0 - mean * mean));
}

TEST(Rooms, AverageDaylightFactorIsTheFormulas) {
  EXPECT_NEAR(roomBehind(0.0).averageDaylightFactor_pct, formula_pct(90.0), 1e-3 * formula_pct(90.0));
  // A wall 10 m away that rises 10 m above the pane's middle leaves 45 degrees, found in half degrees.
  EXPECT_NEAR(roomBehind(11.7).averageDaylightFactor_pct, formula_pct(45.0), 0.012 * formula_pct(45.0));
}

// On the equinox the sun moves in a plane through east and west: a free pane to the south sees it as long as
// it is up, 12 hours and the minutes that refraction adds (1.1 deg at both ends over 10 deg an hour and more
// at this latitude: 7 minutes), less those before it passes east and after it passes west (none to speak of).
TEST(Rooms, SunlightOfTheEquinoxLastsTwelveHours) {
  EXPECT_NEAR(roomBehind(0.0).sunlight_h, 12.0, 0.25);
}

// To the north of a pane on the southern half of the globe, nothing.
TEST(Rooms, NoSunFromTheFarSide) {
  Site south;
  south.latitude_deg = -33.9;
  south.longitude_deg = 18.4;
  south.timeZone_h = 2.0;
  EXPECT_LT(roomBehind(0.0, south).sunlight_h, 0.5);
}

// At 47.37 deg north the plane of the sun's way stands 42.63 deg above the south's horizon. Before an endless
// wall whose top is seen under that angle it is hidden all day, but for an hour or so after it rises and
// before it sets: half a day after the equinox it is 0.2 deg north of that plane, and refraction lifts it.
TEST(Rooms, WallBeforeThePaneTakesTheSun) {
  const double top_m = 1.7 + 10.0 * std::tan(42.63 / 180.0 * std::numbers::pi);
  EXPECT_GT(roomBehind(top_m - 0.5).sunlight_h, 8.0);
  EXPECT_LT(roomBehind(top_m + 0.5).sunlight_h, 3.0);
}

// The sun rises south of east on 1 February: at 47.37 deg north and a declination of -17.2 deg it is up for
// 2 acos(tan 47.37 tan 17.2) / 15 = 9.4 hours, and 10 minutes more by refraction, all of it before the pane.
TEST(Rooms, SunlightIsThatOfTheDayAskedFor) {
  SunlightSettings sunlight;
  sunlight.date.month = 2;
  sunlight.date.day = 1;
  EXPECT_NEAR(roomBehind(0.0, {}, sunlight).sunlight_h, 9.55, 0.2);
  // At noon it stands at 90 - 47.37 - 17.2 = 25.4 deg.
  sunlight.leastAltitude_deg = 25.0;
  EXPECT_LT(roomBehind(0.0, {}, sunlight).sunlight_h, 1.5);
  sunlight.leastAltitude_deg = 26.0;
  EXPECT_EQ(roomBehind(0.0, {}, sunlight).sunlight_h, 0.0);
}

// The sun is counted from the inner end of the reveal: of an opening of 1.5 m in a wall of 0.5 m that looks
// to the south, those suns that are less than atan(0.75 / 0.5) = 56.3 deg aside, and under the lintel.
TEST(Rooms, RevealsTakeSunlight) {
  Drawing drawing;
  addBox(drawing, {0, 0, 0}, {5, 6, 3}, plaster, 0, {2});
  addWallWithHole(drawing, 0, 0, 5, 3, 0, {1.75, 0.8, 3.25, 2.6});
  for (const auto& [x, z] : {std::pair{1.75, 0.0}, {3.25, 0.0}, {0.0, 0.8}, {0.0, 2.6}}) {
    if (x > 0.0) {
      drawing.face({{x, -0.5, 0.8}, {x, 0, 0.8}, {x, 0, 2.6}, {x, -0.5, 2.6}});
    } else {
      drawing.face({{1.75, -0.5, z}, {3.25, -0.5, z}, {3.25, 0, z}, {1.75, 0, z}});
    }
  }
  drawing.face(upright(1.75, 0.8, 3.25, 2.6, -0.5), glass);
  Study study;
  const Solved room = solved(drawing.scene, study);
  ASSERT_EQ(room.solution.rooms.size(), 1U);
  // 1.2 m above the floor, below a lintel 1.4 m higher and 0.5 m away: seen under 70 deg, above any sun.
  double hours = 0.0;
  ClockTime time;
  for (int minute = 0; minute < 24 * 60; ++minute) {
    time.hour_h = minute / 60.0;
    const glm::dvec2 sun_deg = sunPosition_deg(time, study.site);
    if (sun_deg.x > 0.0 && std::abs(sun_deg.y - 180.0) < glm::degrees(std::atan(0.75 / 0.5)))
      hours += 1.0 / 60.0;
  }
  EXPECT_LT(hours, 8.0);
  EXPECT_NEAR(room.solution.rooms[0].sunlight_h, hours, 0.2);  // to 2 cm of depth and 5 minutes
}

// A pane counts for the room that it serves, not for another that shares its air.
TEST(Rooms, NextRoomsPaneDoesNotCount) {
  const Scene scene = testModel("reference/floor/floor.obj", {});
  Study study;
  study.accuracy = 0.5;
  study.grids = {gridOf({{1, 2, 0.85}})};
  const Solved floor = solved(scene, study);
  const Building& building = floor.building;
  const Solution& solution = floor.solution;
  std::size_t without = 0;
  for (std::size_t i = 0; i < building.rooms.size(); ++i) {
    const bool hasPane =
        std::any_of(building.portals.begin(), building.portals.end(),
                    [&](const Portal& portal) { return portal.room == static_cast<std::int32_t>(i); });
    EXPECT_EQ(solution.rooms.at(i).averageDaylightFactor_pct > 0.0, hasPane);
    if (!hasPane) {
      EXPECT_EQ(solution.rooms[i].sunlight_h, 0.0);
    }
    without += hasPane ? 0 : 1;
  }
  EXPECT_GE(without, 1U) << "the corridor";
}

// A list of points in two rooms side by side, without a door: each sensor has the light of its own room's
// window, whichever is first in the list.
TEST(Rooms, SensorsOfOneListStandInDifferentRooms) {
  Drawing drawing;
  addRoomWithPane(drawing, {0, 0, 0}, {4, 5, 3}, {0.5, 0.8, 3.5, 2.6});
  addRoomWithPane(drawing, {10, 0, 0}, {14, 5, 3}, {11.5, 1.2, 12.5, 2.0});
  const std::vector<glm::dvec3> places = {{2, 2, 0.85}, {12, 2, 0.85}};
  Study study;
  study.grids = {gridOf(places)};
  const std::vector<double> both_lx = solved(drawing.scene, study).sensors_lx();
  EXPECT_GT(both_lx[0], 2.0 * both_lx[1]);
  for (std::size_t i = 0; i < 2; ++i) {
    study.grids = {gridOf({places[i]})};
    const double alone_lx = solved(drawing.scene, study).sensors_lx().at(0);
    EXPECT_NEAR(both_lx[i], alone_lx, 0.1 * alone_lx) << i;  // each number in a list has rays of its own
  }
}

}  // namespace
}  // namespace clerestory
