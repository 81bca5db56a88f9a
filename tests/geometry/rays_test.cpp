// SPDX-License-Identifier: GPL-3.0-or-later
// Rays in packets against the same rays one by one.
#include <gtest/gtest.h>

#include <filesystem>

#include <geometry/rays.hpp>
#include <geometry/sampling.hpp>

#include "../scenes.hpp"

namespace clerestory {
namespace {

class RaysOfOffice : public testing::Test {
 protected:
  const CleanModel model =
      cleanScene(readModel(std::filesystem::path(CLERESTORY_SAMPLES) / "office" / "office.glb", {}));
  const RayScene rays{model, {}};

  /// How many of the rays meet something else in packets: another piece, or the same more than 0.1 mm off.
  [[nodiscard]] std::size_t differing(const std::vector<RayScene::Ray>& some) const {
    std::vector<RayScene::Hit> hits(some.size());
    rays.nearest(some, RayScene::Barrier::opaqueAndGlass, hits);
    std::size_t count = 0;
    for (std::size_t i = 0; i < some.size(); ++i) {
      const auto alone = rays.nearest(some[i].from, some[i].direction, RayScene::Barrier::opaqueAndGlass);
      const bool isSame = static_cast<bool>(alone) == static_cast<bool>(hits[i]) &&
                          (!alone || (alone.side() == hits[i].side() &&
                                      std::abs(alone.distance_m - hits[i].distance_m) < 1e-4F));
      if (!isSame) ++count;
    }
    return count;
  }
};

// A count that is no multiple of a packet's width. Where two pieces touch, either may be met.
TEST_F(RaysOfOffice, MeetTheSameInPackets) {
  const glm::vec3 eye(glm::dvec3(6.0, 4.0, 1.6) - rays.origin());
  const Sequence sequence(1);
  std::vector<RayScene::Ray> alike;
  std::vector<RayScene::Ray> scattered;
  for (std::uint32_t i = 0; i < 100'003; ++i) {
    const float angle = 6.2832F * static_cast<float>(i) / 100'003.0F;
    alike.push_back({eye, glm::normalize(glm::vec3(std::cos(angle), std::sin(angle), -0.2F))});
    scattered.push_back({eye, cosineDirection({0, 0, i % 2 == 0 ? 1 : -1}, sequence(i, 0), sequence(i, 1))});
  }
  EXPECT_LT(differing(alike), 10U);
  EXPECT_LT(differing(scattered), 10U);
}

}  // namespace
}  // namespace clerestory
