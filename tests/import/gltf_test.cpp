// SPDX-License-Identifier: GPL-3.0-or-later
// glTF models, written in memory: containers, transforms, accessors, materials, cages, and what is refused.
#include <glm/geometric.hpp>

#include <array>
#include <cstring>
#include <limits>
#include <numbers>

#include <import/scene.hpp>

#include "gltffile.hpp"

namespace clerestory {
namespace {

glm::dvec3 normalOf(const Scene& scene, std::size_t face) {
  const auto f = scene.faces[face];
  return glm::normalize(
      glm::cross(scene.points[f[1]] - scene.points[f[0]], scene.points[f[2]] - scene.points[f[0]]));
}

Material materialOf(const std::string& material) {
  Parts parts;
  parts.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
  parts.rest = R"(,"materials":[)" + material + "]";
  return read(parts).materials.at(0);
}

TEST(Gltf, ReadsTheContainerAndTurnsYUp) {
  const Scene scene = read({});
  ASSERT_EQ(scene.faces.size(), 2U);
  EXPECT_EQ(scene.objects, (std::vector<std::string>{"floor"}));
  EXPECT_EQ(scene.points[2], glm::dvec3(4, -3, 0));
  EXPECT_EQ(normalOf(scene, 0), glm::dvec3(0, 0, 1));
  EXPECT_EQ(scene.materials[0].reflectance, glm::dvec3(0.9)) << "the default material is white";
  EXPECT_EQ(countOf(scene.diagnoses, "C121"), 1U);
}

// 32 bits hold 7.777 but for 2e-7: what was drawn is the shortest decimal that they stand for.
TEST(Gltf, FloatsStandForTheirDecimals) {
  const TempFolder folder;
  std::string bytes = squareBytes();
  const float drawn[3] = {7.777F, 0.1F, 3.003F};
  std::memcpy(bytes.data(), drawn, sizeof drawn);
  const Scene scene = readModel(folder.write("square.glb", glb(jsonOf(Parts()), bytes)), {});
  ASSERT_EQ(scene.points.size(), 4U);
  EXPECT_EQ(scene.points[0], glm::dvec3(7.777, -3.003, 0.1));
}

TEST(Gltf, FlipsTheWindingOfMirroredNodes) {
  Parts parts;
  parts.nodes = R"([{"children":[1],"scale":[-1,1,1]},{"mesh":0,"translation":[1,2,3]}])";
  const Scene scene = read(parts);
  EXPECT_EQ(normalOf(scene, 0), glm::dvec3(0, 0, 1)) << "it still faces up";
  EXPECT_EQ(scene.points[0], glm::dvec3(-1, -3, 2));
  EXPECT_EQ(scene.objects[0], "mesh");
}

TEST(Gltf, AppliesMatricesAndRotations) {
  Parts parts;
  parts.nodes = R"([{"mesh":0,"matrix":[2,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,1]}])";
  EXPECT_EQ(read(parts).points[3], glm::dvec3(13, 0, 0));
  parts.nodes = R"([{"mesh":0,"rotation":[0,0.7071067811865476,0,0.7071067811865476]}])";
  const glm::dvec3 turned = read(parts).points[3];  // (4, 0, 0) about y: (0, 0, -4) y-up
  EXPECT_NEAR(glm::length(turned - glm::dvec3(0, 4, 0)), 0.0, 1e-12);
}

TEST(Gltf, ReadsDataUrisAndNeighbourFiles) {
  const TempFolder folder;
  Parts parts;
  parts.buffer = R"({"byteLength":60,"uri":"data:application/octet-stream;base64,)"
                 "AAAAAAAAAAAAAAAAAAAAAAAAAAAAAEBAAACAQAAAAAAAAEBAAACAQAAAAAAAAAAAAAABAAIAAAACAAMA"
                 R"("})";
  EXPECT_EQ(readModel(folder.write("a.gltf", jsonOf(parts)), {}).faces.size(), 2U);
  folder.write("my data.bin", squareBytes());
  parts.buffer = R"({"byteLength":60,"uri":"my%20data.bin"})";
  EXPECT_EQ(readModel(folder.write("a.gltf", jsonOf(parts)), {}).points[2], glm::dvec3(4, -3, 0));
}

