// SPDX-License-Identifier: GPL-3.0-or-later
// Extensions of glTF: quantised and compressed meshes, instances, lamps, materials.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <glm/geometric.hpp>
#include <meshoptimizer.h>

#include <array>
#include <cmath>
#include <numbers>

#include "gltffile.hpp"

namespace clerestory {
namespace {

void expectNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-6) {
  EXPECT_NEAR(glm::length(a - b), 0.0, tolerance) << a.x << ' ' << a.y << ' ' << a.z;
}

Scene readGlb(const std::string& json, const std::string& binary) {
  const TempFolder folder;
  return readModel(folder.write("a.glb", glb(json, binary)), {});
}

TEST(GltfExtensions, ReadsQuantisedPositions) {
  // The square's corners as signed bytes of 127ths, and as plain shorts, padded to four bytes.
  std::string bytes;
  for (const auto& corner : {std::array{0, 0, 0}, {0, 0, 127}, {-127, 0, 127}, {-127, 0, 0}}) {
    for (const int v : corner) {
      append(bytes, static_cast<std::int8_t>(v));
    }
    append(bytes, std::int8_t{0});
  }
  const auto json = [](const std::string& accessor) {
    return R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_mesh_quantization"],"nodes":[{"mesh":0,)"
           R"("scale":[4,1,3]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":6}]}],)"
           R"("accessors":[)" +
           accessor +
           R"(],"bufferViews":[{"buffer":0,"byteLength":16,"byteStride":4}],"buffers":[{"byteLength":16}]})";
  };
  const Scene fractions = readGlb(
      json(R"({"bufferView":0,"componentType":5120,"normalized":true,"count":4,"type":"VEC3"})"), bytes);
  expectNear(fractions.points[2], glm::dvec3(-4, -3, 0));
  const Scene whole =
      readGlb(json(R"({"bufferView":0,"componentType":5120,"count":4,"type":"VEC3"})"), bytes);
  expectNear(whole.points[2], 0.01 * glm::dvec3(-508, -381, 0));  // as metres it would be no building
}

TEST(GltfExtensions, ReadsSparseIndices) {
  Parts parts;
  std::string bytes = squareBytes();
  append(bytes, std::uint16_t{5});  // the last index …
  append(bytes, std::uint16_t{1});  // … becomes 1
  parts.indices =
      R"({"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR","sparse":{"count":1,)"
      R"("indices":{"bufferView":1,"byteOffset":12,"componentType":5123},"values":{"bufferView":1,"byteOffset":14}}})";
  parts.view += R"(,{"buffer":0,"byteOffset":48,"byteLength":16})";
  parts.buffer = R"({"byteLength":64})";
  const Scene scene = readGlb(jsonOf(parts), bytes);
  EXPECT_EQ(scene.faces[1][2], 1U);
}

/// The square by meshoptimizer's codecs: its positions and its indices in one buffer.
std::string meshoptSquare(std::string& json, const std::string& change = "") {
  const std::string plain = squareBytes();
  std::vector<float> positions(12);
  std::vector<std::uint16_t> indices(6);
  std::memcpy(positions.data(), plain.data(), 48);
  std::memcpy(indices.data(), plain.data() + 48, 12);
  std::string vertices(meshopt_encodeVertexBufferBound(4, 12), '\0');
  vertices.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(vertices.data()),
                                             vertices.size(), positions.data(), 4, 12));
  std::string triangles(meshopt_encodeIndexBufferBound(6, 4), '\0');
  triangles.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(triangles.data()),
                                             triangles.size(), indices.data(), 6));
  const auto view = [](std::size_t offset, std::size_t length, const std::string& rest,
                       std::size_t fallback) {
    return R"({"buffer":1,"byteLength":)" + std::to_string(fallback) +
           R"(,"extensions":{"EXT_meshopt_compression":{"buffer":0,"byteOffset":)" + std::to_string(offset) +
           R"(,"byteLength":)" + std::to_string(length) + "," + rest + "}}}";
  };
  json =
      R"({"asset":{"version":"2.0"},"extensionsRequired":["EXT_meshopt_compression"],"nodes":[{"mesh":0}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[)"
      R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
      R"({"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}],"bufferViews":[)" +
      view(0, vertices.size(),
           change.empty() ? R"("byteStride":12,"count":4,"mode":"ATTRIBUTES","filter":"NONE")" : change, 48) +
      "," + view(vertices.size(), triangles.size(), R"("byteStride":2,"count":6,"mode":"TRIANGLES")", 12) +
      R"(],"buffers":[{"byteLength":)" + std::to_string(vertices.size() + triangles.size()) +
      R"(},{"byteLength":60}]})";
  return vertices + triangles;
}

TEST(GltfExtensions, ReadsMeshopt) {
  std::string json;
  const std::string bytes = meshoptSquare(json);
  const Scene scene = readGlb(json, bytes);
  ASSERT_EQ(scene.faces.size(), 2U);
  const Scene plain = read({});
  EXPECT_EQ(scene.points, plain.points);
}

