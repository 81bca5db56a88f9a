// SPDX-License-Identifier: GPL-3.0-or-later
// Edges along which several faces meet, and faces back to back over a part of each.
#include <gtest/gtest.h>

#include <map>

#include <geometry/faults.hpp>

#include "redrawn.hpp"

namespace clerestory {
namespace {

using namespace drawn;

// Four walls meet along one edge, and each meets floor, ceiling and another wall along edges of more than two
// faces. Nobody splits them: pieces have sides of their own, and each side has the air before it.
TEST(Seams, EdgesOfManyFacesPartTheRoomsAroundThem) {
  Drawing drawing;
  addBox(drawing, {0, 0, 0}, {4, 4, 3});
  const auto wall = [&](const glm::dvec2& a, const glm::dvec2& b) {
    drawing.face({{a, 0}, {b, 0}, {b, 3}, {a, 3}}, wood, 1);
  };
  for (const glm::dvec2& end : {glm::dvec2(0, 2), glm::dvec2(4, 2), glm::dvec2(2, 0), glm::dvec2(2, 4)})
    wall({2, 2}, end);
  EXPECT_GT(countFaults(drawing.scene).nonManifoldEdges, 0U);
  const Building building = buildingOf(drawing.scene);
  ASSERT_EQ(building.rooms.size(), 4U);
  for (const Room& room : building.rooms) {
    EXPECT_NEAR(room.floorArea_m2, 4.0, 1e-9);
    EXPECT_NEAR(building.domains[static_cast<std::size_t>(room.domain)].area_m2, 32.0, 1e-9);
  }
  for (const std::int32_t domain : building.sideDomain) EXPECT_GE(domain, 0);
}

/// A room that looks out through its whole south side; its other faces are one object's.
void addLitRoom(Drawing& drawing, const glm::dvec3& a, const glm::dvec3& b, std::uint32_t material,
                std::uint32_t object) {
  addBox(drawing, a, b, material, object, {2});
  drawing.face(upright(a.x, a.z, b.x, b.z, a.y), glass);
}

/// By domain: what it sees in the plane three metres along an axis, by object. [m²]
std::map<std::int32_t, std::map<std::string, double>> seenAtThreeMetres(const Building& building, int axis) {
  const Pieces& pieces = building.model.pieces;
  std::map<std::int32_t, std::map<std::string, double>> seen_m2;
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
    const std::uint32_t piece = side / 2;
    const double off_m = pieces.points[pieces.polygons[piece][0]][axis] - 3.0;
    if (building.sideDomain[side] < 0 || std::abs(off_m) > 0.01 || std::abs(pieces.normal[piece][axis]) < 0.9)
      continue;
    seen_m2[building.sideDomain[side]][building.model.surfaces[pieces.surface[piece]].name] +=
        pieces.area_m2[piece];
  }
  return seen_m2;
}

// A room over parts of two others, each drawn with a floor and a ceiling of its own: each side has its own
// name where both lie, also where all is of one material, whichever way all faces look.
TEST(Seams, FacesBackToBackOverAPartKeepTheirSides) {
  for (const std::uint32_t upper : {wood, plaster}) {
    for (const bool looksIn : {false, true}) {
      SCOPED_TRACE(testing::Message() << "material " << upper << (looksIn ? ", inwards" : ", outwards"));
      Drawing drawing;
      addLitRoom(drawing, {0, 0, 0}, {4, 3, 3}, plaster, addObject(drawing, "west"));
      addLitRoom(drawing, {4, 0, 0}, {10, 3, 3}, plaster, addObject(drawing, "east"));
      addLitRoom(drawing, {1, 0, 3}, {8, 3, 6}, upper, addObject(drawing, "upper"));
      const Building building = buildingOf(looksIn ? reversed(drawing.scene) : drawing.scene);
      ASSERT_EQ(building.rooms.size(), 3U);
      auto seen_m2 = seenAtThreeMetres(building, 2);
      std::map<std::string, double> own_m2;
      for (const Room& room : building.rooms) {
        auto& here_m2 = seen_m2[room.domain];
        ASSERT_EQ(here_m2.size(), 1U);
        own_m2[here_m2.begin()->first] = here_m2.begin()->second;
      }
      EXPECT_NEAR(own_m2["west"], 12.0, 1e-9);
      EXPECT_NEAR(own_m2["east"], 18.0, 1e-9);
      EXPECT_NEAR(own_m2["upper"], 21.0, 1e-9);
      EXPECT_NEAR(seen_m2[0]["west"], 3.0, 1e-9);  // their roofs beside it
      EXPECT_NEAR(seen_m2[0]["east"], 6.0, 1e-9);
    }
  }
}

// Two rooms back to back, one of them with a shaft of 0.2 x 0.2 m in its corner, which is too little air for
// anything to be cut at its walls: the longer wall is the shorter one's partner as far as that goes.
TEST(Seams, FacesBackToBackKeepTheirSidesBesideAShaft) {
  for (const std::uint32_t northern : {wood, plaster}) {
    for (const bool looksIn : {false, true}) {
      SCOPED_TRACE(testing::Message() << "material " << northern << (looksIn ? ", inwards" : ", outwards"));
      Drawing drawing;
      addLitRoom(drawing, {0, 0, 0}, {4, 3, 3}, plaster, addObject(drawing, "south"));
      const std::uint32_t north = addObject(drawing, "north");
      const std::vector<glm::dvec2> plan{{0, 3}, {3.8, 3}, {3.8, 3.2}, {4, 3.2}, {4, 6}, {0, 6}};
      Outline floor;
      Outline ceiling;
      for (std::size_t i = 0; i < plan.size(); ++i) {
        const glm::dvec2& from = plan[i];
        const glm::dvec2& to = plan[(i + 1) % plan.size()];
        const Outline wall{{from, 0}, {to, 0}, {to, 3}, {from, 3}};
        drawing.face(wall, from.y == 6 && to.y == 6 ? glass : northern, north);
        floor.insert(floor.begin(), {from, 0});
        ceiling.emplace_back(from, 3);
      }
      drawing.face(floor, northern, north);
      drawing.face(ceiling, northern, north);
      const std::uint32_t shaft = addObject(drawing, "shaft");
      drawing.face({{4, 3, 0}, {4, 3.2, 0}, {4, 3.2, 3}, {4, 3, 3}}, plaster, shaft);
      drawing.face({{3.8, 3, 0}, {3.8, 3.2, 0}, {4, 3.2, 0}, {4, 3, 0}}, plaster, shaft);
      drawing.face({{3.8, 3, 3}, {4, 3, 3}, {4, 3.2, 3}, {3.8, 3.2, 3}}, plaster, shaft);
      const Building building = buildingOf(looksIn ? reversed(drawing.scene) : drawing.scene);
      ASSERT_EQ(building.rooms.size(), 2U);
      auto seen_m2 = seenAtThreeMetres(building, 1);
      for (const Room& room : building.rooms) {
        const bool isNorth = room.floorArea_m2 < 11.99;
        EXPECT_NEAR(room.floorArea_m2, isNorth ? 12.0 - 0.04 : 12.0, 1e-9);
        auto& here_m2 = seen_m2[room.domain];
        EXPECT_NEAR(here_m2["north"], isNorth ? 3.8 * 3.0 : 0.0, 1e-9);
        if (isNorth) {
          EXPECT_LE(here_m2["south"], 0.2 * 3.0 + 1e-9);  // the shaft's, which is nobody's room
        } else {
          EXPECT_NEAR(here_m2["south"], 12.0, 1e-9);
        }
      }
    }
  }
}

/// Pieces of a level surface at a height.
std::vector<std::uint32_t> piecesAtHeight(const Building& building, double height_m) {
  const Pieces& pieces = building.model.pieces;
  std::vector<std::uint32_t> found;
  for (std::uint32_t piece = 0; piece < pieces.size(); ++piece) {
    const double off_m = pieces.points[pieces.polygons[piece][0]].z - height_m;
    if (std::abs(pieces.normal[piece].z) > 0.9 && std::abs(off_m) < 1e-6) found.push_back(piece);
  }
  return found;
}

// One slab under a wall of two boards, which are too near to each other for air between them.
TEST(Seams, SlabIsCutUnderAThinWall) {
  Drawing drawing;
  addBox(drawing, {0, 0, 0}, {8, 3, 3});
  addBox(drawing, {4, 0, 0}, {4.01, 3, 3}, wood, 1, {0, 1});
  const Building building = buildingOf(drawing.scene);
  ASSERT_EQ(building.rooms.size(), 2U);
  const Pieces& pieces = building.model.pieces;
  for (const std::uint32_t piece : piecesAtHeight(building, 0.0)) {
    const auto isWest = [&](std::uint32_t corner) { return pieces.points[corner].x < 4.005; };
    const auto corners = pieces.polygons[piece];
    EXPECT_TRUE(std::ranges::all_of(corners, isWest) || std::ranges::none_of(corners, isWest) ||
                pieces.area_m2[piece] < 0.04);
  }
}

// The slab is cut where a column stands in it, but not by the legs of a stool.
TEST(Seams, LegsCutNothing) {
  std::vector<std::size_t> floorPieces;
  for (const bool hasStool : {false, true}) {
    Drawing drawing;
    addLitRoom(drawing, {0, 0, 0}, {4, 3, 3}, plaster, 0);
    addBox(drawing, {1.0, 1.0, -0.1}, {1.4, 1.4, 3.1}, wood, 1);
    for (const double x : {2.5, 2.8}) {
      for (const double y : {1.5, 1.8})
        if (hasStool) addBox(drawing, {x, y, 0}, {x + 0.04, y + 0.04, 0.45}, wood, 1);
    }
    const Building building = buildingOf(drawing.scene);
    std::size_t count = 0;
    for (const std::uint32_t piece : piecesAtHeight(building, 0.0))
      count += building.model.surfaces[building.model.pieces.surface[piece]].material == plaster ? 1 : 0;
    floorPieces.push_back(count);
  }
  EXPECT_GT(floorPieces[0], 1U);
  EXPECT_EQ(floorPieces[1], floorPieces[0]);
}

}  // namespace
}  // namespace clerestory