TEST(Gltf, ReadsNoBufferOutsideTheModelsFolder) {
  const TempFolder folder;
  folder.write("data.bin", squareBytes());
  for (const std::string& uri : {std::string("../data.bin"), (folder.path() / "data.bin").string(),
                                 std::string("%2E%2E/data.bin"), std::string("file:///etc/passwd")}) {
    Parts parts;
    parts.buffer = R"({"byteLength":60,"uri":")" + uri + "\"}";
    const auto model = folder.write("in/a.gltf", jsonOf(parts));
    const std::string message = inputErrorOf([&] { readModel(model, {}); });
    EXPECT_TRUE(contains(message, "/buffers/0/uri")) << message;
  }
}

TEST(Gltf, ReadsStripsFansAndPlainVertices) {
  Parts parts;
  parts.primitive = R"({"attributes":{"POSITION":0},"mode":6})";
  Scene scene = read(parts);
  ASSERT_EQ(scene.faces.size(), 2U);
  EXPECT_EQ(normalOf(scene, 0), normalOf(scene, 1));
  parts.primitive = R"({"attributes":{"POSITION":0},"indices":1,"mode":5})";
  scene = read(parts);  // 0 1 2 0 2 3: the third of its four triangles is 2 0 2, a joint
  EXPECT_EQ(scene.faces.size(), 3U);
  EXPECT_EQ(normalOf(scene, 1), -normalOf(scene, 0)) << "1 0 2, as every other face of a strip is turned";
  parts.primitive = R"({"attributes":{"POSITION":0},"indices":1},{"attributes":{"POSITION":0},"mode":1})";
  EXPECT_EQ(countOf(read(parts).diagnoses, "C111"), 1U);
}

TEST(Gltf, NamesThePlaceOfWhatReachesTooFar) {
  Parts parts;
  parts.positions = R"({"bufferView":0,"componentType":5126,"count":5,"type":"VEC3"})";
  EXPECT_TRUE(contains(errorOf(parts), "/accessors/0: reaches beyond")) << errorOf(parts);
  parts.positions = R"({"bufferView":0,"componentType":5126,"count":9007199254740991,"type":"VEC3"})";
  EXPECT_TRUE(contains(errorOf(parts), "/accessors/0: reaches beyond"));
  parts.positions =
      R"({"bufferView":0,"byteOffset":9007199254740991,"componentType":5126,"count":1,"type":"VEC3"})";
  EXPECT_TRUE(contains(errorOf(parts), "/accessors/0: reaches beyond"));
  parts.positions = R"({"bufferView":2,"componentType":5126,"count":4,"type":"VEC3"})";
  EXPECT_TRUE(contains(errorOf(parts), "/accessors/0/bufferView: names bufferView 2"));
  parts.positions = R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})";
  EXPECT_TRUE(contains(errorOf(parts), "/meshes/0/primitives/0: index 3 is out of range"));
  parts = {};
  parts.view = R"({"buffer":0,"byteOffset":48,"byteLength":48})";
  EXPECT_TRUE(contains(errorOf(parts), "/bufferViews/0: reaches beyond"));
  parts = {};
  parts.buffer = R"({"byteLength":61000})";
  EXPECT_TRUE(contains(errorOf(parts), "/buffers/0: the buffer is cut off"));
}

