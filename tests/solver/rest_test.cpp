// SPDX-License-Identifier: GPL-3.0-or-later
// The rest of the series, which is summed in closed form when the steps end.
#include <gtest/gtest.h>

#include "../scenes.hpp"
#include "shooting.hpp"

namespace clerestory {
namespace {

using namespace drawn;

/// Two rooms of 4 x 4 x 3 m with an opening of 0.8 m between them; the ceiling of the southern one shines.
Building litRoomAndDarkRoom() {
  Drawing drawing;
  drawing.scene.materials[plaster].reflectance = glm::dvec3(0.7);
  const std::uint32_t lit = addMaterial(
      drawing, {.name = "lit", .reflectance = glm::dvec3(0.7), .exitance_lm_m2 = glm::dvec3(1e3)});
  const Hole opening{1.6, 0.4, 2.4, 1.2};
  addBox(drawing, {0, 0, 0}, {4, 4, 3}, plaster, 0, {1, 4});
  drawing.face(box({0, 0, 0}, {4, 4, 3})[1], lit, addObject(drawing, "ceiling"));
  addWallWithHole(drawing, 0, 0, 4, 3, 4.0, opening);
  addBox(drawing, {0, 4.2, 0}, {4, 8.2, 3}, plaster, 0, {2});
  addWallWithHole(drawing, 0, 0, 4, 3, 4.2, opening);
  for (const double x : {1.6, 2.4})
    drawing.face({{x, 4.0, 0.4}, {x, 4.2, 0.4}, {x, 4.2, 1.2}, {x, 4.0, 1.2}});
  for (const double z : {0.4, 1.2})
    drawing.face({{1.6, 4.0, z}, {2.4, 4.0, z}, {2.4, 4.2, z}, {1.6, 4.2, z}});
  return buildingOf(drawing.scene);
}

/// Mean illuminance in the northern room when steps end at `endShare` of the light. [lx]
double meanBehindTheOpening_lx(double endShare) {
  const Building building = litRoomAndDarkRoom();
  const World world(building, Study{});
  std::vector<std::uint32_t> sides;
  std::int32_t inside = -1;
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
    const std::int32_t domain = building.sideDomain[side];
    if (domain < 0 || building.domains[static_cast<std::size_t>(domain)].open) continue;
    inside = domain;
    sides.push_back(side);
  }
  const Hierarchy bare(world.pieces(), sides, world.rays.origin(), {});
  TransportSettings settings = transportFor(0.05);
  settings.endShare = endShare;
  LinkCache cache(std::size_t{1} << 20);
  const SolvedLight<1> light(world);
  const SolvedDomain<1> solved = shootingHR<1>(light, inside, bare, settings, cache);
  const Hierarchy& tree = solved.radiosity.tree;
  const float wall_y = world.local({0.0, 4.1, 0.0}).y;
  double sum_lm = 0.0;
  double area_m2 = 0.0;
  for (NodeIndex node = 0; node < tree.size(); ++node) {
    if (!tree.isLeaf(node) || tree.isCluster(node) || tree.centre[node].y < wall_y) continue;
    const auto own_m2 = static_cast<double>(tree.area_m2[node]);
    sum_lm += own_m2 * static_cast<double>(solved.radiosity.irradiance_lx[node][0]);
    area_m2 += own_m2;
  }
  return sum_lm / area_m2;
}

// A room that has its light through an opening from the next one is no brighter for it when the steps end
// early. Spread evenly, a tenth of the light would make it several times as bright. It may be darker: its
// light builds up later than the other room's, so the last step has less than its share.
TEST(Rest, ARoomBehindAnOpeningGetsItsOwnShare) {
  const double truth_lx = meanBehindTheOpening_lx(1e-5);
  EXPECT_GT(truth_lx, 0.0);
  EXPECT_NEAR(meanBehindTheOpening_lx(0.1), truth_lx, 0.3 * truth_lx);
}

}  // namespace
}  // namespace clerestory
