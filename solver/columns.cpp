// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the columns of a solve: no more than the scene needs.
#include "columns.hpp"

#include <cmath>

namespace clerestory {
namespace {

bool isGrey(const glm::dvec3& colour) {
  return colour.r == colour.g && colour.g == colour.b;
}

}  // namespace

ColumnLayout columnsFor(const Building& building, bool skyIsBright, bool sunShines) {
  ColumnLayout layout;
  std::vector<bool> used(building.model.materials.size(), false);
  for (const std::uint32_t material : building.model.pieces.material) used[material] = true;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const Material& material = building.model.materials[i];
    if (!used[i]) continue;
    layout.grey = layout.grey && isGrey(material.reflectance) && isGrey(material.exitance_lm_m2) &&
                  (!material.glazing || isGrey(material.transmittance));
    layout.electric = layout.electric || material.exitance_lm_m2 != glm::dvec3(0.0);
  }
  for (const Luminaire& luminaire : building.luminaires) {
    layout.grey = layout.grey && isGrey(luminaire.color);
    layout.electric = true;
  }
  bool seesSky = !building.portals.empty();
  for (const Domain& domain : building.domains) seesSky = seesSky || domain.open;
  layout.sky = (skyIsBright && seesSky) || !layout.electric;
  layout.sun = sunShines && seesSky;
  return layout;
}

}  // namespace clerestory
