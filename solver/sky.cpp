// SPDX-License-Identifier: GPL-3.0-or-later
// The CIE skies: gradation from the zenith to the horizon times an indicatrix about the sun, scaled by
// cubature.
//
// CIE S 011 / ISO 15469:2004, Spatial distribution of daylight: CIE standard general sky.
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include <solver/sky.hpp>

namespace clerestory {
namespace {

using std::numbers::pi;

constexpr int kTraditionalOvercast = 16;

/// CIE S 011, Table 1: gradation a, b and indicatrix c, d, e.
struct Parameters {
  double a, b, c, d, e;
};
constexpr std::array<Parameters, 15> kTypes = {{{4.0, -0.70, 0.0, -1.0, 0.0},
                                                {4.0, -0.70, 2.0, -1.5, 0.15},
                                                {1.1, -0.80, 0.0, -1.0, 0.0},
                                                {1.1, -0.80, 2.0, -1.5, 0.15},
                                                {0.0, -1.00, 0.0, -1.0, 0.0},
                                                {0.0, -1.00, 2.0, -1.5, 0.15},
                                                {0.0, -1.00, 5.0, -2.5, 0.30},
                                                {0.0, -1.00, 10.0, -3.0, 0.45},
                                                {-1.0, -0.55, 2.0, -1.5, 0.15},
                                                {-1.0, -0.55, 5.0, -2.5, 0.30},
                                                {-1.0, -0.55, 10.0, -3.0, 0.45},
                                                {-1.0, -0.32, 10.0, -3.0, 0.45},
                                                {-1.0, -0.32, 16.0, -3.0, 0.30},
                                                {-1.0, -0.15, 16.0, -3.0, 0.30},
                                                {-1.0, -0.15, 24.0, -2.8, 0.15}}};

SkyShape shapeOf(const Parameters& sky) {
  if (sky.c == 0.0) return {sky.a, sky.b, 1.0, 0.0, sky.d, 0.0};
  return {sky.a, sky.b, 1.0 - sky.c * std::exp(sky.d * pi / 2.0), sky.c, sky.d, sky.e};
}

double gradation(const SkyShape& sky, double cosZenith) {
  return 1.0 + sky.a * std::exp(sky.b / std::max(cosZenith, 1e-6));
}

double indicatrix(const SkyShape& sky, double cosToSun) {
  const double angle = std::acos(std::clamp(cosToSun, -1.0, 1.0));
  return sky.base + sky.c * std::exp(sky.d * angle) + sky.e * cosToSun * cosToSun;
}

/// Abscissae and weights of the Gauss-Legendre rule on [0, 1], by Newton's method on the polynomial.
template <std::size_t N>
std::array<std::pair<double, double>, N> gaussLegendre() {
  std::array<std::pair<double, double>, N> rule;
  constexpr double n = static_cast<double>(N);
  for (std::size_t i = 0; i < N; ++i) {
    double x = std::cos(pi * (static_cast<double>(i) + 0.75) / (n + 0.5)), slope = 1.0;
    for (int step = 0; step < 8; ++step) {
      double p = x, before = 1.0;
      for (std::size_t k = 2; k <= N; ++k) {
        const double order = static_cast<double>(k);
        before = std::exchange(p, ((2.0 * order - 1.0) * x * p - (order - 1.0) * before) / order);
      }
      slope = n * (x * p - before) / (x * x - 1.0);
      x -= p / slope;
    }
    rule[i] = {0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope)};
  }
  return rule;
}

/// Mean of the indicatrix around the zenith, half of the ring from the sun's azimuth on.
template <class Rule>
double meanOfRing(const SkyShape& sky, double sunZenith, double cosZenith, double sinZenith,
                  const Rule& rule) {
  if (sky.c == 0.0 && sky.e == 0.0) return sky.base;
  double mean = 0.0;
  for (const auto& [y, weight] : rule)
    mean += weight * std::max(indicatrix(sky, std::cos(sunZenith) * cosZenith +
                                                  std::sin(sunZenith) * sinZenith * std::cos(pi * y)),
                              0.0);
  return mean;
}

/// Integral of gradation times indicatrix times cosine over the hemisphere: in panels that end at the sun's
/// zenith angle and azimuth, where the indicatrix has its cusp.
double horizontalPerScale(const SkyShape& sky, double sunZenith) {
  static const auto rule = gaussLegendre<96>();
  double sum = 0.0;
  const double split = std::min(sunZenith, pi / 2.0);
  for (const auto& [from, to] : {std::pair{0.0, split}, std::pair{split, pi / 2.0}})
    for (const auto& [x, weight] : rule) {
      const double zenith = from + (to - from) * x, cosZenith = std::cos(zenith),
                   sinZenith = std::sin(zenith);
      sum += weight * (to - from) * cosZenith * sinZenith * std::max(gradation(sky, cosZenith), 0.0) *
             meanOfRing(sky, sunZenith, cosZenith, sinZenith, rule);
    }
  return 2.0 * pi * sum;
}

/// Of type 16, which has a formula of its own, the uniform sky's.
SkyShape shapeOfType(int cieType) {
  if (cieType < 1 || cieType > kTraditionalOvercast)
    throw std::invalid_argument("CIE sky type " + std::to_string(cieType) + " is not one of 1 to 16");
  return shapeOf(kTypes[cieType == kTraditionalOvercast ? 4 : static_cast<std::size_t>(cieType - 1)]);
}

}  // namespace

