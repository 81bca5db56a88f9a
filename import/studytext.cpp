// SPDX-License-Identifier: GPL-3.0-or-later
// Names of skies, accuracies and units, and the sentences for what a study leaves open.
#include "studytext.hpp"

#include "textfile.hpp"
#include "units.hpp"

namespace clerestory {

std::optional<int> skyTypeNumber(const std::string& name) {
  if (name == "cie-overcast") {
    return 16;
  }
  if (name == "cie-clear") {
    return 12;
  }
  if (name == "uniform") {
    return 5;
  }
  const auto number =
      name.starts_with("cie-") ? parseInteger(std::string_view(name).substr(4)) : std::nullopt;
  if (!number || *number < 1 || *number > 16 || name != "cie-" + std::to_string(*number)) {
    return std::nullopt;
  }
  return static_cast<int>(*number);
}

std::string skyTypeName(int cieType) {
  switch (cieType) {
    case 16:
      return "cie-overcast";
    case 0:
    case 5:
      return "uniform";
    default:
      return "cie-" + std::to_string(cieType);
  }
}

/// Types 1, 3, 5 of CIE S 011 have no indicatrix; 16 depends on the altitude above the horizon alone.
bool skyNeedsSun(int cieType) {
  return cieType != 0 && cieType != 1 && cieType != 3 && cieType != 5 && cieType != 16;
}

bool isUnit(const std::string& text) {
  return metresOf(text).has_value();
}

std::optional<double> parseAccuracy(const std::string& text) {
  const std::string_view word = trimmed(text);
  if (word == "draft") {
    return 0.10;
  }
  if (word == "standard") {
    return 0.05;
  }
  if (word == "fine") {
    return 0.02;
  }
  if (!word.ends_with('%')) {
    return std::nullopt;
  }
  const auto percent = parseNumber(trimmed(word.substr(0, word.size() - 1)));
  if (!percent || *percent < 0.1 || *percent > 50.0) {
    return std::nullopt;
  }
  return *percent / 100.0;
}

void assumeWhatIsMissing(Study& study, const Stated& stated) {
  if (!stated.sky) {
    study.assumptions.emplace_back(
        "The sky is the traditional CIE overcast sky with 10,000 lx on the horizontal, without sun.");
  } else if (study.sky.sun_deg && !skyNeedsSun(study.sky.cieType)) {
    study.assumptions.emplace_back(
        "The sun's position does not matter to this sky, and its beam is left out.");
  } else if (study.sky.sun_deg) {
    study.assumptions.emplace_back("The sun shapes the sky's luminance; its beam is left out.");
  }
  if (!stated.ground) {
    study.assumptions.emplace_back("The ground reflects 0.2 of the light and is of uniform luminance.");
  }
  if (!stated.north) {
    study.assumptions.emplace_back("North is the direction of +y, and the site is at 47.37 degrees north.");
  }
  if (study.grids.empty()) {
    GridSettings grid;
    grid.name = "Work plane";
    study.grids.push_back(grid);
    study.assumptions.emplace_back("Each room has a grid 0.85 m above its floor with points 0.25 m apart.");
  }
}

}  // namespace clerestory
