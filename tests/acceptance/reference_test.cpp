// SPDX-License-Identifier: GPL-3.0-or-later
// Whole studies of the reference rooms against Radiance: the first honest point of error, held from here on.
#include <algorithm>
#include <limits>

#include "program.hpp"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t spotsInSun = 5;  // of a sensor: its place and 4 cm to each side

/// The places of sensors, and around each those that tell whether a sun patch ends there.
std::vector<ReferencePoint> withNeighbours(const std::vector<ReferencePoint>& points) {
  std::vector<ReferencePoint> all;
  for (const ReferencePoint& point : points) {
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {0.04, 0.0}, {-0.04, 0.0}, {0.0, 0.04}, {0.0, -0.04}})
      all.push_back({{point.place_m[0] + x, point.place_m[1] + y, point.place_m[2]}, point.value});
  }
  return all;
}

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Of the median of what is stated of errors: as a share of the illuminance, and times the true ones' median.
struct StatedMost {
  double share, times;
};

/// What is promised of error_lx, as shares of the true illuminance: with twice the reference's deviation in
/// squares it covers the difference at 95 % of the sensors, and not by being large.
void expectHonest(const std::vector<double>& stated, const std::vector<double>& deviation,
                  const std::vector<double>& difference, const StatedMost& most, const std::string& where) {
  double covered = 0.0;
  for (std::size_t i = 0; i < stated.size(); ++i)
    covered += difference[i] <= std::hypot(stated[i], 2.0 * deviation[i]) ? 1.0 : 0.0;
  EXPECT_GE(covered, 0.95 * static_cast<double>(stated.size())) << where;
  EXPECT_LE(medianOf(stated), std::min(most.share, most.times * medianOf(difference))) << where;
}

/// The accuracy and five times. Behind blades at fine more is stated, since what is left out there is more,
/// and in a corridor that is lit through doors a quarter of its light.
StatedMost statedMost(const std::string& room, const std::string& table, const std::string& accuracy) {
  constexpr double any = std::numeric_limits<double>::infinity();
  if (room == "louvres" && accuracy == "fine") return {any, 5.0};
  if (table == "corridor_paths") return {0.25, any};
  return {accuracy == "draft" ? 0.1 : accuracy == "standard" ? 0.05 : 0.02, 5.0};
}

// A reference room as a user would run it, with the sensors of its reference. Those at the edge of a sun
// patch are left out: the reference's sun is a point, ours a disc. Where the reference knows its own error,
// error_lx is held to it.
GridErrors errorsOfRoom(const std::string& name, const std::string& table, const std::string& accuracy,
                        const std::string& sections = "") {
  const std::size_t spots = sections.empty() ? 1 : spotsInSun;
  const fs::path folder = fs::path(CLERESTORY_TEST_DATA) / "reference" / name;
  const Workplace place;
  place.copy(folder / (name + ".obj"));
  place.copy(folder / (name + ".mtl"));
  const std::vector<ReferencePoint> reference = readReference(folder / (name + "_" + table + ".csv"));
  place.writePoints("points.csv", spots == 1 ? reference : withNeighbours(reference));
  place.write("study.toml", studyOf(name + ".obj") + "units = \"m\"\nup = \"z\"\n" + sections +
                                "[[grid]]\nname = \"reference\"\npoints = \"points.csv\"\n");
  const CsvTable sensors(place.study("study.toml --quiet --accuracy " + accuracy) / "sensors.csv");
  std::vector<double> ours;
  std::vector<double> truth;
  std::vector<double> stated;
  std::vector<double> deviation;
  std::vector<double> difference;
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
    stated.push_back(sensors.number(spots * i, "error_lx") / truth.back());
    deviation.push_back(reference[i].standardDeviation / truth.back());
    difference.push_back(std::abs(ours.back() - truth.back()) / truth.back());
  }
  if (table.ends_with("_paths"))
    expectHonest(stated, deviation, difference, statedMost(name, table, accuracy),
                 name + " " + table + " " + accuracy);
  EXPECT_GE(ours.size() + 20, reference.size());
  return measuredErrors(name + " " + table + " " + accuracy, ours, truth);
}

const std::string clearSky =
    "[sky]\ntype = \"cie-12\"\ndiffuse_horizontal_lx = 7761\ndirect_normal_lx = 69162\n"
    "sun = { altitude = 35.836, azimuth = 141.922 }\n";

/// What is promised of an accuracy: a p95 within it, beyond twice the reference's standard error, and a bias
/// of half of it at fine and two fifths at standard.
void expectWithin(const GridErrors& errors, double accuracy, double standardError) {
  EXPECT_LE(errors.p95, accuracy + 2.0 * standardError);
  EXPECT_LE(std::abs(errors.bias), accuracy <= 0.02 ? 0.01 : 0.02);
}

