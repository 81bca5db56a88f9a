// SPDX-License-Identifier: GPL-3.0-or-later
// The checks of a room beside its sensors, against the formula by hand and the hours of an equinox.
#include <solver/glass.hpp>

#include "solved.hpp"

namespace clerestory {
namespace {

using namespace drawn;

constexpr double reflectance = 0.5;

/// A room of 4 x 6 x 3 m with a pane of 3 x 1.8 m to the south, and a wall before it of a given height.
RoomValue roomBehind(double wall_m, const Site& site = {}) {
  Drawing drawing;
  drawing.scene.materials[plaster].reflectance = glm::dvec3(reflectance);
  addRoomWithPane(drawing, {0, 0, 0}, {4, 6, 3}, {0.5, 0.8, 3.5, 2.6});
  if (wall_m > 0.0) drawing.face(upright(-500, 0, 504, wall_m, -10.0));
  Study study;
  study.site = site;
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

}  // namespace
}  // namespace clerestory
