// SPDX-License-Identifier: GPL-3.0-or-later
// Division of elements: halves add up, stay convex and plump, have keys of their own, and a point finds its
// leaf.
#include "hierarchy.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include <geometry/sampling.hpp>

#include "../scenes.hpp"

namespace clerestory {
namespace {

using namespace drawn;

// A convex polygon with corners on an ellipse, in a plane through `centre`.
ElementShape convexShape(std::mt19937& random) {
  const auto unit = [&] { return static_cast<float>(random()) * 0x1p-32F; };
  const auto corners = 3U + random() % 6U;
  std::vector<float> angles;
  for (unsigned i = 0; i < corners; ++i) {
    angles.push_back(2.0F * std::numbers::pi_v<float> * (static_cast<float>(i) + 0.8F * unit()) /
                     static_cast<float>(corners));
  }
  const glm::vec3 normal = cosineDirection({0, 0, 1}, unit(), unit());
  glm::vec3 u;
  glm::vec3 v;
  tangentFrame(normal, u, v);
  const float wide = 0.2F + 3.0F * unit();
  const float high = 0.2F + 3.0F * unit();
  ElementShape shape;
  for (const float angle : angles)
    shape.corners.push_back(wide * std::cos(angle) * u + high * std::sin(angle) * v);
  for (const glm::vec3& corner : shape.corners) shape.centre += corner / static_cast<float>(corners);
  for (const glm::vec3& corner : shape.corners) {
    shape.radius_m = std::max(shape.radius_m, glm::length(corner - shape.centre));
  }
  return shape;
}

glm::vec3 areaVector(const std::vector<glm::vec3>& corners) {
  glm::vec3 sum(0.0F);
  for (std::size_t i = 2; i < corners.size(); ++i) {
    sum += 0.5F * glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
  }
  return sum;
}

// How far a point lies outside a convex polygon, in its plane. [m]
float outside_m(const glm::vec3& point, std::span<const glm::vec3> polygon, const glm::vec3& normal) {
  float most = 0.0F;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const glm::vec3 edge = polygon[i] - polygon[j];
    if (glm::length(edge) < 1e-6F) continue;
    most = std::max(most, -glm::dot(glm::normalize(glm::cross(normal, edge)), point - polygon[j]));
  }
  return most;
}

// Corners of cuts are rounded to float, some 1e-7 of metres; five divisions add a few of these.
constexpr float rounding_m = 3e-6F;

class Division {
 public:
  void divide(const ElementShape& shape, const glm::vec3& normal, int depth) {
    EXPECT_TRUE(keys_.insert(shape.key).second) << "two elements with key " << std::hex << shape.key;
    expectConvex(shape, normal);
    if (depth == 0) return;
    const Halves halves = halve(shape, normal);
    // The second's is the difference to the first's, so that their sum is off by one rounding of a float at
    // most.
    EXPECT_NEAR(halves.first.area_m2 + halves.second.area_m2, shape.area_m2, 1.2e-7F * shape.area_m2);
    EXPECT_NEAR(halves.first.weight + halves.second.weight, shape.weight, 1.2e-7F * shape.weight);
    for (const ElementShape& half : {halves.first, halves.second}) {
      EXPECT_GT(half.area_m2, 0.0F);
      // They are the areas of the polygons drawn, but for the rounding of corners.
      EXPECT_NEAR(half.area_m2, glm::length(areaVector(half.corners)), 1e-5F * shape.area_m2 + 1e-6F);
      EXPECT_LT(half.radius_m, shape.radius_m * 1.0001F);
      for (const glm::vec3& corner : half.corners) {
        EXPECT_LE(outside_m(corner, shape.corners, normal), rounding_m);
        EXPECT_LE(glm::length(corner - half.centre), half.radius_m * 1.00001F);
      }
      const float height = glm::dot(glm::vec3(halves.plane), half.centre) + halves.plane.w;
      EXPECT_EQ(height > 0.0F, half.key == halves.second.key);
    }
    divide(halves.first, normal, depth - 1);
    divide(halves.second, normal, depth - 1);
  }

 private:
  static void expectConvex(const ElementShape& shape, const glm::vec3& normal) {
    ASSERT_GE(shape.corners.size(), 3U);
    for (const glm::vec3& corner : shape.corners)
      EXPECT_LE(outside_m(corner, shape.corners, normal), rounding_m);
    EXPECT_GT(glm::dot(areaVector(shape.corners), normal), 0.0F);
  }
  std::set<std::uint64_t> keys_;
};

TEST(Halve, HalvesAddUpAndStayConvex) {
  std::mt19937 random(7);
  for (int i = 0; i < 60; ++i) {
    ElementShape shape = convexShape(random);
    const glm::vec3 normal = glm::normalize(areaVector(shape.corners));
    shape.area_m2 = glm::length(areaVector(shape.corners));
    shape.weight = 0.37F * shape.area_m2;
    shape.key = std::uint64_t{5} << 32U | 1U;
    Division().divide(shape, normal, 5);
  }
}

TEST(Halve, SquareStaysPlump) {
  ElementShape square;
  square.corners = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  square.centre = {0.5F, 0.5F, 0.0F};
  square.radius_m = std::sqrt(0.5F);
  square.area_m2 = square.weight = 1.0F;
  const Halves first = halve(square, {0, 0, 1});
  const Halves second = halve(first.first, {0, 0, 1});
  EXPECT_FLOAT_EQ(second.first.area_m2, 0.25F);
  EXPECT_NEAR(second.first.radius_m, std::sqrt(0.125F), 1e-6F);  // a square again
}

// The sides that look inwards in a box with a cabinet.
struct Tree {
  Building building;
  Hierarchy hierarchy;
};

Tree boxTree() {
  Drawing drawing;
  addBox(drawing, {0, 0, 0}, {4, 3, 3});
  addBox(drawing, {1, 1, 0.5}, {2, 1.5, 1.5}, wood, 1);
  Building building = buildingOf(drawing.scene);
  std::vector<std::uint32_t> sides;
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
    if (building.sideDomain[side] == building.rooms.at(0).domain) sides.push_back(side);
  }
  Hierarchy hierarchy(building.model.pieces, sides, {2, 1.5, 1.5}, {});
  return {std::move(building), std::move(hierarchy)};
}

