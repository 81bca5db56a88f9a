// SPDX-License-Identifier: GPL-3.0-or-later
// What a model's display material means for light: shared by MTL and glTF.
#pragma once

#include <glm/vec3.hpp>

#include <string>
#include <string_view>
#include <vector>

#include <import/scene.hpp>

namespace clerestory {

/// The surface that a model file describes for display, before it is judged.
struct DisplayMaterial {
  std::string name;
  std::string where;                        ///< file and line, or JSON pointer
  std::optional<glm::dvec3> color;          ///< linear; empty: not stated
  std::optional<glm::dvec3> transmittance;  ///< that counts as such
  glm::dvec3 luminance_cd_m2{0.0};
  bool transparent = false;   ///< by alpha: marks glazing, says nothing of its transmittance
  bool statedOpaque = false;  ///< the file says in so many words that nothing shines through
  bool mirrors = false;       ///< drawn as a metal or a mirror
};

/// The material for light. A colour above 0.9 becomes 0.9; a missing one 0.5; glazing reflects 0 here
/// (its Fresnel reflection belongs to the solver). What was decided is added to `diagnoses`.
///
/// Glazing is what states a transmittance above 0, what is drawn transparent, and what is named like glass
/// (`isGlazingName`) unless the file states that it is opaque (MTL `d 1`, glTF alphaMode OPAQUE).
Material materialOf(const DisplayMaterial& display, std::vector<Diagnosis>& diagnoses);

/// Whether one of the name's words says glass or pane in a common language and none says frame, wool, tile …
/// Words end at any sign that is not a letter and where aCapital follows a small letter.
bool isGlazingName(std::string_view name);

}  // namespace clerestory
