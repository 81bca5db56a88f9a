// SPDX-License-Identifier: GPL-3.0-or-later
// Gathers the faces of one object and material by plane.
#pragma once

#include "soup.hpp"

namespace clerestory {

/// A face of the soup and its measures.
struct Face {
  std::uint32_t index;
  glm::dvec3 normal;      ///< unit, of the face as it was drawn
  glm::dvec3 bentNormal;  ///< unit, after the weld; `normal` where that moved no corner
  glm::dvec3 middle;
  double area_m2;
  double thickness_m;
};

/// The soup's faces in groups of one object, one material and one plane: a face joins the plane of a larger
/// one that it touches, and planes that overlap are one. Each group by falling area.
std::vector<std::vector<Face>> facesByPlane(const Soup& soup, const Tolerances& tolerances);

}  // namespace clerestory
