// SPDX-License-Identifier: GPL-3.0-or-later
// Shooting hierarchical radiosity in one domain: the paper's algorithm of section 3.1.
#pragma once

#include "solveddomain.hpp"

namespace clerestory {

/// SHOOTING-HR. Solves a domain of `light.world()` over `tree`, which grows by elements where light asks for
/// them. `light` holds the outside where the domain has portals. Results do not depend on the cache.
template <int K>
SolvedDomain<K> shootingHR(const SolvedLight<K>& light, std::int32_t domain, Hierarchy tree,
                           const TransportSettings& settings, LinkCache& cache);

}  // namespace clerestory
