// SPDX-License-Identifier: GPL-3.0-or-later
// Gathering hierarchical radiosity with stored links (paper, sections 2.4 and 4.2): what shooting is charted
// against, never what a user's study runs.
#pragma once

#include "solveddomain.hpp"

namespace clerestory {

/// B <- E + HR(epsilon, B) by Jacobi steps over the same hierarchy, links and oracle as shootingHR, until a
/// step changes the domain's power by less than `settings.endShare`. All links are stored.
template <int K>
SolvedDomain<K> gatheringHR(const SolvedLight<K>& light, std::int32_t domain, Hierarchy tree,
                            const TransportSettings& settings);

}  // namespace clerestory
