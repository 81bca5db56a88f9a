// SPDX-License-Identifier: GPL-3.0-or-later
// Light from luminous polygons, and the directions that it is sampled by.
#include "direct.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include <geometry/sampling.hpp>
#include <solver/formfactor.hpp>

#include "sphericalpolygon.hpp"

namespace clerestory {
namespace {

constexpr std::array<glm::vec3, 4> window{
    {{-1.0F, 2.0F, 0.9F}, {1.0F, 2.0F, 0.9F}, {1.0F, 2.0F, 2.4F}, {-1.0F, 2.0F, 2.4F}}};

ColumnLayout grey() {
  ColumnLayout layout;
  layout.sky = true;
  return layout;
}

DirectLight<1> sampled(const glm::vec3& point, const glm::vec3& normal, std::span<const glm::vec3> polygon,
                       float samples, std::uint64_t key, Luminance<1> luminance) {
  const ColumnLayout layout = grey();
  PolygonLight<1> light(layout, point, normal, polygon, key, std::move(luminance));
  light.sampleTo(static_cast<std::uint32_t>(samples));
  return light.light();
}

/// Receivers before the window, with the window above, across and low over their horizon.
template <class Check>
void forReceivers(const Check& check) {
  const Sequence sequence(7);
  for (std::uint32_t i = 0; i < 500; ++i) {
    const glm::vec3 point(6.0F * sequence(i, 0) - 3.0F, 1.99F - 8.0F * sequence(i, 1), 0.85F);
    const glm::vec3 normal = cosineDirection({0, 0, 1}, sequence(i, 2), sequence(i, 3));
    check(point, normal, i);
  }
}

// Even light is its luminance times pi times the form factor, whatever the samples, and has no spread.
TEST(PolygonLight, EvenLightIsExactAndSure) {
  forReceivers([](const glm::vec3& point, const glm::vec3& normal, std::uint32_t i) {
    for (const float samples : {1.0F, 2.0F, 37.0F, 500.0F}) {
      const DirectLight<1> light =
          sampled(point, normal, window, samples, i, [](const glm::vec3&) { return Columns<1>{{3.0F}}; });
      const float exact = 3.0F * std::numbers::pi_v<float> * pointToPolygon(point, normal, window);
      EXPECT_NEAR(light.illuminance_lx[0], exact, 1e-5F + 1e-4F * exact);
      ASSERT_TRUE(std::isfinite(light.deviation_lx));
      EXPECT_LE(light.deviation_lx, 1e-3F * exact + 1e-5F);
    }
  });
}

// Half of the window bright: the exact light is that of a smaller window.
TEST(PolygonLight, HalfAWindowIsASmallerWindow) {
  const std::array<glm::vec3, 4> half{
      {{-1.0F, 2.0F, 0.9F}, {0.0F, 2.0F, 0.9F}, {0.0F, 2.0F, 2.4F}, {-1.0F, 2.0F, 2.4F}}};
  double bias = 0.0;
  double squares = 0.0;
  int count = 0;
  forReceivers([&](const glm::vec3& point, const glm::vec3& normal, std::uint32_t i) {
    const float whole = pointToPolygon(point, normal, window);
    if (whole < 1e-3F) return;
    const DirectLight<1> light = sampled(point, normal, window, 256.0F, i, [](const glm::vec3& onPane) {
      return Columns<1>{{onPane.x < 0.0F ? 1.0F : 0.0F}};
    });
    const float exact = std::numbers::pi_v<float> * pointToPolygon(point, normal, half);
    const double error = static_cast<double>(light.illuminance_lx[0] - exact) /
                         (std::numbers::pi * static_cast<double>(whole));
    bias += error;
    squares += error * error;
    ++count;
  });
  ASSERT_GT(count, 300);
  // Independent samples would have a deviation of up to 0.5 / sqrt(256) = 3.1 % of the whole window's light.
  EXPECT_LT(std::sqrt(squares / count), 0.02);
  EXPECT_LT(std::abs(bias / count), 0.003);  // three deviations of a mean of 300 errors of 2 %
}

// A small lamp far away: all samples are alike but for rounding, which must not end below a root.
TEST(PolygonLight, DeviationOfAFarLampIsANumber) {
  constexpr std::array<glm::vec3, 4> lamp{
      {{0.0F, 9.0F, 2.0F}, {0.05F, 9.0F, 2.0F}, {0.05F, 9.0F, 2.05F}, {0.0F, 9.0F, 2.05F}}};
  forReceivers([&](const glm::vec3& point, const glm::vec3& normal, std::uint32_t i) {
    for (const float samples : {2.0F, 3.0F, 8.0F, 9.0F, 18.0F}) {
      const DirectLight<1> light = sampled(point, normal, lamp, samples, i, [&](const glm::vec3&) {
        return Columns<1>{{1234.567F + 0.001F * static_cast<float>(i)}};
      });
      ASSERT_TRUE(std::isfinite(light.deviation_lx)) << samples << " samples";
    }
  });
}

// Light in two even halves leaves cells whose samples are all alike.
TEST(PolygonLight, DeviationIsANumber) {
  forReceivers([](const glm::vec3& point, const glm::vec3& normal, std::uint32_t i) {
    for (const float samples : {1.0F, 2.0F, 3.0F, 8.0F, 9.0F, 12.0F, 18.0F, 33.0F}) {
      for (const float edge_m : {1.0F, 1.6F, 2.2F}) {
        const DirectLight<1> light = sampled(point, normal, window, samples, i, [&](const glm::vec3& onPane) {
          return Columns<1>{{onPane.z < edge_m ? 600.0F : 2000.0F}};
        });
        ASSERT_TRUE(std::isfinite(light.illuminance_lx[0]));
        ASSERT_TRUE(std::isfinite(light.deviation_lx)) << samples << " samples";
      }
    }
  });
}

// Solid angle of a rectangle seen from before its corner: W. D. Khadjavi 1968, atan(ab / (d sqrt(a²+b²+d²))).
TEST(SphericalPolygon, SolidAngleOfARectangle) {
  const std::array<glm::vec3, 4> rectangle{{{0, 0, 1}, {2, 0, 1}, {2, 3, 1}, {0, 3, 1}}};
  const SphericalPolygon seen({0, 0, 0}, {0, 0, 1}, rectangle);
  EXPECT_NEAR(seen.solidAngle_sr(), std::atan(6.0 / std::sqrt(14.0)), 1e-12);
}

// The mean of the cosine over directions that are even by solid angle is pi times the form factor over it.
TEST(SphericalPolygon, DirectionsAreEvenAndAboveTheHorizon) {
  forReceivers([](const glm::vec3& point, const glm::vec3& normal, std::uint32_t i) {
    const SphericalPolygon seen(point, normal, window);
    if (seen.solidAngle_sr() < 1e-4) return;
    const Sequence sequence(i);
    constexpr std::uint32_t count = 512;
    double sum = 0.0;
    double sumOfSingle = 0.0;
    for (std::uint32_t k = 0; k < count; ++k) {
      const glm::vec3 direction = seen.direction(sequence(k, 0), sequence(k, 1));
      ASSERT_TRUE(std::isfinite(direction.x + direction.y + direction.z));
      EXPECT_GT(glm::dot(direction, normal), -1e-5F);
      sum += static_cast<double>(glm::dot(direction, normal)) / count;
      const auto single = sampleSeen(point, normal, window, sequence(k, 0), sequence(k, 1));
      ASSERT_TRUE(single);
      EXPECT_DOUBLE_EQ(single->solidAngle_sr, seen.solidAngle_sr());
      EXPECT_GT(glm::dot(single->direction, normal), -1e-5F);
      sumOfSingle += static_cast<double>(glm::dot(single->direction, normal)) / count;
    }
    const double exact =
        std::numbers::pi * static_cast<double>(pointToPolygon(point, normal, window)) / seen.solidAngle_sr();
    // Cosines spread by 0.3 at most; 512 independent ones would err by 0.013.
    EXPECT_NEAR(sum, exact, 0.01);
    EXPECT_NEAR(sumOfSingle, exact, 0.01);
  });
}

}  // namespace
}  // namespace clerestory
