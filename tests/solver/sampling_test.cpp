// SPDX-License-Identifier: GPL-3.0-or-later
// The points that everything is sampled with: the same on every machine, and evenly spread.
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <vector>

#include <geometry/sampling.hpp>

namespace clerestory {
namespace {

constexpr std::uint32_t count = 4096;

// A low-discrepancy sequence in four dimensions errs by some (log n)^4 / n at worst, in practice by a few /
// n.
constexpr double tolerance = 20.0 / count;

TEST(Sequence, KeysMixAsSplitmix64Does) {
  EXPECT_EQ(mixKey(0), 0xe220a8397b1dcdafU);  // first output of the published generator with seed 0
  EXPECT_EQ(mixKey(0x9e3779b97f4a7c15U), 0x6e789e6aa1b965f4U);  // its second
}

TEST(Sequence, SameKeySamePoints) {
  const Sequence a(123456789);
  const Sequence b(123456789);
  const Sequence other(123456790);
  std::set<float> first;
  for (int dimension = 0; dimension < 4; ++dimension) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const float value = a(i, dimension);
      EXPECT_EQ(value, b(i, dimension));
      EXPECT_GE(value, 0.0F);
      EXPECT_LT(value, 1.0F);
    }
    first.insert(a(0, dimension));
    first.insert(other(0, dimension));
  }
  EXPECT_EQ(first.size(), 8U);
}

TEST(Sequence, MomentsAreThoseOfTheUniform) {
  for (const std::uint64_t key : {std::uint64_t{1}, std::uint64_t{2}, std::uint64_t{0xdeadbeef}}) {
    const Sequence sequence(key);
    std::array<double, 4> mean{};
    std::array<std::array<double, 4>, 4> product{};
    for (std::uint32_t i = 0; i < count; ++i) {
      for (int a = 0; a < 4; ++a) {
        const double x = static_cast<double>(sequence(i, a)) - 0.5;
        mean[static_cast<std::size_t>(a)] += x / count;
        for (int b = 0; b <= a; ++b) {
          product[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] +=
              x * (static_cast<double>(sequence(i, b)) - 0.5) / count;
        }
      }
    }
    for (std::size_t a = 0; a < 4; ++a) {
      EXPECT_NEAR(mean[a], 0.0, tolerance);
      EXPECT_NEAR(product[a][a], 1.0 / 12.0, tolerance);
      for (std::size_t b = 0; b < a; ++b) EXPECT_NEAR(product[a][b], 0.0, tolerance);
    }
  }
}

// Each of 16 x 16 cells of every pair of dimensions gets its share, which pure random points miss by 25 % (4
// of 16).
TEST(Sequence, PairsFillTheSquare) {
  const Sequence sequence(99);
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < a; ++b) {
      std::vector<int> cells(256, 0);
      for (std::uint32_t i = 0; i < count; ++i) {
        ++cells[static_cast<std::size_t>(16.0F * sequence(i, a)) * 16 +
                static_cast<std::size_t>(16.0F * sequence(i, b))];
      }
      double variance = 0.0;
      for (const int cell : cells) variance += (cell - 16.0) * (cell - 16.0) / 256.0;
      EXPECT_LT(std::sqrt(variance), 4.0) << "dimensions " << a << " and " << b;
    }
  }
}

TEST(Sampling, PointsOnAPolygonAreUniformByArea) {
  const std::vector<glm::dvec3> outline{{0, 0, 0}, {3, 0, 0}, {4, 2, 0}, {2, 4, 0}, {0, 1, 0}};
  const Sequence sequence(5);
  glm::dvec3 mean(0.0);
  for (std::uint32_t i = 0; i < count; ++i) {
    mean += pointOnPolygon<glm::dvec3>(outline, sequence(i, 0), sequence(i, 1)) / static_cast<double>(count);
  }
  glm::dvec3 centroid(0.0);
  double total = 0.0;
  for (std::size_t i = 2; i < outline.size(); ++i) {
    const double area = 0.5 * glm::length(glm::cross(outline[i - 1] - outline[0], outline[i] - outline[0]));
    centroid += area * (outline[0] + outline[i - 1] + outline[i]) / 3.0;
    total += area;
  }
  EXPECT_NEAR(glm::length(mean - centroid / total), 0.0, 4.0 * tolerance);  // the polygon is some 4 m wide
}

TEST(Sampling, DirectionsFollowTheCosine) {
  for (const glm::vec3& normal :
       {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::normalize(glm::vec3(1, -2, 0.5F))}) {
    const Sequence sequence(8);
    glm::dvec3 mean(0.0);
    for (std::uint32_t i = 0; i < count; ++i) {
      const glm::vec3 direction = cosineDirection(normal, sequence(i, 0), sequence(i, 1));
      EXPECT_NEAR(glm::length(direction), 1.0F, 1e-5F);
      EXPECT_GT(glm::dot(direction, normal), 0.0F);
      mean += glm::dvec3(direction) / static_cast<double>(count);
    }
    EXPECT_NEAR(glm::length(mean - 2.0 / 3.0 * glm::dvec3(normal)), 0.0, tolerance);  // mean of cos is 2/3
  }
}

}  // namespace
}  // namespace clerestory
