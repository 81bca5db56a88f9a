// SPDX-License-Identifier: GPL-3.0-or-later
// A subdivision cage in OpenSubdiv's terms, checked.
#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include <memory>
#include <optional>
#include <vector>

#include "soup.hpp"

namespace clerestory {

/// Faces of four corners, or of three for Loop's scheme.
struct LimitCage {
  std::vector<double> points;  ///< 3 × #points
  std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> refiner;
};

/// The cage with its points on the grid; where faces have other than four corners, after one step of
/// subdivision, which leaves its limit surface as it is. Empty where an index is out of range or a face
/// cannot be subdivided: OpenSubdiv must not see it.
std::optional<LimitCage> limitCage(const Scene& scene, const Cage& cage, double grid_m);

/// Whether Bfr can make surfaces of the faces: OpenSubdiv 3.5.0 reads beyond its arrays where two faces alone
/// meet at a vertex that is not on the boundary, and where 16,000 meet; its time grows with their cube.
bool takesSurfaces(const LimitCage& cage);

}  // namespace clerestory
