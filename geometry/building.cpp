// SPDX-License-Identifier: GPL-3.0-or-later
// From a clean model to a building, in the order of its questions: which air, which rooms, which sensors.
#include <algorithm>

#include <geometry/building.hpp>
#include <geometry/rays.hpp>

#include "backtoback.hpp"
#include "covered.hpp"
#include "cut.hpp"
#include "domains.hpp"
#include "luminaires.hpp"
#include "ownframe.hpp"
#include "rooms.hpp"
#include "shutopenings.hpp"

namespace clerestory {

namespace {

void cutAtCrossings(Building& building) {
  CleanModel& model = building.model;
  const std::size_t before = model.pieces.size();
  const std::vector<std::uint32_t> surfaceOf = model.pieces.surface;
  std::vector<Crossing> crossings;
  const std::vector<std::uint32_t> wholeOf =
      cutWhereCrossed(model.pieces, model.materials, building.sideDomain, crossings);
  if (wholeOf.size() != before) followCut(building, before, wholeOf);
  if (crossings.empty()) return;
  const auto objectOf = [&](const Crossing& crossing) {
    return model.surfaces[surfaceOf[crossing.piece]].name;
  };
  for (const Crossing& crossing : crossings)
    building.marks.push_back({"G220", objectOf(crossing), crossing.place_m});
  const auto longest =
      std::max_element(crossings.begin(), crossings.end(),
                       [](const Crossing& a, const Crossing& b) { return a.length_m < b.length_m; });
  addDiagnosis(
      building.diagnoses,
      {"G220", "surfaces run through each other and were cut where they cross; the longest line is named",
       "object \"" + objectOf(*longest) + "\"", crossings.size(), longest->place_m});
}

/// Turns what findings of a building have for places out of the frame, in which it was looked at.
void turnOutOf(const PlanFrame& frame, Building& building) {
  turnOutOf(frame, building.model.pieces);
  for (RoomBorder& border : building.borders)
    for (glm::dvec3& place : border.line_m) place = outOfFrame(frame, place);
  for (Diagnosis& diagnosis : building.diagnoses)
    if (diagnosis.place_m) diagnosis.place_m = outOfFrame(frame, *diagnosis.place_m);
  for (Mark& mark : building.marks) mark.place_m = outOfFrame(frame, mark.place_m);
  for (Luminaire& luminaire : building.luminaires) {
    luminaire.position_m = outOfFrame(frame, luminaire.position_m);
    for (int axis = 0; axis < 3; ++axis) luminaire.axes[axis] = outOfFrame(frame, luminaire.axes[axis]);
  }
}

}  // namespace

Building makeBuilding(CleanModel model, const Study& study) {
  Building building;
  building.model = std::move(model);
  if (building.model.pieces.size() == 0) {
    throw InputError("the model has no surface left to light: it holds no polygon, or only degenerate ones");
  }
  const PlanFrame frame = ownFrameOf(building.model.pieces.points, building.model.pieces.polygons);
  turnInto(frame, Tolerances(), building.model.pieces);
  cutAtPanes(building.model.pieces, building.model.materials);
  placeLuminaires(building, study, frame);
  findDomains(building);
  cutAtCrossings(building);
  cutBackToBack(building);
  RayScene rays(building.model, building.innerGlass);
  const std::vector<RoomAir> airs = airOfRooms(building, rays);
  if (cutAtDoorways(building, airs)) rays = RayScene(building.model, building.innerGlass);
  findRooms(building, frame, rays, airs);
  tellShutOpenings(building, rays);
  darkenCovered(building);
  partBackToBack(building);
  checkLuminaires(building);
  turnOutOf(frame, building);
  if (!study.grids.empty()) layGrids(building, study, RayScene(building.model, building.innerGlass));
  return building;
}

}  // namespace clerestory
