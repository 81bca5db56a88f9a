// SPDX-License-Identifier: GPL-3.0-or-later
// Rooms that share their air: parted at doors, not at wide openings, with floors and panes told apart.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include <import/photometry.hpp>

#include "../scenes.hpp"

namespace clerestory {
namespace {

using namespace drawn;

constexpr double exact = 1e-9;

/// Two rooms of 4 x 3 x 2.7 m side by side, a wall of 0.2 m with an opening of the given size between them, a
/// pane in the south wall of the western one. One floor and one ceiling run through.
Drawing twoRooms(double openingWidth_m, double openingHeight_m) {
  Drawing drawing;
  addRoomWithPane(drawing, {0, 0, 0}, {8.2, 3, 2.7}, {1.0, 1.0, 3.0, 2.0});
  const double low = 1.5 - 0.5 * openingWidth_m;
  const double high = 1.5 + 0.5 * openingWidth_m;
  addBox(drawing, {4.0, 0, 0}, {4.2, low, 2.7}, plaster, 0, {0, 1, 2});
  addBox(drawing, {4.0, high, 0}, {4.2, 3, 2.7}, plaster, 0, {0, 1, 4});
  if (openingHeight_m < 2.7)
    addBox(drawing, {4.0, low, openingHeight_m}, {4.2, high, 2.7}, plaster, 0, {1, 2, 4});
  return drawing;
}

/// The scene turned about the vertical axis.
Scene turned(Scene scene, double angle_rad) {
  for (glm::dvec3& point : scene.points) {
    point = {std::cos(angle_rad) * point.x - std::sin(angle_rad) * point.y,
             std::sin(angle_rad) * point.x + std::cos(angle_rad) * point.y, point.z};
  }
  return scene;
}

Scene mirrored(Scene scene) {
  for (glm::dvec3& point : scene.points) point.x = -point.x;
  return scene;
}

std::vector<double> floorAreas(const Building& building) {
  std::vector<double> areas_m2;
  for (const Room& room : building.rooms) areas_m2.push_back(room.floorArea_m2);
  std::sort(areas_m2.begin(), areas_m2.end());
  return areas_m2;
}

TEST(Rooms, PartAtADoor) {
  for (const double height_m : {2.05, 2.7}) {
    const Building building = buildingOf(twoRooms(0.9, height_m).scene);
    ASSERT_EQ(building.rooms.size(), 2U) << "door of " << height_m << " m";
    EXPECT_EQ(building.rooms[0].domain, building.rooms[1].domain);
    double floor_m2 = 0.0;
    for (const Room& room : building.rooms) {
      // The doorway's floor, 0.9 x 0.2 m, is halved: the cut runs through the middle of its reveals.
      EXPECT_NEAR(room.floorArea_m2, 12.09, 1e-6);
      EXPECT_NEAR(room.ceiling_m, 2.7, exact);
      floor_m2 += room.floorArea_m2;
    }
    EXPECT_NEAR(floor_m2, 24.18, 1e-6);
    ASSERT_EQ(building.borders.size(), 1U);
    const std::vector<glm::dvec3>& line_m = building.borders[0].line_m;
    ASSERT_EQ(line_m.size(), 2U);
    for (const glm::dvec3& end : line_m) EXPECT_NEAR(end.x, 4.1, 1e-6);
    EXPECT_NEAR(glm::length(line_m[1] - line_m[0]), 0.9, 1e-6);
    EXPECT_NEAR(building.borders[0].height_m, height_m, 1e-6);
  }
}

// What is found is told in the model's own axes, in which studies speak of places, and not in those that it
// was looked at in.
TEST(Rooms, AreToldInTheModelsAxes) {
  for (const double angle_rad : {0.0, 0.7, 2.4, 4.0}) {
    for (const bool isMirrored : {false, true}) {
      SCOPED_TRACE(testing::Message() << angle_rad << " rad" << (isMirrored ? ", mirrored" : ""));
      const auto placeOf = [&](const glm::dvec3& place) {
        Scene point;
        point.points = {place};
        return turned(isMirrored ? mirrored(point) : point, angle_rad).points[0];
      };
      Drawing drawing = twoRooms(0.9, 2.05);
      addBox(drawing, {7.4, 0.2, 0}, {8.1, 1.2, 1.1}, wood, 1);  // the same from no two sides
      const Scene& drawn = drawing.scene;
      const Scene scene = turned(isMirrored ? mirrored(drawn) : drawn, angle_rad);
      LuminaireSettings lamp;
      lamp.photometry = std::make_shared<const Photometry>(lambertianPhotometry(100.0));
      lamp.position_m = placeOf({6.2, 1.1, 2.5});
      lamp.aim = placeOf({1, 0, 0});
      Study study;
      study.luminaires = {lamp};
      const Building building = buildingOf(scene, study);
      ASSERT_EQ(building.luminaires.size(), 1U);
      EXPECT_LT(glm::length(building.luminaires[0].position_m - lamp.position_m), 1e-12);
      EXPECT_LT(glm::length(building.luminaires[0].axes[2] + lamp.aim), 1e-12);
      ASSERT_EQ(building.rooms.size(), 2U);
      EXPECT_EQ(building.luminaireDomain[0], building.rooms[0].domain);
      // From south to north, then from west to east; the pane is the first drawn room's.
      const glm::dvec3 lit = placeOf({2.0, 1.5, 0});
      const glm::dvec3 other = placeOf({6.2, 1.5, 0});
      const bool isFirst = std::abs(lit.y - other.y) > 0.1 ? lit.y < other.y : lit.x < other.x;
      ASSERT_EQ(building.portals.size(), 1U);
      EXPECT_EQ(building.portals[0].room, isFirst ? 0 : 1);
      ASSERT_EQ(building.borders.size(), 1U);
      std::vector<glm::dvec3> line_m = building.borders[0].line_m;
      ASSERT_EQ(line_m.size(), 2U);
      if (glm::length(line_m[0] - placeOf({4.1, 1.05, 0})) > 0.1) std::swap(line_m[0], line_m[1]);
      EXPECT_LT(glm::length(line_m[0] - placeOf({4.1, 1.05, 0})), 1e-6);
      EXPECT_LT(glm::length(line_m[1] - placeOf({4.1, 1.95, 0})), 1e-6);
    }
  }
}

// A partition drawn as one sheet parts as well as a wall does.
TEST(Rooms, PartAtADoorInASheet) {
  Drawing drawing;
  addRoomWithPane(drawing, {0, 0, 0}, {8, 3, 2.7}, {1.0, 1.0, 3.0, 2.0});
  drawing.face({{4, 0, 0}, {4, 1, 0}, {4, 1, 2.7}, {4, 0, 2.7}});
  drawing.face({{4, 1.9, 0}, {4, 3, 0}, {4, 3, 2.7}, {4, 1.9, 2.7}});
  drawing.face({{4, 1, 2.05}, {4, 1.9, 2.05}, {4, 1.9, 2.7}, {4, 1, 2.7}});
  const Building building = buildingOf(drawing.scene);
  ASSERT_EQ(building.rooms.size(), 2U);
  for (const Room& room : building.rooms) EXPECT_NEAR(room.floorArea_m2, 12.0, 1e-6);
  EXPECT_EQ(building.borders.size(), 1U);
}

// Where rooms meet in the open, the edges of their floors part them exactly.
TEST(Rooms, MeetAtTheEdgesOfTheirFloors) {
  Drawing drawing;
  addBox(drawing, {0, 0, 0}, {6, 4, 2.7}, plaster, 0, {0});
  const auto floor = [&](double x0, double y0, double x1, double y1, const std::string& name) {
    drawing.face({{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}}, wood, addObject(drawing, name));
  };
  floor(0, 0, 6, 2.2, "living");
  floor(0, 2.2, 1.9, 4, "kitchen");
  floor(1.9, 2.2, 6, 4, "hall");
  addBox(drawing, {1.85, 2.8, 0}, {1.95, 4, 2.7}, plaster, 0, {0, 1});
  addBox(drawing, {2.9, 2.15, 0}, {6, 2.25, 2.7}, plaster, 0, {0, 1});
  for (const Scene& scene : {drawing.scene, mirrored(drawing.scene), turned(drawing.scene, 0.3)}) {
    const std::vector<double> areas_m2 = floorAreas(buildingOf(scene));
    ASSERT_EQ(areas_m2.size(), 3U);
    // Without the walls' halves: 0.05 x 1.2 and 0.05 x 3.1 m.
    EXPECT_NEAR(areas_m2[0], 1.9 * 1.8 - 0.06, 1e-6);
    EXPECT_NEAR(areas_m2[1], 4.1 * 1.8 - 0.06 - 0.155, 1e-6);
    EXPECT_NEAR(areas_m2[2], 6 * 2.2 - 0.155, 1e-6);
  }
}

// A border round a kitchen's open corner is a line with a bend, to a cell of 5 cm.
TEST(Rooms, BorderOfFloorsGoesRoundACorner) {
  Drawing drawing;
  addBox(drawing, {0, 0, 0}, {6, 4, 2.7}, plaster, 0, {0});
  const std::uint32_t kitchen = addObject(drawing, "kitchen");
  const std::uint32_t hall = addObject(drawing, "hall");
  drawing.face({{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}}, wood, kitchen);
  drawing.face({{3, 0, 0}, {6, 0, 0}, {6, 4, 0}, {0, 4, 0}, {0, 2, 0}, {3, 2, 0}}, wood, hall);
  addBox(drawing, {2.95, 0, 0}, {3.05, 1.2, 2.7}, plaster, 0, {0, 1});
  addBox(drawing, {0, 1.95, 0}, {2.2, 2.05, 2.7}, plaster, 0, {0, 1});
  for (const Scene& scene : {drawing.scene, mirrored(drawing.scene)}) {
    const Building building = buildingOf(scene);
    EXPECT_EQ(building.rooms.size(), 2U);
    ASSERT_EQ(building.borders.size(), 1U);
    const std::vector<glm::dvec3>& line_m = building.borders[0].line_m;
    ASSERT_EQ(line_m.size(), 3U);
    EXPECT_NEAR(std::abs(line_m[1].x), 3.0, 0.06);
    EXPECT_NEAR(line_m[1].y, 2.0, 0.06);
  }
}

// A gap that nothing is seen from at the height of people is the room's, as it is open above.
TEST(Rooms, FloorGoesOnBetweenBookcases) {
  Drawing drawing;
  addRoomWithPane(drawing, {0, 0, 0}, {4, 3, 3}, {1.0, 1.0, 3.0, 2.0});
  for (const double x : {1.0, 1.51, 2.02}) addBox(drawing, {x, 2.6, 0}, {x + 0.5, 2.98, 2.1}, wood, 0);
  const Building building = buildingOf(drawing.scene);
  ASSERT_EQ(building.rooms.size(), 1U);
  EXPECT_NEAR(building.rooms[0].floorArea_m2, 12.0, 1e-6);
}

TEST(Rooms, PaneBelongsToTheRoomItIsIn) {
  const Building building = buildingOf(twoRooms(0.9, 2.05).scene);
  ASSERT_EQ(building.portals.size(), 1U);
  ASSERT_GE(building.portals[0].room, 0);
  const Room& room = building.rooms[static_cast<std::size_t>(building.portals[0].room)];
  for (const std::uint32_t piece : room.floorPieces) {
    for (const std::uint32_t corner : building.model.pieces.polygons[piece])
      EXPECT_LE(building.model.pieces.points[corner].x, 4.1 + 1e-6);
  }
}

TEST(Rooms, NoSideLiesInTwo) {
  const Building building = buildingOf(twoRooms(0.9, 2.05).scene);
  const Pieces& pieces = building.model.pieces;
  for (std::uint32_t side = 0; side < building.sideRoom.size(); ++side) {
    if (building.sideRoom[side] < 0 || std::abs(pieces.normal[side / 2].z) < 0.9) continue;
    double low = 1e300;
    double high = -1e300;
    for (const std::uint32_t corner : pieces.polygons[side / 2]) {
      low = std::min(low, pieces.points[corner].x);
      high = std::max(high, pieces.points[corner].x);
    }
    EXPECT_TRUE(high <= 4.1 + 1e-6 || low >= 4.1 - 1e-6) << "piece " << side / 2;
  }
}

TEST(Rooms, WideOpeningIsOneRoom) {
  const Building building = buildingOf(twoRooms(2.4, 2.7).scene);
  ASSERT_EQ(building.rooms.size(), 1U);
  EXPECT_NEAR(building.rooms[0].floorArea_m2, 24.0 + 0.2 * 2.4,
              1e-9);  // and the strip between the wall's ends
  EXPECT_TRUE(building.borders.empty());
}

TEST(Rooms, BedIsNoFloor) {
  Drawing drawing;
  addBox(drawing, {0, 0, 0}, {4, 3, 2.7});
  addBox(drawing, {0.5, 0.5, 0.0}, {2.5, 2.1, 0.45}, wood, addObject(drawing, "bed"));
  const Building building = buildingOf(drawing.scene);
  ASSERT_EQ(building.rooms.size(), 1U);
  EXPECT_NEAR(building.rooms[0].floorArea_m2, 12.0, exact);
  EXPECT_NEAR(building.rooms[0].floor_m, 0.0, exact);
}

// The floor, a parquet on it and a cupboard's bottom lie in one plane: each place counts once.
TEST(Rooms, SurfacesInOnePlaneCountOnce) {
  Drawing drawing;
  addBox(drawing, {0, 0, 0}, {4, 3, 2.7});
  drawing.face({{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}}, wood, addObject(drawing, "parquet"));
  addBox(drawing, {3.0, 1.0, 0.0}, {3.5, 2.0, 0.9}, wood, addObject(drawing, "cupboard"));
  const Building building = buildingOf(drawing.scene);
  ASSERT_EQ(building.rooms.size(), 1U);
  EXPECT_NEAR(building.rooms[0].floorArea_m2, 12.0, exact);
}

// Tiles 6 mm lower than the parquet are floor under a cupboard too, where they have been cut at its foot.
TEST(Rooms, FloorOfTilesGoesOnUnderACupboard) {
  Drawing drawing;
  addBox(drawing, {0, 0, -0.006}, {4, 3, 2.7}, plaster, 0, {0});
  drawing.face({{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {0, 2, 0}}, wood, addObject(drawing, "parquet"));
  drawing.face({{0, 2, -0.006}, {4, 2, -0.006}, {4, 3, -0.006}, {0, 3, -0.006}}, plaster,
               addObject(drawing, "tiles"));
  addBox(drawing, {1, 2.4, -0.006}, {3, 3, 0.9}, wood, addObject(drawing, "cupboard"), {0, 4});
  const Building building = buildingOf(drawing.scene);
  ASSERT_EQ(building.rooms.size(), 1U);
  EXPECT_NEAR(building.rooms[0].floorArea_m2, 12.0, exact);
  double pieces_m2 = 0.0;
  std::size_t tiles = 0;
  for (const std::uint32_t piece : building.rooms[0].floorPieces) {
    pieces_m2 += building.model.pieces.area_m2[piece];
    tiles += building.model.surfaces[building.model.pieces.surface[piece]].name == "tiles" ? 1 : 0;
  }
  EXPECT_NEAR(pieces_m2, 12.0, exact);
  EXPECT_GE(tiles, 2U) << "they are cut at the cupboard's foot";
}

// Under a gable no height is that of most of the ceiling: the mean one stands for it. The volume is exact.
TEST(Rooms, SlopingCeilingHasAMeanHeight) {
  Drawing drawing;
  drawing.face({{0, 0, 0}, {4, 0, 0}, {4, 6, 0}, {0, 6, 0}});
  for (const double x : {0.0, 4.0}) drawing.face({{x, 0, 0}, {x, 6, 0}, {x, 6, 1}, {x, 0, 1}});
  for (const double y : {0.0, 6.0}) drawing.face({{0, y, 0}, {4, y, 0}, {4, y, 1}, {2, y, 3}, {0, y, 1}});
  for (const double x : {0.0, 4.0}) drawing.face({{x, 0, 1}, {x, 6, 1}, {2, 6, 3}, {2, 0, 3}});
  const Building building = buildingOf(drawing.scene);
  ASSERT_EQ(building.rooms.size(), 1U);
  EXPECT_NEAR(building.rooms[0].floorArea_m2, 24.0, 1e-6);
  EXPECT_NEAR(building.rooms[0].volume_m3, 48.0, 1e-6);
  EXPECT_NEAR(building.rooms[0].ceiling_m, 2.0, 0.03);
}

// A slab that runs through under the walls is no floor there, nor in a window's reveal.
TEST(Rooms, FloorEndsAtTheWalls) {
  Drawing drawing;
  addBox(drawing, {-1, -1, 0}, {5, 4, 0}, plaster, 0, {1, 2, 3, 4, 5});   // the slab
  addBox(drawing, {0, 0, 0}, {4, 3, 2.7}, plaster, 0, {0, 2});            // the room
  addBox(drawing, {-0.3, -0.3, 0}, {4.3, 3.3, 2.8}, plaster, 0, {0, 2});  // its outer faces
  addWallWithHole(drawing, 0, 0, 4, 2.7, 0.0, {1, 0.8, 3, 2.4});
  addWallWithHole(drawing, -0.3, 0, 4.3, 2.8, -0.3, {1, 0.8, 3, 2.4});
  drawing.face({{1, -0.3, 0.8}, {3, -0.3, 0.8}, {3, 0, 0.8}, {1, 0, 0.8}});  // its sill
  drawing.face({{1, -0.3, 2.4}, {3, -0.3, 2.4}, {3, 0, 2.4}, {1, 0, 2.4}});
  drawing.face({{1, -0.3, 0.8}, {1, 0, 0.8}, {1, 0, 2.4}, {1, -0.3, 2.4}});
  drawing.face({{3, -0.3, 0.8}, {3, 0, 0.8}, {3, 0, 2.4}, {3, -0.3, 2.4}});
  drawing.face(upright(1, 0.8, 3, 2.4, -0.25), glass);
  const Building building = buildingOf(drawing.scene);
  ASSERT_EQ(building.rooms.size(), 1U);
  EXPECT_NEAR(building.rooms[0].floorArea_m2, 12.0, 1e-6);
  EXPECT_EQ(building.portals.size(), 1U);
}

// Names that objects bear: the beginning that a room has for itself, its floor's name if that is a room's.
TEST(Rooms, TakeNamesFromTheModel) {
  Drawing drawing;
  addBox(drawing, {0, 0, 0}, {4, 3, 2.7}, plaster, addObject(drawing, "Meeting_walls"));
  const std::uint32_t shell = addObject(drawing, "shell");  // of two rooms: neither's name
  addBox(drawing, {5, 0, 0}, {9, 3, 2.7}, plaster, shell, {0});
  drawing.face({{5, 0, 0}, {9, 0, 0}, {9, 3, 0}, {5, 3, 0}}, wood, addObject(drawing, "Kitchen floor"));
  addBox(drawing, {10, 0, 0}, {14, 3, 2.7}, plaster, shell);
  const Building building = buildingOf(drawing.scene);
  ASSERT_EQ(building.rooms.size(), 3U);
  EXPECT_EQ(building.rooms[0].name, "Meeting_walls");
  EXPECT_EQ(building.rooms[1].name, "Kitchen floor");
  EXPECT_EQ(building.rooms[2].name, "Room 3");
}

// Rooms and areas do not depend on how the model lies, nor on the order and winding of its faces.
TEST(Rooms, SameWhenTurnedMirroredAndShuffled) {
  const Scene scene = twoRooms(0.9, 2.05).scene;
  const std::vector<double> areas_m2 = floorAreas(buildingOf(scene));
  ASSERT_EQ(areas_m2.size(), 2U);
  const std::vector<Scene> others = {turned(scene, 1.5707963267948966), turned(scene, 0.3), mirrored(scene),
                                     shuffled(scene, 7)};
  for (std::size_t i = 0; i < others.size(); ++i) {
    const Building building = buildingOf(others[i]);
    const std::vector<double> found_m2 = floorAreas(building);
    ASSERT_EQ(found_m2.size(), areas_m2.size()) << "scene " << i;
    for (std::size_t room = 0; room < areas_m2.size(); ++room)
      EXPECT_NEAR(found_m2[room] / areas_m2[room], 1.0, 1e-8) << "scene " << i;
    EXPECT_EQ(building.portals.size(), 1U);
    EXPECT_EQ(building.borders.size(), 1U);
  }
}

TEST(Rooms, LargestGapIsNamed) {
  Drawing drawing;
  addRoomWithHole(drawing, {0, 0, 0}, {4, 3, 3}, {1.0, 1.0, 1.6, 2.4});
  const Building building = buildingOf(drawing.scene);
  ASSERT_EQ(building.diagnoses.size(), 1U);
  EXPECT_EQ(building.diagnoses[0].code, "G251");
  const std::string& text = building.diagnoses[0].message;
  double width_m = 0.0;
  const std::size_t at = text.find("the largest gap");
  ASSERT_NE(at, std::string::npos) << text;
  ASSERT_EQ(std::sscanf(text.c_str() + at, "the largest gap is about %lf m wide", &width_m), 1);
  ASSERT_TRUE(building.diagnoses[0].place_m);
  const glm::dvec3 place_m = *building.diagnoses[0].place_m;
  EXPECT_NEAR(width_m, 0.6, 0.07);  // two voxels
  EXPECT_NEAR(place_m.y, 0.0, 0.1);
  EXPECT_GT(place_m.x, 1.0);
  EXPECT_LT(place_m.x, 1.6);
  EXPECT_GT(place_m.z, 1.0);
  EXPECT_LT(place_m.z, 2.4);
}

}  // namespace
}  // namespace clerestory
