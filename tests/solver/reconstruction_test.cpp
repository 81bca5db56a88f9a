// SPDX-License-Identifier: GPL-3.0-or-later
// Planes over the elements: exact where light is linear, within what neighbours have where it is not, quiet
// where it is noisy, and never across a screen.
#include "reconstruction.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include <geometry/sampling.hpp>

#include "../scenes.hpp"
#include "neighbours.hpp"

namespace clerestory {
namespace {

using namespace drawn;
using Field = std::function<float(const glm::vec3& point)>;  // local coordinates

/// The sides of a scene that look up, divided by hand and lit by a formula.
class Floor {
 public:
  Floor(const Scene& scene, const std::function<bool(const ElementShape&)>& isDivided)
      : building_(buildingOf(scene)),
        world_(building_, Study{}),
        light_{grown(isDivided), {}, {}, {}, {}, {}} {
    light_.irradiance_lx.resize(tree().size());
  }

  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] const Hierarchy& tree() const { return light_.tree; }
  [[nodiscard]] glm::vec3 local(const glm::dvec3& point) const { return world_.local(point); }
  [[nodiscard]] float mean(NodeIndex leaf) const { return light_.irradiance_lx[leaf][0]; }
  [[nodiscard]] const Plane<1>& plane(NodeIndex leaf) const { return light_.planes[leaf]; }

  [[nodiscard]] std::vector<NodeIndex> leaves() const {
    std::vector<NodeIndex> leaves;
    for (NodeIndex node = 0; node < tree().size(); ++node) {
      if (!tree().isCluster(node) && tree().isLeaf(node)) leaves.push_back(node);
    }
    return leaves;
  }

  /// Each leaf gets what `mean_lx` says at its centroid.
  void light(const Field& mean_lx, float error_lm = 0.0F) {
    for (const NodeIndex leaf : leaves()) light_.irradiance_lx[leaf][0] = mean_lx(tree().centre[leaf]);
    reconstruct<1>(world_, error_lm, light_);
  }

  /// What the reconstruction says of a point of the scene.
  [[nodiscard]] float at(const glm::dvec3& place) const {
    const glm::vec3 point = local(place);
    for (const TreeSide& side : tree().sides) {
      const auto polygon = tree().polygon(side.root);
      bool isOn = true;
      for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const glm::vec3 inward = glm::cross(side.normal, polygon[i] - polygon[j]);
        isOn = isOn && glm::dot(inward, point - polygon[j]) >= 0.0F;
      }
      if (isOn) return light_.irradianceAt(tree().leafAt(side.root, point), point)[0];
    }
    ADD_FAILURE() << "no floor there";
    return 0.0F;
  }

 private:
  Hierarchy grown(const std::function<bool(const ElementShape&)>& isDivided) const {
    std::vector<std::uint32_t> sides;
    for (std::uint32_t side = 0; side < 2 * world_.pieces().size(); ++side) {
      if (world_.normalOf(side).z > 0.5F) sides.push_back(side);
    }
    Hierarchy tree(world_.pieces(), sides, world_.rays.origin(), {});
    for (NodeIndex node = 0; node < tree.size(); ++node) {
      if (tree.isCluster(node) || !tree.isLeaf(node) || !isDivided(tree.shape(node))) continue;
      const Halves halves = halve(tree.shape(node), tree.normal(node));
      tree.divide(node, halves.first, halves.second, halves.plane);
    }
    return tree;
  }

  Building building_;
  World world_;
  Radiosity<1> light_;
};

void addFloor(Drawing& drawing, double x0, double y0, double x1, double y1) {
  drawing.face({{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}});
}

Scene plainFloor() {
  Drawing drawing;
  addFloor(drawing, 0, 0, 4, 3);
  return drawing.scene;
}

// As unevenly as a solve divides: neighbours of up to eight times the area.
bool unevenly(const ElementShape& shape) {
  return shape.radius_m > 0.08F + 0.5F * Sequence(shape.key)(0, 0);
}

bool evenly(const ElementShape& shape) {
  return shape.radius_m > 0.15F;
}

float noiseAt(const glm::vec3& point) {
  const auto hash = [](float v) { return static_cast<std::uint64_t>(std::lround(1e4F * (v + 100.0F))); };
  return 2.0F * Sequence(mixKeys(hash(point.x), hash(point.y)))(0, 0) - 1.0F;  // in [-1, 1)
}