TEST(GltfExtensions, RefusesBrokenMeshopt) {
  const std::array<std::array<std::string, 2>, 6> cases{{
      {R"("byteStride":12,"count":400000000,"mode":"ATTRIBUTES")", "/count: announces more"},
      {R"("byteStride":13,"count":4,"mode":"ATTRIBUTES")", "/byteStride: 13 does not fit"},
      {R"("byteStride":0,"count":4,"mode":"ATTRIBUTES")", "/byteStride: 0 does not fit"},
      {R"("byteStride":4,"count":4,"mode":"TRIANGLES")", "/count: 4 indices are no whole triangles"},
      {R"("byteStride":12,"count":4,"mode":"ATTRIBUTES","filter":"QUATERNION")", "/filter: does not fit"},
      {R"("byteStride":12,"count":4,"mode":"ZIP")", "/mode: is none of"},
  }};
  for (const auto& [change, expected] : cases) {
    std::string json;
    const std::string bytes = meshoptSquare(json, change);
    const std::string message = inputErrorOf([&] { readGlb(json, bytes); });
    EXPECT_TRUE(contains(message, "/bufferViews/0/extensions/EXT_meshopt_compression" + expected)) << message;
  }
  std::string json;
  std::string bytes = meshoptSquare(json);
  bytes[0] = 'x';
  EXPECT_TRUE(contains(inputErrorOf([&] { readGlb(json, bytes); }), "does not decode"));
}

/// The square by Draco, positions to 14 bits.
std::string dracoSquare() {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const std::array<std::array<float, 3>, 4> corners{{{0, 0, 0}, {0, 0, 3}, {4, 0, 3}, {4, 0, 0}}};
  builder.SetAttributeValuesForFace(position, draco::FaceIndex(0), corners[0].data(), corners[1].data(),
                                    corners[2].data());
  builder.SetAttributeValuesForFace(position, draco::FaceIndex(1), corners[0].data(), corners[2].data(),
                                    corners[3].data());
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {buffer.data(), buffer.size()};
}

std::string dracoJson(std::size_t size, const std::string& attribute = "0") {
  return R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"],"nodes":[{"mesh":0}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"extensions":{)"
         R"("KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":)" +
         attribute +
         R"(}}}}]}],"accessors":[{"componentType":5126,"count":4,"type":"VEC3"},)"
         R"({"componentType":5125,"count":6,"type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteLength":)" +
         std::to_string(size) + R"(}],"buffers":[{"byteLength":)" + std::to_string(size) + "}]}";
}

TEST(GltfExtensions, ReadsDraco) {
  const std::string bytes = dracoSquare();
  const Scene scene = readGlb(dracoJson(bytes.size()), bytes);
  ASSERT_EQ(scene.faces.size(), 2U);
  glm::dvec3 area(0.0);
  for (std::size_t f = 0; f < 2; ++f) {
    const auto face = scene.faces[f];
    area += 0.5 * glm::cross(scene.points[face[1]] - scene.points[face[0]],
                             scene.points[face[2]] - scene.points[face[0]]);
  }
  expectNear(area, glm::dvec3(0, 0, 12), 0.002);  // 14 bits of 4 m: 0.25 mm
}

TEST(GltfExtensions, RefusesBrokenDraco) {
  const std::string bytes = dracoSquare();
  EXPECT_TRUE(contains(inputErrorOf([&] { readGlb(dracoJson(bytes.size(), "7"), bytes); }),
                       "/attributes/POSITION: the Draco mesh has no attribute 7"));
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const std::string cut = bytes.substr(0, length);
    EXPECT_NE(inputErrorOf([&] { readGlb(dracoJson(length), cut); }), "") << length;
  }
}

TEST(GltfExtensions, PlacesInstances) {
  Parts parts;
  std::string bytes = squareBytes();
  for (const float v : {10.F, 0.F, 0.F, 20.F, 0.F, 0.F, 1.F, 1.F, 1.F, -2.F, 1.F, 1.F}) {
    append(bytes, v);
  }
  const float half = std::sqrt(0.5F);
  for (const float v : {0.F, 0.F, 0.F, 1.F, 0.F, half, 0.F, half}) {
    append(bytes, v);
  }
  parts.nodes =
      R"([{"mesh":0,"name":"chair","translation":[0,1,0],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":)"
      R"({"TRANSLATION":2,"SCALE":3,"ROTATION":4}}}}])";
  const std::string two = R"(,"componentType":5126,"count":2,"type":)";
  parts.indices += R"(,{"bufferView":2)" + two + R"("VEC3"},{"bufferView":2,"byteOffset":24)" + two +
                   R"("VEC3"},{"bufferView":2,"byteOffset":48)" + two + R"("VEC4"})";
  parts.view +=
      R"(,{"buffer":0,"byteOffset":48,"byteLength":12},{"buffer":0,"byteOffset":60,"byteLength":80})";
  parts.buffer = R"({"byteLength":140})";
  const Scene scene = readGlb(jsonOf(parts), bytes);
  ASSERT_EQ(scene.faces.size(), 4U);
  EXPECT_EQ(scene.objects, (std::vector<std::string>{"chair", "chair"}));
  expectNear(scene.points[2], glm::dvec3(14, -3, 1));
  // Second: x times -2, then a quarter turn about y: (4, 0, 3) to (-8, 0, 3) to (3, 0, 8), y up.
  expectNear(scene.points[6], glm::dvec3(23, -8, 1), 1e-5);
  EXPECT_EQ(scene.faces[2][1], 4U + 2U) << "mirrored, so wound the other way";
}

