// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of illuminances at sensors: those of a report, measured ones, and other programs'.
#pragma once

#include <glm/vec3.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace clerestory {

struct SensorReading {
  glm::dvec3 place_m{0.0};
  std::optional<glm::dvec3> direction;  ///< unit normal, where the table states one
  double illuminance_lx = 0.0;
  std::string grid;  ///< empty where the table has no grids
};

struct SensorTable {
  std::vector<SensorReading> readings;
  bool hasGrids = false;  ///< whether there is a column of grids
};

/// Reads a table with a header that names x_m, y_m, z_m (or x, y, z), illuminance_lx (or lux), and perhaps
/// grid and nx, ny, nz; further columns are passed over. `path` is a CSV file or a report's folder, whose
/// sensors.csv is read. Throws InputError with file and line.
SensorTable readSensorTable(const std::filesystem::path& path);

}  // namespace clerestory
