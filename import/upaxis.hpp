// SPDX-License-Identifier: GPL-3.0-or-later
// Which axis of an OBJ is up, judged by its head and by what lies level in a building.
#pragma once

#include <filesystem>
#include <string>

#include <import/scene.hpp>

namespace clerestory {

struct UpAxis {
  std::string axis = "z";
  std::string reason;       ///< in words that go after "because"; empty: nothing speaks for either axis
  bool isDoubtful = false;  ///< two reasons contradict each other
};

/// Judges by, the first that says something:
/// * a comment before the first statement that says "Y up" or "Z up",
/// * the geometry: along the vertical a building is low, or far more area faces it than the other axes, as
///   floors and ceilings do, and only one axis may look so,
/// * panes, which stand upright more often than they lie level,
/// * a comment that names an exporter whose own setting is y: Sweet Home 3D, Blender, Rhino, 3ds Max.
/// Else z.
UpAxis judgeUpAxis(const std::filesystem::path& file, const Scene& scene);

}  // namespace clerestory
