// SPDX-License-Identifier: GPL-3.0-or-later
// The emitter cube against its reference, and where the light of a room goes.
#include "solved.hpp"

namespace clerestory {
namespace {

// What is emitted is absorbed or leaves; the scaling of received to shot power takes care of that in every
// step, so that a per cent is generous. Before scaling, links should miss less than 1 %, which with
// furniture they do not reach yet.
void expectBalance(const EnergyBalance& balance, double defectMost) {
  const double missing_lm = balance.emitted_lm - balance.absorbed_lm - balance.escaped_lm;
  std::cout << "emitted " << balance.emitted_lm << " lm, missing " << 100.0 * missing_lm / balance.emitted_lm
            << " %, unscaled defect " << 100.0 * balance.unscaledDefect << " %\n";
  EXPECT_GT(balance.emitted_lm, 0.0);
  EXPECT_LE(std::abs(missing_lm), 0.01 * balance.emitted_lm);
  EXPECT_LT(balance.unscaledDefect, defectMost);
}

TEST(Cube, EmitterAgreesWithTheReference) {
  Study study;
  study.materials.push_back({.glob = "emitter",
                             .reflectance = {},
                             .transmittance = {},
                             .panes = {},
                             .exitance_lm_m2 = glm::dvec3(56235.0)});
  const auto reference =
      readReference(std::filesystem::path(CLERESTORY_TEST_DATA) / "reference/cube/cube_emitter.csv");
  study.grids = {drawn::gridOf(placesOf(reference))};
  const Solved cube = solved(testModel("reference/cube/cube.obj", study), study);
  ASSERT_EQ(cube.building.rooms.size(), 1U);
  // The standard accuracy promises 5 % at the 95th percentile; 1.5 % of bias is four of the reference's
  // standard errors.
  const GridErrors errors = measuredErrors("cube", cube.sensors_lx(), valuesOf(reference));
  EXPECT_LT(errors.p95, 0.05);
  EXPECT_LT(std::abs(errors.bias), 0.015);
  const EnergyBalance balance = cube.balanceOf(cube.building.rooms[0].domain);
  EXPECT_NEAR(balance.emitted_lm, 0.16 * 56235.0, 1.0);  // float areas of some 0.1 m2
  EXPECT_EQ(balance.escaped_lm, 0.0);
  expectBalance(balance, 0.01);
}

TEST(Balance, DaylitOfficeKeepsItsLight) {
  for (const double accuracy : {0.05, 0.02}) {
    Study study;
    study.accuracy = accuracy;
    const Solved office = solved(testModel("reference/refoffice/refoffice.obj", study), study);
    ASSERT_EQ(office.building.rooms.size(), 1U);
    const EnergyBalance balance = office.balanceOf(office.building.rooms[0].domain);
    EXPECT_GT(balance.escaped_lm, 0.0);  // back through the window
    expectBalance(balance, 0.01);
    for (const SurfaceValue& row : office.solution.surfaces) EXPECT_GE(row.illuminanceMin_lx, 0.0);
  }
}

TEST(Balance, FurnishedOfficeKeepsItsLight) {
  const Solved office = solved(testModel("reference/furnished/furnished.obj", {}), {});
  ASSERT_EQ(office.building.rooms.size(), 1U);
  expectBalance(office.balanceOf(office.building.rooms[0].domain), 0.01);
  for (const SurfaceValue& row : office.solution.surfaces) EXPECT_GE(row.illuminanceMin_lx, 0.0);
}

}  // namespace
}  // namespace clerestory
