// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces of one air are cut where others run through them or stand on them.
#include <gtest/gtest.h>

#include "../scenes.hpp"

namespace clerestory {
namespace {

using namespace drawn;

std::size_t crossingsOf(const Building& building) {
  std::size_t count = 0;
  for (const Diagnosis& diagnosis : building.diagnoses)
    count += diagnosis.code == "G220" ? diagnosis.count : 0;
  return count;
}

/// Pieces of `surface` that reach by more than a millimetre to both sides of the plane x = `x`, over the
/// stretch from y = 1 to y = 2.
std::size_t piecesOnBothSides(const Building& building, const std::string& surface, double x) {
  const Pieces& pieces = building.model.pieces;
  std::size_t count = 0;
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    if (building.model.surfaces[pieces.surface[piece]].name != surface) continue;
    glm::dvec3 low(1e300);
    glm::dvec3 high(-1e300);
    for (const std::uint32_t corner : pieces.polygons[piece]) {
      low = glm::min(low, pieces.points[corner]);
      high = glm::max(high, pieces.points[corner]);
    }
    if (low.x < x - 1e-3 && high.x > x + 1e-3 && low.y < 1.9 && high.y > 1.1) ++count;
  }
  return count;
}

Drawing roomWithFloor(std::uint32_t& floor) {
  Drawing drawing;
  addRoomWithPane(drawing, {0, 0, 0}, {6, 3, 2.7}, {1.0, 1.0, 3.0, 2.0});
  floor = addObject(drawing, "raised floor");
  drawing.face({{0, 0, 0.1}, {6, 0, 0.1}, {6, 3, 0.1}, {0, 3, 0.1}}, wood, floor);
  return drawing;
}

TEST(Crossings, FloorIsCutWhereAScreenStandsOnIt) {
  std::uint32_t floor = 0;
  Drawing drawing = roomWithFloor(floor);
  drawing.face({{4, 1, 0.1}, {4, 2, 0.1}, {4, 2, 1.7}, {4, 1, 1.7}}, wood, addObject(drawing, "screen"));
  const Building building = buildingOf(drawing.scene);
  EXPECT_EQ(piecesOnBothSides(building, "raised floor", 4.0), 0U);
  EXPECT_EQ(crossingsOf(building), 0U) << "as it should be drawn";
  EXPECT_NEAR(building.rooms.at(0).floorArea_m2, 18.0, 1e-9);
  ASSERT_EQ(building.portals.size(), 1U);
  EXPECT_NEAR(building.model.pieces.area_m2[building.portals[0].piece], 2.0, 1e-9) << "numbered anew";
}

TEST(Crossings, ScreensThatRunThroughEachOtherAreCutAndSaid) {
  std::uint32_t floor = 0;
  Drawing drawing = roomWithFloor(floor);
  drawing.face({{4, 0.5, 0.5}, {4, 2.5, 0.5}, {4, 2.5, 1.7}, {4, 0.5, 1.7}}, wood,
               addObject(drawing, "screen"));
  drawing.face({{3, 1.5, 0.5}, {5, 1.5, 0.5}, {5, 1.5, 1.7}, {3, 1.5, 1.7}}, wood,
               addObject(drawing, "shelf"));
  const Building building = buildingOf(drawing.scene);
  EXPECT_EQ(piecesOnBothSides(building, "shelf", 4.0), 0U);
  EXPECT_EQ(crossingsOf(building), 2U);
}

TEST(Crossings, FurnitureThatTouchesIsNoCrossing) {
  std::uint32_t floor = 0;
  Drawing drawing = roomWithFloor(floor);
  const std::size_t before = buildingOf(drawing.scene).model.pieces.size();
  addBox(drawing, {4, 1, 0.1}, {4.4, 1.4, 0.6}, wood, addObject(drawing, "stool"));
  const Building building = buildingOf(drawing.scene);
  EXPECT_EQ(crossingsOf(building), 0U);
  EXPECT_EQ(building.model.pieces.size(), before + 6 + 4)
      << "the floor: what it covers, and four parts around it";
}

}  // namespace
}  // namespace clerestory
