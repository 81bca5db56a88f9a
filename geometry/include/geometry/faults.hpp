// SPDX-License-Identifier: GPL-3.0-or-later
// Faults of a mesh as it was drawn, counted the way tools for meshes count them, before anything is repaired.
#pragma once

#include <cstddef>

#include <import/scene.hpp>

namespace clerestory {

/// Of the scene's faces; cages are left out. Points count as one where their coordinates are equal. Faces
/// without area are counted and then left out of everything else.
struct DrawnFaults {
  std::size_t repeatedPoints = 0;    ///< corners' points beyond the first at a place
  std::size_t facesWithoutArea = 0;  ///< exactly none
  std::size_t repeatedFaces = 0;     ///< faces beyond the first with the same corners, whatever their winding
  std::size_t nonManifoldEdges = 0;  ///< of more than two faces
  std::size_t edgesWoundApart = 0;   ///< of two faces that run along it in one direction
  std::size_t tJunctions = 0;  ///< points within 10 µm of an edge of one face alone, strictly inside it
};

DrawnFaults countFaults(const Scene& scene);

}  // namespace clerestory
