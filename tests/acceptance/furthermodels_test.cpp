// SPDX-License-Identifier: GPL-3.0-or-later
// Whole studies of models that others made; built only where CLERESTORY_MODELS says where these are.
#include "program.hpp"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

const fs::path kModels = CLERESTORY_MODELS;

// Radiance's mean daylight factor has a standard error of 0.5 %; 10 % is the first honest point, held from
// here on.
TEST(FurtherModels, RadianceTutorialRoom) {
  const fs::path folder = kModels / "room-radiance-tutorial";
  const Workplace place;
  for (const char* name : {"rt_room.obj", "rt_room.mtl", "points.txt"}) place.copy(folder / name);
  place.write("study.toml", studyOf("rt_room.obj") +
                                "units = \"m\"\nup = \"z\"\n[materials.\"Glazing\"]\ntransmittance = 0.596\n"
                                "[[grid]]\nname = \"points\"\npoints = \"points.txt\"\n");
  const CsvTable sensors(place.study("study.toml --quiet") / "sensors.csv");
  const std::vector<ReferencePoint> reference = readReference(folder / "df_radiance.txt");
  std::vector<double> truth;
  double mean_pct = 0.0;
  double expected_pct = 0.0;
  ASSERT_EQ(sensors.size(), reference.size());
  for (std::size_t i = 0; i < reference.size(); ++i) {
    truth.push_back(reference[i].value);
    mean_pct += sensors.number(i, "daylight_factor_pct") / static_cast<double>(reference.size());
    expected_pct += reference[i].value / static_cast<double>(reference.size());
    EXPECT_NEAR(sensors.number(i, "x_m"), reference[i].place_m[0], 1e-5);
    EXPECT_NEAR(sensors.number(i, "y_m"), reference[i].place_m[1], 1e-5);
  }
  measuredErrors("tutorial room", sensors.numbers("daylight_factor_pct"), truth);
  std::cout << "mean daylight factor " << mean_pct << " %, Radiance " << expected_pct << " %\n";
  EXPECT_NEAR(mean_pct, expected_pct, 0.10 * expected_pct);
}

// A model with many faults, in centimetres and y up: rooms are found, and no value is impossible.
TEST(FurtherModels, StudioShell) {
  const fs::path folder = kModels / "room-sh3d-Studio";
  const Workplace place;
  for (const char* name : {"Studio_shell.obj", "Studio.mtl", "Studio_shell.mtl"}) place.copy(folder / name);
  const fs::path report = place.study("Studio_shell.obj --units cm --up y --accuracy draft --quiet");
  const CsvTable sensors(report / "sensors.csv");
  double largest_pct = 0.0;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const double illuminance_lx = sensors.number(i, "illuminance_lx");
    EXPECT_TRUE(std::isfinite(illuminance_lx));
    EXPECT_GE(illuminance_lx, 0.0);
    const double factor_pct = sensors.number(i, "daylight_factor_pct");
    EXPECT_LT(factor_pct, 60.0) << "at " << sensors.text(i, "x_m") << ' ' << sensors.text(i, "y_m") << ' '
                                << sensors.text(i, "z_m") << " in " << sensors.text(i, "room");
    largest_pct = std::max(largest_pct, factor_pct);
  }
  const CsvTable rooms(report / "rooms.csv");
  std::cout << rooms.size() << " rooms, " << sensors.size() << " sensors, largest daylight factor "
            << largest_pct << " %\n";
  EXPECT_GE(rooms.size(), 1U);
}

}  // namespace
}  // namespace clerestory
