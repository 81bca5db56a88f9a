// SPDX-License-Identifier: GPL-3.0-or-later
// The solution's elements as few bytes as the page's viewer needs.
#pragma once

#include <glm/vec3.hpp>

#include <string>

#include <solver/solution.hpp>

namespace clerestory {

/// Elements quantised and compressed; report/viewer/mesh.js unpacks them.
struct PackedMesh {
  std::string bytes;      ///< zlib stream
  double step_m = 1.0;    ///< of coordinates: the longest extent in 65,535 parts
  glm::dvec3 low_m{0.0};  ///< world coordinates of the corner that coordinates count from
  glm::dvec3 size_m{0.0};
};

/// Packs a mesh with at least one element. Illuminances and exitances are kept to 0.1 %, tints to 8 bits.
PackedMesh packMesh(const ElementMesh& mesh);

}  // namespace clerestory
