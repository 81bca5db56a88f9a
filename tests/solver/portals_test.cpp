// SPDX-License-Identifier: GPL-3.0-or-later
// Light from panes: what few samples bring is, over many seeds, what many samples bring.
#include "portals.hpp"

#include <gtest/gtest.h>

#include <solver/formfactor.hpp>

#include "../scenes.hpp"

namespace clerestory {
namespace {

/// A room with one pane under an overcast sky.
struct PaneRoom {
  Study study;
  Building building;
  World world;
  SolvedLight<1> light;
  std::vector<PortalSender<1>> portals;

  PaneRoom()
      : building([] {
          drawn::Drawing drawing;
          drawn::addRoomWithPane(drawing, {0, 0, 0}, {4, 6, 2.8}, {0.5, 0.9, 3.5, 2.4});
          return drawn::buildingOf(drawing.scene);
        }()),
        world(building, study),
        light(world) {
    for (const Portal& portal : building.portals) {
      if (portals.empty()) portals = portalsOf(light, portal.inside, 1024, false);
    }
  }
};

// On a floor the sky high up counts most and is brightest: a ratio of two means, which go together, is too
// dark.
TEST(Portals, FewSamplesAreNotDarkerThanMany) {
  const PaneRoom room;
  ASSERT_EQ(room.portals.size(), 1U);
  const PortalSender<1>& pane = room.portals[0];
  const glm::vec3 up(0.0F, 0.0F, 1.0F);
  for (const float depth_m : {1.0F, 2.5F, 5.0F}) {
    const glm::vec3 centre = room.world.local({2.0, static_cast<double>(depth_m), 0.0});
    const std::vector<glm::vec3> corners{
        centre + glm::vec3(-0.2F, -0.2F, 0.0F), centre + glm::vec3(0.2F, -0.2F, 0.0F),
        centre + glm::vec3(0.2F, 0.2F, 0.0F), centre + glm::vec3(-0.2F, 0.2F, 0.0F)};
    const auto meanOf = [&](float samples, std::uint64_t seeds) {
      double sum_lx = 0.0;
      for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        Receiver receiver;
        receiver.treeSide = 0;
        receiver.corners = corners;
        receiver.centre = centre;
        receiver.normal = up;
        receiver.radius_m = 0.283F;
        receiver.area_m2 = 0.16F;
        receiver.key = mixKey(seed);
        const PortalSight sight = lookAtPortal(room.light, pane, receiver);
        sum_lx += static_cast<double>(
            elementLightFromPortal(room.light, pane, receiver, sight, samples).illuminance_lx[0]);
      }
      return sum_lx / static_cast<double>(seeds);
    };
    const double many_lx = meanOf(16384.0F, 4);
    // A mean of seeds has a standard error of 0.1 %; ratios of two samples are 0.85 % too dark at 5 m.
    EXPECT_NEAR(meanOf(2.0F, 16384) / many_lx, 1.0, 0.003) << depth_m;
    EXPECT_NEAR(meanOf(8.0F, 4096) / many_lx, 1.0, 0.003) << depth_m;
  }
}

}  // namespace
}  // namespace clerestory
