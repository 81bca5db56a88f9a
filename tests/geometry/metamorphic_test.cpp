// SPDX-License-Identifier: GPL-3.0-or-later
// The sample office drawn in other ways.
#include "howeverdrawn.hpp"

namespace clerestory {
namespace {

using namespace drawn;

const std::filesystem::path offices = std::filesystem::path(CLERESTORY_SAMPLES) / "office";

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
