// SPDX-License-Identifier: GPL-3.0-or-later
// OBJ models: indices, lines, names, numbers, and what is refused.
#include <numbers>

#include <import/scene.hpp>

#include "tempfolder.hpp"

namespace clerestory {
namespace {

const std::string kSquare = "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\n";

Scene readText(const std::string& text, const ModelOptions& options = {}) {
  const TempFolder folder;
  return readModel(folder.write("room.obj", text), options);
}

std::string errorOfText(const std::string& text) {
  return inputErrorOf([&] { readText(text); });
}

std::vector<std::uint32_t> corners(const Scene& scene, std::size_t face) {
  return {scene.faces[face].begin(), scene.faces[face].end()};
}

TEST(Obj, KeepsPolygonsAsPolygons) {
  const Scene scene = readText(kSquare + "v -1 1.5 0\nf 1 2 3 4 5\n");
  ASSERT_EQ(scene.faces.size(), 1U);
  EXPECT_EQ(corners(scene, 0), (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(scene.points[4], glm::dvec3(-1, 1.5, 0));
}

TEST(Obj, CountsNegativeIndicesFromTheLastVertex) {
  const Scene scene = readText(kSquare + "f -4 -3 -2\nv 9 9 9\nf -5/1/1 -3//2 -1/7\n");
  EXPECT_EQ(corners(scene, 0), (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(corners(scene, 1), (std::vector<std::uint32_t>{0, 2, 4}));
}

TEST(Obj, ReadsEveryLineEndAndContinuation) {
  const std::string lf = kSquare + "f 1 2 \\\n 3 \\\n 4\n";
  for (const std::string end : {"\r\n", "\r", "\n"}) {
    std::string text;
    for (const char c : lf) {
      text += c == '\n' ? end : std::string(1, c);
    }
    const Scene scene = readText(text);
    ASSERT_EQ(scene.faces.size(), 1U);
    EXPECT_EQ(corners(scene, 0).size(), 4U);
  }
}

TEST(Obj, ReadsCommentsAndUnusualNumbers) {
  const Scene scene = readText(
      "\xEF\xBB\xBF# c\n  # c\n\nv +.5e+1 -5. 1E-001 # c\nv 1 0 0 1 0 0\nv 0 1 0\n"
      "f 1 2 3 # y\n");
  EXPECT_EQ(scene.points[0], glm::dvec3(5.0, -5.0, 0.1));
}

TEST(Obj, NamesFileAndLineOfABadNumber) {
  for (const std::string bad : {"0,5,5", "1.000,5", "nan", "inf", "1e999", "1.5m", "--1", "0x1"}) {
    const std::string message = errorOfText("v 0 0 0\nv 1 0 0\nv 0 " + bad + " 0\nf 1 2 3\n");
    EXPECT_TRUE(contains(message, "room.obj:3: \"" + bad + "\"")) << message;
  }
}

TEST(Obj, NamesFileAndLineOfABadFace) {
  EXPECT_TRUE(contains(errorOfText(kSquare + "f 1 2 5\n"), "room.obj:5: a face names vertex 5, but 4"));
  EXPECT_TRUE(contains(errorOfText(kSquare + "f 1 2 0\n"), "room.obj:5:"));
  EXPECT_TRUE(contains(errorOfText(kSquare + "f 1 2 -5\n"), "room.obj:5:"));
  EXPECT_TRUE(contains(errorOfText(kSquare + "f 1 2 99999999999999999999\n"), "room.obj:5:"));
  EXPECT_TRUE(contains(errorOfText(kSquare + "f 1/1/1/1 2 3\n"), "room.obj:5:"));
  EXPECT_TRUE(contains(errorOfText(kSquare + "f 1/a 2 3\n"), "room.obj:5:"));
  EXPECT_TRUE(contains(errorOfText("v 1 2\n"), "room.obj:1: a vertex has three"));
}

TEST(Obj, SaysWhatItLeftOut) {
  const Scene scene = readText(kSquare + "f 1 2 3\nf 1 2\nf 1\nl 1 2 3\np 1\nbogus 1\n");
  EXPECT_EQ(scene.faces.size(), 1U);
  EXPECT_EQ(countOf(scene.diagnoses, "C110"), 2U);
  EXPECT_EQ(countOf(scene.diagnoses, "C111"), 2U);
  EXPECT_EQ(countOf(scene.diagnoses, "C112"), 1U);
}

TEST(Obj, NamesObjectsByTheLastOfObjectAndGroup) {
  const Scene scene = readText(kSquare +
                               "f 1 2 3\no desk\nf 1 2 3\ng leg  left\nf 1 2 3\ng leg left\nf 1 2 4\n"
                               "o chair\nf 1 2 3\no chair\nf 1 2 4\no unused\n");
  EXPECT_EQ(scene.objects, (std::vector<std::string>{"room", "desk", "leg left", "chair", "chair"}));
  EXPECT_EQ(scene.faceObject, (std::vector<std::uint32_t>{0, 1, 2, 2, 3, 4}));
}

TEST(Obj, MakesNamesPrintable) {
  const Scene scene = readText(kSquare + "o B\xFCro\t1\x01\nusemtl W\xC3\xA4nde\nf 1 2 3\n");
  EXPECT_EQ(scene.objects[0], "B\xC3\xBCro 1");
  EXPECT_EQ(scene.materials[0].name, "W\xC3\xA4nde");
}

/// UTF-16 with its byte order mark, of text that is ASCII.
std::string utf16(const std::string& ascii, bool lowFirst) {
  std::string bytes = lowFirst ? "\xFF\xFE" : "\xFE\xFF";
  for (const char c : ascii) {
    bytes += lowFirst ? std::string{c, '\0'} : std::string{'\0', c};
  }
  return bytes;
}

TEST(Obj, ReadsUtf16) {
  for (const bool lowFirst : {true, false}) {
    const Scene scene = readText(utf16(kSquare + "o hall\nf 1 2 3 4\n", lowFirst));
    EXPECT_EQ(corners(scene, 0).size(), 4U);
    EXPECT_EQ(scene.objects[0], "hall");
  }
  const std::string name("\xE4\0 \0\x3D\xD8\xE0\xDE \0\x00\xD8",
                         12);  // a umlaut, a door beyond 16 bits, half a pair
  const Scene scene = readText(utf16(kSquare + "o ", true) + name + utf16("\nf 1 2 3\n", true).substr(2));
  EXPECT_EQ(scene.objects[0], "\xC3\xA4 \xF0\x9F\x9B\xA0 \xEF\xBF\xBD");
}

TEST(Obj, ReadsNumbersAsOtherProgramsPrintThem) {
  const Scene scene = readText("v 0,5 1e-400 1.5e+003\nv 1 -0 .0\nv 0 1. +1\nf 1 2 3\n");
  EXPECT_EQ(scene.points[0], glm::dvec3(0.5, 0.0, 1500.0));
  EXPECT_EQ(countOf(scene.diagnoses, "C114"), 1U);
}

TEST(Obj, ReadsPolygonsOfThousandsOfCorners) {
  std::string text;
  std::string face = "f";
  for (int i = 0; i < 5000; ++i) {
    text += "v " + std::to_string(i) + " " + std::to_string(i % 2) + " 0\n";
    face += " " + std::to_string(i + 1);
  }
  EXPECT_EQ(corners(readText(text + face + "\n"), 0).size(), 5000U);
}

TEST(Obj, RefusesWhatIsNoText) {
  EXPECT_TRUE(contains(errorOfText(std::string("\xFF\xFEv\0 \0\0\0", 8)), "not a text file"));
  EXPECT_TRUE(contains(errorOfText(std::string("v 0 0 \0 0\n", 10)), "not a text file"));
  EXPECT_TRUE(contains(errorOfText(""), "no face"));
  EXPECT_TRUE(contains(errorOfText(kSquare), "no face"));
}

TEST(Obj, SaysThatAFileIsMissing) {
  const std::string missing = inputErrorOf([] { readModel("nowhere/room.obj", {}); });
  EXPECT_TRUE(contains(missing, "model file not found: nowhere/room.obj")) << missing;
  const std::string folder = inputErrorOf([] { readModel(std::filesystem::temp_directory_path() / "", {}); });
  EXPECT_TRUE(contains(folder, ".obj, .gltf or .glb")) << folder;
}

TEST(Obj, TurnsYUpAndScalesAsAsked) {
  ModelOptions options;
  options.units = "cm";
  options.upAxis = "y";
  const Scene scene = readText("v 100 250 300\nv 0 0 0\nv 500 0 0\nf 1 2 3\n", options);
  EXPECT_DOUBLE_EQ(scene.points[0].x, 1.0);
  EXPECT_DOUBLE_EQ(scene.points[0].y, -3.0);
  EXPECT_DOUBLE_EQ(scene.points[0].z, 2.5);
  options.units = "yards";
  EXPECT_TRUE(contains(inputErrorOf([&] { readText(kSquare + "f 1 2 3\n", options); }), "yards"));
}

TEST(Obj, ReadsTagsAsACage) {
  const Scene scene = readText(kSquare +
                               "v 0 0 2\nv 4 0 2\no plain\nf 1 2 3 4\no soft\nf 1 2 3 4\nf 1 2 6 5\n"
                               "t crease 3/2/0 0 1 2 1.5 12\nt crease 2/1/0 0 2 9\nt corner 1/1/0 4 3\n"
                               "t interpolateboundary 1/0/0 2\nt hole 1/0/0 1\n");
  ASSERT_EQ(scene.cages.size(), 1U);
  EXPECT_EQ(scene.faces.size(), 1U);
  const Cage& cage = scene.cages[0];
  EXPECT_EQ(scene.objects[cage.object], "soft");
  EXPECT_EQ(cage.faces.size(), 2U);
  ASSERT_EQ(cage.creases.size(), 2U);
  EXPECT_EQ(cage.creases[1].b, 2U);
  EXPECT_EQ(cage.creases[0].sharpness, 1.5F);
  EXPECT_EQ(cage.creases[1].sharpness, 10.0F);
  ASSERT_EQ(cage.corners.size(), 1U);
  EXPECT_EQ(cage.corners[0].point, 4U);
  EXPECT_EQ(cage.holes, (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(cage.boundary, Cage::Boundary::edgeOnly);
  EXPECT_EQ(countOf(scene.diagnoses, "C141"), 1U) << "0 to 2 is a diagonal";
}

TEST(Obj, RefusesBrokenTags) {
  const std::string base = kSquare + "f 1 2 3 4\n";
  EXPECT_TRUE(contains(errorOfText(base + "t crease 2/1/0 0 4 2\n"), "room.obj:6: a tag names vertex 4"));
  EXPECT_TRUE(contains(errorOfText(base + "t crease 2/1/0 0 1\n"), "room.obj:6:"));
  EXPECT_TRUE(contains(errorOfText(base + "t crease 2000000000/2000000000/0 0 1 1\n"), "room.obj:6:"));
  EXPECT_TRUE(contains(errorOfText(base + "t crease 2/1 0 1 1\n"), "room.obj:6:"));
  EXPECT_TRUE(contains(errorOfText(base + "t corner 1/1/0 0 -1\n"), "room.obj:6:"));
  EXPECT_TRUE(contains(errorOfText(base + "t hole 1/0/0 1\n"), "hole 1 is not one of its faces"));
  EXPECT_TRUE(contains(errorOfText(base + "t interpolateboundary 1/0/0 3\n"), "room.obj:6:"));
}

TEST(Model, SubdividesChosenObjects) {
  ModelOptions options;
  options.subdivide = {{"CHAIR?", "catmark", 0.01}, {"nothing*", "catmark", {}}};
  const std::string text = kSquare + "o chair1\nf 1 2 3 4\no table\nf 1 2 3\n";
  const Scene scene = readText(text, options);
  ASSERT_EQ(scene.cages.size(), 1U);
  EXPECT_EQ(scene.faces.size(), 1U);
  EXPECT_EQ(scene.cages[0].tolerance_m, 0.01);
  EXPECT_EQ(countOf(scene.diagnoses, "C143"), 1U);
  options.subdivide = {{"*", "loop", {}}};
  EXPECT_TRUE(contains(inputErrorOf([&] { readText(text, options); }), "triangles only"));
}

TEST(Model, TurnsATaggedCageBackIntoFaces) {
  ModelOptions options;
  options.subdivide = {{"soft", "none", {}}};
  const Scene scene = readText(kSquare + "o soft\nf 1 2 3 4\nf 1 2 3\nt hole 1/0/0 1\n", options);
  EXPECT_TRUE(scene.cages.empty());
  EXPECT_EQ(scene.faces.size(), 1U) << "a hole is no face";
}

/// A closed box of the given size in the file's unit.
std::string boxText(double x, double y, double z) {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    text += "v " + std::to_string((i & 1) * x) + " " + std::to_string((i >> 1 & 1) * y) + " " +
            std::to_string((i >> 2) * z) + "\n";
  }
  return text + "f 1 2 4 3\nf 5 6 8 7\nf 1 2 6 5\nf 3 4 8 7\nf 1 3 7 5\nf 2 4 8 6\n";
}

TEST(Model, GuessesTheUnitOfARoom) {
  for (const double unit : {1.0, 100.0, 1000.0}) {
    const Scene scene = readText(boxText(3.6 * unit, 8.2 * unit, 2.8 * unit));
    EXPECT_NEAR(scene.points[7].y, 8.2, 1e-9);
    EXPECT_EQ(countOf(scene.diagnoses, "C101"), unit == 1.0 ? 0U : 1U);
  }
}

TEST(Model, LeavesAGroundOutOfTheGuess) {
  const std::string ground = "v -200 -200 0\nv 200 -200 0\nv 200 200 0\nv -200 200 0\nf -4 -3 -2 -1\n";
  EXPECT_NEAR(readText(boxText(3.6, 8.2, 2.8) + ground).points[7].y, 8.2, 1e-9);
}

TEST(Model, AsksForTheUnitWhereNoneFits) {
  for (const double size : {0.001, 1e5}) {
    const std::string message = errorOfText(boxText(3.6 * size, 8.2 * size, 2.8 * size));
    EXPECT_TRUE(contains(message, "--units")) << message;
  }
}

/// The axis taken for up, with a * where C103 tells of it.
std::string upAxisOf(const std::string& text) {
  const Scene scene = readText(text);
  EXPECT_TRUE(scene.axes.upAxisIsGuessed);
  return scene.axes.upAxis + (countOf(scene.diagnoses, "C103") > 0 ? "*" : "");
}

TEST(Model, GuessesTheUpAxis) {
  const std::string lyingAlongY = boxText(6, 2.5, 8);
  const std::string lyingAlongZ = boxText(6, 8, 2.5);
  const std::string cube = boxText(3, 3, 3);
  EXPECT_EQ(upAxisOf(lyingAlongY), "y*");
  EXPECT_EQ(upAxisOf(lyingAlongZ), "z");
  EXPECT_EQ(upAxisOf(cube), "z");
  // What the head states stands over the geometry, and the geometry over what an exporter usually does.
  EXPECT_EQ(upAxisOf("# units: m, Y up\n" + cube), "y*");
  EXPECT_EQ(upAxisOf("# Z-up\n" + lyingAlongY), "z*");
  EXPECT_EQ(upAxisOf("# Blender 4.1\n" + cube), "y*");
  EXPECT_EQ(upAxisOf("# Blender 4.1\n" + lyingAlongZ), "z*");
  EXPECT_EQ(upAxisOf("# drawn by a blenderer; really up\n" + cube), "z");
  EXPECT_EQ(upAxisOf(cube + "# y up\n"), "z");  // not at the head
}

TEST(Model, StatedUpAxisStandsOverTheGuess) {
  ModelOptions options;
  options.upAxis = "z";
  const Scene scene = readText("# y up\n" + boxText(6, 2.5, 8), options);
  EXPECT_EQ(scene.axes.upAxis, "z");
  EXPECT_FALSE(scene.axes.upAxisIsGuessed);
  EXPECT_EQ(countOf(scene.diagnoses, "C103"), 0U);
}

TEST(Model, MatchesGlobs) {
  EXPECT_TRUE(globMatches("*", ""));
  EXPECT_TRUE(globMatches("wall*", "Wall 12"));
  EXPECT_TRUE(globMatches("*a*b?", "xaxbxbz"));
  EXPECT_TRUE(globMatches("?", "x"));
  EXPECT_FALSE(globMatches("?", ""));
  EXPECT_FALSE(globMatches("wall", "wall 1"));
  EXPECT_FALSE(globMatches("", "x"));
}

}  // namespace
}  // namespace clerestory
