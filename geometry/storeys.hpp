// SPDX-License-Identifier: GPL-3.0-or-later
// The storeys of a domain's air, each cut into regions: what rooms are made of.
#pragma once

#include "airmap.hpp"
#include "parting.hpp"

namespace clerestory {

struct Storey {
  double floor_m, end_m;  ///< heights of its floor and of the next storey's
  double ceiling_m;       ///< of most of its ceiling
  Parted parted;
  std::vector<std::int32_t> nearest;  ///< #cells: region of the nearest cell that has one
};

/// Storeys that have a region, from the lowest up. Floors of two storeys are 1.8 m apart at least.
std::vector<Storey> storeysOf(const AirMap& map, const Pieces& pieces, const RayScene& rays);

}  // namespace clerestory
