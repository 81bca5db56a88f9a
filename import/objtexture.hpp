// SPDX-License-Identifier: GPL-3.0-or-later
// Colours that an OBJ's pictures give to its materials.
#pragma once

#include <glm/vec2.hpp>

#include <cstdint>
#include <vector>

#include "mtl.hpp"

namespace clerestory {

/// `vt` of an OBJ, and which of them each corner of the scene's faces has.
struct TextureCoordinates {
  static constexpr std::uint32_t kNone = ~0U;

  std::vector<glm::vec2> values;
  std::vector<std::uint32_t> corners;  ///< as Scene::faces.corners, perhaps shorter: the rest has none
};

/// Multiplies the colours of `materials` (numbered as in Scene::faceMaterial) by the
/// means of their pictures over the faces that wear them. A picture that cannot be read is a diagnosis.
void applyTextures(std::vector<MtlMaterial>& materials, const TextureCoordinates& coordinates, Scene& scene);

}  // namespace clerestory
