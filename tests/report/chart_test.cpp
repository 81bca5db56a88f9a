// SPDX-License-Identifier: GPL-3.0-or-later
// A chart's table and the figures over its runs.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <report/chart.hpp>

namespace clerestory {
namespace {

ChartRun runOf(const std::string& method, double cpu_s, double rms) {
  ChartRun run;
  run.series = "accuracy";
  run.method = method;
  run.setting = "5 %";
  run.value = 0.05;
  run.cpu_s = cpu_s;
  run.wall_s = 0.5 * cpu_s;
  run.memory_MiB = 1.5;
  run.links = 1000.0;
  run.elements = 20.0;
  run.sensors = {-0.01, rms, 2.0 * rms, 4.0 * rms};
  run.surfaces = std::numeric_limits<double>::quiet_NaN();
  return run;
}

TEST(Chart, RunsComeBackFromTheirTable) {
  const std::vector<ChartRun> runs = {runOf("shooting", 0.25, 0.02), runOf("=cmd(), \"x\"", 4.0, 0.5)};
  const std::vector<ChartRun> again = readChartCsv(chartCsv(runs));
  ASSERT_EQ(again.size(), 2U);
  EXPECT_EQ(again[0].method, "shooting");
  EXPECT_EQ(again[1].method, "'=cmd(), \"x\"") << "no spreadsheet runs it";
  EXPECT_NEAR(again[0].cpu_s, 0.25, 1e-6);
  EXPECT_NEAR(again[1].sensors.maximum, 2.0, 1e-6);
  EXPECT_TRUE(std::isnan(again[0].surfaces));
}

// A run that is stopped may leave half a line.
TEST(Chart, AHalfWrittenLineIsPassedOver) {
  const std::string whole = chartCsv({runOf("shooting", 0.25, 0.02), runOf("plain", 4.0, 0.5)});
  for (std::size_t length = chartCsvHeader().size(); length < whole.size(); ++length)
    EXPECT_LE(readChartCsv(whole.substr(0, length)).size(), 1U);
  EXPECT_EQ(readChartCsv(whole).size(), 2U);
}

TEST(Chart, FrontAndSlope) {
  std::vector<std::pair<double, double>> points;
  for (int i = 0; i < 6; ++i) points.emplace_back(std::pow(2.0, i), 3.0 * std::pow(2.0, -0.5 * i));
  points.emplace_back(20.0, 2.9);  // beaten by all of its time
  const std::vector<bool> isOnFront = paretoFront(points);
  EXPECT_EQ(std::count(isOnFront.begin(), isOnFront.end(), true), 6);
  EXPECT_FALSE(isOnFront.back());
  ASSERT_TRUE(frontSlope(points).has_value());
  EXPECT_NEAR(*frontSlope(points), -0.5, 1e-9);
  EXPECT_FALSE(frontSlope({{1.0, 1.0}, {2.0, 0.5}}).has_value());
}

TEST(Chart, ErrorsAreAgainstTheReferenceOrAShareOfItsMean) {
  const ErrorFigures figures = errorsAgainst({110.0, 1.0}, {100.0, 0.0});
  EXPECT_NEAR(figures.maximum, 1.0 / 2.5, 1e-12);  // 5 % of the mean of 50
  EXPECT_NEAR(figures.bias, 0.5 * (0.1 + 0.4), 1e-12);
  EXPECT_TRUE(std::isnan(errorsAgainst({1.0}, {0.0}).rms));
}

TEST(Chart, NamesDoNoHarmInThePage) {
  const std::string evil = "<script>alert(1)</script>";
  ChartRun run = runOf(evil, 1.0, 0.1);
  run.setting = evil;
  const std::string page = chartPage(evil, {evil, 0.01}, {run, runOf("plain", 2.0, 0.05)});
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_NE(page.find("&lt;script&gt;"), std::string::npos);
  EXPECT_EQ(chartSvg(evil, {evil, 0.01}, {run}).find("<script"), std::string::npos);
}

TEST(Chart, WithoutRunsThereIsAPageToo) {
  EXPECT_NE(chartPage("study", {"none", 0.0}, {}).find("</html>"), std::string::npos);
  EXPECT_TRUE(chartSvg("study", {"none", 0.0}, {}).empty());
}

}  // namespace
}  // namespace clerestory
