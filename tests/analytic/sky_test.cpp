// SPDX-License-Identifier: GPL-3.0-or-later
// The CIE skies against closed forms, published ratios and CIE 171's roof and wall openings in a black room.
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <solver/glass.hpp>
#include <solver/sky.hpp>

namespace clerestory {
namespace {

using glm::dvec3;
using std::numbers::pi;

/// Illuminance of a plane from the sky alone, by midpoints in equal steps of zenith angle and azimuth.
double skyIlluminance(const Sky& sky, dvec3 normal, int n = 600) {
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double zenith = (i + 0.5) / n * pi / 2.0, r = std::sin(zenith);
    for (int j = 0; j < n; ++j) {
      const double angle = 2.0 * pi * (j + 0.5) / n;
      const dvec3 direction(r * std::cos(angle), r * std::sin(angle), std::cos(zenith));
      const double cosine = glm::dot(direction, normal);
      if (cosine > 0.0) sum += r * cosine * static_cast<double>(sky.luminance_cd_m2(glm::vec3(direction)));
    }
  }
  return sum * pi * pi / n / n;
}

TEST(Sky, HorizontalIlluminanceIsTheOneAskedFor) {
  for (int type = 1; type <= 16; ++type)
    for (const double altitude : {0.0, 35.0, 90.0}) {
      const Sky sky(type, 10000.0, directionFromAngles(altitude, 70.0, 20.0), 0.2);
      EXPECT_DOUBLE_EQ(sky.horizontalIlluminance_lx(), 10000.0);
      EXPECT_NEAR(skyIlluminance(sky, {0, 0, 1}), 10000.0, 0.15) << "type " << type << " sun " << altitude;
    }
}

TEST(Sky, ZenithRatios) {
  const std::map<int, std::array<double, 4>> published = {
      {1, {2.4495, 2.4495, 2.4495, 2.4495}},
      {2, {2.662, 2.557, 2.364, 2.086}},
      {3, {2.77, 2.77, 2.77, 2.77}},
      {4, {3.030, 2.890, 2.647, 2.315}},
      {5, {pi, pi, pi, pi}},
      {6, {3.456, 3.278, 2.978, 2.584}},
      {7, {3.902, 3.673, 3.143, 2.421}},
      {8, {4.421, 4.123, 3.339, 2.328}},
      {9, {4.865, 4.553, 4.059, 3.459}},
      {10, {5.594, 5.145, 4.253, 3.170}},
      {11, {6.452, 5.818, 4.485, 2.989}},
      {12, {7.205, 6.394, 4.849, 3.191}},
      {13, {8.073, 6.995, 4.983, 3.026}},
      {14, {9.118, 7.708, 5.375, 3.217}},
      {15, {10.338, 8.116, 5.271, 3.016}},
      {16, {7 * pi / 9, 7 * pi / 9, 7 * pi / 9, 7 * pi / 9}}};
  const std::array<double, 4> altitudes = {15.0, 30.0, 45.0, 60.0};
  for (const auto& [type, ratios] : published)
    for (std::size_t i = 0; i < altitudes.size(); ++i) {
      const Sky sky(type, 1000.0, directionFromAngles(altitudes[i], 0.0, 0.0), 0.0);
      EXPECT_NEAR(1000.0 / sky.zenithLuminance_cd_m2(), ratios[i], 6e-4)
          << "type " << type << " sun " << altitudes[i];
      EXPECT_NEAR(static_cast<double>(sky.luminance_cd_m2({0, 0, 1})) / sky.zenithLuminance_cd_m2(), 1.0,
                  1e-5);
    }
}

/// pi + 2 pi a E_3(-b), the integral of a gradation without indicatrix.
double gradationIntegral(double a, double b) {
  const double e1 = -std::expint(b), e2 = std::exp(b) + b * e1, e3 = 0.5 * (std::exp(b) + b * e2);
  return pi + 2.0 * pi * a * e3;
}

TEST(Sky, GradationsIntegralInClosedForm) {
  const Sky steep(1, 1.0, {0, 0, 1}, 0.0), weak(3, 1.0, {0, 0, 1}, 0.0);
  EXPECT_NEAR(1.0 / steep.zenithLuminance_cd_m2() * (1 + 4 * std::exp(-0.7)) / gradationIntegral(4, -0.7),
              1.0, 1e-9);
  EXPECT_NEAR(1.0 / weak.zenithLuminance_cd_m2() * (1 + 1.1 * std::exp(-0.8)) / gradationIntegral(1.1, -0.8),
              1.0, 1e-9);
}

TEST(Sky, VerticalOverHorizontal) {
  EXPECT_NEAR(skyIlluminance(Sky(16, 1.0, {0, 0, 1}, 0.0), {0, 1, 0}, 2000), 0.3962, 6e-5);
  EXPECT_NEAR(skyIlluminance(Sky(1, 1.0, {0, 0, 1}, 0.0), {1, 0, 0}, 2000), 0.3792, 6e-5);
  EXPECT_NEAR(skyIlluminance(Sky(5, 1.0, {0, 0, 1}, 0.0), {1, 0, 0}, 2000), 0.5, 1e-5);
}

TEST(Sky, TwiceTheSkyIsTwiceTheLight) {
  for (int type = 1; type <= 16; ++type) {
    const dvec3 sun = directionFromAngles(40.0, 120.0, 0.0);
    const Sky one(type, 7777.0, sun, 0.3), two(type, 15554.0, sun, 0.3);
    for (const dvec3 towards : {dvec3(0, 0, 1), dvec3(1, 2, 0.5), dvec3(-3, 1, 0), dvec3(1, 1, -1)}) {
      const glm::vec3 direction(glm::normalize(towards));
      EXPECT_EQ(two.luminance_cd_m2(direction), 2.0F * one.luminance_cd_m2(direction));
    }
  }
}

TEST(Sky, Horizon) {
  for (int type = 1; type <= 16; ++type) {
    const Sky sky(type, 10000.0, directionFromAngles(30.0, 0.0, 0.0), 0.5);
    const float above = sky.luminance_cd_m2({1, 0, 1e-4F});
    EXPECT_NEAR(static_cast<double>(sky.luminance_cd_m2({1, 0, 0.0F}) / above), 1.0, 3e-4) << type;
    EXPECT_EQ(sky.luminance_cd_m2({1, 0, 0.0F}), sky.luminance_cd_m2({1, 0, -0.0F}));
  }
}

TEST(Sky, GroundIsUniform) {
  const Sky sky(12, 10000.0, directionFromAngles(45.0, 0.0, 0.0), 0.25);
  EXPECT_NEAR(sky.groundLuminance_cd_m2(), 0.25 * 10000.0 / pi, 1e-9);
  EXPECT_FLOAT_EQ(sky.luminance_cd_m2({0, 0, -1}), static_cast<float>(sky.groundLuminance_cd_m2()));
  EXPECT_EQ(sky.luminance_cd_m2({0, 0, -1}), sky.luminance_cd_m2(glm::normalize(glm::vec3(1, 1, -0.01F))));
}

TEST(Sky, BrightestAtTheSunAndSymmetricAboutIt) {
  const dvec3 sun = directionFromAngles(50.0, 200.0, 0.0);
  const Sky sky(12, 10000.0, sun, 0.2);
  const auto at = [&](double altitude, double azimuth) {
    return sky.luminance_cd_m2(glm::vec3(directionFromAngles(altitude, azimuth, 0.0)));
  };
  EXPECT_GT(at(50, 200), at(50, 203));
  EXPECT_GT(at(50, 200), at(53, 200));
  EXPECT_NEAR(static_cast<double>(at(30, 170) / at(30, 230)), 1.0, 1e-5);
}

TEST(Sky, UnknownTypesAreRefused) {
  EXPECT_THROW(Sky(0, 1.0, {0, 0, 1}, 0.0), std::invalid_argument);
  EXPECT_THROW(Sky(17, 1.0, {0, 0, 1}, 0.0), std::invalid_argument);
}

TEST(DirectionFromAngles, AzimuthRunsFromNorthOverEast) {
  const auto expectNear = [](dvec3 found, dvec3 expected) {
    EXPECT_LT(glm::distance(found, expected), 1e-14);
  };
  expectNear(directionFromAngles(0, 0, 0), {0, 1, 0});
  expectNear(directionFromAngles(0, 90, 0), {1, 0, 0});
  expectNear(directionFromAngles(0, 180, 0), {0, -1, 0});
  expectNear(directionFromAngles(0, 0, 90), {1, 0, 0});
  expectNear(directionFromAngles(0, 90, 90), {0, -1, 0});
  expectNear(directionFromAngles(90, 123, 45), {0, 0, 1});
  expectNear(directionFromAngles(30, 0, 0), {0, std::sqrt(0.75), 0.5});
}

TEST(DirectionFromAngles, TurningNorthTurnsTheSky) {
  const Sky sky(11, 5000.0, directionFromAngles(25.0, 130.0, 0.0), 0.2);
  const Sky turned(11, 5000.0, directionFromAngles(25.0, 130.0, 77.0), 0.2);
  for (double azimuth = 0.0; azimuth < 360.0; azimuth += 15.0)
    EXPECT_NEAR(
        static_cast<double>(sky.luminance_cd_m2(glm::vec3(directionFromAngles(40.0, azimuth, 0.0))) /
                            turned.luminance_cd_m2(glm::vec3(directionFromAngles(40.0, azimuth, 77.0)))),
        1.0, 2e-6);
}

/// A rectangular opening of CIE 171 and the receivers in the room behind it.
struct Opening {
  dvec3 corner, u, v;

