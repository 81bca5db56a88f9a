// SPDX-License-Identifier: GPL-3.0-or-later
// Turns display colours, transparencies and names into reflectances, transmittances and exitances.
#include "material.hpp"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "textfile.hpp"

namespace clerestory {
namespace {

constexpr double kMaxDisplayReflectance = 0.9;
constexpr double kDefaultReflectance = 0.5;
constexpr double kAssumedTransmittance = 0.7;
constexpr double kMaxGlassTransmittance = 0.95;  // two faces of n = 1.5 alone reflect 8 %

constexpr auto kGlassWords = std::to_array<std::string_view>({"glass",          "glas",
                                                              "glazing",        "windowpane",
                                                              "windowglass",    "pane",
                                                              "panes",          "scheibe",
                                                              "fensterscheibe", "glasscheibe",
                                                              "fensterglas",    "isolierglas",
                                                              "verbundglas",    "sicherheitsglas",
                                                              "verglasung",     "verre",
                                                              "vitre",          "vitrage",
                                                              "vidrio",         "vidrios",
                                                              "cristal",        "acristalamiento",
                                                              "vidro",          "vidraça",
                                                              "vetro",          "vetrata",
                                                              "ruit",           "glasruit",
                                                              "dubbelglas",     "fönsterglas",
                                                              "vindusglass",    "lasi",
                                                              "ikkunalasi",     "szkło",
                                                              "szyba",          "sklo",
                                                              "üveg",           "стекло",
                                                              "Стекло",         "玻璃",
                                                              "ガラス"});
constexpr auto kOtherWords = std::to_array<std::string_view>(
    {"frame",   "frames",  "rahmen",  "cadre",    "marco",    "telaio", "kozijn", "kader",  "karm",
     "rama",    "perfil",  "profil",  "profile",  "bar",      "bars",   "bead",   "gasket", "mullion",
     "transom", "rail",    "handle",  "holder",   "block",    "blocks", "brick",  "wool",   "wolle",
     "laine",   "lana",    "fiber",   "fibre",    "fibra",    "faser",  "tile",   "tiles",  "mosaic",
     "mosaik",  "mosaico", "paint",   "fabric",   "foam",     "foamed", "cloth",  "mirror", "spiegel",
     "miroir",  "espejo",  "espelho", "specchio", "spandrel", "opaque", "vase",   "bottle"});

bool isLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c & '\x80') != 0;
}
bool isCapital(char c) {
  return c >= 'A' && c <= 'Z';
}

std::vector<std::string> wordsOf(std::string_view name) {
  std::vector<std::string> words(1);
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool hump = i > 0 && isCapital(name[i]) && isLetter(name[i - 1]) && !isCapital(name[i - 1]);
    if ((!isLetter(name[i]) || hump) && !words.back().empty()) {
      words.emplace_back();
    }
    if (isLetter(name[i])) {
      words.back() += name[i];
    }
  }
  for (std::string& word : words) {
    word = lowerCase(word);
  }
  return words;
}

template <typename Words>
bool holds(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// `value` held within [0, most], with a diagnosis where it was not.
glm::dvec3 held(glm::dvec3 value, double most, const Diagnosis& diagnosis,
                std::vector<Diagnosis>& diagnoses) {
  const glm::dvec3 clamped = glm::clamp(value, 0.0, most);
  if (clamped != value) {
    addDiagnosis(diagnoses, diagnosis);
  }
  return clamped;
}

glm::dvec3 reflectanceOf(const DisplayMaterial& display, std::vector<Diagnosis>& diagnoses) {
  const std::string where = "material \"" + display.name + "\"";
  if (!display.color) {
    addDiagnosis(diagnoses, {"C120", "material without a colour: reflectance 0.5 is taken", where});
    return glm::dvec3(kDefaultReflectance);
  }
  return held(
      *display.color, kMaxDisplayReflectance,
      {"C121", "display colour above 0.9 (or below 0) is no reflectance of a room: 0.9 (or 0) is taken",
       where},
      diagnoses);
}

bool isGlazing(const DisplayMaterial& display, std::vector<Diagnosis>& diagnoses) {
  if (display.transmittance) {
    return *display.transmittance != glm::dvec3(0.0);
  }
  if (display.transparent) {
    return true;
  }
  if (!isGlazingName(display.name)) {
    return false;
  }
  const std::string where = "material \"" + display.name + "\"";
  if (display.statedOpaque) {
    addDiagnosis(diagnoses, {"C124",
                             "material named like glass but drawn opaque is opaque; state a transmittance in "
                             "the study if it is a pane",
                             where});
    return false;
  }
  addDiagnosis(diagnoses, {"C125", "material taken for glazing by its name", where});
  return true;
}

}  // namespace

bool isGlazingName(std::string_view name) {
  const std::vector<std::string> words = wordsOf(name);
  const auto isGlass = [](const std::string& word) { return holds(kGlassWords, word); };
  const auto isOther = [](const std::string& word) { return holds(kOtherWords, word); };
  return std::any_of(words.begin(), words.end(), isGlass) &&
         std::none_of(words.begin(), words.end(), isOther);
}

Material materialOf(const DisplayMaterial& display, std::vector<Diagnosis>& diagnoses) {
  const std::string where = "material \"" + display.name + "\"";
  Material material;
  material.name = display.name;
  material.exitance_lm_m2 = std::numbers::pi * glm::max(display.luminance_cd_m2, 0.0);
  material.glazing = isGlazing(display, diagnoses);
  if (!material.glazing) {
    material.reflectance = reflectanceOf(display, diagnoses);
    material.mirrorsAsMatt = display.mirrors;
    if (display.mirrors) {
      addDiagnosis(diagnoses,
                   {"C135", "what a metal or a mirror reflects counts as matt, in its colour", where});
    }
    return material;
  }
  material.reflectance = glm::dvec3(0.0);
  material.transmittanceIsAssumed = !display.transmittance;
  material.transmittance = glm::dvec3(kAssumedTransmittance);
  if (display.transmittance) {
    material.transmittance =
        held(*display.transmittance, 1.0, {"C122", "transmittance outside 0 to 1 is taken as 0 or 1", where},
             diagnoses);
    if (std::min({material.transmittance.r, material.transmittance.g, material.transmittance.b}) >
        kMaxGlassTransmittance) {
      addDiagnosis(diagnoses,
                   {"C123",
                    "transmittance above 0.95 is more than any glass has; state one in the study if "
                    "it is only the exporter's default",
                    where});
    }
  }
  return material;
}

}  // namespace clerestory
