// SPDX-License-Identifier: GPL-3.0-or-later
// The light outdoors that a study asks for: where the sun stands, how bright its beam and the sky are.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <optional>

#include <import/study.hpp>
#include <solver/sky.hpp>

namespace clerestory {

/// Half the angle that the sun's disc is seen under: a mean of the year. [degrees]
inline constexpr double sunRadius_deg = 0.2665;

/// The sun's apparent altitude and azimuth (from north over east) in degrees: the Astronomical Almanac's
/// approximate formulae as Michalsky gives them (Solar Energy 40, 1988, 227-235), within 0.01° from 1950 to
/// 2050 and little worse to 2100. Raised by refraction in an atmosphere of 1010 mbar and 10 °C (Saemundsson's
/// formula as in Meeus, Astronomical Algorithms, 16.4) where the sun is not far below the horizon.
glm::dvec2 sunPosition_deg(const ClockTime& time, const Site& site);

/// Illuminances from irradiances by the luminous efficacies of Perez et al. (Solar Energy 44, 1990, 271-289).
struct Brightness {
  double diffuseHorizontal_lx, directNormal_lx;
};
Brightness perezBrightness(const Irradiance& irradiance, double sunAltitude_deg, int dayOfYear);

/// What shines on a building.
struct Daylight {
  Sky sky;
  std::optional<glm::dvec2> sun_deg;     ///< altitude and azimuth, where the study places the sun
  glm::dvec3 towardsSun{0.0, 0.0, 1.0};  ///< unit vector, z up
  double directNormal_lx = 0.0;          ///< of the sun's beam; 0: none
};

/// Throws InputError where a sky that needs the sun is asked for while it is below the horizon.
Daylight daylightOf(const Study& study);

}  // namespace clerestory