TEST(Gltf, NamesThePlaceOfWrongTypes) {
  Parts parts;
  parts.positions = R"({"bufferView":0,"componentType":5130,"count":4,"type":"VEC3"})";
  EXPECT_TRUE(contains(errorOf(parts), "/accessors/0: componentType 5130 is not one"));
  parts.positions = R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC4"})";
  EXPECT_TRUE(contains(errorOf(parts), "/accessors/0: its type has to be VEC3"));
  parts.positions = R"({"bufferView":0,"componentType":5126,"count":-1,"type":"VEC3"})";
  EXPECT_TRUE(contains(errorOf(parts), "/accessors/0/count: has to be a whole number"));
  parts.positions = R"({"componentType":5126,"count":4000000,"type":"VEC3"})";
  EXPECT_TRUE(contains(errorOf(parts), "/accessors/0: has no bufferView"));
  parts = {};
  parts.nodes = R"([{"mesh":0,"matrix":[1,2]}])";
  EXPECT_TRUE(contains(errorOf(parts), "/nodes/0/matrix: has to have 16 numbers"));
  parts.nodes = R"([{"mesh":"0"}])";
  EXPECT_TRUE(contains(errorOf(parts), "/nodes/0/mesh: has to be a finite number"));
}

TEST(Gltf, RefusesCyclesAndUnknownExtensions) {
  Parts parts;
  parts.nodes = R"([{"mesh":0,"children":[1]},{"children":[0]}])";
  EXPECT_TRUE(contains(errorOf(parts), "/nodes/0: the node is met twice"));
  parts = {};
  for (const std::string name : {"KHR_texture_basisu", "KHR_meshopt_compression", "ACME_walls"}) {
    parts.rest = R"(,"extensionsRequired":[")" + name + "\"]";
    EXPECT_TRUE(contains(errorOf(parts), "/extensionsRequired/0: the model needs the extension \"" + name));
  }
  parts.rest = R"(,"extensionsRequired":["KHR_materials_transmission"])";
  EXPECT_EQ(errorOf(parts), "");
  parts.rest = R"(,"extensionsUsed":["KHR_materials_transmission","ACME_walls"])";
  EXPECT_EQ(countOf(read(parts).diagnoses, "C137"), 1U);
}

TEST(Gltf, ReadsDeepNodesButNotDeepJson) {
  Parts parts;
  constexpr int kDepth = 20000;
  parts.nodes = "[";
  for (int i = 0; i < kDepth; ++i) {
    parts.nodes += R"({"children":[)" + std::to_string(i + 1) + "]},";
  }
  parts.nodes += R"({"mesh":0}])";
  EXPECT_EQ(read(parts).faces.size(), 2U);
  parts = {};
  parts.rest = R"(,"extras":)" + std::string(100000, '[') + std::string(100000, ']');
  EXPECT_TRUE(contains(errorOf(parts), "nested deeper"));
}

TEST(Gltf, RefusesGeometryOutOfProportion) {
  Parts parts;
  std::string children;
  std::string nodes;
  for (int i = 1; i < 300; ++i) {
    children += (i > 1 ? "," : "") + std::to_string(i);
    nodes += R"(,{"mesh":0})";
  }
  parts.nodes = R"([{"children":[)" + children + "]}" + nodes + "]";
  parts.positions = R"({"componentType":5126,"count":1000000,"type":"VEC3","sparse":{"count":1,)"
                    R"("indices":{"bufferView":1,"componentType":5123},"values":{"bufferView":0}}})";
  EXPECT_TRUE(contains(errorOf(parts), "too often")) << errorOf(parts);
}

