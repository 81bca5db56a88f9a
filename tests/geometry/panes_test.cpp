// SPDX-License-Identifier: GPL-3.0-or-later
// Panes drawn as solids or as several sheets count once.
#include <gtest/gtest.h>

#include "drawn.hpp"

namespace clerestory {
namespace {

using namespace drawn;

TEST(Panes, SolidPaneBecomesOneSheet) {
  for (const double thickness_m : {0.0025, 0.02}) {  // a cabinet's or a door's, and a unit
    Drawing drawing;
    for (const Outline& side : box({0, 0, 0}, {1.2, thickness_m, 1.5})) drawing.fan(side, 0, 1);
    const CleanModel model = cleanScene(drawing.scene);
    ASSERT_EQ(model.pieces.size(), 1U);
    EXPECT_NEAR(model.pieces.area_m2[0], 1.8, 1e-12);
    EXPECT_EQ(model.counts.paneSheetsDropped, 5U);
    EXPECT_EQ(model.pieces.points[0].y, 0.0);
  }
}

TEST(Panes, FourSheetsBecomeOne) {
  for (const double turn : {0.0, 0.5}) {
    Drawing drawing;
    for (const double y : {0.0, 0.004, 0.016, 0.02}) {
      Outline sheet = upright(0, 0, 1, 1, y);
      for (glm::dvec3& p : sheet) {
        p = {std::cos(turn) * p.x - std::sin(turn) * p.y, std::sin(turn) * p.x + std::cos(turn) * p.y, p.z};
      }
      drawing.face(sheet, 1);
    }
    EXPECT_EQ(cleanScene(drawing.scene).pieces.size(), 1U);
  }
}

TEST(Panes, OneSheetInTwoHalvesStandsForTheUnit) {
  Drawing drawing;
  drawing.face(upright(0, 0, 1, 2, 0.0), 1, 0);
  drawing.face(upright(1, 0, 2, 2, 0.0), 1, 1);
  drawing.face(upright(0, 0, 2, 2, 0.02), 1, 0);
  EXPECT_DOUBLE_EQ(totalArea_m2(cleanScene(drawing.scene)), 4.0);
}

TEST(Panes, SashesThatPassEachOtherStay) {
  Drawing drawing;
  drawing.face(upright(0, 0, 1, 1, 0.0), 1);
  drawing.face(upright(0.9, 0, 1.9, 1, 0.03), 1);
  EXPECT_EQ(cleanScene(drawing.scene).pieces.size(), 2U);
}

TEST(Panes, SheetsFarApartAndOpaqueSheetsStay) {
  Drawing apart;
  apart.face(upright(0, 0, 1, 1, 0.0), 1);
  apart.face(upright(0, 0, 1, 1, 0.1), 1);
  EXPECT_EQ(cleanScene(apart.scene).pieces.size(), 2U);
  Drawing opaque;
  opaque.face(upright(0, 0, 1, 1, 0.0));
  opaque.face(upright(0, 0, 1, 1, 0.02));
  EXPECT_EQ(cleanScene(opaque.scene).pieces.size(), 2U);
}

TEST(Panes, GlassAcrossACornerStays) {
  Drawing drawing;  // two solid panes that meet at a right angle
  for (const Outline& side : box({0, 0, 0}, {1, 0.02, 1})) drawing.face(side, 1, 0);
  for (const Outline& side : box({1, 0, 0}, {1.02, 1, 1})) drawing.face(side, 1, 1);
  EXPECT_NEAR(totalArea_m2(cleanScene(drawing.scene)), 2.0, 1e-9);
}

}  // namespace
}  // namespace clerestory
