// SPDX-License-Identifier: GPL-3.0-or-later
// Norms judged at their thresholds, and the table of luminaires.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <import/photometry.hpp>
#include <report/report.hpp>

#include "fake.hpp"

namespace clerestory {
namespace {

using Json = nlohmann::json;

/// The made office at 9:00 of the equinox under a clear sky with its beam.
fake::Case leedMorning() {
  fake::Case made = fake::office();
  made.study.norms = {"en17037", "leed"};
  made.study.sky = {};
  made.study.sky.cieType = 12;
  made.study.sky.directNormal_lx = 60000.0;
  made.study.sky.time = ClockTime{2026, 3, 21, 9.0, std::nullopt};
  return made;
}

/// Lights `lit` of every hundred sensors of the first grid with 300 lx, the others with 299.
void light(fake::Case& made, std::size_t lit) {
  GridValues& grid = made.solution.grids[0];
  grid.sensors.assign(100, {});
  for (std::size_t i = 0; i < 100; ++i) grid.sensors[i].illuminance_lx = i < lit ? 300.0 : 299.0;
  SensorGrid& place = made.building.grids[0];
  place.points.assign(100, glm::dvec3(0.0));
  place.normals.assign(100, glm::dvec3(0.0, 0.0, 1.0));
}

Json normsOfFirstGrid(const fake::Case& made) {
  return Json::parse(studyJson(made.input()))["rooms"][0]["grids"][0]["norms"];
}

TEST(Norms, LeedCountsPointsOfItsHour) {
  fake::Case made = leedMorning();
  for (const auto& [lit, v4, v41] : {std::array{54, 0, 0}, {55, 0, 1}, {74, 0, 1}, {75, 1, 2}, {90, 2, 3}}) {
    light(made, static_cast<std::size_t>(lit));
    const Json leed = normsOfFirstGrid(made)["leed_option_2"];
    EXPECT_EQ(leed["points_v4_if_other_hour_alike"], v4) << lit;
    EXPECT_EQ(leed["points_v4_1_if_other_hour_alike"], v41) << lit;
  }
}

TEST(Norms, SayWhyTheyAreNotJudged) {
  fake::Case made = leedMorning();
  EXPECT_TRUE(normsOfFirstGrid(made)["en17037"].contains("not_judged")) << "a clear sky";
  made.study.sky.time->hour_h = 12.0;
  EXPECT_TRUE(normsOfFirstGrid(made)["leed_option_2"].contains("not_judged")) << "noon";
  made.study.sky.time = ClockTime{2026, 6, 21, 9.0, std::nullopt};
  EXPECT_TRUE(normsOfFirstGrid(made)["leed_option_2"].contains("not_judged")) << "June";
  made.study.norms = {};
  EXPECT_FALSE(Json::parse(studyJson(made.input()))["rooms"][0]["grids"][0].contains("norms"));
}

// Sunlight for 1.5, 3 and 4 h, on a day from 1 February to 21 March.
TEST(Norms, SunlightHasLevels) {
  fake::Case made = leedMorning();
  made.solution.rooms.assign(made.building.rooms.size(), {});
  const auto room = [&] { return Json::parse(studyJson(made.input()))["rooms"][0]; };
  for (const auto& [hours, level] :
       {std::pair{1.49, "none"}, {1.5, "minimum"}, {3.0, "medium"}, {4.0, "high"}}) {
    made.solution.rooms[0].sunlight_h = hours;
    EXPECT_EQ(room()["sunlight_level_en17037"], level);
  }
  for (const auto& [month, day, level] : {std::tuple{1, 31, "not judged"},
                                          {2, 1, "high"},
                                          {2, 28, "high"},
                                          {3, 21, "high"},
                                          {3, 22, "not judged"}}) {
    made.study.sunlight.date.month = month;
    made.study.sunlight.date.day = day;
    EXPECT_EQ(room()["sunlight_level_en17037"], level) << month << '-' << day;
  }
  EXPECT_EQ(room()["sunlight_date"], "2026-03-22");
}

TEST(Norms, OvercastSkyIsJudged) {
  fake::Case made = fake::office();
  made.study.norms = {"en17037"};
  made.study.sky = {};
  light(made, 100);
  for (SensorValue& sensor : made.solution.grids[0].sensors) sensor.sky_lx = 1000.0;  // a factor of 10 %
  EXPECT_EQ(normsOfFirstGrid(made)["en17037"]["level"], "high");
  for (SensorValue& sensor : made.solution.grids[0].sensors) sensor.sky_lx = 10.0;
  EXPECT_EQ(normsOfFirstGrid(made)["en17037"]["passes"], false);
}

// Equal luminaires are one row; another factor is another row.
TEST(Luminaires, AreCountedByKind) {
  fake::Case made = fake::office();
  EXPECT_TRUE(Json::parse(studyJson(made.input()))["luminaires"].empty());
  Luminaire lamp;
  lamp.name = "Pendant";
  lamp.photometry = std::make_shared<const Photometry>(uniformPhotometry(100.0));
  made.building.luminaires = {lamp, lamp, lamp};
  made.building.luminaires[1].factor = 0.8;
  const Json rows = Json::parse(studyJson(made.input()))["luminaires"];
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0]["count"], 2);
  EXPECT_NEAR(rows[0]["flux_each_lm"].get<double>(), 1256.6, 1.0);
  EXPECT_EQ(rows[1]["factor"], 0.8);
}

}  // namespace
}  // namespace clerestory
