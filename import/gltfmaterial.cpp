// SPDX-License-Identifier: GPL-3.0-or-later
// Reads glTF's materials: base colour, emission with its strength, transmission and alpha.
#include "gltfmaterial.hpp"

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

/// The colour that a metal reflects counts as diffuse, like the rest.
BaseColor baseColor(const JsonNode& model, const char* factorKey) {
  BaseColor base;
  if (const auto factor = model.find(factorKey)) {
    const std::vector<double> numbers = factor->numbers(4);
    base.color = {numbers[0], numbers[1], numbers[2]};
    base.alpha = numbers[3];
  }
  return base;
}

void noteTexture(const JsonNode& node, const char* key, std::vector<Diagnosis>& diagnoses) {
  if (const auto texture = node.find(key)) {
    addDiagnosis(diagnoses, {"C126", "textures are not read: the material's colour stands for them",
                             texture->pointer()});
  }
}

std::optional<JsonNode> extension(const JsonNode& material, const char* name) {
  const auto extensions = material.find("extensions");
  return extensions ? extensions->find(name) : std::nullopt;
}

}  // namespace

DisplayMaterial gltfMaterial(const JsonNode& material, std::vector<Diagnosis>& diagnoses) {
  DisplayMaterial display;
  display.where = material.pointer();
  display.name = cleanName(material.textOr("name", ""));
  BaseColor base;
  if (const auto model = material.find("pbrMetallicRoughness")) {
    base = baseColor(*model, "baseColorFactor");
    noteTexture(*model, "baseColorTexture", diagnoses);
  } else if (const auto older = extension(material, "KHR_materials_pbrSpecularGlossiness")) {
    base = baseColor(*older, "diffuseFactor");
    noteTexture(*older, "diffuseTexture", diagnoses);
  }
  display.color = base.color;
  const auto alphaMode = material.find("alphaMode");
  display.statedOpaque = alphaMode && alphaMode->text() == "OPAQUE";
  display.transparent = alphaMode && alphaMode->text() == "BLEND" && base.alpha < 1.0;
  if (const auto transmission = extension(material, "KHR_materials_transmission")) {
    const double factor = transmission->numberOr("transmissionFactor", 0.0);
    noteTexture(*transmission, "transmissionTexture", diagnoses);
    if (factor > 0.0) {
      display.transmittance = factor * base.color;
    }
  }
  double strength = 1.0;
  if (const auto emission = extension(material, "KHR_materials_emissive_strength")) {
    strength = emission->numberOr("emissiveStrength", 1.0);
  }
  display.luminance_cd_m2 = strength * colorOr(material, "emissiveFactor", glm::dvec3(0.0));
  noteTexture(material, "emissiveTexture", diagnoses);
  return display;
}

}  // namespace clerestory
