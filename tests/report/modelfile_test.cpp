// SPDX-License-Identifier: GPL-3.0-or-later
// The repaired model as a file: our own readers find the same building in it, and no markers.
#include <gtest/gtest.h>

#include <map>

#include <report/modelfile.hpp>

#include "../import/tempfolder.hpp"
#include "../scenes.hpp"

namespace clerestory {
namespace {

Scene readOffice() {
  return readModel(std::string(CLERESTORY_SAMPLES) + "/office/office.obj", {});
}

/// One side of everything drawn, by object and material. [m²]
std::map<std::pair<std::string, std::string>, double> areasOf(const CleanModel& model) {
  std::map<std::pair<std::string, std::string>, double> areas_m2;
  for (std::size_t piece = 0; piece < model.pieces.size(); ++piece) {
    const Surface& surface = model.surfaces[model.pieces.surface[piece]];
    areas_m2[{surface.name, model.materials[surface.material].name}] += model.pieces.area_m2[piece];
  }
  return areas_m2;
}

class ModelFile : public testing::TestWithParam<const char*> {};

TEST_P(ModelFile, HoldsTheSameRoomsSurfacesAndMaterials) {
  const Scene drawn = readOffice();
  const CleanModel model = cleanScene(drawn);
  const std::vector<Mark> marks{{"G202", "desk_1", {1.0, 1.0, 0.7}}, {"G251", "", {0.0, 0.0, 0.0}}};
  const TempFolder folder;
  const std::filesystem::path file = folder.path() / GetParam();
  writeModel(file, model, marks);

  const Scene read = readModel(file, {});
  EXPECT_EQ(read.axes.upAxis, file.extension() == ".obj" ? "z" : "y");
  EXPECT_EQ(countOf(read.diagnoses, "C115"), 2U);  // one object a mark
  const CleanModel again = cleanScene(read);
  const auto areas_m2 = areasOf(model);
  const auto againAreas_m2 = areasOf(again);
  for (const auto& [surface, area_m2] : areas_m2) {
    const auto same = againAreas_m2.find(surface);
    ASSERT_NE(same, againAreas_m2.end()) << surface.first << ' ' << surface.second << ' ' << area_m2;
    // Facets of the curved chair that are nearly in one plane merge along others: 5e-5.
    EXPECT_NEAR(same->second, area_m2, 1e-4 * area_m2) << surface.first << ' ' << surface.second;
  }
  for (const Material& material : model.materials) {
    const auto same = std::find_if(again.materials.begin(), again.materials.end(),
                                   [&](const Material& other) { return other.name == material.name; });
    if (same == again.materials.end()) continue;  // drawn by nothing
    EXPECT_LT(glm::length(same->reflectance - material.reflectance), 1e-6) << material.name;
    EXPECT_EQ(same->glazing, material.glazing) << material.name;
    EXPECT_LT(glm::length(same->transmittance - material.transmittance), 1e-6) << material.name;
    EXPECT_LT(glm::length(same->exitance_lm_m2 - material.exitance_lm_m2), 1e-3) << material.name;
  }

  const Building building = makeBuilding(model, {});
  const Building againBuilding = makeBuilding(again, {});
  ASSERT_EQ(againBuilding.rooms.size(), building.rooms.size());
  for (std::size_t i = 0; i < building.rooms.size(); ++i) {
    EXPECT_EQ(againBuilding.rooms[i].name, building.rooms[i].name);
    EXPECT_NEAR(againBuilding.rooms[i].floorArea_m2, building.rooms[i].floorArea_m2,
                1e-6 * building.rooms[i].floorArea_m2);
  }
  EXPECT_EQ(againBuilding.portals.size(), building.portals.size());
}

INSTANTIATE_TEST_SUITE_P(Of, ModelFile, testing::Values("repaired.glb", "repaired.obj"),
                         [](const auto& test) {
                           return std::string(test.param).ends_with("glb") ? "Glb" : "Obj";
                         });

TEST(ModelFileName, IsAModelByItsEnding) {
  EXPECT_TRUE(isModelFile("a/b.GLB"));
  EXPECT_TRUE(isModelFile("b.obj"));
  EXPECT_FALSE(isModelFile("plans"));
  EXPECT_FALSE(isModelFile("b.gltf"));
}

}  // namespace
}  // namespace clerestory
