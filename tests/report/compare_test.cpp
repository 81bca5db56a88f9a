// SPDX-License-Identifier: GPL-3.0-or-later
// Comparisons of tables whose errors can be reckoned by hand.
#include <gtest/gtest.h>

#include <cmath>

#include <import/error.hpp>
#include <report/compare.hpp>

#include "fake.hpp"

namespace clerestory {
namespace {

SensorReading reading(const std::string& grid, double x_m, double lx) {
  return {.place_m = {x_m, 0.0, 0.85}, .direction = {}, .illuminance_lx = lx, .grid = grid};
}

SensorTable table(std::vector<SensorReading> readings, bool hasGrids = true) {
  return {std::move(readings), hasGrids};
}

Comparison compared(const SensorTable& first, const SensorTable& reference) {
  return compareTables("a", first, "b", reference);
}

SensorTable readText(const std::string& text) {
  const fake::TemporaryFolder folder;
  std::ofstream(folder.path() / "table.csv", std::ios::binary) << text;
  return readSensorTable(folder.path() / "table.csv");
}

TEST(Compare, ErrorsAreRelativeToTheReferenceButToNoLessThanATwentiethOfItsMean) {
  // The reference's mean is 100 lx, so the dark sensor counts against 5 lx: errors +0.1, -0.2, +0.6.
  const Comparison c = compared(table({reading("g", 0, 110), reading("g", 1, 160 - 0.2), reading("g", 2, 4)}),
                                table({reading("g", 0, 100), reading("g", 1, 199), reading("g", 2, 1)}));
  ASSERT_EQ(c.grids.size(), 1U);
  const GridComparison& grid = c.grids[0];
  EXPECT_DOUBLE_EQ(grid.referenceMean_lx, 100.0);
  const double second = (159.8 - 199.0) / 199.0;
  EXPECT_DOUBLE_EQ(grid.pairs[0].error, 0.1);
  EXPECT_DOUBLE_EQ(grid.pairs[1].error, second);
  EXPECT_DOUBLE_EQ(grid.pairs[2].error, 0.6);
  EXPECT_DOUBLE_EQ(grid.errors.bias, (0.1 + second + 0.6) / 3.0);
  EXPECT_DOUBLE_EQ(grid.errors.rms, std::sqrt((0.01 + second * second + 0.36) / 3.0));
  EXPECT_DOUBLE_EQ(grid.errors.maximum, 0.6);
  EXPECT_DOUBLE_EQ(grid.errors.p95, 0.6);
}

TEST(Compare, NinetyFiveOfAHundredKeepWithinTheP95) {
  std::vector<SensorReading> first, reference;
  for (int i = 1; i <= 100; ++i) {  // errors of 1, 2, … 100 %, every second one below
    first.push_back(reading("g", i, 100.0 + (i % 2 == 0 ? i : -i)));
    reference.push_back(reading("g", i, 100.0));
  }
  const ErrorFigures errors = compared(table(first), table(reference)).errors;
  EXPECT_DOUBLE_EQ(errors.p95, 0.95);
  EXPECT_DOUBLE_EQ(errors.maximum, 1.0);
  EXPECT_NEAR(errors.bias, 0.005, 1e-15);                               // 50 of 100 %
  EXPECT_NEAR(errors.rms, std::sqrt(338350.0 / 100.0) / 100.0, 1e-15);  // sum of the first 100 squares
}

TEST(Compare, ATableAgainstItselfHasNoErrorInAnyOrder) {
  const SensorTable forward = table({reading("g", 0, 10), reading("g", 0.25, 20), reading("h", 0, 30)});
  const SensorTable backward = table({reading("h", 0, 30), reading("g", 0.25, 20), reading("g", 0, 10)});
  const Comparison c = compared(forward, backward);
  EXPECT_EQ(c.grids.size(), 2U);
  EXPECT_EQ(c.errors.maximum, 0.0);
  EXPECT_EQ(c.errors.rms, 0.0);
}

TEST(Compare, SensorsPairWithinAMillimetreOnly) {
  // Negative places too, where truncation and rounding down differ; 1 mm apart crosses cubes.
  for (const double x : {-3.0005, -0.0004, 0.0, 0.0019, 5.25}) {
    const SensorTable reference = table({reading("g", x, 10), reading("g", 9, 1)});
    for (const double apart : {0.001, -0.001, 0.0004}) {
      const Comparison c = compared(table({reading("g", x + apart, 11), reading("g", 9, 1)}), reference);
      EXPECT_EQ(c.grids[0].pairs.size(), 2U) << x << ' ' << apart;
    }
    for (const double apart : {0.0011, -0.0011}) {
      const Comparison c = compared(table({reading("g", x + apart, 11), reading("g", 9, 1)}), reference);
      EXPECT_EQ(c.grids[0].pairs.size(), 1U) << x << ' ' << apart;
      EXPECT_EQ(c.grids[0].onlyFirst, 1U);
      EXPECT_EQ(c.grids[0].onlyReference, 1U);
    }
  }
}

TEST(Compare, TheNearestIsThePartnerAndNoneHasTwo) {
  const Comparison c = compared(table({reading("g", 0, 1), reading("g", 0, 2)}),
                                table({reading("g", 0.0008, 10), reading("g", 0.0002, 20)}));
  ASSERT_EQ(c.grids[0].pairs.size(), 2U);
  EXPECT_EQ(c.grids[0].pairs[0].reference_lx, 20.0);
  EXPECT_EQ(c.grids[0].pairs[1].reference_lx, 10.0);
}

TEST(Compare, SensorsOfOnePlacePairByTheirDirections) {
  SensorReading up = reading("g", 0, 100), east = reading("g", 0, 40);
  up.direction = glm::dvec3(0, 0, 1);
  east.direction = glm::dvec3(1, 0, 0);
  EXPECT_EQ(compared(table({up, east}), table({east, up})).errors.maximum, 0.0);
}

TEST(Compare, SensorsWithoutAPartnerAreCountedInTheirGrids) {
  const Comparison c = compared(table({reading("g", 0, 1), reading("g", 1, 1), reading("old", 0, 1)}),
                                table({reading("g", 0, 1), reading("new", 0, 1), reading("new", 1, 1)}));
  ASSERT_EQ(c.grids.size(), 3U);
  EXPECT_EQ(c.grids[0].onlyFirst, 1U);
  EXPECT_EQ(c.grids[1].name, "old");
  EXPECT_EQ(c.grids[1].onlyFirst, 1U);
  EXPECT_EQ(c.grids[2].name, "new");
  EXPECT_EQ(c.grids[2].onlyReference, 2U);
  EXPECT_TRUE(std::isnan(c.grids[2].errors.rms));
  EXPECT_EQ(c.errors.rms, 0.0);  // of what is in both
}

TEST(Compare, ATableWithoutGridsTakesTheOthersNames) {
  const SensorTable named = table({reading("g", 0, 10), reading("h", 1, 10)});
  const SensorTable plain = table({reading("", 1, 10), reading("", 0, 10)}, false);
  for (const Comparison& c : {compared(named, plain), compared(plain, named)}) {
    ASSERT_EQ(c.grids.size(), 2U);
    EXPECT_EQ(std::min(c.grids[0].name, c.grids[1].name), "g");
    EXPECT_EQ(std::max(c.grids[0].name, c.grids[1].name), "h");
    EXPECT_EQ(c.errors.maximum, 0.0);
  }
}

TEST(Compare, NothingInCommonIsAnError) {
  try {
    compared(table({reading("north", 0, 1)}), table({reading("south", 0, 1)}));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("\"north\""), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("\"south\""), std::string::npos) << error.what();
  }
  EXPECT_THROW(compared(table({reading("", 0, 1)}, false), table({reading("", 1, 1)}, false)), InputError);
}

TEST(Compare, ADarkReferenceHasNoErrors) {
  const Comparison c = compared(table({reading("g", 0, 1)}), table({reading("g", 0, 0)}));
  EXPECT_TRUE(std::isnan(c.errors.bias));
  EXPECT_TRUE(worstPlaces(c, 5).empty());
  EXPECT_TRUE(comparisonCsv(c).ends_with("\r\ng,1,0,0,1,0,,,,\r\n")) << comparisonCsv(c);
}

TEST(Compare, FiguresOfAllLeaveOutWhatIsDarkInTheReference) {
  const Comparison c = compared(table({reading("lit", 0, 11), reading("dark", 0, 0)}),
                                table({reading("lit", 0, 10), reading("dark", 0, 0)}));
  EXPECT_EQ(c.pairs, 1U);
  EXPECT_DOUBLE_EQ(c.errors.bias, 0.1);
}

TEST(Compare, ExtremeNumbersGiveAPage) {
  const SensorTable far =
      table({reading("g", -1e12, 1e12), reading("g", 1e12, 1e-300), reading("h", 0, 1e12)});
  const SensorTable faint = table({reading("g", -1e12, 1e-300), reading("g", 1e12, 0), reading("h", 0, 1)});
  const std::string page = comparisonPage(compared(far, faint));
  for (const char* wrong : {"=\"nan", "=\"inf", "=\"-inf", "x=\"\"", "offset=\"\""}) {
    EXPECT_EQ(page.find(wrong), std::string::npos) << wrong;
  }
}

TEST(Compare, WorstPlacesComeBySizeOfTheirErrors) {
  const Comparison c = compared(table({reading("g", 0, 101), reading("g", 1, 50), reading("h", 0, 130)}),
                                table({reading("g", 0, 100), reading("g", 1, 100), reading("h", 0, 100)}));
  const std::vector<PairPlace> worst = worstPlaces(c, 2);
  ASSERT_EQ(worst.size(), 2U);
  EXPECT_EQ(c.grids[worst[0].grid].pairs[worst[0].pair].error, -0.5);
  EXPECT_EQ(c.grids[worst[1].grid].name, "h");
}

TEST(Compare, TablesAreRfc4180AndHarmless) {
  const Comparison c =
      compared(table({reading("=cmd(),\"x\"", 0.25, 110)}), table({reading("=cmd(),\"x\"", 0.25, 100)}));
  EXPECT_EQ(comparisonCsv(c),
            "grid,sensors,only_first,only_reference,illuminance_mean_lx,reference_mean_lx,bias_pct,rms_pct,"
            "p95_pct,max_pct\r\n\"'=cmd(),\"\"x\"\"\",1,0,0,110,100,10,10,10,10\r\n");
  EXPECT_EQ(differencesCsv(c),
            "grid,x_m,y_m,z_m,illuminance_lx,reference_lx,difference_lx,error_pct\r\n"
            "\"'=cmd(),\"\"x\"\"\",0.25,0,0.85,110,100,10,10\r\n");
}

TEST(Compare, ThePageShowsErrorsAndRunsNoName) {
  const std::string name = "<script>alert(1)</script>";
  const SensorTable first = table({reading(name, 0, 110), reading(name, 1, 90), reading("dark", 0, 1)});
  const SensorTable reference = table({reading(name, 0, 100), reading(name, 1, 100), reading("dark", 0, 0)});
  const std::string page = comparisonPage(compareTables(name, first, "\"onload=x", reference));
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("\"onload"), std::string::npos);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
  EXPECT_NE(page.find("fill=\"#e08a2e\"><title>10.00 % at 0.00, 0.00, 0.85 m"), std::string::npos) << page;
  EXPECT_NE(page.find("fill=\"#5b9bd5\"><title>\u221210.00 %"), std::string::npos);
  EXPECT_NE(page.find("The reference is dark"), std::string::npos);
  EXPECT_NE(page.find("<td class=\"n\">–</td>"), std::string::npos);  // its figures
}

