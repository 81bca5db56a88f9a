// SPDX-License-Identifier: GPL-3.0-or-later
// The furnace: where every surface sends 1 lm/m2 and reflects the same, every step and the end are known in
// closed form.
#include "solved.hpp"

namespace clerestory {
namespace {

using namespace drawn;

// Up to 200 steps are taken in a bright furnace, so it is solved at the standard accuracy.
double accuracyAt(double reflectance) {
  return reflectance > 0.9 ? 0.05 : 0.02;
}

// Rows of the surfaces' table in the furnace.
constexpr std::uint32_t shell = 0, furniture = 1;

// A room of 5 x 4 x 3 m with two cabinets, a tilted board and 25 small boxes, 150 polygons, so that clusters
// are in use. All hangs in the air, since a face that stands on another would part it into seen and unseen
// elements.
Drawing furnaceRoom(double reflectance) {
  Drawing drawing;
  addBox(drawing, {0, 0, 0}, {5, 4, 3}, plaster, shell);
  addBox(drawing, {0.3, 0.4, 0.2}, {1.3, 0.9, 1.4}, plaster, furniture);
  addBox(drawing, {3.4, 2.9, 0.3}, {4.6, 3.6, 1.1}, plaster, furniture);
  drawing.face({{2.0, 1.0, 0.8}, {3.2, 1.2, 0.9}, {3.0, 2.0, 1.6}, {1.8, 1.8, 1.5}}, plaster, furniture);
  const std::uint32_t clutter = addObject(drawing, "clutter");
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 5; ++column) {
      const glm::dvec3 low(0.4 + 0.30 * column, 2.4 + 0.04 * row, 0.6 + 0.34 * row);
      addBox(drawing, low, low + glm::dvec3(0.16, 0.10, 0.2), plaster, clutter);
    }
  }
  drawing.scene.materials[plaster].reflectance = glm::dvec3(reflectance);
  drawing.scene.materials[plaster].exitance_lm_m2 = glm::dvec3(1.0);
  return drawing;
}

constexpr double kFurnaceArea_m2 = 94.0                                                // room
                                   + 2 * (0.5 + 0.6 + 1.2) + 2 * (0.84 + 0.56 + 0.96)  // cabinets
                                   + 25 * 2 * (0.016 + 0.02 + 0.032);  // clutter; the board comes on top

double boardArea_m2() {
  return 2.0 * glm::length(glm::cross(glm::dvec3(1.2, 0.2, 0.1),
                                      glm::dvec3(-0.2, 0.8, 0.7)));  // seen from both sides
}

// Views are closed at every leaf, so every element gets what it sends; only float sums over the steps are
// left.
constexpr double kElementTolerance = 1e-4;

// Solves a furnace of known surface and checks what every step leaves and where it ends.
void expectFurnace(const Drawing& drawing, double reflectance, double area_m2, double defectMost) {
  Study study;
  study.accuracy = accuracyAt(reflectance);
  const Solved furnace = solved(drawing.scene, study);
  ASSERT_EQ(furnace.building.rooms.size(), 1U);
  const std::int32_t room = furnace.building.rooms[0].domain;

  // What step k leaves is area x reflectance^k. Received power is scaled to what was shot, so that only sums
  // in float over some ten thousand elements are left.
  int steps = 0;
  for (const IterationStatistics& row : furnace.solution.iterations) {
    if (row.domain != room || row.unshotPower_lm == 0.0) continue;
    ++steps;
    const double left_lm = area_m2 * std::pow(reflectance, row.iteration);
    EXPECT_NEAR(row.unshotPower_lm, left_lm, 1e-4 * left_lm) << "after step " << row.iteration;
  }
  EXPECT_GE(steps, 3);

  // In the end every place has E = 1 / (1 - reflectance).
  const double expected_lx = 1.0 / (1.0 - reflectance);
  double seen_m2 = 0.0;
  double mean = 0.0;
  for (const SurfaceValue& row : furnace.solution.surfaces) {
    if (row.room != 0) continue;
    seen_m2 += row.area_m2;
    mean += row.area_m2 * row.illuminanceMean_lx / expected_lx / area_m2;
    const std::string& name = furnace.building.model.surfaces[row.surface].name;
    const double own = row.illuminanceMean_lx / expected_lx;
    const double least = row.illuminanceMin_lx / expected_lx;
    const double most = row.illuminanceMax_lx / expected_lx;
    std::cout << name << ": " << row.elements << " elements, of what is known the mean has " << own
              << ", the least " << least << ", the most " << most << '\n';
    EXPECT_NEAR(own, 1.0, kElementTolerance) << name;
    EXPECT_NEAR(least, 1.0, kElementTolerance) << name;
    EXPECT_NEAR(most, 1.0, kElementTolerance) << name;
  }
  EXPECT_NEAR(seen_m2, area_m2, 1e-5 * area_m2);  // element areas are float
  EXPECT_NEAR(mean, 1.0, kElementTolerance);      // every reflectance is the mean one, so the end is exact
  const EnergyBalance balance = furnace.balanceOf(room);
  std::cout << "mean " << mean << ", unscaled defect " << balance.unscaledDefect << '\n';
  // The links themselves, before views are closed and power is scaled.
  EXPECT_LT(balance.unscaledDefect, defectMost);
}

class Furnace : public testing::TestWithParam<double> {};

// Form factors alone, nothing hides anything: reached 0.4 % when this was written.
TEST_P(Furnace, EmptyRoomIsEven) {
  Drawing drawing;
  addBox(drawing, {0, 0, 0}, {5, 4, 3}, plaster, shell);
  drawing.scene.materials[plaster].reflectance = glm::dvec3(GetParam());
  drawing.scene.materials[plaster].exitance_lm_m2 = glm::dvec3(1.0);
  expectFurnace(drawing, GetParam(), 94.0, 0.01);
}

// With furniture, sampled visibility and clusters.
TEST_P(Furnace, ClutteredRoomIsEven) {
  expectFurnace(furnaceRoom(GetParam()), GetParam(), kFurnaceArea_m2 + boardArea_m2(), 0.04);
}

INSTANTIATE_TEST_SUITE_P(Reflectance, Furnace, testing::Values(0.2, 0.5, 0.8, 0.95, 0.99),
                         [](const auto& info) {
                           return std::to_string(std::lround(100.0 * info.param)) + "Percent";
                         });

}  // namespace
}  // namespace clerestory
