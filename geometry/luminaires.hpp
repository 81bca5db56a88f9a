// SPDX-License-Identifier: GPL-3.0-or-later
// Luminaires in a building: in front of the surface that they are fixed to, and in which air.
#pragma once

#include <functional>
#include <optional>

#include <geometry/building.hpp>
#include <geometry/rays.hpp>

#include "planframe.hpp"

namespace clerestory {

/// Puts a building's luminaires in place, in the frame that its pieces lie in: those of the model and of the
/// study, with what their files had to say. One that lies in or little behind a surface, as a recessed one in
/// a ceiling, comes a millimetre before it.
void placeLuminaires(Building& building, const Study& study, const PlanFrame& frame);

/// What a luminaire sees along its aim or, where `isAir` refuses that side, about it: a side, or nothing (a
/// false Hit). Empty where all are refused, so that it is within something solid.
std::optional<RayScene::Hit> sideSeenBy(const Luminaire& luminaire, const RayScene& rays,
                                        const std::function<bool(std::uint32_t side)>& isAir);

/// Says which luminaires stand in no room and not outdoors. Asked when rooms are known.
void checkLuminaires(Building& building);

}  // namespace clerestory