TEST(Reconstruction, LinearLightIsExact) {
  Floor floor(plainFloor(), unevenly);
  const auto linear = [](const glm::vec3& p) { return 500.0F + 80.0F * p.x - 30.0F * p.y; };
  floor.light(linear);
  ASSERT_GT(floor.leaves().size(), 100U);
  for (const NodeIndex leaf : floor.leaves()) {
    for (const glm::vec3& corner : floor.tree().polygon(leaf)) {
      const float own = floor.plane(leaf).at(corner - floor.tree().centre[leaf])[0];
      EXPECT_NEAR(own, linear(corner), 0.005F);  // float's steps are 6e-5 here
    }
  }
}

// Each leaf without noise, each side with it; what is left is rounding.
TEST(Reconstruction, MeansAreKept) {
  Floor floor(plainFloor(), unevenly);
  const auto rough = [](const glm::vec3& p) { return 100.0F + 90.0F * noiseAt(p); };
  floor.light(rough);
  for (const NodeIndex leaf : floor.leaves())
    EXPECT_NEAR(floor.plane(leaf).level_lx[0], floor.mean(leaf), 1e-4F);
  for (const float error_lm : {0.1F, 1.0F, 10.0F}) {
    floor.light(rough, error_lm);
    double solved_lm = 0.0;
    double shown_lm = 0.0;
    for (const NodeIndex leaf : floor.leaves()) {
      solved_lm += static_cast<double>(floor.tree().area_m2[leaf] * floor.mean(leaf));
      shown_lm += static_cast<double>(floor.tree().area_m2[leaf] * floor.plane(leaf).level_lx[0]);
    }
    EXPECT_NEAR(shown_lm, solved_lm, 1e-5 * solved_lm);
  }
}

TEST(Reconstruction, NoCornerLeavesTheRangeOfItsNeighbours) {
  Floor floor(plainFloor(), evenly);
  floor.light([](const glm::vec3& p) { return 100.0F + 90.0F * noiseAt(p); });
  const Neighbours neighbours(floor.world(), floor.tree());
  std::size_t within = 0;
  for (const NodeIndex leaf : floor.leaves()) {
    const Beside beside = neighbours.of(leaf);
    float low = floor.mean(leaf);
    float high = low;
    for (const NodeIndex other : beside.all()) {
      low = std::min(low, floor.mean(other));
      high = std::max(high, floor.mean(other));
    }
    for (const glm::vec3& corner : floor.tree().polygon(leaf)) {
      const float own = floor.plane(leaf).at(corner - floor.tree().centre[leaf])[0];
      EXPECT_GE(own, -1e-4F);
      if (beside.endsAt.any()) continue;
      EXPECT_GE(own, low - 1e-3F);
      EXPECT_LE(own, high + 1e-3F);
      ++within;
    }
  }
  EXPECT_GT(within, 200U);
}

// Where noise is taken out, too: what is dark gives nothing away.
TEST(Reconstruction, NothingFallsBelowZero) {
  Floor floor(plainFloor(), unevenly);
  for (const float error_lm : {0.0F, 0.3F, 3.0F}) {
    floor.light([](const glm::vec3& p) { return std::max(0.0F, 100.0F * noiseAt(p)); }, error_lm);
    for (const NodeIndex leaf : floor.leaves()) {
      for (const glm::vec3& corner : floor.tree().polygon(leaf))
        EXPECT_GE(floor.plane(leaf).at(corner - floor.tree().centre[leaf])[0], -1e-3F);
    }
  }
}

// A step between two leaves: none of the values beside it rings.
TEST(Reconstruction, ShadowEdgeDoesNotRing) {
  Floor floor(plainFloor(), evenly);
  const float edge = floor.local({2.0, 0, 0}).x;  // where the first division cuts
  floor.light([&](const glm::vec3& p) { return p.x < edge ? 300.0F : 20.0F; });
  for (const NodeIndex leaf : floor.leaves()) {
    for (const glm::vec3& corner : floor.tree().polygon(leaf)) {
      const float own = floor.plane(leaf).at(corner - floor.tree().centre[leaf])[0];
      EXPECT_NEAR(own, floor.mean(leaf), 1e-3F);
    }
  }
}

// Light that rises towards a screen, and the dark behind it. Neither side takes from the other, even where
// all that parts them may be noise: then each is even.
TEST(Reconstruction, ScreenKeepsLightAndDarkApart) {
  Drawing drawing;
  addFloor(drawing, 0, 0, 4, 3);
  drawing.face({{2, 0, 0}, {2, 3, 0}, {2, 3, 1.2}, {2, 0, 1.2}}, wood, addObject(drawing, "screen"));
  Floor floor(drawing.scene, evenly);
  const float edge = floor.local({2.0, 0, 0}).x;
  const auto rising = [&](const glm::vec3& p) { return p.x < edge ? 300.0F + 50.0F * (p.x - edge) : 5.0F; };
  for (const float error_lm : {0.0F, 1000.0F}) {
    floor.light(rising, error_lm);
    for (double y = 0.05; y < 3.0; y += 0.1) {
      EXPECT_NEAR(floor.at({1.999, y, 0}), error_lm > 0.0F ? 250.0F : 300.0F, 0.1F);
      EXPECT_NEAR(floor.at({2.001, y, 0}), 5.0F, 1e-3F);
    }
  }
}

