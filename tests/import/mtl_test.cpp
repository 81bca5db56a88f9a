// SPDX-License-Identifier: GPL-3.0-or-later
// Materials of OBJ models: what counts as reflectance, glazing and light.
#include <numbers>

#include <import/scene.hpp>

#include "tempfolder.hpp"

namespace clerestory {
namespace {

/// A scene of one triangle with the material `name` from a library with the given text.
Scene readMaterial(const std::string& name, const std::string& mtl) {
  const TempFolder folder;
  folder.write("a.mtl", mtl);
  return readModel(
      folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 4 0 0\nv 0 3 0\nusemtl " + name + "\nf 1 2 3\n"), {});
}

Material materialFrom(const std::string& statements, const std::string& name = "m") {
  return readMaterial(name, "newmtl " + name + "\n" + statements).materials.at(0);
}

TEST(Mtl, ReadsKdAsReflectance) {
  EXPECT_EQ(materialFrom("Kd 0.2 0.3 0.4\n").reflectance, glm::dvec3(0.2, 0.3, 0.4));
  EXPECT_EQ(materialFrom("  kd 0.2\r\n").reflectance, glm::dvec3(0.2));
  EXPECT_EQ(materialFrom("Ka 1 1 1\n").reflectance, glm::dvec3(0.5));
}

TEST(Mtl, HoldsADisplayColourBelowNineTenths) {
  const Scene scene = readMaterial("white", "newmtl white\nKd 1 0.9 0.5\n");
  EXPECT_EQ(scene.materials[0].reflectance, glm::dvec3(0.9, 0.9, 0.5));
  EXPECT_EQ(countOf(scene.diagnoses, "C121"), 1U);
}

TEST(Mtl, TakesTfForTransmittanceOnlyWhereLightPasses) {
  EXPECT_FALSE(materialFrom("Kd 0.5 0.5 0.5\nTf 1 1 1\n").glazing);
  EXPECT_FALSE(materialFrom("Kd 0.5 0.5 0.5\nTf 1 1 1\nd 1\nillum 2\n").glazing);
  for (const char* passing :
       {"d 0.5\n", "Tr 0.5\n", "illum 4\n", "illum 6\n", "illum 7\n", "d 1\nillum 9\n"}) {
    const Material glass = materialFrom(std::string("Kd 0 0 0\nTf 0.6 0.7 0.65\n") + passing);
    EXPECT_TRUE(glass.glazing) << passing;
    EXPECT_EQ(glass.transmittance, glm::dvec3(0.6, 0.7, 0.65));
    EXPECT_FALSE(glass.transmittanceIsAssumed);
    EXPECT_EQ(glass.reflectance, glm::dvec3(0.0));
  }
}

TEST(Mtl, OnlyMarksGlazingByAlpha) {
  const Material glass = materialFrom("Kd 0.2 0.3 0.4\nd 0.1\n");
  EXPECT_TRUE(glass.glazing);
  EXPECT_TRUE(glass.transmittanceIsAssumed);
  EXPECT_EQ(glass.transmittance, glm::dvec3(0.7));
}

TEST(Mtl, LetsDissolveStandOverTransparency) {
  EXPECT_TRUE(materialFrom("d 0.75\nTr 0\n").glazing);
  EXPECT_FALSE(materialFrom("Tr 0.5\nd 1\n").glazing);
  EXPECT_FALSE(materialFrom("Kd 0.5 0.5 0.5\nTr 1\n").glazing);
}

TEST(Mtl, KnowsGlassByName) {
  for (const char* name : {"Glass", "glas", "Glazing_01", "windowGlass", "Verre clair", "vidrio", "Vetro",
                           "pane 3", "Fensterscheibe", "GLASS", "vidro_temperado", "Cristal-6mm",
                           "dubbelglas", "Sklo 4", "szyba", "Стекло", "стекло_01", "玻璃", "ガラス 2"}) {
    EXPECT_TRUE(materialFrom("Kd 0.5 0.5 0.5\n", name).glazing) << name;
  }
  for (const char* name : {"fibreglass", "FiberGlass", "glasswool", "glass wool", "glass frame", "panel",
                           "Glasgow", "windowframe", "spyglasses", "mirror glass", "laine de verre",
                           "lana di vetro", "Glass Block", "marco de vidrio", "camera", "стеклопластик"}) {
    EXPECT_FALSE(materialFrom("Kd 0.5 0.5 0.5\n", name).glazing) << name;
  }
}

TEST(Mtl, KeepsGlassOpaqueWhereTheFileSaysSo) {
  const Scene scene = readMaterial("glass", "newmtl glass\nKd 0.4 0.4 0.4\nd 1.0\n");
  EXPECT_FALSE(scene.materials[0].glazing);
  EXPECT_EQ(countOf(scene.diagnoses, "C124"), 1U);
}

TEST(Mtl, TurnsLuminanceIntoExitance) {
  EXPECT_DOUBLE_EQ(materialFrom("Kd 0 0 0\nKe 100 50 0\n").exitance_lm_m2.g, 50.0 * std::numbers::pi);
}

TEST(Mtl, GoesOnWithoutItsLibrary) {
  const TempFolder folder;
  const Scene scene =
      readModel(folder.write("a.obj",
                             "mtllib gone.mtl\nv 0 0 0\nv 4 0 0\nv 0 3 0\nusemtl wall\nf 1 2 3\n"
                             "usemtl window pane\nf 1 2 3\n"),
                {});
  EXPECT_EQ(scene.materials[0].reflectance, glm::dvec3(0.5));
  EXPECT_TRUE(scene.materials[1].glazing);
  EXPECT_EQ(countOf(scene.diagnoses, "C129"), 1U);
  EXPECT_EQ(countOf(scene.diagnoses, "C131"), 2U);
}

TEST(Mtl, ReadsNoLibraryOutsideTheModelsFolder) {
  const TempFolder folder;
  const auto secret = folder.write("secret.mtl", "newmtl m\nKd 0.1 0.1 0.1\n");
  for (const std::string& name :
       {std::string("../secret.mtl"), secret.string(), std::string("..\\secret.mtl")}) {
    const auto model =
        folder.write("in/a.obj", "mtllib " + name + "\nv 0 0 0\nv 4 0 0\nv 0 3 0\nusemtl m\nf 1 2 3\n");
    const Scene scene = readModel(model, {});
    EXPECT_EQ(scene.materials[0].reflectance, glm::dvec3(0.5)) << name;
    EXPECT_EQ(countOf(scene.diagnoses, "C130"), 1U) << name;
  }
}

TEST(Mtl, FollowsNoLinkOutOfTheModelsFolder) {
  const TempFolder folder;
  const auto secret = folder.write("secret.mtl", "newmtl m\nKd 0.1 0.1 0.1\n");
  const auto model = folder.write("in/a.obj", "mtllib l.mtl\nv 0 0 0\nv 4 0 0\nv 0 3 0\nusemtl m\nf 1 2 3\n");
  std::filesystem::create_symlink(secret, folder.path() / "in" / "l.mtl");
  EXPECT_EQ(readModel(model, {}).materials[0].reflectance, glm::dvec3(0.5));
}

TEST(Mtl, ReadsSeveralLibrariesAndNamesWithBlanks) {
  const TempFolder folder;
  folder.write("a.mtl", "newmtl a\nKd 0.1 0.1 0.1\n");
  folder.write("b.mtl", "newmtl b\nKd 0.2 0.2 0.2\n");
  folder.write("my room.mtl", "newmtl c d\nKd 0.3 0.3 0.3\n");
  const Scene scene = readModel(
      folder.write("a.obj",
                   "mtllib a.mtl b.mtl\nmtllib my room.mtl\nv 0 0 0\nv 4 0 0\nv 0 3 0\n"
                   "usemtl b\nf 1 2 3\nusemtl c  d \nf 1 2 3\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n"),
      {});
  ASSERT_EQ(scene.materials.size(), 3U);
  EXPECT_EQ(scene.materials[0].reflectance, glm::dvec3(0.2));
  EXPECT_EQ(scene.materials[1].reflectance, glm::dvec3(0.3));
  EXPECT_EQ(scene.materials[2].reflectance, glm::dvec3(0.1));
  EXPECT_EQ(scene.faceMaterial, (std::vector<std::uint32_t>{0, 1, 2, 0}));
}

TEST(Mtl, SaysWhatItCannotRead) {
  const Scene scene = readMaterial("m", "newmtl m\nKd xyz 1 1 1\nmap_Kd wood.png\nKe spectral x.rfl\n");
  EXPECT_EQ(countOf(scene.diagnoses, "C126"), 1U);
  EXPECT_EQ(countOf(scene.diagnoses, "C127"), 2U);
}

TEST(Mtl, ReadsDecimalCommas) {
  const Scene scene = readMaterial("m", "newmtl m\nKd 0,25 0,5 0,75\n");
  EXPECT_EQ(scene.materials[0].reflectance, glm::dvec3(0.25, 0.5, 0.75));
  EXPECT_EQ(countOf(scene.diagnoses, "C114"), 3U);
}

TEST(Mtl, SaysWhereAMirrorCountsAsMatt) {
  const Scene scene = readMaterial("m", "newmtl m\nKd 0.5 0.5 0.5\nillum 3\n");
  EXPECT_TRUE(scene.materials[0].mirrorsAsMatt);
  EXPECT_EQ(countOf(scene.diagnoses, "C135"), 1U);
}

}  // namespace
}  // namespace clerestory
