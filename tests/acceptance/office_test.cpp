// SPDX-License-Identifier: GPL-3.0-or-later
// The sample office: the same light from OBJ and GLB, and the same bytes on any number of threads with any
// cache.
#include <nlohmann/json.hpp>

#include <array>
#include <charconv>

#include "../geometry/redrawn.hpp"
#include "program.hpp"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

// The sample's study on `model`, both copied to the test's folder.
void prepare(const Workplace& place) {
  for (const char* name : {"office.glb", "office.obj", "office.mtl"})
    place.copy(fs::path(CLERESTORY_SAMPLES) / "office" / name);
  const std::string rest =
      "[materials.\"glazing\"]\ntransmittance = 0.70\n"
      "[[grid]]\nname = \"Desks\"\npolygon = [[0, 0], [12, 0], [12, 8], [0, 8]]\nspacing = 0.5\ninset = "
      "0.5\n";
  place.write("glb.toml", studyOf("office.glb") + rest);
  place.write("obj.toml", studyOf("office.obj") + "units = \"m\"\nup = \"z\"\n" + rest);
}

TEST(Office, ObjAndGlbGiveTheSameLight) {
  const Workplace place;
  prepare(place);
  const CsvTable glb(place.study("glb.toml --quiet", "glb") / "surfaces.csv");
  const CsvTable obj(place.study("obj.toml --quiet", "obj") / "surfaces.csv");
  ASSERT_EQ(glb.size(), obj.size());
  std::map<std::string, double> means;
  for (std::size_t row = 0; row < glb.size(); ++row) {
    const std::string key =
        glb.text(row, "surface") + "|" + glb.text(row, "room") + "|" + glb.text(row, "material");
    EXPECT_TRUE(means.emplace(key, glb.number(row, "illuminance_mean_lx")).second) << key << " twice";
  }
  double worst = 0.0;
  for (std::size_t row = 0; row < obj.size(); ++row) {
    const std::string key =
        obj.text(row, "surface") + "|" + obj.text(row, "room") + "|" + obj.text(row, "material");
    ASSERT_TRUE(means.contains(key)) << key << " is not in the GLB's table";
    const double mean = obj.number(row, "illuminance_mean_lx");
    worst = std::max(worst, std::abs(mean - means[key]) / std::max(mean, 1e-9));
    // Coordinates of a GLB are float, those of an OBJ decimal: some 1e-7 apart, which moves hardly a ray.
    EXPECT_NEAR(means[key], mean, 1e-3 * mean) << key;
  }
  std::cout << "largest difference of a surface's mean: " << 100.0 * worst << " %\n";
}

/// As OBJ, with the materials of the sample's library.
std::string objOf(const Scene& scene) {
  std::string text = "mtllib office.mtl\n";
  const auto number = [](double value) {
    std::array<char, 40> digits{};
    return std::string(digits.data(), std::to_chars(digits.data(), digits.data() + 40, value).ptr);
  };
  for (const glm::dvec3& p : scene.points)
    text += "v " + number(p.x) + ' ' + number(p.y) + ' ' + number(p.z) + '\n';
  for (std::size_t face = 0; face < scene.faces.size(); ++face) {
    text += "o " + scene.objects[scene.faceObject[face]] + "\nusemtl " +
            scene.materials[scene.faceMaterial[face]].name + "\nf";
    for (const std::uint32_t corner : scene.faces[face]) text += ' ' + std::to_string(corner + 1);
    text += '\n';
  }
  return text;
}

