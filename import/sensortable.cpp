// SPDX-License-Identifier: GPL-3.0-or-later
// Reads tables of illuminances at sensors.
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <import/error.hpp>
#include <import/sensortable.hpp>

#include "textfile.hpp"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxBytes = 1ULL << 30U;
constexpr double kLargestNumber = 1e12;

/// Which field of a row holds what.
struct Columns {
  std::array<std::size_t, 3> place{};
  std::size_t illuminance = 0;
  std::optional<std::size_t> grid;
  std::optional<std::array<std::size_t, 3>> direction;
};

std::optional<std::size_t> columnNamed(const std::vector<std::string>& header, std::string_view name,
                                       std::string_view otherName) {
  const auto found = std::find_if(header.begin(), header.end(), [&](const std::string& field) {
    const std::string known = lowerCase(field);
    return known == name || known == otherName;
  });
  if (found == header.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header.begin());
}

Columns columnsOf(const std::vector<std::string>& header, const Place& place) {
  const auto needed = [&](std::string_view name, std::string_view otherName) {
    const auto column = columnNamed(header, name, otherName);
    if (!column) {
      failAt(place, "the header lacks a column \"" + std::string(name) + "\" (or \"" +
                        std::string(otherName) +
                        "\"); a table of sensors has x_m,y_m,z_m,illuminance_lx or x,y,z,lux");
    }
    return *column;
  };
  Columns columns;
  columns.place = {needed("x_m", "x"), needed("y_m", "y"), needed("z_m", "z")};
  columns.illuminance = needed("illuminance_lx", "lux");
  columns.grid = columnNamed(header, "grid", "grid");
  const auto nx = columnNamed(header, "nx", "nx");
  const auto ny = columnNamed(header, "ny", "ny");
  const auto nz = columnNamed(header, "nz", "nz");
  if (nx && ny && nz) columns.direction = {*nx, *ny, *nz};
  return columns;
}

double numberAt(const std::vector<std::string>& fields, std::size_t column, const Place& place) {
  if (column >= fields.size()) failAt(place, "the line has too few fields");
  const auto value = parseNumber(fields[column]);
  if (!value || std::abs(*value) > kLargestNumber) {
    failAt(place, "\"" + cleanName(fields[column]) + "\" is not a number that a place or a light can have");
  }
  return *value;
}

glm::dvec3 vectorAt(const std::vector<std::string>& fields, const std::array<std::size_t, 3>& columns,
                    const Place& place) {
  return {numberAt(fields, columns[0], place), numberAt(fields, columns[1], place),
          numberAt(fields, columns[2], place)};
}

/// A grid's name without the apostrophe that keeps spreadsheets from running it.
std::string gridName(std::string name) {
  const bool isGuarded =
      name.size() > 1 && name[0] == '\'' && std::string_view("=+-@").find(name[1]) != std::string_view::npos;
  return cleanName(isGuarded ? name.substr(1) : name);
}

SensorReading readingOf(const std::vector<std::string>& fields, const Columns& columns, const Place& place) {
  SensorReading reading;
  reading.place_m = vectorAt(fields, columns.place, place);
  reading.illuminance_lx = numberAt(fields, columns.illuminance, place);
  if (columns.grid) {
    if (*columns.grid >= fields.size()) failAt(place, "the line has too few fields");
    reading.grid = gridName(fields[*columns.grid]);
  }
  if (columns.direction) {
    const glm::dvec3 direction = vectorAt(fields, *columns.direction, place);
    const double length = glm::length(direction);
    if (length < 1e-9) failAt(place, "the normal has no length");
    reading.direction = direction / length;
  }
  return reading;
}

std::filesystem::path tableIn(const std::filesystem::path& path) {
  std::error_code failure;
  if (!std::filesystem::is_directory(path, failure)) return path;
  const std::filesystem::path table = path / "sensors.csv";
  if (!std::filesystem::exists(table, failure)) {
    throw InputError(path.string() +
                     ": the folder holds no sensors.csv; give the folder of a report or a CSV table");
  }
  return table;
}

}  // namespace

SensorTable readSensorTable(const std::filesystem::path& path) {
  const std::filesystem::path file = tableIn(path);
  const std::string text = decodedText(readWholeFile(file, "table", kMaxBytes), file.string());
  LineReader lines(text);
  SensorTable table;
  std::optional<Columns> columns;
  while (lines.next()) {
    const std::string_view line = trimmed(lines.line());
    if (line.empty() || line.starts_with('#')) continue;
    const Place place{file.string(), lines.number()};
    const std::vector<std::string> fields = csvFields(line);
    if (columns) {
      table.readings.push_back(readingOf(fields, *columns, place));
    } else {
      columns = columnsOf(fields, place);
      table.hasGrids = columns->grid.has_value();
    }
  }
  if (table.readings.empty()) throw InputError(file.string() + ": there is no sensor in the table");
  return table;
}

}  // namespace clerestory
