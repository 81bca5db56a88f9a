// SPDX-License-Identifier: GPL-3.0-or-later
// The view that a study without views gets: from inside, over the room, towards its window.
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <geometry/defaultview.hpp>

#include "../scenes.hpp"

namespace clerestory {
namespace {

using namespace drawn;

Study withGrid() {
  Study study;
  study.grids.resize(1);
  return study;
}

TEST(DefaultView, LooksOverTheRoomTowardsItsWindow) {
  Drawing drawing;
  addRoomWithPane(drawing, {0, 0, 0}, {4, 6, 2.8}, {1.0, 0.9, 3.0, 2.2});
  const auto view = defaultView(buildingOf(drawing.scene, withGrid()));
  ASSERT_TRUE(view);
  EXPECT_GT(view->eye_m.x, 0.0);
  EXPECT_LT(view->eye_m.x, 4.0);
  EXPECT_GT(view->eye_m.y, 3.0);  // the window is in the south: from the northern half
  EXPECT_LT(view->eye_m.y, 6.0);
  EXPECT_NEAR(view->eye_m.z, 1.6, 1e-9);
  EXPECT_LT(glm::normalize(view->target_m - view->eye_m).y, -0.7);
}

// A cupboard from floor to ceiling stands before the place that is best without it.
TEST(DefaultView, FindsAPlaceThatIsNotBlocked) {
  Drawing drawing;
  addRoomWithPane(drawing, {0, 0, 0}, {4, 6, 2.8}, {1.0, 0.9, 3.0, 2.2});
  addBox(drawing, {0.01, 4.0, 0.01}, {2.4, 4.6, 2.79}, wood);
  const auto view = defaultView(buildingOf(drawing.scene, withGrid()));
  ASSERT_TRUE(view);
  const glm::dvec3 ahead = glm::normalize(view->target_m - view->eye_m);
  for (double along_m = 0.0; along_m < 0.8; along_m += 0.05) {
    const glm::dvec3 at = view->eye_m + along_m * ahead;
    EXPECT_FALSE(at.x < 2.4 && at.y > 4.0 && at.y < 4.6) << at.x << ' ' << at.y;
  }
}

TEST(DefaultView, IsEmptyWithoutAPlaceToStand) {
  Drawing drawing;
  addBox(drawing, {0, 0, 0}, {4, 6, 2.8});  // no light reaches it
  EXPECT_FALSE(defaultView(buildingOf(drawing.scene, withGrid())));
  EXPECT_FALSE(defaultView(Building{}));
}

}  // namespace
}  // namespace clerestory
