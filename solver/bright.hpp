// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of surfaces that reflect far more than the rest: a patch of sun, what a lamp hangs close to. Rays
// over a hemisphere meet them by luck alone, so points look at them apart.
#pragma once

#include "radiosity.hpp"

namespace clerestory {

/// Finds them in a solved domain.
template <int K>
void findBrightParts(const ColumnLayout& layout, Radiosity<K>& radiosity);

}  // namespace clerestory
