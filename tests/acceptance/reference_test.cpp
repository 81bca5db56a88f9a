// SPDX-License-Identifier: GPL-3.0-or-later
// Whole studies of the reference rooms against Radiance: the first honest point of error, held from here on.
#include "program.hpp"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t spots = 5;  // of a sensor: its place and 4 cm to each side

/// The places of sensors, and around each those that tell whether a sun patch ends there.
std::vector<ReferencePoint> withNeighbours(const std::vector<ReferencePoint>& points) {
  std::vector<ReferencePoint> all;
  for (const ReferencePoint& point : points) {
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {0.04, 0.0}, {-0.04, 0.0}, {0.0, 0.04}, {0.0, -0.04}})
      all.push_back({{point.place_m[0] + x, point.place_m[1] + y, point.place_m[2]}, point.value});
  }
  return all;
}

// A reference room as a user would run it, with the sensors of its reference. Those at the edge of a sun
// patch are left out: the reference's sun is a point, ours a disc.
GridErrors errorsOfRoom(const std::string& name, const std::string& sky, const std::string& sections) {
  const fs::path folder = fs::path(CLERESTORY_TEST_DATA) / "reference" / name;
  const Workplace place;
  place.copy(folder / (name + ".obj"));
  place.copy(folder / (name + ".mtl"));
  const std::vector<ReferencePoint> reference = readReference(folder / (name + "_" + sky + ".csv"));
  place.writePoints("points.csv", withNeighbours(reference));
  place.write("study.toml", studyOf(name + ".obj") + "units = \"m\"\nup = \"z\"\n" + sections +
                                "[[grid]]\nname = \"reference\"\npoints = \"points.csv\"\n");
  const CsvTable sensors(place.study("study.toml --quiet") / "sensors.csv");
  std::vector<double> ours;
  std::vector<double> truth;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    EXPECT_NEAR(sensors.number(spots * i, "x_m"), reference[i].place_m[0],
                1e-6);  // rows keep the order of the points
    EXPECT_NEAR(sensors.number(spots * i, "y_m"), reference[i].place_m[1], 1e-6);
    double least_lx = 1e9;
    double most_lx = 0.0;
    for (std::size_t spot = 0; spot < spots; ++spot) {
      const double sun_lx = sensors.number(spots * i + spot, "sun_lx");
      least_lx = std::min(least_lx, sun_lx);
      most_lx = std::max(most_lx, sun_lx);
    }
    if (most_lx - least_lx > 5000.0) continue;  // a fifth of the beam that the glass lets in
    ours.push_back(sensors.number(spots * i, "illuminance_lx"));
    truth.push_back(reference[i].value);
  }
  EXPECT_GE(ours.size() + 20, reference.size());
  return measuredErrors(name + " " + sky, ours, truth);
}

const std::string clearSky =
    "[sky]\ntype = \"cie-12\"\ndiffuse_horizontal_lx = 7761\ndirect_normal_lx = 69162\n"
    "sun = { altitude = 35.836, azimuth = 141.922 }\n";

// The reference's own standard error is 0.28 %; measured when this was written: bias -0.9 %, RMS 3.2 %,
// p95 6.4 %.
TEST(Reference, EmptyOffice) {
  const GridErrors errors = errorsOfRoom("refoffice", "overcast", "");
  EXPECT_LE(std::abs(errors.bias), 0.05);
  EXPECT_LT(errors.rms, 0.10);
}

// The reference's own standard error is 0.4 %; measured when this was written: bias -1.9 %, RMS 3.9 %,
// p95 7.8 %.
TEST(Reference, FurnishedOffice) {
  const GridErrors errors = errorsOfRoom("furnished", "overcast", "");
  EXPECT_LE(std::abs(errors.bias), 0.05);
  EXPECT_LT(errors.rms, 0.10);
}

// 21 March, 10 o'clock, with sun. The reference's standard error is 0.4 %. At the standard accuracy the bias
// is asked to stay within 2 %, the 95th percentile within 5 % and twice that standard error.
TEST(Reference, EmptyOfficeWithSun) {
  const GridErrors errors = errorsOfRoom("refoffice", "clear", clearSky);
  EXPECT_LE(std::abs(errors.bias), 0.02);
  EXPECT_LE(errors.p95, 0.058);
}

TEST(Reference, FurnishedOfficeWithSun) {
  const GridErrors errors = errorsOfRoom("furnished", "clear", clearSky);
  EXPECT_LE(std::abs(errors.bias), 0.02);
  EXPECT_LE(errors.p95, 0.058);
}

}  // namespace
}  // namespace clerestory
