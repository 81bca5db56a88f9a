// SPDX-License-Identifier: GPL-3.0-or-later
// Where the sensors of a grid stand: centred over rooms, within outlines, as listed, and clear of furniture.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "../import/tempfolder.hpp"
#include "../scenes.hpp"

namespace clerestory {
namespace {

using namespace drawn;

constexpr double exact = 1e-9;  // a few additions in double

// A room of 4.1 x 3 m, 2.8 m high, whose floor lies 1 m above the origin.
Drawing roomDrawing() {
  Drawing drawing;
  addBox(drawing, {10.0, 20.0, 1.0}, {14.1, 23.0, 3.8});
  return drawing;
}

GridSettings roomGrid(double spacing_m) {
  GridSettings grid;
  grid.name = "Desks";
  grid.spacing_m = spacing_m;
  return grid;
}

SensorGrid laid(const Drawing& drawing, const GridSettings& settings) {
  Study study;
  study.grids = {settings};
  const Building building = buildingOf(drawing.scene, study);
  EXPECT_EQ(building.grids.size(), 1U);
  EXPECT_EQ(building.grids.at(0).points.size(), building.grids.at(0).normals.size());
  return building.grids.at(0);
}

TEST(Grids, PointsAreCentredOverTheFloor) {
  const SensorGrid grid = laid(roomDrawing(), roomGrid(0.5));
  ASSERT_EQ(grid.points.size(), 8U * 6U);  // floor(4.1 / 0.5) by floor(3 / 0.5)
  EXPECT_EQ(grid.room, 0);
  EXPECT_EQ(grid.spacing_m, 0.5);
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    EXPECT_NEAR(grid.points[i].x, 10.3 + 0.5 * static_cast<double>(i % 8), exact);
    EXPECT_NEAR(grid.points[i].y, 20.25 + 0.5 * static_cast<double>(i / 8), exact);
    EXPECT_NEAR(grid.points[i].z, 1.85, exact);
    EXPECT_EQ(grid.normals[i], glm::dvec3(0, 0, 1));
  }
}

TEST(Grids, SpacingThatDividesTheRoomLosesNoRow) {
  Drawing drawing;
  addBox(drawing, {0, 0, 0}, {3.6, 4.2, 2.8});  // 3.6 / 0.3 and 4.2 / 0.3 are below 12 and 14 in double
  EXPECT_EQ(laid(drawing, roomGrid(0.3)).points.size(), 12U * 14U);
}

TEST(Grids, SpacingWiderThanTheRoomLeavesOnePoint) {
  const SensorGrid grid = laid(roomDrawing(), roomGrid(10.0));
  ASSERT_EQ(grid.points.size(), 1U);
  EXPECT_NEAR(grid.points[0].x, 12.05, exact);
  EXPECT_NEAR(grid.points[0].y, 21.5, exact);
}

TEST(Grids, InsetKeepsClearOfTheWalls) {
  GridSettings settings = roomGrid(0.5);
  settings.inset_m = 0.5;
  const SensorGrid grid = laid(roomDrawing(), settings);
  ASSERT_EQ(grid.points.size(), 6U * 4U);  // 3.1 x 2 m are left
  EXPECT_NEAR(grid.points[0].x, 10.5 + 0.5 * (3.1 - 5 * 0.5), exact);
  EXPECT_NEAR(grid.points[0].y, 20.5 + 0.5 * (2.0 - 3 * 0.5), exact);
  for (const glm::dvec3& point : grid.points) {
    EXPECT_GE(point.x, 10.5);
    EXPECT_LE(point.x, 13.6);
    EXPECT_GE(point.y, 20.5);
    EXPECT_LE(point.y, 22.5);
  }
}

TEST(Grids, SensorWithinACabinetIsLeftOut) {
  Drawing drawing = roomDrawing();
  addBox(drawing, {11.0, 20.5, 1.0}, {12.2, 21.1, 3.0}, wood,
         1);  // stands on the floor, higher than the grid
  const SensorGrid grid = laid(drawing, roomGrid(0.5));
  const SensorGrid all = laid(roomDrawing(), roomGrid(0.5));
  std::vector<glm::dvec3> expected;
  for (const glm::dvec3& point : all.points) {
    const bool within = point.x > 11.0 && point.x < 12.2 && point.y > 20.5 && point.y < 21.1;
    if (!within) expected.push_back(point);
  }
  ASSERT_EQ(all.points.size() - expected.size(), 2U);  // (11.3 and 11.8, 20.75)
  EXPECT_EQ(grid.points, expected);
}

TEST(Grids, SensorOverATableStays) {
  Drawing drawing = roomDrawing();
  addBox(drawing, {11.0, 20.5, 1.7}, {12.6, 21.3, 1.75}, wood, 1);
  EXPECT_EQ(laid(drawing, roomGrid(0.5)).points.size(), 48U);
}

TEST(Grids, PolygonHoldsItsPoints) {
  GridSettings settings = roomGrid(0.5);
  settings.polygon_m = {{10.5, 20.5}, {12.5, 20.5}, {12.5, 21.5},
                        {11.5, 21.5}, {11.5, 22.5}, {10.5, 22.5}};  // an L
  const SensorGrid grid = laid(roomDrawing(), settings);
  EXPECT_EQ(grid.room, 0);
  ASSERT_EQ(grid.points.size(), 12U);  // 4 x 4 over its bounds, less the quarter that is not in it
  for (const glm::dvec3& point : grid.points) {
    EXPECT_FALSE(point.x > 11.5 && point.y > 21.5);
    EXPECT_NEAR(point.z, 1.85, exact);  // over the floor of the room below
  }
  EXPECT_NEAR(grid.points[0].x, 10.75, exact);
  EXPECT_NEAR(grid.points[0].y, 20.75, exact);

  settings.inset_m = 0.3;
  for (const glm::dvec3& point : laid(roomDrawing(), settings).points) {
    EXPECT_GE(point.x, 10.8 - exact);
    EXPECT_GE(point.y, 20.8 - exact);
    EXPECT_GE(glm::length(glm::dvec2(11.5, 21.5) - glm::dvec2(point)), 0.3 - exact);  // the L's inner corner
  }
}

TEST(Grids, ListedPointsStayAsTheyAre) {
  GridSettings settings;
  settings.name = "listed";
  settings.points = {{11.0, 21.0, 1.5, 0.0, 0.0, 2.0}, {12.0, 22.0, 2.5, 0.0, -3.0, 4.0}};
  const SensorGrid grid = laid(roomDrawing(), settings);
  EXPECT_EQ(grid.room, 0);
  EXPECT_EQ(grid.points, (std::vector<glm::dvec3>{{11.0, 21.0, 1.5}, {12.0, 22.0, 2.5}}));
  EXPECT_EQ(grid.normals[0], glm::dvec3(0, 0, 1));
  EXPECT_NEAR(glm::length(grid.normals[1] - glm::dvec3(0.0, -0.6, 0.8)), 0.0, 1e-15);
}

TEST(Grids, EveryRoomGetsOne) {
  Drawing drawing = roomDrawing();
  addBox(drawing, {20.0, 20.0, 1.0}, {23.0, 23.0, 3.8});
  Study study;
  study.grids = {roomGrid(0.5)};
  const Building building = buildingOf(drawing.scene, study);
  ASSERT_EQ(building.grids.size(), 2U);
  EXPECT_EQ(building.grids[0].name, "Desks Room 1");
  EXPECT_EQ(building.grids[1].name, "Desks Room 2");
  EXPECT_EQ(building.grids[1].points.size(), 36U);

  study.grids[0].room = "*2";
  const Building one = buildingOf(drawing.scene, study);
  ASSERT_EQ(one.grids.size(), 1U);
  EXPECT_EQ(one.grids[0].name, "Desks");
  EXPECT_EQ(one.grids[0].room, 1);
}

TEST(Grids, NoSensorIsAnErrorThatSaysWhatToDo) {
  const auto errorOf = [](const GridSettings& settings) {
    Study study;
    study.grids = {settings};
    return inputErrorOf([&] { buildingOf(roomDrawing().scene, study); });
  };
  GridSettings settings = roomGrid(0.5);
  settings.inset_m = 2.0;
  const std::string tooSmall = errorOf(settings);
  for (const char* word : {"Desks", "no sensor", "spacing", "inset"})
    EXPECT_TRUE(contains(tooSmall, word)) << tooSmall;

  settings = roomGrid(0.5);
  settings.height_m = 5.0;  // above the ceiling
  EXPECT_TRUE(contains(errorOf(settings), "height")) << errorOf(settings);

  settings = roomGrid(0.5);
  settings.room = "Kitchen";
  const std::string noRoom = errorOf(settings);
  for (const char* word : {"Desks", "Kitchen", "inspect"}) EXPECT_TRUE(contains(noRoom, word)) << noRoom;
}

// A millimetre over 12 m2, alone or as the second grid, and an outline as wide as a country.
TEST(Grids, TooManySensorsAreRefusedBeforeTheyAreMade) {
  GridSettings dense = roomGrid(0.001);
  GridSettings wide = roomGrid(0.25);
  wide.polygon_m = {{0, 0}, {1e6, 0}, {1e6, 1e6}, {0, 1e6}};
  for (const std::vector<GridSettings>& grids :
       {std::vector{dense}, std::vector{wide}, std::vector{roomGrid(0.5), dense}}) {
    Study study;
    study.grids = grids;
    const std::string message = inputErrorOf([&] { buildingOf(roomDrawing().scene, study); });
    for (const char* word : {"Desks", "million sensors", "spacing"})
      EXPECT_TRUE(contains(message, word)) << message;
  }
}

// A wall of 4.1 x 2.8 m that faces +y inside: points centred on it, a millimetre off it, looking into the
// room; the outer side of the same sheet has none.
TEST(Grids, LieOnSurfacesAndLookIntoTheRoom) {
  Drawing drawing;
  addBox(drawing, {10.0, 20.0, 1.0}, {14.1, 23.0, 3.8}, plaster, 0, {2});
  drawing.face(upright(10.0, 1.0, 14.1, 3.8, 20.0), plaster, addObject(drawing, "South wall"));
  GridSettings settings = roomGrid(0.5);
  settings.surface = "south*";
  settings.height_m = 0.0;
  const SensorGrid grid = laid(drawing, settings);
  ASSERT_EQ(grid.points.size(), 8U * 5U);
  EXPECT_EQ(grid.room, 0);
  std::set<double> columns, rows;
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    EXPECT_NEAR(grid.points[i].y, 20.001, exact);
    EXPECT_EQ(grid.normals[i], glm::dvec3(0, 1, 0));
    columns.insert(std::round(1e6 * grid.points[i].x) / 1e6);
    rows.insert(std::round(1e6 * grid.points[i].z) / 1e6);
  }
  ASSERT_EQ(columns.size(), 8U);
  ASSERT_EQ(rows.size(), 5U);
  EXPECT_NEAR(*columns.begin(), 10.3, 1e-5);
  EXPECT_NEAR(*rows.begin(), 1.4, 1e-5);
}

