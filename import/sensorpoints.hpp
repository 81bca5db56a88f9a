// SPDX-License-Identifier: GPL-3.0-or-later
// Files of sensor points.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

namespace clerestory {

/// Points with unit normals: x y z nx ny nz in metres. The file is CSV with a header that names x_m, y_m, z_m
/// (or x, y, z) and perhaps nx, ny, nz, further columns being left out; or Radiance's, six numbers a line.
/// Normals that are not given point up. Throws InputError with file and line.
std::vector<std::array<double, 6>> readSensorPoints(const std::filesystem::path& file);

}  // namespace clerestory
