// SPDX-License-Identifier: GPL-3.0-or-later
// Textures of a glTF: which picture, how it lies, and its bytes.
#pragma once

#include <optional>
#include <vector>

#include <import/error.hpp>

#include "gltfdocument.hpp"
#include "texture.hpp"

namespace clerestory {

/// What a material's textureInfo names.
struct GltfTexture {
  std::size_t image = 0;          ///< index in `images`
  std::size_t coordinateSet = 0;  ///< n of TEXCOORD_n
  TextureMapping mapping;
  PictureEncoding encoding = PictureEncoding::sRgb;
};

/// Reads the textureInfo `key` of `owner`, KHR_texture_transform and the sampler's wrapping included. Empty
/// where there is none, or, with a diagnosis, where its picture is of a kind that is not read.
std::optional<GltfTexture> gltfTexture(const GltfDocument& document, const JsonNode& owner, const char* key,
                                       PictureEncoding encoding, std::vector<Diagnosis>& diagnoses);

/// The picture of `images[image]`. Throws InputError.
Picture readGltfImage(const GltfDocument& document, std::size_t image, PictureEncoding encoding);

}  // namespace clerestory
