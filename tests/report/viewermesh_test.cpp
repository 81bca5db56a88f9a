// SPDX-License-Identifier: GPL-3.0-or-later
// Elements packed for the page: the same after unpacking, and small.
#include "viewermesh.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <random>

namespace clerestory {
namespace {

/// `count` squares of 10 cm side by side on walls of 100, lit unevenly and with noise.
ElementMesh wall(std::uint32_t count) {
  ElementMesh mesh;
  std::mt19937 random(1);
  std::normal_distribution<float> noise(1.0F, 0.02F);
  mesh.origin_m = {100.0, 200.0, 3.0};
  for (std::uint32_t e = 0; e < count; ++e) {
    const auto x = static_cast<float>(e % 100) * 0.1F;
    const auto y = static_cast<float>(e / 100 % 100) * 0.1F;
    const auto z = static_cast<float>(e / 10'000);
    const glm::vec3 corners[] = {{x, y, z}, {x + 0.1F, y, z}, {x + 0.1F, y + 0.1F, z}, {x, y + 0.1F, z}};
    for (const glm::vec3& corner : corners) {
      mesh.corners_m.push_back(corner);
      mesh.illuminance_lx.push_back(1000.0F / (1.0F + corner.x * corner.x) * noise(random));
      const float level = mesh.illuminance_lx.back();
      mesh.exitance_lm_m2.emplace_back(0.7F * level, 0.6F * level, 0.5F * level * noise(random));
    }
    mesh.firstCorner.push_back(static_cast<std::uint32_t>(mesh.corners_m.size()));
    mesh.surfaceRow.push_back(e / 1000);
  }
  return mesh;
}

std::vector<unsigned char> inflated(const std::string& bytes, std::size_t size) {
  std::vector<unsigned char> result(size);
  auto length = static_cast<uLongf>(size);
  EXPECT_EQ(uncompress(result.data(), &length, reinterpret_cast<const Bytef*>(bytes.data()),
                       static_cast<uLong>(bytes.size())),
            Z_OK);
  EXPECT_EQ(length, size);
  return result;
}

/// Sums of the differences that lie at `at`, as mesh.js reads them.
std::vector<std::uint16_t> shortsAt(const std::vector<unsigned char>& bytes, std::size_t at,
                                    std::size_t count) {
  std::vector<std::uint16_t> values;
  unsigned value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    value += bytes[at + i] + 256U * bytes[at + count + i];
    values.push_back(static_cast<std::uint16_t>(value));
  }
  return values;
}

TEST(ViewerMesh, UnpacksToTheSamePlacesAndLight) {
  const ElementMesh mesh = wall(500);
  const PackedMesh packed = packMesh(mesh);
  const std::size_t elements = mesh.size();
  const std::size_t corners = mesh.corners_m.size();
  const auto bytes = inflated(packed.bytes, 6 * elements + 13 * corners);
  EXPECT_EQ(packed.low_m, glm::dvec3(100.0, 200.0, 3.0));
  const auto x = shortsAt(bytes, 6 * elements, corners);
  const auto illuminance = shortsAt(bytes, 6 * elements + 6 * corners, corners);
  for (std::size_t c = 0; c < corners; ++c) {
    EXPECT_NEAR(x[c] * packed.step_m, mesh.corners_m[c].x, 0.51 * packed.step_m);
    // Steps of 40 octaves / 16382 are 0.17 %; rounding errs by half of one.
    const double lx = std::exp2((illuminance[c] - 1) / 16382.0 * 40.0 - 14.0);
    EXPECT_NEAR(lx / static_cast<double>(mesh.illuminance_lx[c]), 1.0, 0.00086);
  }
}

TEST(ViewerMesh, ThreeHundredThousandElementsStayUnderFifteenMegabytes) {
  const PackedMesh packed = packMesh(wall(300'000));
  // In the page four letters stand for three bytes.
  EXPECT_LT(packed.bytes.size() * 4 / 3, 15'000'000u);
}

TEST(ViewerMesh, LivesWithOnePointAndWithDarkness) {
  ElementMesh mesh;
  mesh.corners_m = {glm::vec3(1.0F), glm::vec3(1.0F), glm::vec3(1.0F)};
  mesh.illuminance_lx = {0.0F, std::numeric_limits<float>::quiet_NaN(), 1e30F};
  mesh.exitance_lm_m2.assign(3, glm::vec3(0.0F));
  mesh.firstCorner = {0, 3};
  mesh.surfaceRow = {70'000};
  const auto bytes = inflated(packMesh(mesh).bytes, 6 + 39);
  EXPECT_EQ(shortsAt(bytes, 6 + 18, 3), (std::vector<std::uint16_t>{0, 0, 16383}));
  EXPECT_EQ(shortsAt(bytes, 2, 1)[0] + 65536 * shortsAt(bytes, 4, 1)[0], 70'000);
}

}  // namespace
}  // namespace clerestory
