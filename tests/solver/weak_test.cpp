// SPDX-License-Identifier: GPL-3.0-or-later
// Weak light by rays against exact form factors: of senders in the list alone, whole sides and parts of them.
#include "weak.hpp"

#include <gtest/gtest.h>

#include <solver/formfactor.hpp>

#include "../scenes.hpp"

namespace clerestory {
namespace {

/// A closed box room whose floor is divided once and whose six sides have radiosities of their own.
struct BoxRoom {
  Building building;
  World world;
  Hierarchy tree;
  Unshot<1> unshot;
  std::vector<std::uint32_t> treeSideOf;

  BoxRoom()
      : building([] {
          drawn::Drawing drawing;
          drawn::addBox(drawing, {0, 0, 0}, {4, 3, 2.5});
          return drawn::buildingOf(drawing.scene);
        }()),
        world(building, Study{}),
        tree(world.pieces(), insideOf(building), world.rays.origin(), {}),
        treeSideOf(2 * world.pieces().size(), noNode) {
    const NodeIndex floor = sideThatLooks({0, 0, 1});
    const Halves halves = halve(tree.shape(floor), tree.normal(floor));
    tree.divide(floor, halves.first, halves.second, halves.plane);
    for (std::uint32_t i = 0; i < tree.sides.size(); ++i) treeSideOf[tree.sides[i].side] = i;
    unshot.resize(tree.size());
    for (NodeIndex node = 0; node < tree.size(); ++node)
      unshot.radiosity_lm_m2[node][0] = 1.0F + static_cast<float>(node);
  }

  static std::vector<std::uint32_t> insideOf(const Building& building) {
    std::vector<std::uint32_t> sides;
    for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
      const std::int32_t domain = building.sideDomain[side];
      if (domain >= 0 && !building.domains[static_cast<std::size_t>(domain)].open) sides.push_back(side);
    }
    return sides;
  }

  [[nodiscard]] NodeIndex sideThatLooks(const glm::vec3& direction) const {
    for (const TreeSide& side : tree.sides) {
      if (glm::dot(side.normal, direction) > 0.9F) return side.root;
    }
    return noNode;
  }

  [[nodiscard]] Received<1> received(NodeIndex receiver, std::vector<NodeIndex> senders) const {
    Incoming<1> incoming;
    receiveFromWeak<1>(world, tree, unshot, treeSideOf, receiverOf(tree, receiver), senders, 20000, incoming);
    Received<1> sum = incoming.own;
    if (tree.isLeaf(receiver)) return sum;
    const float share = tree.area_m2[tree.firstChild[receiver]] / tree.area_m2[receiver];
    sum += share * incoming.ofChildren[0];
    sum += (1.0F - share) * incoming.ofChildren[1];
    return sum;
  }
  [[nodiscard]] float formFactor(NodeIndex receiver, NodeIndex sender) const {
    return meanFormFactor(tree.polygon(receiver), tree.normal(receiver), tree.area_m2[receiver],
                          tree.polygon(sender), tree.normal(sender));
  }
};

// 20,000 even rays tell a share of the view to some thousandths.
constexpr float tolerance = 0.005F;

TEST(LightOfWeak, SidesAndPartsOfSidesBringTheirFormFactors) {
  const BoxRoom room;
  ASSERT_EQ(room.tree.sides.size(), 6U);
  const NodeIndex ceiling = room.sideThatLooks({0, 0, -1});
  const NodeIndex wall = room.sideThatLooks({1, 0, 0});
  const NodeIndex floor = room.sideThatLooks({0, 0, 1});
  const NodeIndex half = room.tree.firstChild[floor] + 1;

  const Received<1> fromWall = room.received(ceiling, {wall});
  EXPECT_NEAR(fromWall.view, room.formFactor(ceiling, wall), tolerance);
  EXPECT_NEAR(fromWall.irradiance_lx[0], fromWall.view * room.unshot.radiosity_lm_m2[wall][0], 1e-3);

  // Of a divided side only the half that was asked for, with its own radiosity.
  const Received<1> fromHalf = room.received(ceiling, {wall, half});
  const float wallsShare = room.formFactor(ceiling, wall);
  const float halfsShare = room.formFactor(ceiling, half);
  EXPECT_NEAR(fromHalf.view, wallsShare + halfsShare, tolerance);
  const float light_lx =
      wallsShare * room.unshot.radiosity_lm_m2[wall][0] + halfsShare * room.unshot.radiosity_lm_m2[half][0];
  EXPECT_NEAR(fromHalf.irradiance_lx[0], light_lx, 0.02F * light_lx);

  // The root holds all sides, and a closed room fills the view.
  EXPECT_NEAR(room.received(ceiling, {0}).view, 1.0F, 1e-4F);
}

TEST(LightOfWeak, AClusterReceivesTheMeanOfItsContents) {
  const BoxRoom room;
  EXPECT_NEAR(room.received(0, {0}).view, 1.0F, 1e-4F);
  // By reciprocity the mean view of a wall from all over the room is its share of the area.
  const NodeIndex wall = room.sideThatLooks({1, 0, 0});
  EXPECT_NEAR(room.received(0, {wall}).view, room.tree.area_m2[wall] / room.tree.area_m2[0], tolerance);
}

}  // namespace
}  // namespace clerestory
