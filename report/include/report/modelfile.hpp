// SPDX-License-Identifier: GPL-3.0-or-later
// The repaired model as a file for CAD, with a marker at each place that a diagnosis speaks of.
#pragma once

#include <filesystem>
#include <span>

#include <geometry/building.hpp>

namespace clerestory {

/// Whether a name ends as a model does that `writeModel` can write: .glb or .obj, in any case.
bool isModelFile(const std::filesystem::path& file);

/// Writes the model's pieces under their objects' names, with their materials, and an octahedron 10 cm wide
/// for each of `marks`: those of one code share a material "diagnosis CODE" in a colour of its own and stand
/// in objects "diagnosis CODE OBJECT", which our readers leave out. OBJ is in metres with z up, and its MTL
/// is written beside it; GLB has y up, as glTF wants. Throws MachineError where the disk fails.
void writeModel(const std::filesystem::path& file, const CleanModel& model, std::span<const Mark> marks);

}  // namespace clerestory
