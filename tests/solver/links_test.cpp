// SPDX-License-Identifier: GPL-3.0-or-later
// Links half in shadow: which part of the receiver gets the light, and which part of the sender's light
// comes.
#include <gtest/gtest.h>

#include <solver/formfactor.hpp>

#include "../scenes.hpp"
#include "interaction.hpp"

namespace clerestory {
namespace {

/// A room with a screen across its middle and a panel under the ceiling of its eastern half. The floor runs
/// through beneath the screen and is divided there; the panel sees its eastern half alone.
struct ScreenedRoom {
  Building building;
  World world;
  Hierarchy tree;
  NodeIndex floor, panel;
  Unshot<1> unshot;
  TransportSettings settings;

  ScreenedRoom()
      : building([] {
          drawn::Drawing drawing;
          drawn::addBox(drawing, {0, 0, 0}, {8, 2, 4});
          drawn::addBox(drawing, {3.98, 0, 0.02}, {4.02, 2, 3.7}, drawn::wood, 1);
          drawn::addBox(drawing, {5.5, 0.5, 3.85}, {6.5, 1.5, 3.9}, drawn::wood, 1);
          return drawn::buildingOf(drawing.scene);
        }()),
        world(building, Study{}),
        tree(world.pieces(), lightSides(), world.rays.origin(), {}),
        floor(sideOf({0, 0, 1}, 16.0F)),
        panel(sideOf({0, 0, -1}, 1.0F)) {
    const Halves halves = halve(tree.shape(floor), tree.normal(floor));
    tree.divide(floor, halves.first, halves.second, halves.plane);
    tree.findSpotLeaves();
    unshot.resize(tree.size());
  }

  [[nodiscard]] std::vector<std::uint32_t> lightSides() const {
    std::vector<std::uint32_t> sides;
    for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
      const std::int32_t domain = building.sideDomain[side];
      if (domain >= 0 && !building.domains[static_cast<std::size_t>(domain)].open) sides.push_back(side);
    }
    return sides;
  }
  [[nodiscard]] NodeIndex sideOf(const glm::vec3& direction, float area_m2) const {
    for (const TreeSide& side : tree.sides) {
      if (glm::dot(side.normal, direction) > 0.9F && std::abs(tree.area_m2[side.root] - area_m2) < 0.01F)
        return side.root;
    }
    ADD_FAILURE() << "no side of " << area_m2 << " m²";
    return 0;
  }
  /// The child of the floor that the panel sees, as 0 or 1.
  [[nodiscard]] NodeIndex openChild() const {
    const NodeIndex first = tree.firstChild[floor];
    return tree.centre[first].x > tree.centre[first + 1].x ? 0U : 1U;
  }
  void light(NodeIndex node, float radiosity_lm_m2, float lowest, float highest) {
    unshot.radiosity_lm_m2[node][0] = unshot.strength[node] = radiosity_lm_m2;
    unshot.lowest[node] = lowest;
    unshot.highest[node] = highest;
  }
  [[nodiscard]] float formFactor(NodeIndex receiver, NodeIndex sender) const {
    return meanFormFactor(tree.polygon(receiver), tree.normal(receiver), tree.area_m2[receiver],
                          tree.polygon(sender), tree.normal(sender));
  }
  /// What the link between two nodes brings, computed, and once more with its visibility from the cache.
  [[nodiscard]] std::array<Incoming<1>, 2> received(NodeIndex receiver, NodeIndex sender) const {
    const std::vector<Columns<1>> exitance(tree.sides.size());
    const Interactions<1> interactions(world, tree, unshot, exitance, settings);
    const Receiver end = receiverOf(tree, receiver);
    Link link = interactions.measureLink(end, sender);
    std::array<Incoming<1>, 2> incoming;
    RayBatch batch;
    Tally tally;
    for (const bool isKnown : {false, true}) {
      Candidate<1> candidate;
      candidate.sender = sender;
      candidate.link = link;
      candidate.isKnown = isKnown;
      interactions.castRays(end, std::span(&candidate, 1), batch, tally);
      interactions.add(incoming[isKnown ? 1 : 0], end, candidate);
      link = candidate.link;
    }
    return incoming;
  }
};

// What share of a link is in shadow its few rays tell roughly; whose it is they tell well.
constexpr float roughly = 0.5F;

TEST(Links, AReceiverHalfBehindAScreenGetsAllLightOnItsOpenHalf) {
  ScreenedRoom room;
  room.light(room.panel, 100.0F, 100.0F, 100.0F);
  const NodeIndex open = room.openChild();
  const NodeIndex openNode = room.tree.firstChild[room.floor] + open;
  const float true_lx = 100.0F * room.formFactor(openNode, room.panel);
  for (const Incoming<1>& incoming : room.received(room.floor, room.panel)) {
    EXPECT_NEAR(incoming.ofChildren[open].irradiance_lx[0], true_lx, roughly * true_lx);
    EXPECT_NEAR(incoming.ofChildren[open].view, 0.01F * incoming.ofChildren[open].irradiance_lx[0], 1e-6F);
    EXPECT_EQ(incoming.ofChildren[1 - open].irradiance_lx[0], 0.0F);
    EXPECT_EQ(incoming.own.irradiance_lx[0], 0.0F);
  }
}

TEST(Links, OfASenderHalfBehindAScreenTheHalfInSightSends) {
  ScreenedRoom room;
  const NodeIndex open = room.openChild();
  const NodeIndex openNode = room.tree.firstChild[room.floor] + open;
  const NodeIndex hiddenNode = room.tree.firstChild[room.floor] + 1 - open;
  const float trueView = room.formFactor(room.panel, openNode);
  room.light(room.floor, 50.0F, 0.0F, 100.0F);
  room.light(openNode, 100.0F, 100.0F, 100.0F);
  room.light(hiddenNode, 0.0F, 0.0F, 0.0F);
  for (const Incoming<1>& incoming : room.received(room.panel, room.floor)) {
    EXPECT_NEAR(incoming.own.view, trueView, roughly * trueView);
    // All light of the sender comes through, whatever share of the way is open.
    EXPECT_NEAR(incoming.own.irradiance_lx[0], 100.0F * trueView, 0.15F * 100.0F * trueView);
  }
  room.light(openNode, 0.0F, 0.0F, 0.0F);
  room.light(hiddenNode, 100.0F, 100.0F, 100.0F);
  for (const Incoming<1>& incoming : room.received(room.panel, room.floor))
    EXPECT_NEAR(incoming.own.irradiance_lx[0], 0.0F, 0.15F * 100.0F * trueView);
}

}  // namespace
}  // namespace clerestory
