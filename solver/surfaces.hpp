// SPDX-License-Identifier: GPL-3.0-or-later
// Means over surfaces, and the elements to draw, from solved domains.
#pragma once

#include <solver/solution.hpp>

#include "radiosity.hpp"

namespace clerestory {

/// One row for each surface and room of all solved domains, in the order of rooms (outside last) and
/// surfaces; `mesh` becomes the elements that the rows are made of.
template <int K>
std::vector<SurfaceValue> measureSurfaces(const SolvedLight<K>& light, ElementMesh& mesh);

}  // namespace clerestory
