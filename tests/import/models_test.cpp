// SPDX-License-Identifier: GPL-3.0-or-later
// Models that others made, and the sample office: what is in them is read, in metres.
#include <glm/common.hpp>

#include <limits>

#include <import/scene.hpp>
#include <import/study.hpp>

#include "tempfolder.hpp"

namespace clerestory {
namespace {

struct Extent {
  glm::dvec3 low{std::numeric_limits<double>::max()};
  glm::dvec3 high{std::numeric_limits<double>::lowest()};
};

Extent extentOf(const Scene& scene) {
  Extent extent;
  const auto add = [&](const PolygonList& faces) {
    for (const std::uint32_t corner : faces.corners) {
      extent.low = glm::min(extent.low, scene.points[corner]);
      extent.high = glm::max(extent.high, scene.points[corner]);
    }
  };
  add(scene.faces);
  for (const Cage& cage : scene.cages) {
    add(cage.faces);
  }
  return extent;
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

struct Expected {
  std::string file;  // below CLERESTORY_MODELS
  std::string up;    // empty: the format's own
  std::size_t faces;
  glm::dvec3 extent_m;
  std::size_t glazings;
};

std::vector<Expected> expectedModels() {
  if (std::string(CLERESTORY_MODELS).empty()) {
    return {};
  }
  return {{"room-radiance-tutorial/rt_room.obj", "", 19, {398.894, 309.917, 3.117}, 1},
          {"room-sh3d-Studio/Studio_shell.obj", "y", 2980, {9.532, 6.812, 2.5}, 1},
          {"room-sh3d-Studio/Studio.obj", "y", 40973, {9.532, 6.812, 2.5}, 2},
          {"room-sh3d-2BedroomApartment/2BedroomApartment_shell.obj", "y", 8529, {13.703, 10.36, 2.5}, 2},
          {"room-sh3d-2BedroomApartment/2BedroomApartment.obj", "y", 79569, {13.703, 10.36, 2.5}, 2},
          {"room-duplex-ifc/duplex_webifc.obj", "y", 26774, {9.283, 26.566, 8.185}, 2},
          {"room-duplex-ifc/duplex_assimp_ngons.obj", "y", 12718, {9.283, 26.565, 8.185}, 2},
          {"room-lbnl-openplan/frads_openplan.obj", "", 13966, {36.576, 29.465, 3.354}, 2},
          {"room-hotel-glb/hotel-room.glb", "", 99029, {6.483, 9.995, 2.197}, 0},
          {"room-honeybee/single_family_home.obj", "", 100, {18.981, 22.880, 4.0}, 1},
          {"room-honeybee/model_complete_multi_zone_office.obj", "", 25, {10.0, 10.0, 9.0}, 1},
          {"../reference/refoffice/refoffice.obj", "", 14, {3.6, 8.5, 2.8}, 1},
          {"../reference/furnished/furnished.obj", "", 470, {3.6, 8.5, 2.8}, 1},
          {"../reference/floor/floor.obj", "", 5742, {22.1, 19.2, 2.8}, 1}};
}

class Models : public testing::TestWithParam<Expected> {};

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Models);

TEST_P(Models, ReadInMetres) {
  const Expected& expected = GetParam();
  ModelOptions options;
  if (!expected.up.empty()) {
    options.upAxis = expected.up;
  }
  const Scene scene = readModel(std::filesystem::path(CLERESTORY_MODELS) / expected.file, options);
  EXPECT_EQ(scene.faces.size(), expected.faces);
  const Extent extent = extentOf(scene);
  expectNear(extent.high - extent.low, expected.extent_m, 0.001);
  const auto glazings = std::count_if(scene.materials.begin(), scene.materials.end(),
                                      [](const Material& material) { return material.glazing; });
  EXPECT_EQ(static_cast<std::size_t>(glazings), expected.glazings);
}

INSTANTIATE_TEST_SUITE_P(Of, Models, testing::ValuesIn(expectedModels()), [](const auto& test) {
  std::string name = std::filesystem::path(test.param.file).stem().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '-' || c == '_'; }, '0');
  return name;
});

TEST(AllModels, KeepPolygonsOfManySides) {
  if (std::string(CLERESTORY_MODELS).empty()) {
    GTEST_SKIP() << "CLERESTORY_MODELS is not set";
  }
  const auto mostSides = [](const std::string& file) {
    const Scene scene = readModel(std::filesystem::path(CLERESTORY_MODELS) / file, {});
    std::size_t most = 0;
    for (std::size_t face = 0; face < scene.faces.size(); ++face)
      most = std::max(most, scene.faces[face].size());
    return most;
  };
  EXPECT_EQ(mostSides("room-duplex-ifc/duplex_assimp_ngons.obj"), 90U);
  EXPECT_EQ(mostSides("room-lbnl-openplan/frads_openplan.obj"), 64U);
}

