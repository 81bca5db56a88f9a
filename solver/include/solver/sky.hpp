// SPDX-License-Identifier: GPL-3.0-or-later
// Luminance of the CIE skies, of skies of like shape, and of the uniform ground below them.
#pragma once

#include <glm/vec3.hpp>

namespace clerestory {

/// Unit vector, z up, from angles in degrees: azimuth from north over east; north is its direction in plan,
/// degrees clockwise from +y (90 means +x).
glm::dvec3 directionFromAngles(double altitude_deg, double azimuth_deg, double north_deg);

/// Luminance relative to that where both are 1: gradation (1 + a exp(b / z)) times indicatrix
/// (base + c exp(d chi) + e cos² chi), z the sine of altitude and chi the angle to the sun.
struct SkyShape {
  double a, b;
  double base, c, d, e;
};

/// CIE S 011 types 1 to 15 and 16, the traditional overcast sky, scaled to a horizontal diffuse illuminance
/// by the integral over the hemisphere; below the horizon a ground of uniform luminance. Immutable; safe to
/// share by threads.
class Sky {
 public:
  /// towardsSun is a unit vector, z up (types 1, 3, 5 and 16 ignore it). The ground is lit by the sky alone.
  /// Throws std::invalid_argument for a type outside [1, 16].
  Sky(int cieType, double diffuseHorizontal_lx, glm::dvec3 towardsSun, double groundReflectance);
  /// Where the shape falls below zero the sky is black.
  Sky(const SkyShape& shape, double diffuseHorizontal_lx, glm::dvec3 towardsSun, double groundReflectance);

  /// Luminance seen in a unit direction: sky for z >= 0 (the horizon is the sky's limit), else ground.
  float luminance_cd_m2(glm::vec3 direction) const;

  /// What the sky was scaled to, without the ground.
  double horizontalIlluminance_lx() const { return horizontal_lx_; }
  double zenithLuminance_cd_m2() const { return zenith_cd_m2_; }
  double groundLuminance_cd_m2() const { return ground_cd_m2_; }

 private:
  double horizontal_lx_, zenith_cd_m2_, ground_cd_m2_;
  glm::vec3 towardsSun_;
  float scale_cd_m2_ = 0.0F;                            ///< luminance where gradation and indicatrix are 1
  float a_ = 0.0F, b_ = 0.0F;                           ///< gradation: 1 + a exp(b / z); type 16: 1 + a z
  float base_ = 1.0F, c_ = 0.0F, d_ = 0.0F, e_ = 0.0F;  ///< base + c exp(d chi) + e cos^2 chi
  bool linear_ = false;                                 ///< type 16
  bool sunny_ = false;                                  ///< depends on the sun's place
};

}  // namespace clerestory
