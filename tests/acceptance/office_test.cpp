// SPDX-License-Identifier: GPL-3.0-or-later
// The sample office: the same light from OBJ and GLB, and the same bytes on any number of threads with any
// cache.
#include <nlohmann/json.hpp>

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
  EXPECT_NEAR(rooms.number(0, "floor_area_m2"), 96.0 - 0.122, 0.001);  // less the column
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
