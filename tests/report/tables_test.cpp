// SPDX-License-Identifier: GPL-3.0-or-later
// Tables read back: every value again as the same float, every name as it was, no formula for a spreadsheet.
#include <gtest/gtest.h>

#include <cstdlib>

#include "fake.hpp"

namespace clerestory {
namespace {

using Rows = std::vector<std::vector<std::string>>;

/// Reads RFC 4180, strictly: every record ends with CRLF.
Rows parseCsv(const std::string& text) {
  Rows rows(1);
  std::string field;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (quoted) {
      if (text[i] != '"') {
        field += text[i];
      } else if (i + 1 < text.size() && text[i + 1] == '"') {
        field += text[++i];
      } else {
        quoted = false;
      }
    } else if (text[i] == '"') {
      EXPECT_TRUE(field.empty()) << "a quote within an unquoted field";
      quoted = true;
    } else if (text[i] == ',') {
      rows.back().push_back(std::exchange(field, {}));
    } else if (text[i] == '\r') {
      EXPECT_EQ(text.at(i + 1), '\n');
      rows.back().push_back(std::exchange(field, {}));
      rows.emplace_back();
      ++i;
    } else {
      EXPECT_NE(text[i], '\n') << "a bare line feed outside quotes";
      field += text[i];
    }
  }
  EXPECT_FALSE(quoted);
  EXPECT_TRUE(rows.back().empty()) << "the last record has no end";
  rows.pop_back();
  return rows;
}

Rows table(const fake::Case& made, const std::string& file) {
  const fake::TemporaryFolder folder;
  writeReport(folder.path() / "report", made.input());
  return parseCsv(fake::contentOf(folder.path() / "report" / file));
}

std::string cell(const Rows& rows, std::size_t row, const std::string& column) {
  for (std::size_t c = 0; c < rows.at(0).size(); ++c) {
    if (rows[0][c] == column) return rows.at(row).at(c);
  }
  ADD_FAILURE() << "no column " << column;
  return {};
}

float value(const Rows& rows, std::size_t row, const std::string& column) {
  return std::strtof(cell(rows, row, column).c_str(), nullptr);
}

std::string headerOf(const Rows& rows) {
  std::string header;
  for (const std::string& column : rows.at(0)) header += (header.empty() ? "" : ",") + column;
  return header;
}

TEST(Tables, HaveTheDocumentedColumns) {
  const fake::Case made = fake::office();
  EXPECT_EQ(headerOf(table(made, "sensors.csv")),
            "grid,room,x_m,y_m,z_m,nx,ny,nz,illuminance_lx,direct_lx,reflected_lx,sky_lx,sun_lx,electric_lx,"
            "daylight_factor_pct,error_lx");
  EXPECT_EQ(
      headerOf(table(made, "surfaces.csv")),
      "surface,room,material,area_m2,reflectance,illuminance_mean_lx,illuminance_min_lx,illuminance_max_lx,"
      "exitance_mean_lm_m2,luminance_mean_cd_m2,error_lx,elements");
  EXPECT_EQ(headerOf(table(made, "rooms.csv")),
            "room,floor_area_m2,volume_m3,grid,sensors,illuminance_mean_lx,illuminance_median_lx,illuminance_"
            "min_lx,"
            "uniformity,daylight_factor_mean_pct,daylight_factor_median_pct,daylight_factor_min_pct,"
            "daylight_factor_above_2_pct,illuminance_300_3000_pct,average_daylight_factor_formula_pct,"
            "sunlight_h");
  EXPECT_EQ(
      headerOf(table(made, "iterations.csv")),
      "domain,iteration,links_required,links_cached,links_reused,visibility_tests,unshot_power_lm,elements,"
      "seconds");
}

TEST(Tables, SensorsRoundTripToTheSameFloats) {
  const fake::Case made = fake::office();
  const Rows rows = table(made, "sensors.csv");
  std::size_t row = 1;
  for (std::size_t g = 0; g < made.building.grids.size(); ++g) {
    for (std::size_t s = 0; s < made.building.grids[g].points.size(); ++s, ++row) {
      const SensorValue& expected = made.solution.grids[g].sensors[s];
      ASSERT_EQ(rows.at(row).size(), rows[0].size());
      EXPECT_EQ(cell(rows, row, "grid"), made.building.grids[g].name);
      EXPECT_EQ(value(rows, row, "illuminance_lx"), static_cast<float>(expected.illuminance_lx));
      EXPECT_EQ(value(rows, row, "direct_lx"), static_cast<float>(expected.direct_lx));
      EXPECT_EQ(value(rows, row, "reflected_lx"), static_cast<float>(expected.reflected_lx));
      EXPECT_EQ(value(rows, row, "error_lx"), static_cast<float>(expected.error_lx));
      EXPECT_EQ(value(rows, row, "daylight_factor_pct"), static_cast<float>(expected.sky_lx / 100.0));
      EXPECT_NEAR(std::strtod(cell(rows, row, "x_m").c_str(), nullptr), made.building.grids[g].points[s].x,
                  1e-6);
    }
  }
  EXPECT_EQ(row, rows.size());
}

TEST(Tables, CoordinatesFarFromTheOriginKeepTheirMillimetres) {
  fake::Case made = fake::office();
  made.building.grids[0].points[0] = {2683141.123, 1247945.457, 408.001};
  const Rows rows = table(made, "sensors.csv");
  EXPECT_EQ(cell(rows, 1, "x_m"), "2683141.123");
  EXPECT_EQ(cell(rows, 1, "y_m"), "1247945.457");
}

TEST(Tables, DaylightFactorsAreEmptyUnderASkyWithoutThem) {
  fake::Case made = fake::office();
  made.study.sky.cieType = 12;
  EXPECT_EQ(cell(table(made, "sensors.csv"), 1, "daylight_factor_pct"), "");
  EXPECT_EQ(cell(table(made, "rooms.csv"), 1, "daylight_factor_mean_pct"), "");
}

TEST(Tables, RoomsCarryMeanMedianAndUniformity) {
  fake::Case made = fake::office();
  std::vector<SensorValue>& sensors = made.solution.grids[1].sensors;
  made.building.grids[1].points.resize(4);
  made.building.grids[1].normals.resize(4);
  sensors.resize(4);
  for (std::size_t s = 0; s < 4; ++s)
    sensors[s].illuminance_lx = sensors[s].sky_lx = std::vector{10., 40., 20., 130.}[s];
  const Rows rows = table(made, "rooms.csv");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(cell(rows, 2, "room"), "Store");
  EXPECT_EQ(cell(rows, 2, "sensors"), "4");
  EXPECT_EQ(value(rows, 2, "illuminance_mean_lx"), 50.0F);
  EXPECT_EQ(value(rows, 2, "illuminance_median_lx"), 30.0F);
  EXPECT_EQ(value(rows, 2, "illuminance_min_lx"), 10.0F);
  EXPECT_EQ(value(rows, 2, "uniformity"), 0.2F);
  EXPECT_EQ(value(rows, 2, "daylight_factor_median_pct"), 0.3F);
}

TEST(Tables, RoomsWithoutGridAndGridsWithoutRoomHaveARow) {
  fake::Case made = fake::office();
  made.building.grids[1].room = -1;
  const Rows rows = table(made, "rooms.csv");
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(cell(rows, 2, "room"), "Store");
  EXPECT_EQ(cell(rows, 2, "sensors"), "0");
  EXPECT_EQ(cell(rows, 3, "room"), "outside");
  EXPECT_EQ(cell(rows, 3, "grid"), "Shelves");
}

TEST(Tables, SurfacesOfOneNameAreNumberedWithinTheirRoom) {
  const Rows rows = table(fake::office(), "surfaces.csv");
  EXPECT_EQ(cell(rows, 1, "surface"), "Walls");
  EXPECT_EQ(cell(rows, 2, "surface"), "Walls#2");
  EXPECT_EQ(cell(rows, 5, "surface"), "Walls");  // in the other room
  EXPECT_EQ(cell(rows, 7, "room"), "outside");
}

TEST(Tables, LuminanceIsExitanceOverPi) {
  const Rows rows = table(fake::office(), "surfaces.csv");
  const double exitance = 412.0 * (0.2126 * 0.8 + 0.7152 * 0.7 + 0.0722 * 0.6);
  EXPECT_EQ(value(rows, 1, "exitance_mean_lm_m2"), static_cast<float>(exitance));
  EXPECT_NEAR(value(rows, 1, "luminance_mean_cd_m2"), exitance / 3.14159265358979, 1e-4);
}

TEST(Tables, NamesAreQuotedAndNeverFormulas) {
  fake::Case made = fake::office();
  for (const char* name : {"=1+2", "+1", "-1", "@x", "\tx", "\rx"}) {
    made.building.rooms[0].name = name;
    const std::string read = cell(table(made, "sensors.csv"), 1, "room");
    EXPECT_EQ(read.substr(0, 2), std::string("'") + (name[0] == '\r' ? '\xEF' : name[0])) << name;
  }
  const std::string awkward = "a \"b\", c\nd 'e' é =f";
  made.building.rooms[0].name = awkward;
  EXPECT_EQ(cell(table(made, "sensors.csv"), 1, "room"), awkward);
  made.building.rooms[0].name = "bad \xFF\xC3 bytes";
  EXPECT_EQ(cell(table(made, "sensors.csv"), 1, "room"), "bad \uFFFD\uFFFD bytes");
}

TEST(Tables, NegativeNumbersAreNotTakenForFormulas) {
  fake::Case made = fake::office();
  made.building.grids[0].points[0].x = -1.25;
  made.building.grids[0].normals[0] = {0.0, -1.0, 0.0};
  const Rows rows = table(made, "sensors.csv");
  EXPECT_EQ(cell(rows, 1, "x_m"), "-1.25");
  EXPECT_EQ(cell(rows, 1, "ny"), "-1");
}

}  // namespace
}  // namespace clerestory
