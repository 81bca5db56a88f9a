// SPDX-License-Identifier: GPL-3.0-or-later
// The words of a study: names of skies and units, and the sentences for what it leaves open.
#pragma once

#include <optional>
#include <string>

#include <import/study.hpp>

namespace clerestory {

/// 1 to 16 for cie-1 … cie-16, cie-overcast (16), cie-clear (12), uniform (5); empty for anything else.
std::optional<int> skyTypeNumber(const std::string& name);
std::string skyTypeName(const SkySettings& sky);
bool skyNeedsSun(const SkySettings& sky);  ///< whether the luminance depends on the angle to the sun
std::optional<GlassKind> glassPreset(const std::string& name);
std::string glassPresetName(GlassKind kind);
double presetTransmittance(GlassKind kind);  ///< at normal incidence
bool isUnit(const std::string& text);

/// What a study states itself.
struct Stated {
  bool sky = false;
  bool ground = false;
  bool north = false;
};

/// Gives `study` a grid where it has none, and a sentence for everything that was taken for granted.
void assumeWhatIsMissing(Study& study, const Stated& stated);

}  // namespace clerestory
