// SPDX-License-Identifier: GPL-3.0-or-later
// Photometric files that others measured, found through CLERESTORY_MODELS.
#include <gtest/gtest.h>

#include <filesystem>

#include <import/photometry.hpp>

namespace clerestory {
namespace {

// 2 x 2,900 lm by 73 x 5 angles, a quarter of the planes, in feet. The flux is a sum over the file's own
// table by another rule (zones of 2.5 degrees between the angles, as its laboratory would do it): 0.5 %.
TEST(FurtherModels, MeasuredLuminaire) {
  const Photometry apex =
      readPhotometry(std::filesystem::path(CLERESTORY_MODELS) / "photometry-radiance" / "examp1.ies");
  EXPECT_EQ(apex.format, "LM-63-1995");
  EXPECT_EQ(apex.name, "251602SN-12EO");
  EXPECT_EQ(apex.lampFlux_lm, 5800.0);
  EXPECT_NEAR(apex.opening.extent_m.x, 4.04 * 0.3048, 1e-9);
  EXPECT_NEAR(apex.opening.extent_m.y, 0.85 * 0.3048, 1e-9);
  EXPECT_NEAR(apex.distribution.intensity({0, 0, -1}), 778.4, 1e-9);
  EXPECT_NEAR(apex.distribution.intensity({0, 0, 1}), 801.4, 1e-9);
  EXPECT_NEAR(apex.distribution.flux_lm(), 5296.3, 0.005 * 5296.3);
}

}  // namespace
}  // namespace clerestory
