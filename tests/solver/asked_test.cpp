// SPDX-License-Identifier: GPL-3.0-or-later
// What nobody asks for is left out, and what is asked for is the same.
#include <set>

#include "solved.hpp"

namespace clerestory {
namespace {

using namespace drawn;

/// Two rooms of 4 x 6 x 3 m, a metre apart, each with a pane to the south; sensors in as many of them.
Solution rowOfTwo(int roomsWithSensors) {
  Drawing drawing;
  addRoomWithPane(drawing, {0, 0, 0}, {4, 6, 3}, {0.5, 0.8, 3.5, 2.6});
  addRoomWithPane(drawing, {5, 0, 0}, {9, 6, 3}, {5.5, 0.8, 8.5, 2.6});
  Study study;
  for (int room = 0; room < roomsWithSensors; ++room)
    study.grids.push_back(gridOf(pointsOver({5.0 * room, 0, 0}, {5.0 * room + 4.0, 6, 3}, 0.85, 1.0)));
  return solved(drawing.scene, study).solution;
}

std::set<std::int32_t> roomsOf(const Solution& solution) {
  std::set<std::int32_t> rooms;
  for (const SurfaceValue& row : solution.surfaces)
    if (row.room >= 0) rooms.insert(row.room);
  return rooms;
}

TEST(Asked, ARoomWithoutSensorsIsLeftOut) {
  const Solution one = rowOfTwo(1);
  const Solution both = rowOfTwo(2);
  EXPECT_EQ(roomsOf(one), std::set<std::int32_t>{0});
  EXPECT_EQ(roomsOf(both), (std::set<std::int32_t>{0, 1}));
  EXPECT_EQ(one.balances.size(), 1U);
  EXPECT_EQ(both.balances.size(), 2U);
  ASSERT_EQ(one.grids.at(0).sensors.size(), both.grids.at(0).sensors.size());
  for (std::size_t i = 0; i < one.grids[0].sensors.size(); ++i) {
    EXPECT_GT(one.grids[0].sensors[i].illuminance_lx, 0.0);
    EXPECT_EQ(one.grids[0].sensors[i].illuminance_lx, both.grids[0].sensors[i].illuminance_lx);
  }
}

TEST(Asked, AllRoomsAreWhereNoSensorIs) {
  EXPECT_EQ(roomsOf(rowOfTwo(0)), (std::set<std::int32_t>{0, 1}));
}

// From far off nobody looks at the house, so none of its outside weighs anything. The sensor and what is
// stated of its error are still sound.
TEST(Asked, NothingOutdoorsIsLookedAt) {
  Drawing drawing;
  addRoomWithPane(drawing, {0, 0, 0}, {4, 6, 3}, {1, 0.8, 3, 2.2});
  Study study;
  study.grids = {gridOf({{2000, 2000, 1}})};
  const Solved far = solved(drawing.scene, study);
  const SensorValue& sensor = far.solution.grids.at(0).sensors.at(0);
  EXPECT_NEAR(sensor.illuminance_lx, study.sky.diffuseHorizontal_lx, 0.01 * study.sky.diffuseHorizontal_lx);
  EXPECT_LE(sensor.error_lx, 0.1 * sensor.illuminance_lx);  // false for what is no number
}

}  // namespace
}  // namespace clerestory
