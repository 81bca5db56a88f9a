// SPDX-License-Identifier: GPL-3.0-or-later
// What a domain's sides matter to the figures that a study asks for: its dual solution.
#pragma once

#include <span>
#include <vector>

#include "world.hpp"

namespace clerestory {

/// Weights of a closed domain's sides (#sides) for its hierarchy: what the figures that are asked for in it
/// would miss if the light on a side were missed. They add up to the sides' area [m²], so that thresholds
/// stay comparable. Empty where nothing is asked for, or so much that importance would not pay: then area
/// counts.
///
/// Walks begin at sensors, and at eyes in all directions, and are reflected as light is: the dual of the
/// solver's equation, B = E + ρ F B. One that meets a side counts for it what that side reflects. A share of
/// the weights stays with area, since what matters little is still shown, and since walks are a sample.
std::vector<float> importanceOf(const World& world, const Study& study, std::int32_t domain,
                                std::span<const std::uint32_t> sides);

}  // namespace clerestory
