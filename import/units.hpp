// SPDX-License-Identifier: GPL-3.0-or-later
// Which unit a model is drawn in, judged by what a building can measure.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <import/scene.hpp>

namespace clerestory {

/// Metres of one unit: m cm mm ft in; empty for anything else.
std::optional<double> metresOf(std::string_view unit);

/// What the coordinates say about the unit.
struct SizeJudgement {
  bool metresArePossible = true;
  std::vector<std::string> others;  ///< of cm, mm, ft: those that make it a building
  glm::dvec3 extent{0.0};           ///< of everything drawn, in the file's unit
};

/// Judges the scene by two lengths that do not depend on which axis is up. `smallest` is the smallest extent
/// of its bounding box: the height of a flat building, the width of a tower; a large ground does not change
/// it. `typical` is the area-weighted median of the faces' shorter sides, without faces that reach far beyond
/// the building. Metres are possible where `smallest` is at most 90 m and something is 0.3 m long. Another
/// unit has to make `smallest` 1.8 to 60 m and the geometric mean of both 1.0 to 9.9 m: in fourteen models of
/// rooms and houses it is 1.2 to 9.5 m, and with less than a decade between them cm and mm never both fit.
SizeJudgement judgeSize(const Scene& scene);

}  // namespace clerestory
