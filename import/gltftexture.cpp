// SPDX-License-Identifier: GPL-3.0-or-later
// Reads glTF's textures, samplers and images.
#include "gltftexture.hpp"

#include <cmath>

#include "textfile.hpp"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxPictureBytes = 512ULL << 20U;

TextureWrap wrapOf(const JsonNode& sampler, const char* key) {
  switch (sampler.countOr(key, 10497)) {
    case 33071:
      return TextureWrap::clamp;
    case 33648:
      return TextureWrap::mirror;
    default:
      return TextureWrap::repeat;
  }
}

/// KHR_texture_transform: (u', v') = offset + turned(scale * (u, v)). The turn is counter-clockwise as seen
/// with v upwards, and v counts downwards.
glm::dmat3x2 transformOf(const JsonNode& extension) {
  const auto pair = [&](const char* key, const glm::dvec2& otherwise) {
    const auto node = extension.find(key);
    const std::vector<double> values =
        node ? node->numbers(2) : std::vector<double>{otherwise.x, otherwise.y};
    return glm::dvec2(values[0], values[1]);
  };
  const glm::dvec2 offset = pair("offset", glm::dvec2(0.0));
  const glm::dvec2 scale = pair("scale", glm::dvec2(1.0));
  const double angle = extension.numberOr("rotation", 0.0);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * scale.x, -s * scale.x, s * scale.y, c * scale.y, offset.x, offset.y};
}

/// Index of the image that a texture shows: WebP's where it has one, else the plain one.
std::optional<std::size_t> imageOf(const GltfDocument& document, const JsonNode& texture,
                                   std::vector<Diagnosis>& diagnoses) {
  const std::size_t images = document.countOf("images");
  if (const auto webp = texture.extension("EXT_texture_webp")) {
    return webp->index("source", images, "image");
  }
  const auto source = texture.index("source", images, "image");
  if (!source && texture.extension("KHR_texture_basisu")) {
    addDiagnosis(diagnoses, {"C126", "pictures that cannot be read: the material's colour stands for them",
                             texture.pointer() + ": KHR_texture_basisu (KTX2); export them as PNG or JPEG"});
  }
  return source;
}

}  // namespace

std::optional<GltfTexture> gltfTexture(const GltfDocument& document, const JsonNode& owner, const char* key,
                                       PictureEncoding encoding, std::vector<Diagnosis>& diagnoses) {
  const auto info = owner.find(key);
  const auto index = info ? info->index("index", document.countOf("textures"), "texture") : std::nullopt;
  if (!index) {
    return std::nullopt;
  }
  const JsonNode node = document.root().at("textures")[*index];
  const auto image = imageOf(document, node, diagnoses);
  if (!image) {
    return std::nullopt;
  }
  GltfTexture texture{*image, info->countOr("texCoord", 0), {}, encoding};
  if (const auto sampler = node.index("sampler", document.countOf("samplers"), "sampler")) {
    const JsonNode wraps = document.root().at("samplers")[*sampler];
    texture.mapping.wrapU = wrapOf(wraps, "wrapS");
    texture.mapping.wrapV = wrapOf(wraps, "wrapT");
  }
  if (const auto transform = info->extension("KHR_texture_transform")) {
    texture.mapping.transform = transformOf(*transform);
    texture.coordinateSet = transform->countOr("texCoord", texture.coordinateSet);
  }
  return texture;
}

Picture readGltfImage(const GltfDocument& document, std::size_t image, PictureEncoding encoding) {
  const JsonNode node = document.root().at("images")[image];
  const std::string name = document.file() + ": " + node.pointer();
  if (const auto uri = node.find("uri")) {
    const std::string bytes = document.uriBytes(*uri, "picture", kMaxPictureBytes);
    return readPicture(bytes, name, encoding);
  }
  return readPicture(document.viewBytes(node), name, encoding);
}

}  // namespace clerestory
