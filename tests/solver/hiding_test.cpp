// SPDX-License-Identifier: GPL-3.0-or-later
// What is said to be hidden is met by no ray, and a wall that hides a pane is found.
#include "hiding.hpp"

#include <gtest/gtest.h>

#include <geometry/sampling.hpp>

#include "../scenes.hpp"

namespace clerestory {
namespace {

using namespace drawn;

/// Of points all over a room of 8 × 6 × 3 m: how many see nothing of its pane, and of how many that is said.
struct Hidden {
  int truly = 0, said = 0;
};

Hidden hiddenIn(const Drawing& drawing) {
  const Study study;
  const Building building = buildingOf(drawing.scene);
  const World world(building, study);
  EXPECT_EQ(building.portals.size(), 1U);
  const auto pane = world.polygon(building.portals[0].piece);
  Hidden hidden;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const Sequence place(mixKey(i));
    const glm::vec3 from =
        world.local({8.0 * static_cast<double>(place(0, 0)), 6.0 * static_cast<double>(place(0, 1)),
                     3.0 * static_cast<double>(place(0, 2))});
    bool seesSome = false;
    for (std::uint32_t ray = 0; ray < 500 && !seesSome; ++ray) {
      const glm::vec3 to = pointOnPolygon<glm::vec3>(pane, place(ray, 0), place(ray, 1));
      seesSome = !world.rays.occluded(from, to, RayScene::Barrier::opaque);
    }
    const bool isSaid = isBehindOnePiece(world, from, pane);
    hidden.truly += seesSome ? 0 : 1;
    hidden.said += isSaid ? 1 : 0;
    EXPECT_FALSE(isSaid && seesSome) << "point " << i;
  }
  return hidden;
}

Drawing room() {
  Drawing drawing;
  addRoomWithPane(drawing, {0, 0, 0}, {8, 6, 3}, {1, 0.9, 7, 2.4});
  return drawing;
}

TEST(Hiding, NothingHidesThePaneOfAnEmptyRoom) {
  const Hidden hidden = hiddenIn(room());
  EXPECT_EQ(hidden.truly, 0);
  EXPECT_EQ(hidden.said, 0);
}

TEST(Hiding, AWallIsFoundBehindWhatStandsBeforeIt) {
  Drawing drawing = room();
  addBox(drawing, {0, 3, 0}, {6, 3.1, 3});
  addBox(drawing, {0.5, 3.4, 0.1}, {5, 3.6, 1.8}, wood);  // a bookcase, which rays to the pane meet first
  const Hidden hidden = hiddenIn(drawing);
  EXPECT_GT(hidden.truly, 500);
  EXPECT_GT(hidden.said, 9 * hidden.truly / 10);
}

// Through a gap of 5 cm points see little of the pane, but some.
TEST(Hiding, AWallWithAGapHidesNothingBesideIt) {
  Drawing drawing = room();
  addBox(drawing, {0.05, 3, 0.05}, {7.95, 3.1, 2.95});
  const Hidden hidden = hiddenIn(drawing);
  EXPECT_GT(hidden.said, 0);
  EXPECT_LE(hidden.said, hidden.truly);
}

}  // namespace
}  // namespace clerestory
