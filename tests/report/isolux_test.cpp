// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of equal illuminance and sections, on light of which both are known.
#include <gtest/gtest.h>

#include <cmath>

#include "fake.hpp"
#include "plan.hpp"

namespace clerestory {
namespace {

constexpr double spacing_m = 0.5;

/// A lattice of 9 × 5 sensors from (2, 1) on, lit by `lux(x, y)`.
template <class Light>
std::pair<SensorGrid, GridValues> lit(const Light& lux) {
  SensorGrid grid;
  grid.spacing_m = spacing_m;
  GridValues values;
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 9; ++column) {
      const glm::dvec3 point(2.0 + spacing_m * column, 1.0 + spacing_m * row, 0.85);
      grid.points.push_back(point);
      grid.normals.emplace_back(0.0, 0.0, 1.0);
      SensorValue value;
      value.illuminance_lx = lux(point.x, point.y);
      values.sensors.push_back(value);
    }
  }
  return {grid, values};
}

TEST(Isolux, ExponentialFallGivesAStraightLineWhereItShouldLie) {
  const auto [grid, values] = lit([](double x, double) { return 1000.0 * std::exp(-x); });
  const SensorLattice lattice = latticeOf(grid, spacing_m);
  ASSERT_EQ(lattice.columns, 9u);
  ASSERT_EQ(lattice.rows, 5u);
  const auto line = isoluxLine(grid, lattice, values, 1000.0 * std::exp(-3.3));
  ASSERT_EQ(line.size(), 4u);
  double length_m = 0.0;
  for (const IsoluxSegment& segment : line) {
    // The logarithm is linear, so interpolation is exact but for rounding.
    EXPECT_NEAR(segment.from_m.x, 3.3, 1e-9);
    EXPECT_NEAR(segment.to_m.x, 3.3, 1e-9);
    length_m += std::abs(segment.to_m.y - segment.from_m.y);
  }
  EXPECT_NEAR(length_m, 2.0, 1e-9);
  EXPECT_TRUE(isoluxLine(grid, lattice, values, 5000.0).empty());
}

TEST(Isolux, LinesLeaveOutWhatIsMissing) {
  auto [grid, values] = lit([](double x, double) { return 1000.0 * std::exp(-x); });
  grid.points.erase(grid.points.begin());  // the corner at (2, 1)
  values.sensors.erase(values.sensors.begin());
  const auto line = isoluxLine(grid, latticeOf(grid, spacing_m), values, 1000.0 * std::exp(-2.2));
  EXPECT_EQ(line.size(), 3u);
}

TEST(Isolux, SaddlesNeverCross) {
  const auto [grid, values] = lit([](double x, double y) {
    return 100.0 * std::exp((x - 4.2) * (y - 2.1));  // a saddle within a square
  });
  const auto line = isoluxLine(grid, latticeOf(grid, spacing_m), values, 100.5);
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    for (std::size_t k = i + 1; k < line.size(); ++k) {
      const auto side = [](const IsoluxSegment& of, const glm::dvec2& p) {
        const glm::dvec2 along = of.to_m - of.from_m;
        return along.x * (p.y - of.from_m.y) - along.y * (p.x - of.from_m.x);
      };
      const bool crosses = side(line[i], line[k].from_m) * side(line[i], line[k].to_m) < -1e-12 &&
                           side(line[k], line[i].from_m) * side(line[k], line[i].to_m) < -1e-12;
      EXPECT_FALSE(crosses) << i << ' ' << k;
    }
  }
}

TEST(Isolux, ScatteredSensorsAreNoLattice) {
  SensorGrid grid;
  grid.points = {{0, 0, 1}, {0.5, 0, 1}, {0.73, 0.41, 1}};
  EXPECT_TRUE(latticeOf(grid, 0.5).sensors.empty());
  grid.points = {{0, 0, 1}, {1e9, 0, 1}};
  EXPECT_TRUE(latticeOf(grid, 0.001).sensors.empty());
  EXPECT_TRUE(latticeOf({}, 0.5).sensors.empty());
}

TEST(Section, RunsIntoTheDepthOfTheRoom) {
  const fake::Case made = fake::office();  // its light falls off with y
  const std::string chart = sectionChart(made.input(), 0, planScale(made.solution));
  EXPECT_NE(chart.find("Illuminance along x ="), std::string::npos);
}

TEST(Section, LivesWithoutSensors) {
  fake::Case made = fake::office();
  made.building.grids[0].points.clear();
  made.solution.grids[0].sensors.clear();
  EXPECT_TRUE(sectionChart(made.input(), 0, planScale(made.solution)).empty());
}

}  // namespace
}  // namespace clerestory