  /// Illuminance from what is seen through it, in steps that end at the points' horizons; the pane transmits
  /// by the cosine of incidence.
  template <class Transmittance>
  double illuminance(const Sky& sky, dvec3 point, dvec3 normal, const Transmittance& pane,
                     int n = 360) const {
    const dvec3 area = glm::cross(u, v) / static_cast<double>(n * n), facing = glm::normalize(area);
    double sum = 0.0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const dvec3 d = corner + (i + 0.5) / n * u + (j + 0.5) / n * v - point;
        const double distance2 = glm::dot(d, d), cosine = glm::dot(d, normal);
        if (cosine <= 0.0) continue;
        const dvec3 direction = d / std::sqrt(distance2);
        sum += static_cast<double>(sky.luminance_cd_m2(glm::vec3(direction))) * cosine *
               std::abs(glm::dot(d, area)) / (distance2 * distance2) *
               pane(std::abs(glm::dot(direction, facing)));
      }
    return sum;
  }
};

struct Receiver {
  dvec3 point, normal;
};

/// The points of a row of the table: wall A to F then floor G to N, or the ceiling over the floor's points.
std::vector<Receiver> receivers(bool ceiling) {
  std::vector<Receiver> all;
  for (int i = 0; i < 6 && !ceiling; ++i) all.push_back({{2, 0, 2.75 - 0.5 * i}, {0, 1, 0}});
  for (int i = 0; i < 8; ++i) all.push_back({{2, 0.25 + 0.5 * i, ceiling ? 3 : 0}, {0, 0, ceiling ? -1 : 1}});
  return all;
}