TEST(SensorTable, ReadsAReportsColumnsAndOtherPrograms) {
  const SensorTable report =
      readText("\xEF\xBB\xBFgrid,room,x_m,y_m,z_m,nx,ny,nz,illuminance_lx\r\n\"'=a\",r,1,2,3,0,0,2,45.5\r\n");
  EXPECT_TRUE(report.hasGrids);
  ASSERT_EQ(report.readings.size(), 1U);
  EXPECT_EQ(report.readings[0].grid, "=a");
  EXPECT_EQ(report.readings[0].place_m, glm::dvec3(1, 2, 3));
  EXPECT_EQ(report.readings[0].direction, glm::dvec3(0, 0, 1));
  EXPECT_EQ(report.readings[0].illuminance_lx, 45.5);
  const SensorTable measured = readText("# by hand\nX,Y,Z,Lux,tag\n1,2,3,45.5,room\n\n2,2,3,46,room\n");
  EXPECT_FALSE(measured.hasGrids);
  EXPECT_EQ(measured.readings.size(), 2U);
  EXPECT_FALSE(measured.readings[0].direction);
}

TEST(SensorTable, BadTablesAreRefusedWithTheirLine) {
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"x,y,z\n1,2,3\n", ":1:"},           {"x,y,z,lux\n1,2,3,4\n1,2,3,bright\n", ":3:"},
      {"x,y,z,lux\n1,2,3\n", ":2:"},       {"x,y,z,lux\n1,2,nan,4\n", ":2:"},
      {"x,y,z,lux\n", "no sensor"},        {"", "no sensor"},
      {"x,y,z,lux\n1e300,2,3,4\n", ":2:"}, {"x,y,z,nx,ny,nz,lux\n1,2,3,0,0,0,4\n", "normal"}};
  for (const auto& [text, words] : bad) {
    try {
      readText(text);
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }
}

TEST(Compare, IsWrittenBesideNoReport) {
  const Comparison c = compared(table({reading("g", 0, 11)}), table({reading("g", 0, 10)}));
  const fake::TemporaryFolder folder;
  writeComparison(folder.path() / "new" / "place", c);
  EXPECT_EQ(fake::contentOf(folder.path() / "new" / "place" / "compare.csv"), comparisonCsv(c));
  EXPECT_EQ(fake::contentOf(folder.path() / "new" / "place" / "differences.csv"), differencesCsv(c));
  EXPECT_EQ(fake::contentOf(folder.path() / "new" / "place" / "compare.html"), comparisonPage(c));
  const fake::Case made = fake::office();
  writeReport(folder.path() / "report", made.input());
  EXPECT_THROW(writeComparison(folder.path() / "report", c), InputError);
}

}  // namespace
}  // namespace clerestory
