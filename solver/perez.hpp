// SPDX-License-Identifier: GPL-3.0-or-later
// The all-weather sky and the luminous efficacies of Perez et al., by clearness and brightness of the sky.
//
// Perez, R.; Seals, R.; Michalsky, J.: All-weather model for sky luminance distribution. Solar Energy 50
// (1993), 235-245; erratum 51, 423. Perez, R. et al.: Modeling daylight availability and irradiance
// components from direct and global irradiance. Solar Energy 44 (1990), 271-289.
#pragma once

#include <cstddef>

#include <import/study.hpp>
#include <solver/sky.hpp>

namespace clerestory {

/// The sky's clearness and brightness, held to the range that the model was fitted in.
struct PerezWeather {
  double clearness, brightness;
  std::size_t bin;  ///< of clearness, 0 to 7
};

/// dayOfYear from 1, or 0 where it is not known: the sun is then at its mean distance.
PerezWeather perezWeather(const Irradiance& irradiance, double sunAltitude_deg, int dayOfYear);

/// Gradation and indicatrix of the sky's luminance.
SkyShape perezShape(const PerezWeather& weather, double sunAltitude_deg);

/// For a dew point of 11 °C.
struct PerezEfficacy {
  double diffuse_lm_W, direct_lm_W;
};
PerezEfficacy perezEfficacy(const PerezWeather& weather, double sunAltitude_deg);

/// The irradiances that give these illuminances, by iteration.
Irradiance perezIrradiance(double diffuseHorizontal_lx, double directNormal_lx, double sunAltitude_deg,
                           int dayOfYear);

}  // namespace clerestory