// Differences are errors of both, which 95 % of them keep to; means of the desks differ by less.
TEST(Office, HundredThousandTrianglesGiveTheSameLight) {
  const Workplace place;
  prepare(place);
  const Scene office = drawn::read(fs::path(CLERESTORY_SAMPLES) / "office" / "office.glb");
  const Scene fine = drawn::tessellated(office, 3);
  ASSERT_GT(fine.faces.size(), 100000U);
  place.write("drawn.obj", objOf(office));
  place.write("fine.obj", objOf(fine));
  const std::string rest =
      "units = \"m\"\nup = \"z\"\n[materials.\"glazing\"]\ntransmittance = 0.70\n[[grid]]\nname = \"Desks\"\n"
      "polygon = [[0, 0], [12, 0], [12, 8], [0, 8]]\nspacing = 0.5\ninset = 0.5\n";
  place.write("drawn.toml", studyOf("drawn.obj") + rest);
  place.write("fine.toml", studyOf("fine.obj") + rest);
  const CsvTable expected(place.study("drawn.toml --quiet --accuracy draft", "drawn") / "sensors.csv");
  const CsvTable found(place.study("fine.toml --quiet --accuracy draft", "fine") / "sensors.csv");
  ASSERT_EQ(found.size(), expected.size());
  double sum_lx = 0.0;
  double expectedSum_lx = 0.0;
  std::size_t beyond = 0;
  for (std::size_t row = 0; row < found.size(); ++row) {
    const double own_lx = found.number(row, "illuminance_lx");
    const double other_lx = expected.number(row, "illuminance_lx");
    const double errors_lx = std::hypot(found.number(row, "error_lx"), expected.number(row, "error_lx"));
    beyond += std::abs(own_lx - other_lx) > errors_lx ? 1 : 0;
    sum_lx += own_lx;
    expectedSum_lx += other_lx;
  }
  std::cout << "mean of the desks " << 100.0 * (sum_lx / expectedSum_lx - 1.0) << " % off; " << beyond
            << " of " << found.size() << " sensors beyond the errors of both\n";
  EXPECT_NEAR(sum_lx, expectedSum_lx, 0.01 * expectedSum_lx);
  EXPECT_LE(static_cast<double>(beyond), 0.05 * static_cast<double>(found.size()));
}

TEST(Office, SameBytesOnAnyThreadsAndWithAnyCache) {
  const Workplace place;
  prepare(place);
  const fs::path first = place.study("glb.toml --quiet --threads 1 --link-cache 0", "first");
  for (const std::string options : {"--threads 2 --link-cache 64K", "--threads 3 --link-cache 1G"}) {
    const fs::path other = place.study("glb.toml --quiet " + options, "other");
    for (const char* table : {"sensors.csv", "surfaces.csv", "rooms.csv", "study.json"}) {
      EXPECT_TRUE(bytesOf(first / table) == bytesOf(other / table)) << table << " differs with " << options;
    }
  }

  const CsvTable sensors(first / "sensors.csv");
  for (std::size_t row = 0; row < sensors.size(); ++row) {
    const double all_lx = sensors.number(row, "illuminance_lx");
    EXPECT_GT(all_lx, 0.0);
    // Parts are written with the digits of a float.
    EXPECT_NEAR(sensors.number(row, "direct_lx") + sensors.number(row, "reflected_lx"), all_lx,
                1e-5 * all_lx);
    EXPECT_NEAR(
        sensors.number(row, "sky_lx") + sensors.number(row, "sun_lx") + sensors.number(row, "electric_lx"),
        all_lx, 1e-5 * all_lx);
    EXPECT_GE(sensors.number(row, "error_lx"), 0.0);
  }
  const CsvTable rooms(first / "rooms.csv");
  ASSERT_EQ(rooms.size(), 1U);
  // 12 x 8 m less the column: 16 corners in whole millimetres on a circle of 0.2 m, by the shoelace formula.
  // The floor goes on under all furniture and between the bookcases.
  const double column_m2 = 0.122174;
  EXPECT_NEAR(rooms.number(0, "floor_area_m2"), 96.0 - column_m2, 0.001);
  EXPECT_GT(CsvTable(first / "iterations.csv").size(), 2U);
  EXPECT_GT(CsvTable(first / "surfaces.csv").size(), 5U);

  // Where the light went, out of study.json; the scaling of received to shot power keeps it far within a per
  // cent.
  const nlohmann::json json = nlohmann::json::parse(bytesOf(first / "study.json"));
  std::size_t domains = 0;
  for (const auto& balance : json.at("energy_balance")) {
    const double emitted_lm = balance.at("emitted_lm");
    const double gone_lm = balance.at("absorbed_lm").get<double>() + balance.at("escaped_lm").get<double>();
    EXPECT_GT(emitted_lm, 0.0);
    EXPECT_NEAR(gone_lm, emitted_lm, 0.01 * emitted_lm);
    std::cout << "of " << emitted_lm << " lm " << 100.0 * (1.0 - gone_lm / emitted_lm) << " % are missing\n";
    ++domains;
  }
  EXPECT_GE(domains, 1U);
}

}  // namespace
}  // namespace clerestory
