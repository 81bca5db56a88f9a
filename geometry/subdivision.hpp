// SPDX-License-Identifier: GPL-3.0-or-later
// Subdivision cages become facets of their limit surfaces.
#pragma once

#include "findings.hpp"
#include "soup.hpp"

namespace clerestory {

/// Appends the facets of the cage's limit surface to the soup, without cracks between neighbours: triangles,
/// and quadrilaterals that are planar.
void tessellateCage(const Scene& scene, const Cage& cage, const Tolerances& tolerances, Soup& soup,
                    CleanupCounts& counts, Findings& findings);

}  // namespace clerestory
