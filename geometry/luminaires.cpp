// SPDX-License-Identifier: GPL-3.0-or-later
// Seats luminaires by rays along their aim.
#include "luminaires.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <set>

#include "ownframe.hpp"

namespace clerestory {
namespace {

constexpr float behindMost_m = 0.010F;  // a ceiling's sheet, rounding of a model's millimetres
constexpr float before_m = 0.001F;

glm::vec3 aimOf(const Luminaire& luminaire) {
  return -glm::vec3(luminaire.axes[2]);
}

/// Brings a luminaire before a surface that lies up to behindMost_m before it.
bool seat(const RayScene& rays, Luminaire& luminaire) {
  const glm::vec3 aim = aimOf(luminaire);
  const glm::vec3 at(luminaire.position_m - rays.origin());
  const auto hit =
      rays.nearest(at + behindMost_m * aim, -aim, RayScene::Barrier::opaque, behindMost_m + before_m);
  if (!hit) return false;
  const float ahead_m = behindMost_m - hit.distance_m;
  luminaire.position_m += static_cast<double>(ahead_m + before_m) * glm::dvec3(aim);
  return ahead_m > before_m;
}

void addLuminaireDiagnosis(Building& building, const Luminaire& luminaire, const char* code,
                           const char* message) {
  const std::string where = "luminaire \"" + luminaire.name + "\"";
  addDiagnosis(building.diagnoses, {code, message, where, 1, luminaire.position_m});
  building.marks.push_back({code, luminaire.name, luminaire.position_m});
}

}  // namespace

void placeLuminaires(Building& building, const Study& study, const PlanFrame& frame) {
  building.luminaires = building.model.luminaires;
  const std::vector<Luminaire> ofStudy = luminairesOf(study);
  building.luminaires.insert(building.luminaires.end(), ofStudy.begin(), ofStudy.end());
  for (Luminaire& luminaire : building.luminaires) {
    luminaire.position_m = intoFrame(frame, luminaire.position_m);
    for (int axis = 0; axis < 3; ++axis) luminaire.axes[axis] = intoFrame(frame, luminaire.axes[axis]);
  }
  std::set<const Photometry*> files;
  for (const Luminaire& luminaire : building.luminaires) {
    if (!files.insert(luminaire.photometry.get()).second) continue;
    for (const Diagnosis& diagnosis : luminaire.photometry->diagnoses)
      addDiagnosis(building.diagnoses, diagnosis);
  }
  if (building.luminaires.empty()) return;
  const RayScene rays(building.model, {});
  for (Luminaire& luminaire : building.luminaires) {
    if (!seat(rays, luminaire)) continue;
    addLuminaireDiagnosis(
        building, luminaire, "G260",
        "luminaires up to 10 mm behind a surface were put before it, so that they are not hidden");
  }
}

std::optional<RayScene::Hit> sideSeenBy(const Luminaire& luminaire, const RayScene& rays,
                                        const std::function<bool(std::uint32_t side)>& isAir) {
  const glm::vec3 aim = aimOf(luminaire);
  const glm::vec3 along(luminaire.axes[0]);
  const glm::vec3 across(luminaire.axes[1]);
  const glm::vec3 from = glm::vec3(luminaire.position_m - rays.origin()) + before_m * aim;
  for (const glm::vec3& direction :
       {aim, aim + 0.4F * along, aim + 0.4F * across, aim - 0.4F * along, aim - 0.4F * across}) {
    const auto hit = rays.nearest(from, glm::normalize(direction), RayScene::Barrier::opaqueAndGlass);
    if (!hit || isAir(hit.side())) return hit;
  }
  return std::nullopt;
}

void checkLuminaires(Building& building) {
  for (std::size_t i = 0; i < building.luminaires.size(); ++i) {
    const std::int32_t domain = building.luminaireDomain[i];
    const bool isInRoom = std::any_of(building.rooms.begin(), building.rooms.end(),
                                      [&](const Room& room) { return room.domain == domain; });
    if (isInRoom || (domain >= 0 && building.domains[static_cast<std::size_t>(domain)].open)) continue;
    addLuminaireDiagnosis(
        building, building.luminaires[i], "G261",
        "luminaires stand in no room but within something solid; their light reaches nothing");
  }
}

}  // namespace clerestory
