// SPDX-License-Identifier: GPL-3.0-or-later
// A luminaire in its place.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <memory>
#include <string>

#include <import/photometry.hpp>

namespace clerestory {

struct Luminaire {
  std::string name;
  std::shared_ptr<const Photometry> photometry;
  glm::dvec3 position_m{0.0};  ///< of the luminous opening's centre, in the model's coordinates
  glm::dmat3 axes{1.0};        ///< columns: unit vectors towards C0, towards C90 and against the nadir
  double factor = 1.0;         ///< on all intensities
  glm::dvec3 color{1.0};       ///< linear Rec.709, of luminance 1

  /// Flux that leaves it. [lm]
  [[nodiscard]] double flux_lm() const { return factor * photometry->distribution.flux_lm(); }
};

/// Axes of a luminaire whose nadir points along the unit vector `aim`: those of one that points straight
/// down, with C0 turned from +x towards +y, tilted by the shortest turn. Straight up, that turn is about +x.
glm::dmat3 luminaireAxes(const glm::dvec3& aim, double rotation_deg);

/// The factor that a file's TILT data ask for with these axes.
double tiltFactor(const LampTilt& tilt, const glm::dmat3& axes);

}  // namespace clerestory
