// SPDX-License-Identifier: GPL-3.0-or-later
// What panes mirror outdoors: a shutter close before a pane sees itself in it.
#include "mirrored.hpp"

#include <gtest/gtest.h>

#include "../scenes.hpp"

namespace clerestory {
namespace {

constexpr float gap_m = 0.01F;

/// A room with a pane of 3 x 2 m, and a shutter of its size 1 cm before it.
struct Shutter {
  Building building;
  World world;
  Hierarchy tree;
  Unshot<1> unshot;
  std::vector<std::uint32_t> treeSideOf;

  Shutter()
      : building([] {
          drawn::Drawing drawing;
          drawn::addRoomWithPane(drawing, {0, 0, 0}, {4, 6, 3}, {0.5, 0.5, 3.5, 2.5});
          drawing.face(drawn::upright(0.5, 0.5, 3.5, 2.5, static_cast<double>(-gap_m)), drawn::wood);
          return drawn::buildingOf(drawing.scene);
        }()),
        world(building, Study{}),
        tree(world.pieces(), outsideOf(building), world.rays.origin(), {}),
        treeSideOf(2 * world.pieces().size(), noNode) {
    for (std::uint32_t i = 0; i < tree.sides.size(); ++i) treeSideOf[tree.sides[i].side] = i;
    unshot.resize(tree.size());
    for (NodeIndex node = 0; node < tree.size(); ++node) unshot.radiosity_lm_m2[node][0] = 1.0F;
  }

  static std::vector<std::uint32_t> outsideOf(const Building& building) {
    std::vector<std::uint32_t> sides;
    for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
      const std::int32_t domain = building.sideDomain[side];
      if (domain >= 0 && building.domains[static_cast<std::size_t>(domain)].open) sides.push_back(side);
    }
    return sides;
  }

  /// The shutter's side that looks along a direction.
  [[nodiscard]] NodeIndex side(const glm::vec3& direction) const {
    for (const TreeSide& own : tree.sides) {
      const auto polygon = tree.polygon(own.root);
      const double y = static_cast<double>(polygon[0].y) + world.rays.origin().y;
      if (y < -0.5 * static_cast<double>(gap_m) && glm::dot(own.normal, direction) > 0.9F &&
          y > -1.5 * static_cast<double>(gap_m))
        return own.root;
    }
    return noNode;
  }

  /// On a square of 2 cm in the middle of an element, far from its edges.
  [[nodiscard]] float mirrored_lx(NodeIndex element) const {
    Receiver middle = receiverOf(tree, element);
    std::vector<glm::vec3> corners;
    for (const glm::vec3& corner : middle.corners)
      corners.push_back(middle.centre + 0.01F * (corner - middle.centre));
    middle.corners = corners;
    Columns<1> incoming_lx;
    receiveMirrored<1>(world, tree, unshot, treeSideOf, middle, 20000, incoming_lx);
    return incoming_lx[0];
  }
};

// So close that it sees nothing else: what it sends comes back by the pane's hemispherical reflectance.
// 20,000 rays tell that to some tenths of a per cent.
TEST(LightOverPanes, ShutterGetsItsOwnLightBack) {
  const Shutter shutter;
  const NodeIndex inner = shutter.side({0, 1, 0});
  ASSERT_NE(inner, noNode);
  std::uint32_t pane = 0;
  while (!shutter.world.isMirror(pane)) ++pane;
  const auto reflectance = static_cast<float>(shutter.world.reflectanceOf(pane).g);
  ASSERT_GT(reflectance, 0.1F);
  EXPECT_NEAR(shutter.mirrored_lx(inner), reflectance, 0.01F * reflectance);
}

TEST(LightOverPanes, WhatFacesNoPaneGetsNone) {
  const Shutter shutter;
  const NodeIndex outer = shutter.side({0, -1, 0});
  ASSERT_NE(outer, noNode);
  EXPECT_EQ(shutter.mirrored_lx(outer), 0.0F);
}

}  // namespace
}  // namespace clerestory
