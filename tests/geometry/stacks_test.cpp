// SPDX-License-Identifier: GPL-3.0-or-later
// Scan conversion of the sample office, in a frame askew to it, against upright and level rays.
#include "stacks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include <geometry/rays.hpp>
#include <geometry/sampling.hpp>

#include "../scenes.hpp"

namespace clerestory {
namespace {

// 0.31 m wide cells, by no wall of the office; turned so that no edge runs along a row.
PlanRaster askew() {
  const double angle = 0.3;
  return {{{1.0, 2.0}, {std::cos(angle), std::sin(angle)}, {-std::sin(angle), std::cos(angle)}},
          {-12.0, -12.0},
          0.31,
          90,
          90};
}

class StacksOfOffice : public testing::Test {
 protected:
  const CleanModel model =
      cleanScene(readModel(std::filesystem::path(CLERESTORY_SAMPLES) / "office" / "office.glb", {}));
  const RayScene rays{model, {}};
  const PlanRaster raster = askew();
  const Stacks stacks{model.pieces, raster};
};

/// From a place in plan to the nearest edge of a piece.
double toEdge(const Pieces& pieces, std::uint32_t piece, const glm::dvec2& place) {
  const auto corners = pieces.polygons[piece];
  double least_m = 1e300;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const glm::dvec2 from(pieces.points[corners[j]]);
    const glm::dvec2 edge = glm::dvec2(pieces.points[corners[i]]) - from;
    const double t = glm::clamp(glm::dot(place - from, edge) / glm::dot(edge, edge), 0.0, 1.0);
    least_m = std::min(least_m, glm::length(place - from - t * edge));
  }
  return least_m;
}

// Pieces leave their planes by up to 1 mm. Rays are in float: beside an edge either may be right.
TEST_F(StacksOfOffice, HoldWhatUprightRaysMeet) {
  std::size_t met = 0;
  for (std::uint32_t cell = 0; cell < raster.size(); cell += 3) {
    glm::vec3 from(glm::dvec3(raster.middleOf(cell), -5.0) - rays.origin());
    while (const auto hit = rays.nearest(from, {0, 0, 1}, RayScene::Barrier::opaqueAndGlass)) {
      from.z += hit.distance_m;
      const double height_m = from.z + rays.origin().z;
      from.z += rayOffset_m;
      if (std::abs(model.pieces.normal[hit.piece].z) < 0.2) continue;
      if (toEdge(model.pieces, hit.piece, raster.middleOf(cell)) < 1e-5) continue;
      EXPECT_TRUE(std::ranges::any_of(
          stacks.over(cell),
          [&](const Meeting& meeting) { return std::abs(meeting.height_m - height_m) < 1e-3; }))
          << "at " << height_m;
      ++met;
    }
  }
  EXPECT_GT(met, 1000U);
}

TEST_F(StacksOfOffice, HoldNoMoreThanUprightRaysMeet) {
  std::size_t held = 0;
  for (std::uint32_t cell = 0; cell < raster.size(); cell += 3) {
    for (const Meeting& meeting : stacks.over(cell)) {
      const glm::vec3 place(glm::dvec3(raster.middleOf(cell), meeting.height_m) - rays.origin());
      const glm::vec3 up(0, 0, 1e-3F);
      EXPECT_TRUE(rays.meetsAny(place - up, {0, 0, 1}, RayScene::Barrier::opaqueAndGlass, 2e-3F));
      ++held;
    }
  }
  EXPECT_GT(held, 1000U);
}

// Level segments at any height within cells that nothing may stop them in.
TEST_F(StacksOfOffice, NothingStopsALevelLineWhereNothingMay) {
  const Sequence sequence(1);
  std::uint32_t free = 0;
  std::uint32_t stopped = 0;
  for (std::uint32_t i = 0; i < 100000; ++i) {
    const auto cell = static_cast<std::uint32_t>(sequence(i, 0) * static_cast<float>(raster.size()));
    const double angle = 2.0 * std::numbers::pi * sequence(i, 2);
    const glm::dvec2 half = 0.49 * raster.cell_m * glm::dvec2(std::cos(angle), std::sin(angle));
    const double height_m = 3.0 * sequence(i, 1);
    const auto local = [&](const glm::dvec2& place) {
      return glm::vec3(glm::dvec3(place, height_m) - rays.origin());
    };
    const glm::dvec2 middle = raster.middleOf(cell);
    const bool isStopped =
        rays.occluded(local(middle - half), local(middle + half), RayScene::Barrier::opaqueAndGlass);
    if (isStopped) ++stopped;
    if (stacks.mayStop(cell)) continue;
    ++free;
    EXPECT_FALSE(isStopped) << "cell " << cell << " at " << height_m;
  }
  EXPECT_GT(free, 10000U);
  EXPECT_GT(stopped, 100U);
}

}  // namespace
}  // namespace clerestory
