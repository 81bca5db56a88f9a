// SPDX-License-Identifier: GPL-3.0-or-later
// Whether what a few rays agree on is so.
#pragma once

#include <cstdint>
#include <span>

#include "receiver.hpp"
#include "world.hpp"

namespace clerestory {

enum class Way : std::uint8_t { blocked, open };

/// What a receiver is looking at.
struct Target {
  std::span<const glm::vec3> polygon;
  glm::vec3 lift;     ///< off it, where rays end
  std::uint64_t key;  ///< for points of its own
};

/// Whether one of `looks` ways, from all over a receiver to all over a target, is as `asked`; adds the rays
/// that this took. With n looks for each threshold that the light counts, what all of them miss is 1 / (e n)
/// of a threshold on average, or less.
bool findsWay(const World& world, const Receiver& receiver, const Target& target, Way asked, float looks,
              std::uint64_t& rays);

}  // namespace clerestory
