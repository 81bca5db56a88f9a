// SPDX-License-Identifier: GPL-3.0-or-later
// scene.glb read back by our own reader; Khronos' validator sees it in tests/browser/files.mjs.
#include "glb.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstring>

#include <import/scene.hpp>

#include "fake.hpp"

namespace clerestory {
namespace {

/// The office with a triangle on its first surface and a pentagon on its second, 3 m up.
fake::Case lit() {
  fake::Case made = fake::office();
  ElementMesh& mesh = made.solution.mesh;
  mesh.origin_m = {100.0, 200.0, 3.0};
  mesh.corners_m = {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 0, 1}, {2, 0, 1}, {3, 1, 1}, {2, 2, 1}, {0, 2, 1}};
  mesh.firstCorner = {0, 3, 8};
  mesh.surfaceRow = {0, 1};
  for (std::size_t c = 0; c < mesh.corners_m.size(); ++c) {
    mesh.illuminance_lx.push_back(100.0F + static_cast<float>(c));
    mesh.exitance_lm_m2.emplace_back(50.0F, 40.0F, 30.0F + static_cast<float>(c));
  }
  return made;
}

std::uint32_t numberAt(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, &bytes.at(at), sizeof(value));
  return value;
}

TEST(SceneGlb, IsReadBackWithItsPlacesAndNames) {
  const fake::TemporaryFolder folder;
  const fake::Case made = lit();
  std::ofstream(folder.path() / "scene.glb", std::ios::binary) << sceneGlb(made.input());
  const Scene scene = readModel(folder.path() / "scene.glb", {});
  EXPECT_EQ(scene.faces.size(), 4U);  // a triangle, and a pentagon as three
  EXPECT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.objects.at(0), "Walls");
  double most_m = 0.0;
  for (const glm::vec3& corner : made.solution.mesh.corners_m) {
    double nearest_m = 1e9;
    for (const glm::dvec3& point : scene.points) {
      const glm::dvec3 off = point - glm::dvec3(corner) - made.solution.mesh.origin_m;
      nearest_m = std::min(nearest_m, std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}));
    }
    most_m = std::max(most_m, nearest_m);
  }
  EXPECT_LT(most_m, 1e-5);
}

TEST(SceneGlb, HoldsRadiosityAndIlluminance) {
  const fake::Case made = lit();
  const std::string bytes = sceneGlb(made.input());
  ASSERT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(numberAt(bytes, 8), bytes.size());
  const std::uint32_t length = numberAt(bytes, 12);
  const nlohmann::json document = nlohmann::json::parse(bytes.substr(20, length));
  const double radiosityOf1 = document["scenes"][0]["extras"]["radiosity_lm_m2_of_1"];
  const auto valueOf = [&](std::size_t accessor, std::size_t index) {
    const nlohmann::json& view =
        document["bufferViews"][document["accessors"][accessor]["bufferView"].get<std::size_t>()];
    float value = 0.0F;
    std::memcpy(&value, &bytes.at(28 + length + view["byteOffset"].get<std::size_t>() + 4 * index), 4);
    return static_cast<double>(value);
  };
  const nlohmann::json& attributes = document["meshes"][1]["primitives"][0]["attributes"];
  for (std::size_t c = 0; c < 5; ++c) {  // of the pentagon
    EXPECT_EQ(valueOf(attributes["_ILLUMINANCE"].get<std::size_t>(), c), 103.0 + static_cast<double>(c));
    EXPECT_NEAR(valueOf(attributes["COLOR_0"].get<std::size_t>(), 3 * c) * radiosityOf1, 50.0, 1e-3);
    EXPECT_NEAR(valueOf(attributes["COLOR_0"].get<std::size_t>(), 3 * c + 2) * radiosityOf1,
                33.0 + static_cast<double>(c), 1e-3);
  }
}

TEST(SceneGlb, WithoutLightItIsAnEmptyScene) {
  const std::string bytes = sceneGlb(fake::office().input());
  const nlohmann::json document = nlohmann::json::parse(bytes.substr(20));
  EXPECT_FALSE(document.contains("buffers"));
  EXPECT_EQ(bytes.size() % 4, 0U);
}

}  // namespace
}  // namespace clerestory
