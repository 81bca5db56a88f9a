// SPDX-License-Identifier: GPL-3.0-or-later
// From a clean model to a building, in the order of its questions: which air, which rooms, which sensors.
#include <geometry/building.hpp>
#include <geometry/rays.hpp>

#include "cut.hpp"
#include "domains.hpp"
#include "luminaires.hpp"
#include "rooms.hpp"

namespace clerestory {

Building makeBuilding(CleanModel model, const Study& study) {
  Building building;
  building.model = std::move(model);
  if (building.model.pieces.size() == 0) {
    throw InputError("the model has no surface left to light: it holds no polygon, or only degenerate ones");
  }
  cutAtPanes(building.model.pieces, building.model.materials);
  placeLuminaires(building, study);
  findDomains(building);
  RayScene rays(building.model, building.innerGlass);
  const std::vector<RoomAir> airs = airOfRooms(building, rays);
  if (cutAtDoorways(building, airs)) rays = RayScene(building.model, building.innerGlass);
  findRooms(building, rays, airs);
  checkLuminaires(building);
  layGrids(building, study, rays);
  return building;
}

}  // namespace clerestory
