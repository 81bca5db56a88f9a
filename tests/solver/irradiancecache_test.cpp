// SPDX-License-Identifier: GPL-3.0-or-later
// Irradiance between records: even and linear light, and a light that no record has seen.
#include <gtest/gtest.h>
#include <irradiancecache.hpp>

namespace clerestory {
namespace {

const glm::vec3 up(0.0F, 0.0F, 1.0F);

/// 100 lx at the point that is asked about, rising along x and falling along y.
Columns<1> linear(const glm::vec3& way_m) {
  Columns<1> light_lx;
  light_lx[0] = 100.0F + 30.0F * way_m.x - 20.0F * way_m.y;
  return light_lx;
}

TEST(IrradianceCache, OneRecordIsItself) {
  IrradianceFit<1> fit(up);
  fit.add(0.4F, {0.3F, 0.2F, 0.0F}, 1.0F, linear({0.3F, 0.2F, 0.0F}));
  EXPECT_FLOAT_EQ(fit.value()[0], linear({0.3F, 0.2F, 0.0F})[0]);
}

// Most of the records lie to one side, so that their mean is 18 lx too bright. The slope is tied to none by
// 0.05 of their squared radii, 0.8 m², beside their spread along x of 7.2 m²: it comes out a tenth too flat.
TEST(IrradianceCache, LinearLightIsCarriedOn) {
  IrradianceFit<1> fit(up);
  for (const float x : {-0.3F, 0.3F, 0.9F, 1.5F}) {
    for (const float y : {-0.9F, -0.3F, 0.3F, 0.9F}) fit.add(1.0F, {x, y, 0.0F}, 1.0F, linear({x, y, 0.0F}));
  }
  EXPECT_NEAR(fit.value()[0], 100.0F, 0.101F * 18.0F);
}

TEST(IrradianceCache, NothingIsBelowZero) {
  IrradianceFit<1> fit(up);
  Columns<1> dark, bright;
  bright[0] = 100.0F;
  fit.add(1.0F, {0.1F, 0.0F, 0.0F}, 0.1F, dark);
  fit.add(1.0F, {1.0F, 0.0F, 0.0F}, 0.1F, bright);
  EXPECT_GE(fit.value()[0], 0.0F);
}

TEST(IrradianceCache, RecordsHoldOnTheirOwnSurfaceAlone) {
  const IrradianceRecord<1> record{{0.0F, 0.0F, 0.0F}, up, 0, 1.0F, {}};
  EXPECT_FLOAT_EQ(record.weightAt(0, {0.0F, 0.0F, 0.0F}, up), 1.0F);
  EXPECT_GT(record.weightAt(0, {0.5F, 0.0F, 0.0F}, up), 0.0F);
  EXPECT_EQ(record.weightAt(0, {1.0F, 0.0F, 0.0F}, up), 0.0F) << "too far";
  EXPECT_EQ(record.weightAt(1, {0.1F, 0.0F, 0.0F}, up), 0.0F) << "another room";
  EXPECT_EQ(record.weightAt(0, {0.1F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}), 0.0F) << "round a corner";
  EXPECT_EQ(record.weightAt(0, {0.1F, 0.0F, 0.5F}, up), 0.0F) << "on a shelf above";
}

}  // namespace
}  // namespace clerestory