// The accuracy asked for is a p95. The paths' standard deviation, 0.4 %, adds to it as independent errors do:
// 2 sqrt(p95² / 4 + 0.4²) %.
TEST(Reference, EmptyOfficeKeepsToTheAccuracyAskedFor) {
  const std::string table = "overcast_paths";
  EXPECT_LE(errorsOfRoom("refoffice", table, "draft").p95, 0.100);
  EXPECT_LE(errorsOfRoom("refoffice", table, "standard").p95, 0.051);
  const GridErrors fine = errorsOfRoom("refoffice", table, "fine");
  EXPECT_LE(fine.p95, 0.0216);
  EXPECT_LE(std::abs(fine.bias), 0.005);
}

TEST(Reference, FurnishedOfficeKeepsToTheAccuracyAskedFor) {
  const std::string table = "overcast_paths";
  EXPECT_LE(errorsOfRoom("furnished", table, "draft").p95, 0.101);
  expectWithin(errorsOfRoom("furnished", table, "standard"), 0.05, 0.006);
  expectWithin(errorsOfRoom("furnished", table, "fine"), 0.02, 0.006);
}

// Twelve furnished offices, every sixth of their sensors. With sun at fine it would take too long here;
// docs/validation.md has it.
TEST(Reference, FloorOfOfficesKeepsToTheAccuracyAskedFor) {
  expectWithin(errorsOfRoom("floor", "overcast_paths", "draft"), 0.1, 0.005);
  expectWithin(errorsOfRoom("floor", "overcast_paths", "standard"), 0.05, 0.005);
  expectWithin(errorsOfRoom("floor", "overcast_paths", "fine"), 0.02, 0.005);
  expectWithin(errorsOfRoom("floor", "clear_paths", "standard", clearSky), 0.05, 0.006);
}

// The corridor between the offices has 3 to 25 lx through their doors. Few samples of a pane and few rays of
// a link miss a door where more would not, and what took the elements that none of them met as dark was 13,
// 12 and 11 % too dark on average at draft, standard and fine (3, 5 and 4 % with samples of panes mended
// alone). Single places there are not as exact as asked (docs/validation.md).
TEST(Reference, CorridorBehindDoorsIsNotTooDark) {
  const GridErrors draft = errorsOfRoom("floor", "corridor_paths", "draft");
  EXPECT_LE(std::abs(draft.bias), 0.1);
  EXPECT_LE(draft.rms, 0.08);  // 0.1 where light that falls off along it was smoothed away as noise
  EXPECT_LE(std::abs(errorsOfRoom("floor", "corridor_paths", "standard").bias), 0.05);
  EXPECT_LE(errorsOfRoom("floor", "corridor_paths", "fine").rms, 0.04);  // twice what was asked for
}

// A hundred white blades before a window, three times as deep as they are apart: half of the light near the
// window has been to and fro between them. What leaves the room and is sent back by the blades is left out,
// 1.3 % of the light and 1.6 % with sun, so the bias of the sunlit room at fine is not held here.
TEST(Reference, LouvresKeepToTheAccuracyAskedFor) {
  EXPECT_LE(errorsOfRoom("louvres", "overcast_paths", "draft").p95, 0.101);
  expectWithin(errorsOfRoom("louvres", "overcast_paths", "standard"), 0.05, 0.005);
  expectWithin(errorsOfRoom("louvres", "overcast_paths", "fine"), 0.02, 0.005);
  expectWithin(errorsOfRoom("louvres", "clear_paths", "standard", clearSky), 0.05, 0.006);
  errorsOfRoom("louvres", "clear_paths", "fine", clearSky);  // what it states of itself is
}

// Radiance's tables are up to 3 % off the paths at the back of the room (docs/validation.md).
TEST(Reference, OfficesAgreeWithRadiance) {
  for (const std::string name : {"refoffice", "furnished"}) {
    const GridErrors errors = errorsOfRoom(name, "overcast", "standard");
    EXPECT_LE(std::abs(errors.bias), 0.02);
    EXPECT_LT(errors.rms, 0.035);
  }
}

// 21 March, 10 o'clock, with sun; every second sensor.
TEST(Reference, OfficesWithSun) {
  for (const std::string name : {"refoffice", "furnished"}) {
    expectWithin(errorsOfRoom(name, "clear_paths", "draft", clearSky), 0.1, 0.005);
    expectWithin(errorsOfRoom(name, "clear_paths", "standard", clearSky), 0.05, 0.005);
  }
  expectWithin(errorsOfRoom("furnished", "clear_paths", "fine", clearSky), 0.02, 0.005);
}

}  // namespace
}  // namespace clerestory
