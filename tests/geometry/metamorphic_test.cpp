// SPDX-License-Identifier: GPL-3.0-or-later
// The sample office, and the same drawn in other ways.
#include "howeverdrawn.hpp"

namespace clerestory {
namespace {

using namespace drawn;

const std::filesystem::path offices = std::filesystem::path(CLERESTORY_SAMPLES) / "office";

// 12 x 8 m less the column, 16 corners in whole millimetres on a circle of 0.2 m: 0.122174 m² by the shoelace
// formula. From the two gaps between the bookcases, 10 x 320 mm, hardly a look gets out. Left out are slits
// of less than 2.5 cm²: at six ends of bookcases' backs 25 and 50 mm² within their sides.
TEST(Office, FloorIsAllButTheColumn) {
  const Building building = buildingOf(read(offices / "office.obj"));
  ASSERT_EQ(building.rooms.size(), 1U);
  EXPECT_NEAR(building.rooms[0].floorArea_m2, 96.0 - 0.122174 - 6 * 75e-6, 1e-6);
}

TEST(Metamorphic, OfficeIsTheSameHoweverItIsDrawn) {
  expectSameHoweverDrawn(offices / "office.obj");
}

TEST(Metamorphic, OfficeIsTheSameAsGltf) {
  expectSame(read(offices / "office.glb"), buildingOf(read(offices / "office.obj")));
}

// 100,000 triangles and more come back to the polygons that the office was drawn with.
TEST(Metamorphic, TessellatedOfficeBecomesTheDrawnPolygons) {
  const Scene drawnScene = read(offices / "office.obj");
  const CleanModel expected = cleanScene(drawnScene);
  const Scene scene = tessellated(read(offices / "office.glb"), 3);
  EXPECT_GT(scene.faces.size(), 100000U);
  const CleanModel model = cleanScene(scene);
  const auto drawnCount = static_cast<double>(drawnScene.faces.size());
  EXPECT_NEAR(static_cast<double>(model.counts.polygons), drawnCount, 0.1 * drawnCount);
  const Surfaces surfaces_m2 = surfacesOf(model);
  for (const auto& [surface, area_m2] : surfacesOf(expected)) {
    ASSERT_TRUE(surfaces_m2.contains(surface)) << surface.first;
    // A third of a desk's steel, 2 mm thick, is welded to itself.
    EXPECT_NEAR(surfaces_m2.at(surface) / area_m2, 1.0, 2e-3) << surface.first << ' ' << surface.second;
  }
  EXPECT_NEAR(totalArea_m2(model) / totalArea_m2(expected), 1.0, 1e-5);
}

}  // namespace
}  // namespace clerestory