/// Models that have no faces, by their stems, and what is said of them.
std::string expectedRefusal(const std::string& stem) {
  if (stem == "invalid-face-definition") {
    return "no face in the model: faces with fewer than three corners";
  }
  for (const std::string_view name :
       {"line-prim", "points-prim", "Mesh_PrimitiveMode_00", "Mesh_PrimitiveMode_01", "Mesh_PrimitiveMode_02",
        "Mesh_PrimitiveMode_03", "Mesh_PrimitiveMode_07", "Mesh_PrimitiveMode_08", "Mesh_PrimitiveMode_09",
        "Mesh_PrimitiveMode_10"}) {
    if (stem == name) {
      return "no face in the model: points, lines";
    }
  }
  return "";
}

TEST(AllModels, LoadOrAreRefusedForTheirReason) {
  if (std::string(CLERESTORY_MODELS).empty()) {
    GTEST_SKIP() << "CLERESTORY_MODELS is not set";
  }
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(CLERESTORY_MODELS)) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".obj" && ending != ".gltf" && ending != ".glb") {
      continue;
    }
    ++count;
    const std::string expected = expectedRefusal(entry.path().stem().string());
    const std::string message = inputErrorOf([&] { readModel(entry.path(), {}); });
    EXPECT_EQ(message.empty(), expected.empty()) << entry.path() << ": " << message;
    EXPECT_TRUE(contains(message, expected)) << message;
  }
  EXPECT_GT(count, 60U);
}

struct ExpectedCage {
  std::string file;
  std::size_t faces, creases, corners, holes;
};

std::vector<ExpectedCage> expectedCages() {
  if (std::string(CLERESTORY_MODELS).empty()) {
    return {};
  }
  return {{"catmark_cube_corner1", 6, 0, 1, 0},   {"catmark_cube_creases0", 6, 2, 0, 0},
          {"catmark_dart_edgeonly", 16, 2, 0, 0}, {"catmark_edgeonly", 20, 0, 6, 0},
          {"catmark_hole_test1", 6, 0, 0, 1},     {"catmark_torus_creases0", 32, 8, 0, 0},
          {"loop_cube_creases0", 12, 2, 0, 0},    {"loop_icosahedron", 20, 0, 0, 0}};
}

class Cages : public testing::TestWithParam<ExpectedCage> {};

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Cages);

TEST_P(Cages, KeepTheirTags) {
  const ExpectedCage& expected = GetParam();
  const auto file =
      std::filesystem::path(CLERESTORY_MODELS) / "import-opensubdiv/cage" / (expected.file + ".obj");
  const Scene scene = readModel(file, {});
  EXPECT_EQ(scene.faces.size(), 0U);
  ASSERT_EQ(scene.cages.size(), 1U);
  const Cage& cage = scene.cages[0];
  EXPECT_EQ(cage.faces.size(), expected.faces);
  EXPECT_EQ(cage.creases.size(), expected.creases);
  EXPECT_EQ(cage.corners.size(), expected.corners);
  EXPECT_EQ(cage.holes.size(), expected.holes);
}

INSTANTIATE_TEST_SUITE_P(Of, Cages, testing::ValuesIn(expectedCages()),
                         [](const auto& test) { return test.param.file; });

/// The office comes in both formats; they have to mean the same.
TEST(SampleOffice, IsTheSameInBothFormats) {
  const std::filesystem::path folder = std::filesystem::path(CLERESTORY_SAMPLES) / "office";
  const Scene obj = readModel(folder / "office.obj", {});
  const Scene gltf = readModel(folder / "office.glb", {});
  EXPECT_EQ(obj.cages.size(), gltf.cages.size());
  EXPECT_EQ(obj.objects.size(), gltf.objects.size());
  ASSERT_EQ(obj.materials.size(), gltf.materials.size());
  for (const Material& material : obj.materials) {
    const auto same = std::find_if(gltf.materials.begin(), gltf.materials.end(),
                                   [&](const Material& other) { return other.name == material.name; });
    ASSERT_NE(same, gltf.materials.end()) << material.name;
    expectNear(same->reflectance, material.reflectance, 1e-4);
    expectNear(same->exitance_lm_m2, material.exitance_lm_m2, 0.1);
    EXPECT_EQ(same->glazing, material.glazing) << material.name;
  }
  expectNear(extentOf(obj).low, extentOf(gltf).low, 1e-4);
  expectNear(extentOf(obj).high, extentOf(gltf).high, 1e-4);
}

TEST(SampleOffice, HasAStudyThatReads) {
  const Study study = readStudy(std::filesystem::path(CLERESTORY_SAMPLES) / "office" / "study.toml");
  Scene scene = readModel(study.modelFile, study.model);
  applyMaterialRules(study, scene);
  EXPECT_EQ(countOf(scene.diagnoses, "C150"), 0U);
}

}  // namespace
}  // namespace clerestory