TEST(Gltf, ReadsMaterials) {
  EXPECT_EQ(materialOf(R"({"pbrMetallicRoughness":{"baseColorFactor":[0.2,0.3,0.4,1],"metallicFactor":1}})")
                .reflectance,
            glm::dvec3(0.2, 0.3, 0.4));
  const Material lamp = materialOf(
      R"({"emissiveFactor":[1,0.5,0],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":1000}}})");
  EXPECT_DOUBLE_EQ(lamp.exitance_lm_m2.g, 500.0 * std::numbers::pi);
  const Material glass =
      materialOf(R"({"pbrMetallicRoughness":{"baseColorFactor":[1,1,0.5,1]},)"
                 R"("extensions":{"KHR_materials_transmission":{"transmissionFactor":0.8}}})");
  EXPECT_TRUE(glass.glazing);
  EXPECT_FALSE(glass.transmittanceIsAssumed);
  EXPECT_EQ(glass.transmittance, glm::dvec3(0.8, 0.8, 0.4));
  const Material blend =
      materialOf(R"({"alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.3]}})");
  EXPECT_TRUE(blend.glazing);
  EXPECT_TRUE(blend.transmittanceIsAssumed);
  EXPECT_FALSE(materialOf(R"({"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,0.3]}})").glazing);
  EXPECT_TRUE(materialOf(R"({"name":"Glass"})").glazing);
  EXPECT_FALSE(materialOf(R"({"name":"Glass","alphaMode":"OPAQUE"})").glazing);
}

TEST(Gltf, ReadsCages) {
  Parts parts;
  parts.nodes = R"([{"mesh":0,"name":"cushion","scale":[1,1,-1]}])";
  parts.extras = R"(,"extras":{"clerestory":{"scheme":"catmark","boundary":"edge-only","face_sizes":[4],)"
                 R"("face_points":[0,1,2,3],"creases":[[0,1,2.5]],"corners":[[3,20]],"holes":[]}})";
  const Scene scene = read(parts);
  EXPECT_EQ(scene.faces.size(), 0U);
  ASSERT_EQ(scene.cages.size(), 1U);
  const Cage& cage = scene.cages[0];
  EXPECT_EQ(scene.objects[cage.object], "cushion");
  EXPECT_EQ(cage.boundary, Cage::Boundary::edgeOnly);
  const auto face = cage.faces[0];
  EXPECT_EQ((std::vector<std::uint32_t>(face.begin(), face.end())), (std::vector<std::uint32_t>{3, 2, 1, 0}))
      << "mirrored";
  EXPECT_EQ(cage.creases.at(0).sharpness, 2.5F);
  EXPECT_EQ(cage.corners.at(0).sharpness, 10.0F);
}

TEST(Gltf, RefusesBrokenCages) {
  const std::string before = R"(,"extras":{"clerestory":{"face_sizes":)";
  const std::array<std::array<std::string, 2>, 6> cases{{
      {R"([4],"face_points":[0,1,2,4])", "/meshes/0/extras/clerestory/face_points/3: 4 is out of range"},
      {R"([5],"face_points":[0,1,2,3])", "/meshes/0/extras/clerestory/face_sizes/0"},
      {R"([3],"face_points":[0,1,2,3])", "/meshes/0/extras/clerestory/face_sizes"},
      {R"([4],"face_points":[0,1,2,3],"creases":[[0,9,1]])", "/meshes/0/extras/clerestory/creases/0/1"},
      {R"([4],"face_points":[0,1,2,3],"holes":[1])", "/meshes/0/extras/clerestory/holes/0"},
      {R"([4],"face_points":[0,1,2,3],"scheme":"nurbs")", "/meshes/0/extras/clerestory/scheme"},
  }};
  for (const auto& [text, expected] : cases) {
    Parts parts;
    parts.extras = before + text + "}}";
    EXPECT_TRUE(contains(errorOf(parts), expected)) << errorOf(parts);
  }
}

/// Every truncation is an error that says so, never a crash; every changed byte is an error or a model.
TEST(Gltf, SurvivesTruncationAndChangedBytes) {
  const TempFolder folder;
  const std::string whole = glb(jsonOf({}), squareBytes());
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const auto file = folder.write("a.glb", whole.substr(0, length));
    EXPECT_NE(inputErrorOf([&] { readModel(file, {}); }), "") << length;
  }
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const char value : {'\0', '9', '\xFF', '"'}) {
      std::string changed = whole;
      changed[at] = value;
      const auto file = folder.write("a.glb", changed);
      inputErrorOf([&] { readModel(file, {}); });
    }
  }
}

}  // namespace
}  // namespace clerestory