TEST(Hierarchy, TrunkAddsUp) {
  const Tree tree = boxTree();
  const Hierarchy& hierarchy = tree.hierarchy;
  ASSERT_EQ(hierarchy.sides.size(), 12U);
  EXPECT_EQ(hierarchy.trunkSize(), 2 * 12U - 1U);
  EXPECT_TRUE(hierarchy.isCluster(0));
  EXPECT_NEAR(hierarchy.area_m2[0], 66.0F + 4.0F, 1e-4F);
  std::set<std::uint64_t> keys;
  for (NodeIndex node = 0; node < hierarchy.size(); ++node) {
    EXPECT_TRUE(keys.insert(hierarchy.key[node]).second);
    if (hierarchy.isLeaf(node)) continue;
    const NodeIndex child = hierarchy.firstChild[node];
    EXPECT_GT(child, node);
    EXPECT_NEAR(hierarchy.area_m2[node], hierarchy.area_m2[child] + hierarchy.area_m2[child + 1],
                1e-6F * hierarchy.area_m2[node]);
    for (const NodeIndex own : {child, child + 1}) {
      const float reach = glm::length(hierarchy.centre[own] - hierarchy.centre[node]);
      EXPECT_LE(reach, hierarchy.radius_m[node] * 1.0001F);
    }
  }
}

// Divides leaves by chance.
void grow(Hierarchy& hierarchy, int divisions, std::mt19937& random) {
  for (int i = 0; i < divisions; ++i) {
    std::vector<NodeIndex> leaves;
    for (NodeIndex node = 0; node < hierarchy.size(); ++node) {
      if (hierarchy.isLeaf(node)) leaves.push_back(node);
    }
    const NodeIndex parent = leaves[random() % leaves.size()];
    const Halves halves = halve(hierarchy.shape(parent), hierarchy.normal(parent));
    const NodeIndex child = hierarchy.divide(parent, halves.first, halves.second, halves.plane);
    EXPECT_FLOAT_EQ(hierarchy.area_m2[child] + hierarchy.area_m2[child + 1], hierarchy.area_m2[parent]);
  }
}

TEST(Hierarchy, LeavesOfSpotsAreKnownAsItGrows) {
  Tree tree = boxTree();
  Hierarchy& hierarchy = tree.hierarchy;
  std::mt19937 random(5);
  for (int round = 0; round < 3; ++round) {
    grow(hierarchy, 100, random);
    hierarchy.findSpotLeaves();
    ASSERT_EQ(hierarchy.spotLeaves.size(), hierarchy.size());
    for (NodeIndex node = 0; node < hierarchy.size(); ++node) {
      for (std::size_t s = 0; s < spotsOfNode; ++s) {
        const NodeIndex leaf = hierarchy.spotLeaves[node][s];
        EXPECT_TRUE(hierarchy.isLeaf(leaf));
        EXPECT_EQ(hierarchy.normal(leaf), hierarchy.spotNormal(node, s));
        EXPECT_LE(outside_m(hierarchy.spots[node][s], hierarchy.polygon(leaf), hierarchy.normal(leaf)),
                  rounding_m);
      }
    }
  }
}

TEST(Hierarchy, LeafHoldsThePoint) {
  Tree tree = boxTree();
  Hierarchy& hierarchy = tree.hierarchy;
  std::mt19937 random(3);
  grow(hierarchy, 400, random);
  const Sequence sequence(11);
  for (const TreeSide& side : hierarchy.sides) {
    const std::vector<glm::vec3> whole(hierarchy.polygon(side.root).begin(),
                                       hierarchy.polygon(side.root).end());
    for (std::uint32_t i = 0; i < 200; ++i) {
      const glm::vec3 point = pointOnPolygon<glm::vec3>(whole, sequence(i, 0), sequence(i, 1));
      const NodeIndex leaf = hierarchy.leafAt(side.root, point);
      EXPECT_TRUE(hierarchy.isLeaf(leaf));
      EXPECT_EQ(hierarchy.sides[hierarchy.treeSide[leaf]].side, side.side);
      EXPECT_LE(outside_m(point, hierarchy.polygon(leaf), side.normal), rounding_m);
    }
  }
}

// A strip of 3 m x 6 cm is cut along its length where the shorter extent is asked for.
TEST(Halving, CutsTheExtentThatIsAskedFor) {
  const std::vector<glm::vec3> strip = {{0, 0, 0}, {3, 0, 0}, {3, 0.06F, 0}, {0, 0.06F, 0}};
  const glm::vec3 normal(0, 0, 1);
  const ElementShape whole{strip, {1.5F, 0.03F, 0}, 1.5003F, 0.18F, 1.0F, 1};
  const auto half = [&](Extent cut) { return extentsOf(halve(whole, normal, cut).first.corners, normal); };
  EXPECT_FLOAT_EQ(half(Extent::longer).longer_m(), 1.5F);
  EXPECT_FLOAT_EQ(half(Extent::longer).shorter_m(), 0.06F);
  EXPECT_FLOAT_EQ(half(Extent::shorter).longer_m(), 3.0F);
  EXPECT_FLOAT_EQ(half(Extent::shorter).shorter_m(), 0.03F);
}

}  // namespace
}  // namespace clerestory
