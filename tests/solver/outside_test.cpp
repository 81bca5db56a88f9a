// SPDX-License-Identifier: GPL-3.0-or-later
// The outdoor tree: all blades before a window are looked at and divided across, what faces nothing is not.
#include "outside.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "../scenes.hpp"

namespace clerestory {
namespace {

constexpr double blade_m = 0.06;  // deep

/// A room with a window of 3 x 2 m, before it blades of 60 mm at equal distances.
struct Blades {
  Building building;
  World world;
  Hierarchy tree;

  explicit Blades(int count)
      : building([&] {
          drawn::Drawing drawing;
          drawn::addRoomWithPane(drawing, {0, 0, 0}, {4, 6, 3}, {0.5, 0.5, 3.5, 2.5});
          for (int i = 0; i < count; ++i) {
            const double z = 0.5 + 2.0 * (i + 0.5) / count;
            drawing.face(
                {{0.5, -0.02 - blade_m, z}, {3.5, -0.02 - blade_m, z}, {3.5, -0.02, z}, {0.5, -0.02, z}},
                drawn::wood);
          }
          return drawn::buildingOf(drawing.scene);
        }()),
        world(building, Study{}),
        tree(outsideTree(world, Study{}, openDomain(building), outsideOf(building))) {}

  static std::int32_t openDomain(const Building& building) {
    const auto found =
        std::ranges::find_if(building.domains, [](const Domain& domain) { return domain.open; });
    return static_cast<std::int32_t>(found - building.domains.begin());
  }
  static std::vector<std::uint32_t> outsideOf(const Building& building) {
    std::vector<std::uint32_t> sides;
    for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
      if (building.sideDomain[side] == openDomain(building)) sides.push_back(side);
    }
    return sides;
  }
  /// Sides of blades that face another.
  [[nodiscard]] std::vector<NodeIndex> facingSides() const {
    std::vector<NodeIndex> sides;
    for (const TreeSide& side : tree.sides) {
      const auto polygon = tree.polygon(side.root);
      const bool isBlade = std::ranges::all_of(polygon, [&](const glm::vec3& corner) {
        return static_cast<double>(corner.y) + world.rays.origin().y < -0.01;
      });
      const double z = static_cast<double>(polygon[0].z) + world.rays.origin().z;
      const bool isOutermost = (side.normal.z > 0.0F && z > 2.45) || (side.normal.z < 0.0F && z < 0.55);
      if (isBlade && !isOutermost) sides.push_back(side.root);
    }
    return sides;
  }
  void leavesOf(NodeIndex node, std::vector<NodeIndex>& leaves) const {
    if (tree.isLeaf(node)) {
      leaves.push_back(node);
      return;
    }
    leavesOf(tree.firstChild[node], leaves);
    leavesOf(tree.firstChild[node] + 1, leaves);
  }
};

// 400 sides share 1,024 looks: without more of them each tenth would be left out by chance. At most a
// fiftieth of what is looked at may lie on sides that no look has met.
TEST(OutsideTree, HardlyABladeIsOverlooked) {
  const Blades blades(200);
  const std::vector<NodeIndex> sides = blades.facingSides();
  ASSERT_GT(sides.size(), 380U);
  const auto overlooked =
      std::ranges::count_if(sides, [&](NodeIndex side) { return blades.tree.weight[side] <= 0.0F; });
  EXPECT_LE(static_cast<double>(overlooked), 0.02 * static_cast<double>(sides.size()));
}

// 5 mm apart, blades are cut across their depth until no part is wider than the gap, and every part counts.
TEST(OutsideTree, BladesAreDividedAcrossTheirDepth) {
  const Blades blades(400);
  for (const NodeIndex side : blades.facingSides()) {
    if (blades.tree.weight[side] <= 0.0F) continue;
    EXPECT_TRUE(blades.tree.isOverGap(side));
    std::vector<NodeIndex> leaves;
    blades.leavesOf(side, leaves);
    for (const NodeIndex leaf : leaves) {
      EXPECT_LE(extentsOf(blades.tree.polygon(leaf), blades.tree.normal(leaf)).shorter_m(), 0.005F);
      EXPECT_GT(blades.tree.weight[leaf], 0.0F);
    }
  }
}

// What is further apart than it is deep is no gap.
TEST(OutsideTree, ShelvesFarApartAreNoGap) {
  const Blades shelves(10);
  EXPECT_FALSE(shelves.tree.isOverGap(0));
}

}  // namespace
}  // namespace clerestory
