// SPDX-License-Identifier: GPL-3.0-or-later
// Whole studies of models that others made; built only where CLERESTORY_MODELS says where these are.
#include <algorithm>
#include <cctype>

#include "program.hpp"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

const fs::path kModels = CLERESTORY_MODELS;

// 100 daylight factors by Radiance, of a standard error of 0.5 %.
TEST(FurtherModels, RadianceTutorialRoom) {
  const fs::path folder = kModels / "room-radiance-tutorial";
  const Workplace place;
  for (const char* name : {"rt_room.obj", "rt_room.mtl", "points.txt"}) place.copy(folder / name);
  place.write("study.toml", studyOf("rt_room.obj") +
                                "units = \"m\"\nup = \"z\"\n[materials.\"Glazing\"]\ntransmittance = 0.596\n"
                                "[[grid]]\nname = \"points\"\npoints = \"points.txt\"\n");
  const CsvTable sensors(place.study("study.toml --quiet --accuracy fine") / "sensors.csv");
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
  std::cout << "mean daylight factor " << mean_pct << " %, Radiance " << expected_pct << " %\n";
  EXPECT_LE(measuredErrors("tutorial room", sensors.numbers("daylight_factor_pct"), truth).rms, 0.02);
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

struct Dwelling {
  const char *folder, *model, *units;
  std::vector<double> dark_m2;  ///< floors, by size, of rooms without a window whose doors are closed
};

class FurnishedDwelling : public testing::TestWithParam<Dwelling> {};

// Furnished, with nothing but site and units stated. A room with panes of its own has 0.1 to 20 % in the
// mean; one that borrows its light through a doorway or over a stair has less; a dark one has none at all, so
// nothing leaks.
TEST_P(FurnishedDwelling, HasPlausibleDaylightFactors) {
  const Dwelling& dwelling = GetParam();
  const Workplace place;
  const fs::path folder = kModels / dwelling.folder;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".mtl") place.copy(entry.path());
  }
  place.copy(folder / dwelling.model);
  place.write("study.toml", studyOf(dwelling.model) + "units = \"" + dwelling.units +
                                "\"\n[site]\nlatitude = 47.4\nlongitude = 8.5\n");
  const fs::path report = place.study("study.toml --quiet --accuracy draft");
  const CsvTable rooms(report / "rooms.csv");
  std::vector<std::string> dark;
  std::vector<double> dark_m2;
  std::size_t lit = 0;
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    const double mean_pct = rooms.number(i, "daylight_factor_mean_pct");
    const bool hasPanes = rooms.number(i, "average_daylight_factor_formula_pct") > 0.0;
    std::cout << rooms.text(i, "room") << ' ' << mean_pct << " %\n";
    lit += hasPanes ? 1 : 0;
    if (hasPanes) {
      EXPECT_GT(mean_pct, 0.1) << rooms.text(i, "room");
      EXPECT_GT(rooms.number(i, "daylight_factor_min_pct"), 0.0) << rooms.text(i, "room");
    } else {
      EXPECT_LT(mean_pct, 2.0) << rooms.text(i, "room");
    }
    EXPECT_LT(mean_pct, 20.0) << rooms.text(i, "room");
    if (mean_pct == 0.0) {
      dark.push_back(rooms.text(i, "room"));
      dark_m2.push_back(rooms.number(i, "floor_area_m2"));
    }
  }
  EXPECT_GE(lit, 2U);
  std::sort(dark_m2.begin(), dark_m2.end());
  ASSERT_EQ(dark_m2.size(), dwelling.dark_m2.size());
  for (std::size_t i = 0; i < dark_m2.size(); ++i) EXPECT_NEAR(dark_m2[i], dwelling.dark_m2[i], 0.2);
  const CsvTable sensors(report / "sensors.csv");
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const bool isDark = std::find(dark.begin(), dark.end(), sensors.text(i, "room")) != dark.end();
    const double factor_pct = sensors.number(i, "daylight_factor_pct");
    if (isDark) {
      EXPECT_EQ(factor_pct, 0.0);
    }
    EXPECT_LT(factor_pct, 30.0);  // close before a window
  }
}

INSTANTIATE_TEST_SUITE_P(
    Models, FurnishedDwelling,
    testing::Values(Dwelling{"room-sh3d-Studio", "Studio.obj", "cm", {4.3}},
                    Dwelling{"room-sh3d-2BedroomApartment", "2BedroomApartment.obj", "cm", {1.1, 4.8}},
                    Dwelling{"room-duplex-ifc", "duplex_webifc.obj", "m", {1.4, 1.4, 3.2, 3.2, 4.8, 4.8}}),
    [](const auto& info) {
      std::string name = info.param.folder;
      std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
      return name;
    });

}  // namespace
}  // namespace clerestory
