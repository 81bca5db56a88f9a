// SPDX-License-Identifier: GPL-3.0-or-later
// Reads glTF's materials: base colour, emission with its strength, transmission and alpha.
#include "gltfmaterial.hpp"

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include <cmath>
#include <limits>
#include <utility>

#include "textfile.hpp"

namespace clerestory {
namespace {

glm::dvec3 colorOr(const JsonNode& node, const char* key, const glm::dvec3& otherwise) {
  const auto value = node.find(key);
  if (!value) {
    return otherwise;
  }
  const std::vector<double> numbers = value->numbers(3);
  return {numbers[0], numbers[1], numbers[2]};
}

struct BaseColor {
  glm::dvec3 color{1.0};
  double alpha = 1.0;
};

BaseColor baseColor(const JsonNode& model, const char* key) {
  BaseColor base;
  if (const auto factor = model.find(key)) {
    const std::vector<double> numbers = factor->numbers(4);
    base.color = {numbers[0], numbers[1], numbers[2]};
    base.alpha = numbers[3];
  }
  return base;
}

/// What KHR_materials_volume leaves of the light that goes straight through: Lambert's law.
glm::dvec3 volumeTransmittance(const JsonNode& volume) {
  const double thickness = volume.numberOr("thicknessFactor", 0.0);
  const double distance = volume.numberOr("attenuationDistance", std::numeric_limits<double>::infinity());
  if (thickness <= 0.0 || distance <= 0.0) {
    return glm::dvec3(1.0);
  }
  const glm::dvec3 color = colorOr(volume, "attenuationColor", glm::dvec3(1.0));
  return glm::pow(glm::max(color, 0.0), glm::dvec3(thickness / distance));
}

}  // namespace

std::uint32_t GltfMaterials::number(const std::optional<std::size_t>& index) {
  const auto next = static_cast<std::uint32_t>(materials_.size());
  const auto [found, isNew] = numberOf_.try_emplace(index, next);
  if (isNew) {
    Draft draft;
    if (index) {
      draft = read(document_.root().at("materials")[*index]);
    } else {
      draft.display.color = glm::dvec3(1.0);
    }
    if (draft.display.name.empty()) {
      draft.display.name = index ? "material " + std::to_string(*index) : "default";
    }
    materials_.push_back(std::move(draft));
  }
  return found->second;
}

GltfMaterials::Draft GltfMaterials::read(const JsonNode& material) {
  Draft draft;
  draft.display.where = material.pointer();
  draft.display.name = cleanName(material.textOr("name", ""));
  readBaseColor(material, draft);
  readTransmission(material, draft);
  double strength = 1.0;
  if (const auto emission = material.extension("KHR_materials_emissive_strength")) {
    strength = emission->numberOr("emissiveStrength", 1.0);
  }
  draft.display.luminance_cd_m2 = strength * colorOr(material, "emissiveFactor", glm::dvec3(0.0));
  if (draft.display.luminance_cd_m2 != glm::dvec3(0.0)) {
    draft.luminance = addTexture(material, "emissiveTexture", PictureEncoding::sRgb, false, draft);
  }
  return draft;
}

void GltfMaterials::readBaseColor(const JsonNode& material, Draft& draft) {
  const std::string alphaMode = material.textOr("alphaMode", "");
  const bool weighsByAlpha = alphaMode == "BLEND" || alphaMode == "MASK";
  BaseColor base;
  if (const auto older = material.extension("KHR_materials_pbrSpecularGlossiness")) {
    base = baseColor(*older, "diffuseFactor");
    draft.color = addTexture(*older, "diffuseTexture", PictureEncoding::sRgb, weighsByAlpha, draft);
  } else if (const auto model = material.find("pbrMetallicRoughness")) {
    base = baseColor(*model, "baseColorFactor");
    draft.color = addTexture(*model, "baseColorTexture", PictureEncoding::sRgb, weighsByAlpha, draft);
    const bool isUnlit = material.extension("KHR_materials_unlit").has_value();
    draft.display.mirrors =
        !isUnlit && !model->find("metallicRoughnessTexture") && model->numberOr("metallicFactor", 1.0) > 0.0;
  }
  draft.display.color = base.color;
  draft.display.statedOpaque = alphaMode == "OPAQUE";
  draft.display.transparent = alphaMode == "BLEND" && base.alpha < 1.0;
}

void GltfMaterials::readTransmission(const JsonNode& material, Draft& draft) {
  const auto transmission = material.extension("KHR_materials_transmission");
  const double factor = transmission ? transmission->numberOr("transmissionFactor", 0.0) : 0.0;
  if (factor <= 0.0) {
    return;
  }
  draft.transmission =
      addTexture(*transmission, "transmissionTexture", PictureEncoding::linear, false, draft);
  const auto volume = material.extension("KHR_materials_volume");
  draft.display.transmittance =
      factor * *draft.display.color * (volume ? volumeTransmittance(*volume) : glm::dvec3(1.0));
}

std::optional<std::size_t> GltfMaterials::addTexture(const JsonNode& owner, const char* key,
                                                     PictureEncoding encoding, bool weighsByAlpha,
                                                     Draft& draft) {
  auto texture = gltfTexture(document_, owner, key, encoding, diagnoses_);
  const std::shared_ptr<const Picture> pixels = texture ? picture(*texture) : nullptr;
  if (!pixels) {
    return std::nullopt;
  }
  texture->mapping.weighsByAlpha = weighsByAlpha;
  draft.textures.push_back({texture->coordinateSet, TextureMean(pixels, texture->mapping)});
  return draft.textures.size() - 1;
}

/// Null, with a diagnosis, where the picture cannot be read. Each image is read once.
std::shared_ptr<const Picture> GltfMaterials::picture(const GltfTexture& texture) {
  const auto [entry, isNew] = pictures_.try_emplace({texture.image, texture.encoding});
  if (isNew) {
    try {
      entry->second =
          std::make_shared<const Picture>(readGltfImage(document_, texture.image, texture.encoding));
    } catch (const InputError& error) {
      addDiagnosis(diagnoses_, {"C126", "pictures that cannot be read: the material's colour stands for them",
                                error.what()});
    }
  }
  return entry->second;
}

std::vector<Material> GltfMaterials::finish() const {
  std::vector<Material> materials;
  for (const Draft& draft : materials_) {
    const auto mean = [&](const std::optional<std::size_t>& texture) {
      return texture ? draft.textures[*texture].mean.color() : glm::dvec3(1.0);
    };
    DisplayMaterial display = draft.display;
    *display.color *= mean(draft.color);
    display.luminance_cd_m2 *= mean(draft.luminance);
    if (display.transmittance) {
      *display.transmittance *= mean(draft.color) * mean(draft.transmission).r;
    }
    materials.push_back(materialOf(display, diagnoses_));
  }
  return materials;
}

}  // namespace clerestory