/// CIE 171's 6 mm clear glass, case 5.5 (Tregenza and Sharples).
double clearGlass(double c) {
  return -0.028378 + c * (3.156075 + c * (-3.058376 + c * (-1.428919 + c * (4.014235 - 1.775827 * c))));
}

template <class Transmittance>
void compareWithTable(const std::string& test, const Opening& opening, const Transmittance& pane,
                      double tolerance) {
  std::ifstream file(std::string(CLERESTORY_TEST_DATA) + "/cie171/cie171-5.9-5.14.csv");
  int rows = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    std::string name, type, value;
    std::getline(fields, name, ',');
    std::getline(fields, type, ',');
    const bool ceiling = name == test + "_ceil";
    if (name != test && !ceiling) continue;
    const Sky sky(ceiling ? 5 : std::stoi(type), 100.0, directionFromAngles(60.0, 0.0, 0.0), 0.30);
    for (const Receiver& receiver : receivers(ceiling)) {
      ASSERT_TRUE(std::getline(fields, value, ',')) << line;
      const double expected = std::stod(value);
      EXPECT_NEAR(opening.illuminance(sky, receiver.point, receiver.normal, pane), expected,
                  tolerance * expected + 1e-4)
          << name << " type " << type << " y " << receiver.point.y << " z " << receiver.point.z;
    }
    ++rows;
  }
  EXPECT_GE(rows, 4) << test;
}

const Opening kSmallRoof = {{1.5, 1.5, 3}, {1, 0, 0}, {0, 1, 0}};
const Opening kWholeRoof = {{0, 0, 3}, {4, 0, 0}, {0, 4, 0}};
const Opening kWindow = {{1, 4, 1}, {2, 0, 0}, {0, 0, 1}};
const Opening kWholeWall = {{0, 4, 0}, {4, 0, 0}, {0, 0, 3}};
const auto kOpen = [](double) { return 1.0; };

TEST(Cie171, RoofOpening) {
  compareWithTable("5.9_1x1", kSmallRoof, kOpen, 2e-4);
  compareWithTable("5.9_4x4", kWholeRoof, kOpen, 2e-4);
}

TEST(Cie171, RoofGlass) {
  compareWithTable("5.10_1x1", kSmallRoof, clearGlass, 2e-4);
  compareWithTable("5.10_4x4", kWholeRoof, clearGlass, 2e-4);
  const Glass glass(clearGlass(1.0));
  const auto byFresnel = [&](double cosine) { return glass.transmittance(cosine); };
  compareWithTable("5.10_1x1", kSmallRoof, byFresnel, 0.03);
  compareWithTable("5.10_4x4", kWholeRoof, byFresnel, 0.03);
}

TEST(Cie171, WallOpening) {
  compareWithTable("5.11_2x1", kWindow, kOpen, 2e-4);
  compareWithTable("5.11_4x3", kWholeWall, kOpen, 2e-4);
}

TEST(Cie171, WallGlass) {
  compareWithTable("5.12_2x1", kWindow, clearGlass, 2e-4);
  compareWithTable("5.12_4x3", kWholeWall, clearGlass, 2e-4);
}

}  // namespace
}  // namespace clerestory
