// SPDX-License-Identifier: GPL-3.0-or-later
// Materials of glTF models, with the means of their textures.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "gltfdocument.hpp"
#include "gltftexture.hpp"
#include "material.hpp"

namespace clerestory {

/// The materials that a model's primitives use, numbered in the order of first use.
class GltfMaterials {
 public:
  GltfMaterials(const GltfDocument& document, std::vector<Diagnosis>& diagnoses)
      : document_(document), diagnoses_(diagnoses) {}

  /// One texture of a material while triangles are added to its mean.
  struct Texture {
    std::size_t coordinateSet = 0;
    TextureMean mean;
  };

  /// Number of the material `index` of the file; empty: glTF's default material, white.
  std::uint32_t number(const std::optional<std::size_t>& index);
  /// Textures whose means decide the colours of the material `number`.
  std::span<Texture> textures(std::uint32_t number) { return materials_[number].textures; }

  /// All materials, once every triangle is added.
  [[nodiscard]] std::vector<Material> finish() const;

 private:
  struct Draft {
    DisplayMaterial display;
    std::vector<Texture> textures;
    std::optional<std::size_t> color, luminance, transmission;  // indices of textures
  };

  Draft read(const JsonNode& material);
  void readBaseColor(const JsonNode& material, Draft& draft);
  void readTransmission(const JsonNode& material, Draft& draft);
  std::optional<std::size_t> addTexture(const JsonNode& owner, const char* key, PictureEncoding encoding,
                                        bool weighsByAlpha, Draft& draft);
  std::shared_ptr<const Picture> picture(const GltfTexture& texture);

  const GltfDocument& document_;
  std::vector<Diagnosis>& diagnoses_;
  std::vector<Draft> materials_;
  std::map<std::optional<std::size_t>, std::uint32_t> numberOf_;
  std::map<std::pair<std::size_t, PictureEncoding>, std::shared_ptr<const Picture>> pictures_;
};

}  // namespace clerestory
