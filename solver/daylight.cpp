// SPDX-License-Identifier: GPL-3.0-or-later
// Sun position and the brightness of sun and sky.
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <import/error.hpp>
#include <solver/daylight.hpp>

#include "perez.hpp"

namespace clerestory {
namespace {

double wrapped_deg(double angle_deg) {
  const double rest = std::fmod(angle_deg, 360.0);
  return rest < 0.0 ? rest + 360.0 : rest;
}

/// Days since noon of 1 January 2000, universal time (Fliegel and Van Flandern's day count).
double daysSince2000(const ClockTime& time, double universal_h) {
  const int shift = (time.month - 14) / 12;
  const int day = 1461 * (time.year + 4800 + shift) / 4 + 367 * (time.month - 2 - 12 * shift) / 12 -
                  3 * ((time.year + 4900 + shift) / 100) / 4 + time.day - 32075;
  return day - 2451545 - 0.5 + universal_h / 24.0;
}

int dayOfYear(const ClockTime& time) {
  const auto sinceNewYear = [&](int month, int day) {
    ClockTime other = time;
    other.month = month;
    other.day = day;
    return daysSince2000(other, 0.0);
  };
  return static_cast<int>(std::lround(sinceNewYear(time.month, time.day) - sinceNewYear(1, 1))) + 1;
}

/// Refraction of a true altitude. [degrees]
double refraction_deg(double altitude_deg) {
  if (altitude_deg < -1.0) return 0.0;
  const double minutes = 1.02 / std::tan(glm::radians(altitude_deg + 10.3 / (altitude_deg + 5.11)));
  return std::max(minutes / 60.0, 0.0);
}

std::string degrees(double value) {
  const double tenths = std::round(10.0 * value) / 10.0;
  std::string text = std::to_string(tenths);
  return text.substr(0, text.find('.') + 2);
}

}  // namespace

glm::dvec2 sunPosition_deg(const ClockTime& time, const Site& site) {
  const double universal_h = time.hour_h - time.zone_h.value_or(site.timeZone_h);
  const double days = daysSince2000(time, universal_h);
  const double meanLongitude_deg = wrapped_deg(280.460 + 0.9856474 * days);
  const double anomaly = glm::radians(wrapped_deg(357.528 + 0.9856003 * days));
  const double longitude =
      glm::radians(meanLongitude_deg + 1.915 * std::sin(anomaly) + 0.020 * std::sin(2.0 * anomaly));
  const double obliquity = glm::radians(23.439 - 0.0000004 * days);
  const double rightAscension_deg =
      glm::degrees(std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude)));
  const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));

  // Greenwich mean sidereal time by the days since 2000, in which the hours of universal time are contained.
  const double sidereal_deg = wrapped_deg(280.46062 + 360.985647366 * days);
  const double hourAngle = glm::radians(wrapped_deg(sidereal_deg + site.longitude_deg - rightAscension_deg));
  const double latitude = glm::radians(site.latitude_deg);
  const double sinAltitude = std::sin(latitude) * std::sin(declination) +
                             std::cos(latitude) * std::cos(declination) * std::cos(hourAngle);
  const double altitude_deg = glm::degrees(std::asin(std::clamp(sinAltitude, -1.0, 1.0)));
  const double azimuth_deg =
      glm::degrees(std::atan2(-std::cos(declination) * std::sin(hourAngle),
                              std::sin(declination) * std::cos(latitude) -
                                  std::cos(declination) * std::sin(latitude) * std::cos(hourAngle)));
  return {altitude_deg + refraction_deg(altitude_deg), wrapped_deg(azimuth_deg)};
}

Brightness perezBrightness(const Irradiance& irradiance, double sunAltitude_deg, int dayOfYear) {
  const PerezWeather weather = perezWeather(irradiance, sunAltitude_deg, dayOfYear);
  const PerezEfficacy efficacy = perezEfficacy(weather, sunAltitude_deg);
  return {efficacy.diffuse_lm_W * irradiance.diffuseHorizontal_W_m2,
          efficacy.direct_lm_W * irradiance.directNormal_W_m2};
}

Daylight daylightOf(const Study& study) {
  const SkySettings& asked = study.sky;
  std::optional<glm::dvec2> sun_deg = asked.sun_deg;
  if (asked.time) sun_deg = sunPosition_deg(*asked.time, study.site);
  const bool isUp = sun_deg && sun_deg->x > 0.0;
  if (asked.time && !isUp) {
    throw InputError("[sky] time " + clockTimeText(*asked.time) + ": the sun is " + degrees(-sun_deg->x) +
                     " degrees below the horizon at latitude " + degrees(study.site.latitude_deg) +
                     ", longitude " + degrees(study.site.longitude_deg) +
                     "; choose a time of day, or mind [site] time_zone");
  }
  const glm::dvec2 place_deg = sun_deg.value_or(glm::dvec2(90.0, 180.0));
  const glm::dvec3 towardsSun = directionFromAngles(place_deg.x, place_deg.y, study.site.north_deg);
  Brightness brightness{asked.diffuseHorizontal_lx, isUp ? asked.directNormal_lx : 0.0};
  if (!asked.isPerez) {
    return {Sky(asked.cieType, brightness.diffuseHorizontal_lx, towardsSun, study.groundReflectance), sun_deg,
            towardsSun, brightness.directNormal_lx};
  }
  const int day = asked.time ? dayOfYear(*asked.time) : 0;
  const Irradiance irradiance = asked.irradiance.value_or(
      perezIrradiance(brightness.diffuseHorizontal_lx, brightness.directNormal_lx, place_deg.x, day));
  if (asked.irradiance) brightness = perezBrightness(irradiance, place_deg.x, day);
  const SkyShape shape = perezShape(perezWeather(irradiance, place_deg.x, day), place_deg.x);
  return {Sky(shape, brightness.diffuseHorizontal_lx, towardsSun, study.groundReflectance), sun_deg,
          towardsSun, brightness.directNormal_lx};
}

}  // namespace clerestory
