// SPDX-License-Identifier: GPL-3.0-or-later
// Makes luminaires of a model's lamps: their colour is kept beside a luminous intensity.
#include <glm/geometric.hpp>

#include <algorithm>
#include <numbers>

#include <import/scene.hpp>

namespace clerestory {

std::vector<Luminaire> luminairesOf(const std::vector<PunctualLight>& lights) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  std::vector<Luminaire> luminaires;
  for (const PunctualLight& light : lights) {
    const glm::dvec3 intensity_cd = glm::max(light.intensity, glm::dvec3(0.0));
    const double luminous_cd = glm::dot(intensity_cd, glm::dvec3(0.2126, 0.7152, 0.0722));
    if (light.kind == PunctualLight::Kind::directional || !(luminous_cd > 0.0)) continue;
    Luminaire luminaire;
    luminaire.name = light.name;
    luminaire.position_m = light.position_m;
    luminaire.color = intensity_cd / luminous_cd;
    luminaire.axes = luminaireAxes(light.direction, 0.0);
    const double outer_deg = std::clamp(light.outerCone_rad * kDegrees, 0.1, 90.0);
    const double inner_deg = std::clamp(light.innerCone_rad * kDegrees, 0.0, 0.999 * outer_deg);
    luminaire.photometry = std::make_shared<const Photometry>(
        light.kind == PunctualLight::Kind::point ? uniformPhotometry(luminous_cd)
                                                 : spotPhotometry(luminous_cd, inner_deg, outer_deg));
    luminaires.push_back(luminaire);
  }
  return luminaires;
}

}  // namespace clerestory