TEST(GltfExtensions, ReadsLamps) {
  Parts parts;
  parts.nodes =
      R"([{"mesh":0,"children":[1,2]},{"name":"lamp","translation":[1,2.5,-3],"rotation":[-0.7071067811865476,0,0,)"
      R"(0.7071067811865476],"extensions":{"KHR_lights_punctual":{"light":0}}},)"
      R"({"extensions":{"KHR_lights_punctual":{"light":1}}}])";
  parts.rest =
      R"(,"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":800,"color":[1,0.5,0],)"
      R"("spot":{"innerConeAngle":0.3,"outerConeAngle":0.6}},{"type":"directional","name":"sun"}]}})";
  const Scene scene = read(parts);
  ASSERT_EQ(scene.lights.size(), 2U);
  const PunctualLight& spot = scene.lights[0];
  EXPECT_EQ(spot.name, "lamp");
  EXPECT_EQ(spot.kind, PunctualLight::Kind::spot);
  expectNear(spot.position_m, glm::dvec3(1, 3, 2.5));
  expectNear(spot.direction, glm::dvec3(0, 0, -1));
  expectNear(spot.intensity, glm::dvec3(800, 400, 0));
  EXPECT_EQ(spot.innerCone_rad, 0.3);
  EXPECT_EQ(spot.outerCone_rad, 0.6);
  EXPECT_EQ(scene.lights[1].name, "sun");
  expectNear(scene.lights[1].direction, glm::dvec3(0, 1, 0));
  EXPECT_EQ(countOf(scene.diagnoses, "C132"), 1U);
  const std::vector<Luminaire> luminaires = luminairesOf(scene.lights);
  ASSERT_EQ(luminaires.size(), 1U);
  const double luminous_cd = 0.2126 * 800 + 0.7152 * 400;
  EXPECT_NEAR(luminaires[0].photometry->distribution.intensity({0, 0, -1}), luminous_cd, 1e-9);
  EXPECT_EQ(luminaires[0].photometry->distribution.intensity({1, 0, 0}), 0.0);
  expectNear(luminaires[0].color, glm::dvec3(800, 400, 0) / luminous_cd);
  expectNear(luminaires[0].axes[2], glm::dvec3(0, 0, 1));
  parts.nodes = R"([{"mesh":0,"extensions":{"KHR_lights_punctual":{"light":2}}}])";
  EXPECT_TRUE(contains(errorOf(parts), "names light 2"));
}

Material materialOf(const std::string& material) {
  Parts parts;
  parts.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0,"extensions":{)"
                    R"("KHR_materials_variants":{"mappings":[{"material":1,"variants":[0]}]}}})";
  parts.rest = R"(,"materials":[)" + material + R"(,{"name":"variant"}])";
  const Scene scene = read(parts);
  EXPECT_EQ(scene.materials.size(), 1U)
      << "a variant that is not the default one is no material of the model";
  return scene.materials.at(0);
}

TEST(GltfExtensions, ReadsMaterials) {
  const Material older = materialOf(
      R"({"extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[0.2,0.3,0.4,1]}}})");
  EXPECT_EQ(older.reflectance, glm::dvec3(0.2, 0.3, 0.4));
  const Material both = materialOf(
      R"({"pbrMetallicRoughness":{"baseColorFactor":[0.2,0.3,0.4,1]},"extensions":{"KHR_materials_unlit":{},)"
      R"("KHR_materials_ior":{"ior":1.4},"KHR_materials_specular":{"specularFactor":0.5}}})");
  EXPECT_EQ(both.reflectance, glm::dvec3(0.2, 0.3, 0.4));
  EXPECT_FALSE(both.mirrorsAsMatt);
  EXPECT_TRUE(materialOf(R"({"pbrMetallicRoughness":{"metallicFactor":0.5}})").mirrorsAsMatt);
  const Material tinted = materialOf(
      R"({"extensions":{"KHR_materials_transmission":{"transmissionFactor":0.8},"KHR_materials_volume":)"
      R"({"thicknessFactor":0.02,"attenuationDistance":0.01,"attenuationColor":[1,0.5,0.5]}}})");
  expectNear(tinted.transmittance, glm::dvec3(0.8, 0.2, 0.2));
}

}  // namespace
}  // namespace clerestory
