// SPDX-License-Identifier: GPL-3.0-or-later
// The sun's place against published ones, and Perez' sky and efficacies.
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <import/error.hpp>
#include <solver/daylight.hpp>

namespace clerestory {
namespace {

Site siteAt(double latitude_deg, double longitude_deg, double zone_h = 0.0) {
  return {latitude_deg, longitude_deg, zone_h, 0.0, 0.0};
}

/// Altitude that the sun reaches on a day.
double highest_deg(int year, int month, int day, const Site& site) {
  double most = -90.0;
  for (int minute = 0; minute < 24 * 60; ++minute)
    most = std::max(most, sunPosition_deg({year, month, day, minute / 60.0, {}}, site).x);
  return most;
}

// The worked example of Reda and Andreas, Solar Position Algorithm (NREL/TP-560-34302): topocentric zenith
// 50.11162 deg, azimuth 194.34024 deg. It has 820 mbar at 1,830 m, where refraction is 0.004 deg less.
TEST(SunPosition, WorkedExampleOfSpa) {
  const glm::dvec2 sun = sunPosition_deg({2003, 10, 17, 12.0 + 30.0 / 60.0 + 30.0 / 3600.0, {}},
                                         siteAt(39.742476, -105.1786, -7.0));
  EXPECT_NEAR(sun.x, 90.0 - 50.11162 + 0.004, 0.01);
  EXPECT_NEAR(sun.y, 194.34024, 0.01);
}

// Published instants of 2026 (universal time): equinoxes 20 March 14:46 and 23 September 00:05, solstices
// 21 June 08:25 and 21 December 20:50. At a pole the altitude is the declination, raised by refraction: 0.48
// deg at the horizon that way, 0.04 deg at 23.4 deg.
TEST(SunPosition, EquinoxesAndSolsticesOfAYear) {
  const Site north = siteAt(90.0, 0.0);
  const Site south = siteAt(-90.0, 0.0);
  const auto declination = [&](int month, int day, double hour) {
    const double up = sunPosition_deg({2026, month, day, hour, 0.0}, north).x;
    const double down = sunPosition_deg({2026, month, day, hour, 0.0}, south).x;
    if (std::abs(up) > 2.0 || std::abs(down) > 2.0) return up > 0.0 ? up - 0.0387 : -(down - 0.0387);
    return 0.5 * (up - down);
  };
  EXPECT_NEAR(declination(3, 20, 14.0 + 46.0 / 60.0), 0.0, 0.01);
  EXPECT_NEAR(declination(9, 23, 5.0 / 60.0), 0.0, 0.01);
  EXPECT_NEAR(declination(6, 21, 8.0 + 25.0 / 60.0), 23.436, 0.01);
  EXPECT_NEAR(declination(12, 21, 20.0 + 50.0 / 60.0), -23.436, 0.01);
}

// On the solstice the noon altitude is 90 - latitude + 23.436 deg and refraction there is 0.0075 deg.
TEST(SunPosition, NoonAltitudeOnTheSolstice) {
  EXPECT_NEAR(highest_deg(2026, 6, 21, siteAt(47.37, 8.54)), 90.0 - 47.37 + 23.436 + 0.0075, 0.01);
  EXPECT_NEAR(highest_deg(2026, 12, 21, siteAt(-33.87, 151.21)), 90.0 - 33.87 + 23.436 + 0.003, 0.01);
}

// The equation of time is +16 min 26 s on 3 November and -14 min 13 s on 11 February, to 5 s: 0.02 deg of
// the sun's way, which its azimuth magnifies by the cosine of declination over that of altitude.
TEST(SunPosition, PassesTheMeridianByTheEquationOfTime) {
  const Site greenwich = siteAt(51.48, 0.0);
  EXPECT_NEAR(sunPosition_deg({2026, 11, 3, 12.0 - (16.0 * 60.0 + 26.0) / 3600.0, 0.0}, greenwich).y, 180.0,
              0.03);
  EXPECT_NEAR(sunPosition_deg({2026, 2, 11, 12.0 + (14.0 * 60.0 + 13.0) / 3600.0, 0.0}, greenwich).y, 180.0,
              0.03);
}

TEST(SunPosition, ZonesAreOnlyAnotherWayToWriteATime) {
  const Site site = siteAt(47.37, 8.54, 1.0);
  const glm::dvec2 bySite = sunPosition_deg({2026, 3, 21, 0.5, {}}, site);
  const glm::dvec2 byZone = sunPosition_deg({2026, 3, 20, 23.5, 0.0}, site);
  EXPECT_NEAR(bySite.x, byZone.x, 1e-9);
  EXPECT_NEAR(bySite.y, byZone.y, 1e-9);
  const glm::dvec2 morning = sunPosition_deg({2026, 3, 21, 9.0, {}}, site);
  EXPECT_GT(morning.y, 90.0);
  EXPECT_LT(morning.y, 180.0) << "the morning's sun stands east of south";
}

Study skyAt(double hour_h, const std::string& type = "perez") {
  Study study;
  study.sky.isPerez = type == "perez";
  study.sky.time = ClockTime{2026, 6, 21, hour_h, {}};
  return study;
}

TEST(Daylight, SunBelowTheHorizonIsSaid) {
  try {
    daylightOf(skyAt(2.0));
    FAIL() << "a sky without its sun was taken";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("2026-06-21T02:00:00"), std::string::npos) << message;
    EXPECT_NE(message.find("below the horizon"), std::string::npos) << message;
  }
}

// Every sky of the model holds its diffuse illuminance, and is nowhere below zero: over clear, middling and
// overcast hours and suns from 2 to 65 deg. The hemisphere is summed by 200 x 400 directions, even in solid
// angle times cosine; the circumsolar peak is some degrees wide, which leaves 0.5 %.
TEST(Perez, SkyHoldsItsIlluminance) {
  for (const double altitude_deg : {2.0, 10.0, 30.0, 65.0}) {
    for (const Irradiance& weather :
         {Irradiance{0.0, 20.0}, Irradiance{0.0, 150.0}, Irradiance{20.0, 200.0}, Irradiance{80.0, 180.0},
          Irradiance{200.0, 200.0}, Irradiance{400.0, 150.0}, Irradiance{700.0, 100.0},
          Irradiance{900.0, 60.0}, Irradiance{900.0, 300.0}}) {
      Study study;
      study.sky.isPerez = true;
      study.sky.irradiance = weather;
      study.sky.sun_deg = glm::dvec2(altitude_deg, 130.0);
      const Daylight daylight = daylightOf(study);
      double sum = 0.0;
      constexpr int rings = 200, turns = 400;
      for (int i = 0; i < rings; ++i) {
        for (int k = 0; k < turns; ++k) {
          const double sine = std::sqrt((i + 0.5) / rings),
                       angle = 2.0 * std::numbers::pi * (k + 0.5) / turns;
          const glm::vec3 direction(
              glm::dvec3(sine * std::cos(angle), sine * std::sin(angle), std::sqrt(1.0 - sine * sine)));
          const auto luminance = static_cast<double>(daylight.sky.luminance_cd_m2(direction));
          ASSERT_GE(luminance, 0.0);
          sum += std::numbers::pi * luminance / (rings * turns);
        }
      }
      const double asked_lx = daylight.sky.horizontalIlluminance_lx();
      EXPECT_NEAR(sum, asked_lx, 0.005 * asked_lx) << altitude_deg << ' ' << weather.directNormal_W_m2;
    }
  }
}

// Luminous efficacies lie where measured ones do: 100 to 140 lm/W of an overcast sky, more of a blue one, 80
// to 110 of a high sun; and the beam's energy is the irradiance times its efficacy, whatever the hour.
TEST(Perez, EfficaciesArePlausible) {
  const Brightness overcast = perezBrightness({0.0, 150.0}, 40.0, 172);
  EXPECT_EQ(overcast.directNormal_lx, 0.0);
  EXPECT_GT(overcast.diffuseHorizontal_lx, 150.0 * 100.0);
  EXPECT_LT(overcast.diffuseHorizontal_lx, 150.0 * 140.0);
  const Brightness clear = perezBrightness({850.0, 80.0}, 50.0, 172);
  EXPECT_GT(clear.diffuseHorizontal_lx, 80.0 * 115.0);
  EXPECT_LT(clear.diffuseHorizontal_lx, 80.0 * 160.0);
  EXPECT_GT(clear.directNormal_lx, 850.0 * 85.0);
  EXPECT_LT(clear.directNormal_lx, 850.0 * 110.0);
}

// A study in lux makes the same sky as the irradiances that they stand for.
TEST(Perez, LuxAndWattsTellTheSame) {
  Study watts;
  watts.sky.isPerez = true;
  watts.sky.sun_deg = glm::dvec2(35.0, 140.0);
  watts.sky.irradiance = Irradiance{600.0, 120.0};
  const Daylight first = daylightOf(watts);
  Study lux = watts;
  lux.sky.irradiance.reset();
  lux.sky.diffuseHorizontal_lx = first.sky.horizontalIlluminance_lx();
  lux.sky.directNormal_lx = first.directNormal_lx;
  const Daylight second = daylightOf(lux);
  for (const glm::vec3 towards : {glm::vec3(0, 0, 1), glm::vec3(1, 2, 0.5F), glm::vec3(-3, 1, 0.1F)}) {
    const glm::vec3 direction = glm::normalize(towards);
    const float luminance = first.sky.luminance_cd_m2(direction);
    EXPECT_NEAR(second.sky.luminance_cd_m2(direction), luminance, 1e-4F * luminance);
  }
}

}  // namespace
}  // namespace clerestory
