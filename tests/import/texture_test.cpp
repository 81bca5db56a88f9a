// SPDX-License-Identifier: GPL-3.0-or-later
// Textures: the mean of the part that the surfaces wear, in linear light.
#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

#include "gltffile.hpp"
#include "png.hpp"

namespace clerestory {
namespace {

constexpr std::array<int, 4> kBlack{0, 0, 0, 255};
constexpr std::array<int, 4> kGrey{188, 188, 188, 255};  // linear 0.503
constexpr std::array<int, 4> kRed{188, 0, 0, 255};

/// Red, grey / black, grey: 2 x 2.
std::string picture() {
  return png(2, 2, {kRed, kGrey, kBlack, kGrey});
}

/// IEC 61966-2-1.
double linear(int value) {
  const double v = value / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

/// A rectangle 4 x 3 with the material m, its texture coordinates those of [u0, u1] x [v0, v1].
Scene readObj(const std::string& mtl, const std::string& vt, const std::string& pictureName = "a.png") {
  const TempFolder folder;
  folder.write(pictureName, picture());
  folder.write("a.mtl", "newmtl m\n" + mtl);
  return readModel(folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\n" + vt +
                                             "usemtl m\nf 1/1 2/2 3/3 4/4\n"),
                   {});
}

/// Of a mean whose texels are cut by the triangles' sides: 32 samples along each.
constexpr double kCut = 0.003;

const std::string kWhole = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

TEST(Texture, ObjTakesTheMeanInLinearLight) {
  const glm::dvec3 mean = readObj("Kd 1 1 1\nmap_Kd a.png\n", kWhole).materials[0].reflectance;
  EXPECT_NEAR(mean.r, 0.75 * linear(188), kCut);
  EXPECT_NEAR(mean.g, 0.5 * linear(188), kCut);
}

TEST(Texture, ObjCountsVFromTheBottom) {
  const std::string top = "vt 0 0.5\nvt 0.5 0.5\nvt 0.5 1\nvt 0 1\n";
  EXPECT_NEAR(glm::length(readObj("Kd 0.5 1 1\nmap_Kd a.png\n", top).materials[0].reflectance -
                          glm::dvec3(0.5 * linear(188), 0, 0)),
              0.0, 1e-6);
}

TEST(Texture, ObjWeighsByAreaAndRepeats) {
  // Twelve tiles and a bit on one side make the whole picture's mean; -s and -o move it.
  const std::string many = "vt -3 -1\nvt 9 -1\nvt 9 7\nvt -3 7\n";
  const Scene scene = readObj("Kd 1 1 1\nmap_Kd a.png\n", many);
  EXPECT_NEAR(scene.materials[0].reflectance.r, 0.75 * linear(188), 1e-6);
  const Scene half = readObj("Kd 1 1 1\nmap_Kd -s 0.5 1 1 -o 0.5 0 a.png\n", kWhole);
  EXPECT_NEAR(half.materials[0].reflectance.g, linear(188), 1e-6);
  const Scene clamped = readObj("Kd 1 1 1\nmap_Kd -clamp on a.png\n", "vt 1 0\nvt 2 0\nvt 2 1\nvt 1 1\n");
  EXPECT_NEAR(clamped.materials[0].reflectance.g, linear(188), 1e-6);
}

TEST(Texture, ObjReadsOptionsAndNamesWithBlanks) {
  const Scene scene =
      readObj("Kd 0 0 0\nmap_Kd -mm 0.1 0.5 -blendu on my  wood.png\n", kWhole, "my  wood.png");
  EXPECT_NEAR(scene.materials[0].reflectance.g, 0.1 + 0.5 * 0.5 * linear(188), 1e-6)
      << "black behind a picture means that the picture gives the colour";
  EXPECT_EQ(countOf(scene.diagnoses, "C126"), 0U);
}

TEST(Texture, ObjMultipliesLuminance) {
  const Scene scene = readObj("Kd 0 0 0\nKe 100 100 100\nmap_Ke a.png\n", kWhole);
  EXPECT_NEAR(scene.materials[0].exitance_lm_m2.g, std::numbers::pi * 50.0 * linear(188), 1e-3);
}

TEST(Texture, ObjReadsNoPictureOutsideTheModelsFolder) {
  for (const std::string name : {"../a.png", "/tmp/a.png", "C:\\a.png", "..\\a.png"}) {
    const Scene scene = readObj("Kd 0.2 0.2 0.2\nmap_Kd " + name + "\n", kWhole);
    EXPECT_EQ(countOf(scene.diagnoses, "C136"), 1U) << name;
    EXPECT_EQ(scene.materials[0].reflectance, glm::dvec3(0.2));
  }
}

TEST(Texture, SaysWhatCannotBeRead) {
  const TempFolder folder;
  folder.write("a.mtl", "newmtl m\nKd 0.2 0.2 0.2\nmap_Kd a.png\n");
  const auto model =
      folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 4 0 0\nv 0 3 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n");
  const std::string whole = picture();
  // The last chunk says only that the file ends; each cut before it loses pixels.
  for (std::size_t length = 0; length + 12 < whole.size(); ++length) {
    folder.write("a.png", whole.substr(0, length));
    const Scene scene = readModel(model, {});
    EXPECT_EQ(countOf(scene.diagnoses, "C126"), 1U) << length;
    EXPECT_EQ(scene.materials[0].reflectance, glm::dvec3(0.2)) << length;
  }
  std::string huge = whole;
  huge.replace(16, 8, std::string("\0\0\x40\0\0\0\x40\0", 8));  // 16384 x 16384 pixels in 100 bytes
  huge = huge.substr(0, 8) + pngChunk("IHDR", huge.substr(16, 13)) + huge.substr(33);
  folder.write("a.png", huge);
  EXPECT_EQ(countOf(readModel(model, {}).diagnoses, "C126"), 1U);
}

/// The square of gltffile.hpp with texture coordinates 0 to 1 and a picture, base64 as the file's `images`.
Scene readGltf(const std::string& info, const std::string& material = "", const std::string& rest = "") {
  const TempFolder folder;
  folder.write("a.png", picture());
  std::string bytes = squareBytes();
  for (const float v : {0.F, 0.F, 0.F, 1.F, 1.F, 1.F, 1.F, 0.F}) {
    append(bytes, v);
  }
  Parts parts;
  parts.primitive = R"({"attributes":{"POSITION":0,"TEXCOORD_0":2},"indices":1,"material":0})";
  parts.indices += R"(,{"bufferView":2,"componentType":5126,"count":4,"type":"VEC2"})";
  parts.view +=
      R"(,{"buffer":0,"byteOffset":48,"byteLength":12},{"buffer":0,"byteOffset":60,"byteLength":32})";
  parts.buffer = R"({"byteLength":92})";
  parts.rest =
      R"(,"images":[{"uri":"a.png"}],"samplers":[{"wrapS":33071,"wrapT":33648}],)"
      R"("textures":[{"source":0},{"source":0,"sampler":0},{"extensions":{"KHR_texture_basisu":{}}}],)"
      R"("materials":[{"pbrMetallicRoughness":{"metallicFactor":0,"baseColorTexture":)" +
      info + "}" + material + "}]" + rest;
  return readModel(folder.write("a.glb", glb(jsonOf(parts), bytes)), {});
}

TEST(Texture, GltfTakesTheMeanInLinearLight) {
  const glm::dvec3 mean = readGltf(R"({"index":0})").materials[0].reflectance;
  EXPECT_NEAR(mean.r, 0.75 * linear(188), kCut);
  EXPECT_NEAR(mean.g, 0.5 * linear(188), kCut);
}

TEST(Texture, GltfTransformsCoordinates) {
  const auto color = [](const std::string& transform, int texture = 0) {
    return readGltf(R"({"index":)" + std::to_string(texture) + R"(,"extensions":{"KHR_texture_transform":{)" +
                    transform + "}}}")
        .materials[0]
        .reflectance;
  };
  const double grey = linear(188);
  EXPECT_NEAR(glm::length(color(R"("scale":[0.5,0.5])") - glm::dvec3(grey, 0, 0)), 0.0, 1e-6) << "top left";
  EXPECT_NEAR(glm::length(color(R"("offset":[0,0.5],"scale":[0.5,0.5])")), 0.0, 1e-6) << "bottom left";
  // The extension's own example: the lower left quadrant, turned.
  EXPECT_NEAR(glm::length(color(R"("offset":[0,1],"rotation":1.57079632679,"scale":[0.5,0.5])")), 0.0, 1e-6);
  EXPECT_NEAR(color(R"("offset":[1,0])", 1).g, grey, 1e-6) << "clamped to the right edge";
  // Mirrored below: the picture's lower half again.
  EXPECT_NEAR(color(R"("offset":[-1,1],"scale":[0.5,0.5])", 1).r, 0.0, 1e-6);
}

TEST(Texture, GltfMultipliesEmissionAndTransmission) {
  const Scene scene =
      readGltf(R"({"index":0})", R"(,"emissiveFactor":[1,1,1],"emissiveTexture":{"index":0},"extensions":{)"
                                 R"("KHR_materials_emissive_strength":{"emissiveStrength":100}})");
  EXPECT_NEAR(scene.materials[0].exitance_lm_m2.g, std::numbers::pi * 50.0 * linear(188), 1e-3);
  const Scene glass = readGltf(
      R"({"index":0})",
      R"(,"extensions":{"KHR_materials_transmission":{"transmissionFactor":0.9,"transmissionTexture":{"index":0}}})");
  EXPECT_TRUE(glass.materials[0].glazing);
  EXPECT_NEAR(glass.materials[0].transmittance.g, 0.9 * 0.5 * linear(188) * 0.75 * 188 / 255, kCut)
      << "the share that passes is no colour: it is not encoded";
}

TEST(Texture, GltfSaysWhatCannotBeRead) {
  const Scene basis = readGltf(R"({"index":2})");
  EXPECT_EQ(countOf(basis.diagnoses, "C126"), 1U);
  EXPECT_EQ(basis.materials[0].reflectance, glm::dvec3(0.9)) << "white, as without a texture";
  EXPECT_TRUE(contains(inputErrorOf([] { readGltf(R"({"index":3})"); }), "names texture 3"));
}

}  // namespace
}  // namespace clerestory
