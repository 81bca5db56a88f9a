// SPDX-License-Identifier: GPL-3.0-or-later
// Means over surfaces, from the elements of a solved domain.
#pragma once

#include <solver/solution.hpp>

#include "radiosity.hpp"

namespace clerestory {

/// One row for each surface and room of all solved domains, in the order of rooms (outside last) and
/// surfaces. solverError: relative error of an element's illuminance, for error_lx.
template <int K>
std::vector<SurfaceValue> measureSurfaces(const SolvedLight<K>& light, double solverError);

}  // namespace clerestory
