// SPDX-License-Identifier: GPL-3.0-or-later
// Reflected light at the samples of a picture, from an irradiance cache.
#pragma once

#include "viewsamples.hpp"

namespace clerestory {

/// Gathers records of reflected light by at most `raysMost` rays each, at samples that those so far do not
/// cover, in finer and finer lattices of tiles; then tells all samples theirs from records.
template <int K>
void gatherReflected(const SolvedLight<K>& light, std::uint32_t raysMost, ViewSamples<K>& samples);

}  // namespace clerestory
