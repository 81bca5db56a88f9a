// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of a lit room: every pixel of it has light.
#include <cmath>

#include "solved.hpp"

namespace clerestory {
namespace {

TEST(View, NoPixelOfALitRoomIsBlackOrNoNumber) {
  Study study;
  ViewSettings view;
  view.eye_m = {1.8, 7.6, 1.6};
  view.target_m = {1.8, 0.0, 1.2};
  view.size_px = {160, 90};
  study.views = {view};
  const Building building = drawn::buildingOf(testModel("reference/furnished/furnished.obj", study), study);
  const Solution solution = solve(building, study, {});
  ASSERT_EQ(solution.views.size(), 1U);
  const LuminanceImage& image = solution.views[0];
  ASSERT_EQ(image.pixels_cd_m2.size(), 160U * 90U);
  std::size_t dark = 0;
  for (const glm::vec3& pixel : image.pixels_cd_m2) {
    ASSERT_TRUE(std::isfinite(pixel.r + pixel.g + pixel.b));
    dark += pixel.g > 0.1F ? 0U : 1U;  // a thousandth of what the walls have
  }
  EXPECT_LT(dark, image.pixels_cd_m2.size() / 500);  // gaps between books may be
}

}  // namespace
}  // namespace clerestory
