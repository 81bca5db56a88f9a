// SPDX-License-Identifier: GPL-3.0-or-later
// From airs to domains: glass joins or parts them, and what brings light to them is asked.
#include "domains.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

#include <geometry/parallel.hpp>

#include "airsurvey.hpp"
#include "cut.hpp"
#include "luminaires.hpp"

namespace clerestory {
namespace {

bool isGlass(const CleanModel& model, std::uint32_t piece) {
  return model.materials[model.pieces.material[piece]].glazing;
}

bool isEmitter(const CleanModel& model, std::uint32_t piece) {
  return model.materials[model.pieces.material[piece]].exitance_lm_m2 != glm::dvec3(0.0);
}

/// Glass with the outside, or with closed air, on both of its sides bounds nothing: its two airs become one.
std::vector<bool> joinAcrossInnerGlass(const CleanModel& model, std::vector<std::uint32_t>& air,
                                       std::uint32_t outside) {
  std::vector<bool> inner(model.pieces.size(), false);
  std::map<std::uint32_t, std::uint32_t> joined;  // an air and the lower one that it has become a part of
  const auto find = [&](std::uint32_t own) {
    for (auto found = joined.find(own); found != joined.end(); found = joined.find(own)) own = found->second;
    return own;
  };
  for (std::uint32_t piece = 0; piece < model.pieces.size(); ++piece) {
    if (!isGlass(model, piece)) continue;
    if (air[2 * piece] == nowhere || air[2 * piece + 1] == nowhere) {
      inner[piece] = true;  // pressed between other surfaces
      continue;
    }
    const std::uint32_t front = find(air[2 * piece]);
    const std::uint32_t back = find(air[2 * piece + 1]);
    if ((front == outside) != (back == outside)) continue;
    inner[piece] = true;
    if (front != back) joined.emplace(std::max(front, back), std::min(front, back));
  }
  for (std::uint32_t& own : air) own = find(own);
  return inner;
}

/// Pieces that stand in two airs, for which they are worth cutting.
std::vector<bool> piecesInTwoAirs(const CleanModel& model, const AirSurvey& survey) {
  std::vector<bool> inTwoAirs(model.pieces.size());
  for (std::uint32_t piece = 0; piece < model.pieces.size(); ++piece) {
    inTwoAirs[piece] =
        !isGlass(model, piece) && (survey.isInTwoAirs(2 * piece) || survey.isInTwoAirs(2 * piece + 1));
  }
  return inTwoAirs;
}

/// Pieces with another air on either side, at which others are cut: walls and columns, but not the legs of
/// chairs, whose insides are too small to be airs.
std::vector<bool> piecesBetweenAirs(const CleanModel& model, const AirSurvey& survey) {
  constexpr double solidLeast_m2 = 0.05;  // of one that is too thin for air between its sheets
  std::vector<bool> partAirs(model.pieces.size());
  for (std::uint32_t piece = 0; piece < model.pieces.size(); ++piece) {
    const std::uint32_t front = survey.airOf(2 * piece);
    const std::uint32_t back = survey.airOf(2 * piece + 1);
    const bool isSolid = front == nowhere || back == nowhere;
    partAirs[piece] = !isSolid ? front != back : model.pieces.area_m2[piece] >= solidLeast_m2;
  }
  return partAirs;
}

}  // namespace

void findDomains(Building& building) {
  CleanModel& model = building.model;
  const RayScene whole(model, {});
  auto survey = std::make_unique<AirSurvey>(model, whole);
  std::optional<RayScene> cut;
  const std::vector<bool> inTwoAirs = piecesInTwoAirs(model, *survey);
  if (std::find(inTwoAirs.begin(), inTwoAirs.end(), true) != inTwoAirs.end()) {
    const std::size_t piecesBefore = model.pieces.size();
    const SameSides same(cutWhereMet(model.pieces, inTwoAirs, piecesBetweenAirs(model, *survey)),
                         piecesBefore);
    cut.emplace(model, std::vector<bool>());
    survey = std::make_unique<AirSurvey>(model, *cut, *survey, same);
  }
  std::vector<std::uint32_t> air(2 * model.pieces.size());
  for (std::uint32_t side = 0; side < air.size(); ++side) air[side] = survey->airOf(side);
  const std::uint32_t outside = survey->outside();
  std::vector<bool> lit(survey->airLimit(), false);
  lit[outside] = true;
  for (std::uint32_t side = 0; side < air.size(); ++side) {
    const bool brings = isGlass(model, side / 2) || isEmitter(model, side / 2);
    if (brings && air[side] != nowhere) lit[air[side]] = true;
  }
  const RayScene& rays = cut ? *cut : whole;
  for (const Luminaire& luminaire : building.luminaires) {
    const auto seen = sideSeenBy(luminaire, rays, [&](std::uint32_t side) { return air[side] != nowhere; });
    if (seen && *seen) lit[air[seen->side()]] = true;
  }
  forEachIndex(air.size(), 64, [&](std::size_t side) {
    air[side] = survey->closerAirOf(static_cast<std::uint32_t>(side), air[side], lit);
  });
  building.innerGlass = joinAcrossInnerGlass(model, air, outside);

  // Domains are numbered by their first side, the outside first.
  std::map<std::uint32_t, std::int32_t> numbers;
  if (std::find(air.begin(), air.end(), outside) != air.end()) numbers.emplace(outside, 0);
  building.sideDomain.assign(air.size(), -1);
  for (std::uint32_t side = 0; side < air.size(); ++side) {
    if (air[side] == nowhere) continue;
    building.sideDomain[side] =
        numbers.emplace(air[side], static_cast<std::int32_t>(numbers.size())).first->second;
  }
  building.domains.assign(numbers.size(), {});
  for (std::uint32_t side = 0; side < air.size(); ++side) {
    if (air[side] == nowhere) continue;
    Domain& domain = building.domains[static_cast<std::size_t>(building.sideDomain[side])];
    domain.open = air[side] == outside;
    domain.area_m2 += model.pieces.area_m2[side / 2];
    domain.escape_m2 += model.pieces.area_m2[side / 2] * survey->escapedShare(side);
    domain.lit = domain.lit || domain.open || isEmitter(model, side / 2);
  }

  for (std::uint32_t piece = 0; piece < model.pieces.size(); ++piece) {
    if (!isGlass(model, piece) || building.innerGlass[piece]) continue;
    const bool frontIsInside = air[2 * piece + 1] == outside;
    const std::int32_t front = building.sideDomain[2 * piece];
    const std::int32_t back = building.sideDomain[2 * piece + 1];
    building.portals.push_back(
        {piece, frontIsInside, frontIsInside ? front : back, frontIsInside ? back : front});
    building.domains[static_cast<std::size_t>(building.portals.back().inside)].lit = true;
  }

  const auto isAir = [&](std::uint32_t side) { return building.sideDomain[side] >= 0; };
  const bool hasOutside = !building.domains.empty() && building.domains[0].open;
  for (const Luminaire& luminaire : building.luminaires) {
    const auto seen = sideSeenBy(luminaire, rays, isAir);
    std::int32_t domain = -1;
    if (seen && *seen) domain = building.sideDomain[seen->side()];
    if (seen && !*seen && hasOutside) domain = 0;
    building.luminaireDomain.push_back(domain);
    if (domain >= 0) building.domains[static_cast<std::size_t>(domain)].lit = true;
  }
}

}  // namespace clerestory
