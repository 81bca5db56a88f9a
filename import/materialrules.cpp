// SPDX-License-Identifier: GPL-3.0-or-later
// Applies what a study states of materials over what the model says.
#include <algorithm>
#include <cmath>

#include <import/study.hpp>

#include "studytext.hpp"
#include "textfile.hpp"

namespace clerestory {
namespace {

void checkChannels(const std::optional<glm::dvec3>& value, double low, double high, bool highIsIn,
                   const MaterialRule& rule, const std::string& what) {
  for (int i = 0; value && i < 3; ++i) {
    const double channel = (*value)[i];
    const bool fits = channel >= low && (highIsIn ? channel <= high : channel < high);
    if (!fits) {
      throw InputError("[materials.\"" + rule.glob + "\"] " + what + " " + numberText(channel) +
                       (channel >= low
                            ? std::string(highIsIn ? " is above " : " is not below ") + numberText(high)
                            : " is below " + numberText(low)));
    }
  }
}

void checkRule(const MaterialRule& rule) {
  checkChannels(rule.reflectance, 0.0, 1.0, false, rule, "reflectance");
  checkChannels(rule.transmittance, 0.0, 1.0, true, rule, "transmittance");
  checkChannels(rule.exitance_lm_m2, 0.0, 1e9, true, rule, "exitance");
  if (rule.panes && *rule.panes < 1) {
    throw InputError("[materials.\"" + rule.glob + "\"] panes " + std::to_string(*rule.panes) +
                     " is below 1");
  }
}

/// A transmittance above 0 makes glazing, 0 makes it opaque. A reflectance leaves glazing as it is: what
/// glass reflects follows from its index of refraction.
void apply(const MaterialRule& rule, Material& material, std::vector<Diagnosis>& diagnoses) {
  if (rule.transmittance) {
    material.glazing = *rule.transmittance != glm::dvec3(0.0);
    material.transmittanceIsAssumed = false;
    if (material.glazing) {
      material.transmittance = *rule.transmittance;
      material.reflectance = glm::dvec3(0.0);
    }
  }
  if (rule.reflectance && !material.glazing) {
    material.reflectance = *rule.reflectance;
    material.mirrorsAsMatt = false;  // the study knows what it is
  } else if (rule.reflectance) {
    addDiagnosis(diagnoses, {"C151",
                             "a reflectance stated of glazing is not used: it follows from the glass; state "
                             "transmittance = 0 to make it opaque",
                             "material \"" + material.name + "\""});
  }
  if (rule.glass) {
    material.glazing = true;
    material.transmittanceIsAssumed = false;
    material.transmittance = glm::dvec3(presetTransmittance(*rule.glass));
    material.reflectance = glm::dvec3(0.0);
  }
  material.glass = rule.glass.value_or(material.glass);
  material.diffusing = rule.diffusing.value_or(material.diffusing);
  material.panes = rule.panes.value_or(material.panes);
  material.exitance_lm_m2 = rule.exitance_lm_m2.value_or(material.exitance_lm_m2);
}

}  // namespace

void applyMaterialRules(const Study& study, Scene& scene) {
  for (const MaterialRule& rule : study.materials) {
    checkRule(rule);
    bool matched = false;
    for (Material& material : scene.materials) {
      if (globMatches(rule.glob, material.name)) {
        matched = true;
        apply(rule, material, scene.diagnoses);
      }
    }
    if (!matched) {
      addDiagnosis(scene.diagnoses, {"C150", "a study's material rule matches no material of the model",
                                     "[materials.\"" + rule.glob + "\"]"});
    }
  }
  for (const Material& material : scene.materials) {
    if (material.glazing && material.transmittanceIsAssumed) {
      addDiagnosis(
          scene.diagnoses,
          {"C152", "nothing states the transmittance of glazing: 0.70 is assumed; state it in the study",
           "material \"" + material.name + "\""});
    }
  }
}

}  // namespace clerestory
