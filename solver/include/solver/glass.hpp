// SPDX-License-Identifier: GPL-3.0-or-later
// Transmittance and reflectance of a pane unit by the angle of incidence.
#pragma once

#include <glm/vec2.hpp>

#include <vector>

namespace clerestory {

/// A pane unit of equal clear sheets: Fresnel at every face for each polarisation, reflections within and
/// between the sheets summed, absorption fitted so that the unit transmits what is stated at normal incidence
/// (normal-normal). Above what the index allows without absorption (0.918 for one sheet of 1.52) the curve is
/// scaled up and reflects the rest; a stated 1 is an opening without glass. The same from both sides.
/// Immutable; safe to share by threads.
class Glass {
 public:
  /// normalTransmittance in [0, 1], sheets >= 1, refractiveIndex >= 1; std::invalid_argument elsewhere.
  explicit Glass(double normalTransmittance, int sheets = 1, double refractiveIndex = 1.52);

  /// The 6 mm clear glass of CIE 171:2006, case 5.5: its transmittance is the polynomial in the cosine of
  /// Tregenza and Sharples (0.8788 at normal incidence), its reflectance that of a sheet that transmits as
  /// much.
  static Glass cie171Clear();

  /// By |cosine| of the angle of incidence, from a table: within 1e-4 of the model. transmittance +
  /// reflectance <= 1.
  float transmittance(float cosIncidence) const;
  float reflectance(float cosIncidence) const;
  double transmittance(double cosIncidence) const;
  double reflectance(double cosIncidence) const;

  /// For diffuse light, the mean weighted by the cosine.
  double hemisphericalTransmittance() const { return hemispherical_.x; }
  double hemisphericalReflectance() const { return hemispherical_.y; }

 private:
  std::vector<glm::vec2> table_;  ///< transmittance and reflectance, even in the cosine from 0 to 1
  glm::dvec2 hemispherical_;
};

}  // namespace clerestory
