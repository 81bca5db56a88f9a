// SPDX-License-Identifier: GPL-3.0-or-later
// Whole studies of the reference rooms against paths, and against the tables by Radiance.
#include "program.hpp"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

// A reference room as a user would run it, with the sensors of its reference.
GridErrors errorsOfRoom(const std::string& name, const std::string& table, const std::string& accuracy) {
  const fs::path folder = fs::path(CLERESTORY_TEST_DATA) / "reference" / name;
  const Workplace place;
  place.copy(folder / (name + ".obj"));
  place.copy(folder / (name + ".mtl"));
  const std::vector<ReferencePoint> reference = readReference(folder / (name + table));
  place.writePoints("points.csv", reference);
  place.write("study.toml", studyOf(name + ".obj") +
                                "units = \"m\"\nup = \"z\"\n[[grid]]\nname = \"reference\"\n"
                                "points = \"points.csv\"\n");
  const CsvTable sensors(place.study("study.toml --quiet --accuracy " + accuracy) / "sensors.csv");
  std::vector<double> truth;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    truth.push_back(reference[i].value);
    EXPECT_NEAR(sensors.number(i, "x_m"), reference[i].place_m[0],
                1e-6);  // rows keep the order of the points
    EXPECT_NEAR(sensors.number(i, "y_m"), reference[i].place_m[1], 1e-6);
  }
  return measuredErrors(name, sensors.numbers("illuminance_lx"), truth);
}

// The accuracy asked for is a p95. The paths' standard deviation, 0.4 %, adds to it as independent errors do:
// 2 sqrt(p95² / 4 + 0.4²) %.
TEST(Reference, EmptyOfficeKeepsToTheAccuracyAskedFor) {
  const std::string table = "_overcast_paths.csv";
  EXPECT_LE(errorsOfRoom("refoffice", table, "draft").p95, 0.100);
  EXPECT_LE(errorsOfRoom("refoffice", table, "standard").p95, 0.051);
  const GridErrors fine = errorsOfRoom("refoffice", table, "fine");
  EXPECT_LE(fine.p95, 0.0216);
  EXPECT_LE(std::abs(fine.bias), 0.005);
}

TEST(Reference, FurnishedOfficeKeepsToDraftAndStandard) {
  const std::string table = "_overcast_paths.csv";
  EXPECT_LE(errorsOfRoom("furnished", table, "draft").p95, 0.101);
  const GridErrors standard = errorsOfRoom("furnished", table, "standard");
  EXPECT_LE(standard.p95, 0.0515);
  EXPECT_LE(std::abs(standard.bias), 0.015);
}

// Radiance's tables are up to 3 % off the paths at the back of the room (docs/validation.md).
TEST(Reference, OfficesAgreeWithRadiance) {
  for (const std::string name : {"refoffice", "furnished"}) {
    const GridErrors errors = errorsOfRoom(name, "_overcast.csv", "standard");
    EXPECT_LE(std::abs(errors.bias), 0.02);
    EXPECT_LT(errors.rms, 0.035);
  }
}

}  // namespace
}  // namespace clerestory