// Noise as large as the error that the oracle allows is more than halved, though a step of some times that
// goes through it. Smoothed, the step alone would err by more than the noise did.
TEST(Reconstruction, NoiseGoesAndStepsStay) {
  Floor floor(plainFloor(), evenly);
  const float edge = floor.local({2.0, 0, 0}).x;
  const auto truth = [&](const glm::vec3& p) { return (p.x < edge ? 500.0F : 300.0F) + 20.0F * p.y; };
  const float deviation_lx = 30.0F / std::sqrt(3.0F);
  floor.light([&](const glm::vec3& p) { return truth(p) + 30.0F * noiseAt(p); },
              deviation_lx * floor.tree().area_m2[floor.leaves()[0]]);
  float before = 0.0F;
  float after = 0.0F;
  for (const NodeIndex leaf : floor.leaves()) {
    const float real = truth(floor.tree().centre[leaf]);
    before += (floor.mean(leaf) - real) * (floor.mean(leaf) - real);
    after += (floor.plane(leaf).level_lx[0] - real) * (floor.plane(leaf).level_lx[0] - real);
  }
  EXPECT_LT(std::sqrt(after / before), 0.5F);
}

// An L is divided into two rectangles. Undivided as these are, they lean towards each other, so that nothing
// shows where they meet on the way between their centroids.
TEST(Reconstruction, SeamOfOnePolygonShowsNoStep) {
  Drawing drawing;
  drawing.face({{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {2, 2, 0}, {2, 4, 0}, {0, 4, 0}});
  Floor floor(drawing.scene, [](const ElementShape&) { return false; });
  ASSERT_EQ(floor.tree().sides.size(), 2U);
  floor.light([](const glm::vec3& p) { return 100.0F + 20.0F * p.y; });
  const glm::vec3 a = floor.tree().centre[floor.tree().sides[0].root];
  const glm::vec3 b = floor.tree().centre[floor.tree().sides[1].root];
  for (const float place : {0.0F, 0.25F, 0.5F, 0.75F, 1.0F}) {
    const glm::vec3 point = glm::mix(a, b, place);
    const float between = 100.0F + 20.0F * point.y;
    EXPECT_NEAR(floor.at(glm::dvec3(point) + floor.world().rays.origin()), between, 0.01F);
  }
}

// The same light over a mirrored, turned floor: the same planes but for rounding.
TEST(Reconstruction, MirroredAndTurnedFloorIsTheSame) {
  const Field wavy = [](const glm::vec3& p) {
    return 100.0F + 40.0F * std::sin(3.0F * p.x) * std::cos(2.0F * p.y) + 10.0F * p.y;
  };
  Drawing original;
  Drawing mirrored;
  Drawing turned;
  original.face({{-2, -1.5, 0}, {2, -1.5, 0}, {2, 1.5, 0}, {-2, 1.5, 0}});
  mirrored.face({{2, -1.5, 0}, {2, 1.5, 0}, {-2, 1.5, 0}, {-2, -1.5, 0}});
  turned.face({{-1.5, -2, 0}, {1.5, -2, 0}, {1.5, 2, 0}, {-1.5, 2, 0}});
  const auto bySize = [](const ElementShape& shape) {
    return shape.radius_m > 0.1F + 0.2F * std::abs(shape.centre.x * shape.centre.y);
  };
  Floor first(original.scene, bySize);
  Floor second(mirrored.scene, bySize);
  Floor third(turned.scene, bySize);
  for (const float error_lm : {0.0F, 0.2F}) {
    first.light(wavy, error_lm);
    second.light([&](const glm::vec3& p) { return wavy({-p.x, p.y, p.z}); }, error_lm);
    third.light([&](const glm::vec3& p) { return wavy({p.y, -p.x, p.z}); }, error_lm);
    std::mt19937 random(7);
    for (int i = 0; i < 500; ++i) {
      const double x = 4.0 * static_cast<double>(random()) * 0x1p-32 - 2.0;
      const double y = 3.0 * static_cast<double>(random()) * 0x1p-32 - 1.5;
      EXPECT_NEAR(second.at({-x, y, 0}), first.at({x, y, 0}), 0.01F);
      EXPECT_NEAR(third.at({-y, x, 0}), first.at({x, y, 0}), 0.01F);
    }
  }
}

}  // namespace
}  // namespace clerestory