glm::dvec3 directionFromAngles(double altitude_deg, double azimuth_deg, double north_deg) {
  const double altitude = glm::radians(altitude_deg), bearing = glm::radians(north_deg + azimuth_deg);
  return {std::cos(altitude) * std::sin(bearing), std::cos(altitude) * std::cos(bearing), std::sin(altitude)};
}

Sky::Sky(const SkyShape& shape, double diffuseHorizontal_lx, glm::dvec3 towardsSun, double groundReflectance)
    : horizontal_lx_(diffuseHorizontal_lx),
      zenith_cd_m2_(0.0),
      ground_cd_m2_(groundReflectance * diffuseHorizontal_lx / pi),
      towardsSun_(towardsSun) {
  const double sunZenith = std::acos(std::clamp(towardsSun.z, -1.0, 1.0));
  const double scale = horizontal_lx_ / horizontalPerScale(shape, sunZenith);
  sunny_ = shape.c != 0.0 || shape.e != 0.0;
  a_ = static_cast<float>(shape.a);
  b_ = static_cast<float>(shape.b);
  base_ = static_cast<float>(shape.base);
  c_ = static_cast<float>(shape.c);
  d_ = static_cast<float>(shape.d);
  e_ = static_cast<float>(shape.e);
  zenith_cd_m2_ = scale * gradation(shape, 1.0) * indicatrix(shape, towardsSun.z);
  scale_cd_m2_ = static_cast<float>(scale);
}

Sky::Sky(int cieType, double diffuseHorizontal_lx, glm::dvec3 towardsSun, double groundReflectance)
    : Sky(shapeOfType(cieType), diffuseHorizontal_lx, towardsSun, groundReflectance) {
  if (cieType != kTraditionalOvercast) return;  // (1 + 2 z) / 3, whose integral is 7 pi / 9
  linear_ = true;
  a_ = 2.0F;
  zenith_cd_m2_ = horizontal_lx_ * (9.0 / (7.0 * pi));
  scale_cd_m2_ = static_cast<float>(zenith_cd_m2_ / 3.0);
}

float Sky::luminance_cd_m2(glm::vec3 direction) const {
  if (direction.z < 0.0F) return static_cast<float>(ground_cd_m2_);
  if (linear_) return scale_cd_m2_ * (1.0F + a_ * direction.z);
  float relative = 1.0F;
  if (a_ != 0.0F) relative += a_ * std::exp(b_ / std::max(direction.z, 1e-6F));
  if (!sunny_) return scale_cd_m2_ * std::max(relative, 0.0F);
  const float cosToSun = std::clamp(glm::dot(direction, towardsSun_), -1.0F, 1.0F);
  const float toSun = base_ + c_ * std::exp(d_ * std::acos(cosToSun)) + e_ * cosToSun * cosToSun;
  return scale_cd_m2_ * std::max(relative, 0.0F) * std::max(toSun, 0.0F);
}

}  // namespace clerestory