// A box stands on the floor of one of two rooms: points beneath it are left out, and each room has a grid.
TEST(Grids, OnSurfacesAreLaidForEachRoom) {
  Drawing drawing;
  addBox(drawing, {0, 0, 0}, {4, 3, 2.8}, plaster, addObject(drawing, "Box A"));
  addBox(drawing, {10, 0, 0}, {14, 3, 2.8}, plaster, addObject(drawing, "Box B"));
  addBox(drawing, {1, 1, 0}, {2, 2, 0.5}, wood, addObject(drawing, "Crate"));
  Study study;
  GridSettings settings = roomGrid(0.5);
  settings.surface = "box*";
  settings.height_m = 0.1;
  study.grids = {settings};
  const Building building = buildingOf(drawing.scene, study);
  ASSERT_EQ(building.grids.size(), 2U);
  const std::size_t all = 2U * (8U * 6U + 8U * 5U + 6U * 5U);
  EXPECT_EQ(building.grids[0].points.size() + 4U, all);
  EXPECT_EQ(building.grids[1].points.size(), all);
  settings.surface = "nothing";
  study.grids = {settings};
  EXPECT_THROW(buildingOf(drawing.scene, study), InputError);
}

// Points in two rooms that share no air are of neither, so each is lit by the air it stands in.
TEST(Grids, PointsInTwoAirsHaveNoRoom) {
  Drawing drawing;
  addBox(drawing, {0, 0, 0}, {4, 3, 2.8});
  addBox(drawing, {10, 0, 0}, {14, 3, 2.8});
  EXPECT_EQ(laid(drawing, gridOf({{1, 1, 0.85}, {3, 2, 0.85}})).room, 0);
  EXPECT_EQ(laid(drawing, gridOf({{1, 1, 0.85}, {11, 1, 0.85}})).room, -1);
  GridSettings outline = roomGrid(1.0);
  outline.polygon_m = {{0, 0}, {14, 0}, {14, 3}, {0, 3}};
  EXPECT_EQ(laid(drawing, outline).room, -1);
}

}  // namespace
}  // namespace clerestory
