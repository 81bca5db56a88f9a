// SPDX-License-Identifier: GPL-3.0-or-later
// Importance: what sensors get no light from weighs little, what they see weighs by what it reflects, and a
// study that asks for everything goes by area.
#include "importance.hpp"

#include <numeric>

#include "solved.hpp"

namespace clerestory {
namespace {

constexpr glm::dvec3 far{24, 3, 2.5};

std::vector<std::uint32_t> insideOf(const Building& building) {
  std::vector<std::uint32_t> sides;
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
    const std::int32_t domain = building.sideDomain[side];
    if (domain >= 0 && !building.domains[static_cast<std::size_t>(domain)].open) sides.push_back(side);
  }
  return sides;
}

/// A closed corridor, black but for its west end wall, with sensors that look up.
struct Corridor {
  Building building;
  Study study;
  World world;
  std::vector<std::uint32_t> sides;

  explicit Corridor(const std::vector<glm::dvec3>& sensors, double reflectance = 0.0)
      : building([&] {
          drawn::Drawing drawing;
          Material black;
          black.name = "black";
          black.reflectance = glm::dvec3(reflectance);
          const std::uint32_t material = drawn::addMaterial(drawing, black);
          drawn::addBox(drawing, {0, 0, 0}, far, material, 0, {5});
          drawing.face(drawn::box({0, 0, 0}, far)[5], drawn::plaster);
          Study asked;
          if (!sensors.empty()) asked.grids = {drawn::gridOf(sensors)};
          return drawn::buildingOf(drawing.scene, asked);
        }()),
        world(building, study),
        sides(insideOf(building)) {}

  [[nodiscard]] std::vector<float> weights() const {
    return importanceOf(world, study, building.sideDomain[sides[0]], sides);
  }
  [[nodiscard]] bool isWest(std::size_t side) const { return world.normalOf(sides[side]).x > 0.9F; }
  [[nodiscard]] double area_m2(std::size_t side) const { return world.pieces().area_m2[sides[side] / 2]; }
};

TEST(Importance, WhatSendsNothingKeepsTheShareOfItsAreaAlone) {
  const Corridor corridor({{1.0, 1.5, 0.85}, {2.0, 1.0, 0.85}});
  const std::vector<float> weights = corridor.weights();
  ASSERT_EQ(weights.size(), 6U);
  double total_m2 = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) total_m2 += corridor.area_m2(i);
  // Sums of floats.
  EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), total_m2, 1e-4);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double own = 0.1 * corridor.area_m2(i) + (corridor.isWest(i) ? 0.9 * total_m2 : 0.0);
    EXPECT_NEAR(static_cast<double>(weights[i]), own, 1e-4);
  }
}

TEST(Importance, NothingAskedForLeavesArea) {
  EXPECT_TRUE(Corridor({}).weights().empty());
}

TEST(Importance, EverythingAskedForLeavesArea) {
  const Corridor corridor(drawn::pointsOver({0, 0, 0}, far, 0.85, 0.5), 0.5);
  ASSERT_FALSE(corridor.building.grids.at(0).points.empty());
  EXPECT_TRUE(corridor.weights().empty());
}

}  // namespace
}  // namespace clerestory
