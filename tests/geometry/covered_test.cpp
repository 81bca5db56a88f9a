// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces that lie on others in one plane: what they cover is not lit, and each place counts once.
#include <gtest/gtest.h>

#include <map>

#include "../scenes.hpp"
#include "redrawn.hpp"

namespace clerestory {
namespace {

using namespace drawn;

constexpr double exact = 1e-6;  // m2: corners are on a grid of 1 µm

/// A room of 6 x 3 x 2.7 m with a pane, its faces drawn for the inside.
Drawing room() {
  Drawing drawing;
  addRoomWithPane(drawing, {0, 0, 0}, {6, 3, 2.7}, {1.0, 1.0, 3.0, 2.0});
  drawing.scene = reversed(drawing.scene);
  return drawing;
}

/// By object: area of the sides that a room has, but of rims, which are below 0.03 m². [m²]
std::map<std::string, double> litIn(const Building& building, std::int32_t room = 0) {
  std::map<std::string, double> lit_m2;
  const Pieces& pieces = building.model.pieces;
  for (std::uint32_t side = 0; side < building.sideRoom.size(); ++side) {
    if (building.sideRoom[side] == room && pieces.area_m2[side / 2] > 0.03)
      lit_m2[building.model.surfaces[pieces.surface[side / 2]].name] += pieces.area_m2[side / 2];
  }
  return lit_m2;
}

std::size_t guessesOf(const Building& building) {
  std::size_t count = 0;
  for (const Diagnosis& diagnosis : building.diagnoses)
    count += diagnosis.code == "G221" ? diagnosis.count : 0;
  return count;
}

/// What `add` takes of the light of the room's own faces. [m²]
double coveredBy(const std::function<void(Drawing&, std::uint32_t object)>& add, double object_m2,
                 std::size_t guesses) {
  const Drawing bare = room();
  Drawing drawing = bare;
  add(drawing, addObject(drawing, "thing"));
  const double before_m2 = litIn(buildingOf(bare.scene)).at("room");
  double covered_m2 = 0.0;
  for (const Scene& scene : {drawing.scene, turned(drawing.scene, 0.4)}) {
    const Building building = buildingOf(scene);
    EXPECT_EQ(building.rooms.size(), 1U);
    EXPECT_EQ(guessesOf(building), guesses);
    auto lit_m2 = litIn(building);
    EXPECT_NEAR(lit_m2["thing"], object_m2, exact);
    covered_m2 = before_m2 - lit_m2["room"];
    const Domain& domain = building.domains[static_cast<std::size_t>(building.rooms[0].domain)];
    double sides_m2 = 0.0;
    for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side)
      if (building.sideDomain[side] == building.rooms[0].domain)
        sides_m2 += building.model.pieces.area_m2[side / 2];
    EXPECT_NEAR(domain.area_m2, sides_m2, exact);
    EXPECT_NEAR(building.rooms[0].floorArea_m2, 18.0, exact) << "goes on under it";
  }
  return covered_m2;
}

// Eight millimetres are too thin for air inside: nothing told that the floor under it is dark.
TEST(Covered, FloorUnderARug) {
  const auto rug = [](Drawing& drawing, std::uint32_t object) {
    addBox(drawing, {1, 0.5, 0}, {3, 1.5, 0.008}, wood, object);
  };
  EXPECT_NEAR(coveredBy(rug, 2.0, 0), 2.0, exact);
}

TEST(Covered, FloorUnderARugDrawnInItsPlane) {
  const auto rug = [](Drawing& drawing, std::uint32_t object) {
    drawing.face({{1, 0.5, 0}, {3, 0.5, 0}, {3, 1.5, 0}, {1, 1.5, 0}}, wood, object);
  };
  EXPECT_NEAR(coveredBy(rug, 2.0, 1), 2.0, exact);
}

// Drawn for below, as the floor is here, where nothing is lit: both are seen from above.
TEST(Covered, FloorOfASlabUnderARugDrawnForBelow) {
  const auto slab = [](Drawing& drawing, std::uint32_t object) {
    drawing.scene = reversed(drawing.scene);
    addBox(drawing, {0, 0, -0.2}, {6, 3, 0}, plaster, 0, {1});
    drawing.face({{1, 1.5, 0}, {3, 1.5, 0}, {3, 0.5, 0}, {1, 0.5, 0}}, wood, object);
  };
  EXPECT_NEAR(coveredBy(slab, 2.0, 1), 2.0, exact);
}

// A dark room beside a lit one, each with a wall of its own in one plane: the lit one has its own.
TEST(Covered, WallOfADarkRoomCoversNothing) {
  for (const bool looksIn : {false, true}) {
    Drawing drawing;
    addRoomWithPane(drawing, {0, 0, 0}, {6, 3, 2.7}, {1.0, 1.0, 3.0, 2.0});
    addBox(drawing, {6, 0, 0}, {9, 3, 2.7}, wood, addObject(drawing, "store"));
    const auto lit_m2 = litIn(buildingOf(looksIn ? reversed(drawing.scene) : drawing.scene));
    EXPECT_FALSE(lit_m2.contains("store"));
    EXPECT_NEAR(lit_m2.at("room"), 2 * 18.0 + 18.0 * 2.7, exact) << "with its pane";
  }
}

TEST(Covered, CeilingOverALampDrawnInItsPlane) {
  const auto lamp = [](Drawing& drawing, std::uint32_t object) {
    drawing.face({{1, 0.5, 2.7}, {1, 1.5, 2.7}, {2, 1.5, 2.7}, {2, 0.5, 2.7}},
                 addMaterial(drawing, {.name = "lamp", .exitance_lm_m2 = glm::dvec3(1000.0)}), object);
  };
  EXPECT_NEAR(coveredBy(lamp, 1.0, 1), 1.0, exact);
}

TEST(Covered, WallBehindAPicture) {
  const auto picture = [](Drawing& drawing, std::uint32_t object) {
    addBox(drawing, {5.98, 1, 1}, {6, 2, 2}, wood, object);
  };
  EXPECT_NEAR(coveredBy(picture, 1.0, 0), 1.0, exact);
}

// One that is larger than what it covers of each of two floors, and reaches beyond one of them.
TEST(Covered, RugAcrossTwoFloors) {
  const auto tiles = [](Drawing& drawing, std::uint32_t object) {
    drawing.face({{4, 0.5, 0.2}, {5, 0.5, 0.2}, {5, 1, 0.2}, {4, 1, 0.2}}, wood, object);  // over the floor
  };
  EXPECT_NEAR(coveredBy(tiles, 1.0, 0), 0.0, exact) << "20 cm above it: both of its sides are seen";
  Drawing drawing = room();
  const std::uint32_t dais = addObject(drawing, "dais");
  addBox(drawing, {0, 0, 0}, {2, 3, 0.1}, wood, dais);
  addBox(drawing, {2, 0, 0}, {4, 3, 0.1}, wood, addObject(drawing, "second dais"));
  addBox(drawing, {1, 1, 0.1}, {5, 2, 0.11}, wood, addObject(drawing, "rug"));
  auto lit_m2 = litIn(buildingOf(drawing.scene));
  EXPECT_NEAR(lit_m2["dais"], 6.0 - 1.0, exact) << "its sides are at walls and at the second one";
  EXPECT_NEAR(lit_m2["second dais"], 6.0 - 2.0 + 3.0 * 0.1, exact);
}

// A sheet between two rooms is seen from behind where a picture hangs on its other side.
TEST(Covered, SheetBehindAPictureIsSeenFromTheOtherRoom) {
  Drawing drawing;
  addBox(drawing, {0, 0, 0}, {6, 3, 2.7}, plaster, 0, {2});
  drawing.face(upright(0, 0, 6, 2.7), glass);
  const std::uint32_t wall = addObject(drawing, "sheet");
  drawing.face({{3, 0, 0}, {3, 3, 0}, {3, 3, 2.7}, {3, 0, 2.7}}, plaster, wall);
  addBox(drawing, {3, 1, 1}, {3.02, 2, 2}, wood, addObject(drawing, "picture"));
  const Building building = buildingOf(drawing.scene);
  ASSERT_EQ(building.rooms.size(), 2U);
  auto before_m2 = litIn(building, 1);
  auto behind_m2 = litIn(building, 0);
  if (!before_m2.contains("picture")) std::swap(before_m2, behind_m2);
  EXPECT_NEAR(before_m2["sheet"], 8.1 - 1.0, exact);
  EXPECT_NEAR(before_m2["picture"], 1.0, exact);
  EXPECT_NEAR(behind_m2["sheet"], 8.1, exact);
  EXPECT_FALSE(behind_m2.contains("picture"));
}

// What stands on legs leaves all of the floor to the light, but for feet smaller than 0.05 m².
TEST(Covered, FeetCutNothing) {
  const auto stool = [](Drawing& drawing, std::uint32_t object) {
    addBox(drawing, {1, 1, 0}, {1.1, 1.1, 0.5}, wood, object);
  };
  EXPECT_NEAR(coveredBy(stool, 4 * 0.05, 0), 0.0, exact);
}

}  // namespace
}  // namespace clerestory
