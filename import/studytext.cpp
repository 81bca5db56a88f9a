// SPDX-License-Identifier: GPL-3.0-or-later
// Names of skies, accuracies and units, and the sentences for what a study leaves open.
#include "studytext.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "textfile.hpp"
#include "units.hpp"

namespace clerestory {
namespace {

std::string two(int value) {
  return (value < 10 ? "0" : "") + std::to_string(value);
}

}  // namespace

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

std::string skyTypeName(const SkySettings& sky) {
  if (sky.isPerez) {
    return "perez";
  }
  switch (sky.cieType) {
    case 16:
      return "cie-overcast";
    case 0:
    case 5:
      return "uniform";
    default:
      return "cie-" + std::to_string(sky.cieType);
  }
}

/// Types 1, 3, 5 of CIE S 011 have no indicatrix; 16 depends on the altitude above the horizon alone.
bool skyNeedsSun(const SkySettings& sky) {
  const int cieType = sky.cieType;
  return sky.isPerez || (cieType != 0 && cieType != 1 && cieType != 3 && cieType != 5 && cieType != 16);
}

std::optional<GlassKind> glassPreset(const std::string& name) {
  if (name == "cie171-6mm") {
    return GlassKind::cie171Clear;
  }
  return std::nullopt;
}

std::string glassPresetName(GlassKind kind) {
  return kind == GlassKind::cie171Clear ? "cie171-6mm" : "";
}

double presetTransmittance(GlassKind kind) {
  return kind == GlassKind::cie171Clear ? 0.8788 : 0.0;
}

std::string dateText(const ClockTime& time) {
  const std::string year = std::to_string(time.year);
  return std::string(4 - std::min<std::size_t>(year.size(), 4), '0') + year + "-" + two(time.month) + "-" +
         two(time.day);
}

std::string clockTimeText(const ClockTime& time) {
  const auto inHours = [&](double hours) {
    const auto seconds = std::lround(hours * 3600.0);
    const int minutes = static_cast<int>(seconds / 60);
    return std::array{minutes / 60, minutes % 60, static_cast<int>(seconds % 60)};
  };
  const auto [hour, minute, second] = inHours(time.hour_h);
  std::string text = dateText(time) + "T" + two(hour) + ":" + two(minute) + ":" + two(second);
  if (time.zone_h) {
    const auto offset = inHours(std::abs(*time.zone_h));
    text += (*time.zone_h < 0.0 ? "-" : "+") + two(offset[0]) + ":" + two(offset[1]);
  }
  return text;
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
  } else if ((study.sky.sun_deg || study.sky.time) && study.sky.directNormal_lx <= 0.0 &&
             !study.sky.irradiance) {
    study.assumptions.emplace_back(skyNeedsSun(study.sky)
                                       ? "The sun shapes the sky's luminance; its beam is left out."
                                       : "The sun's position does not matter to this sky, and its beam is "
                                         "left out.");
  }
  if (!stated.ground) {
    study.assumptions.emplace_back("The ground's reflectance is not stated: 20 % is taken.");
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
