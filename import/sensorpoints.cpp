// SPDX-License-Identifier: GPL-3.0-or-later
// Reads files of sensor points: CSV with a header, or six numbers a line.
#include "sensorpoints.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <import/error.hpp>

#include "textfile.hpp"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxBytes = 1ULL << 30U;
constexpr std::size_t kMissing = ~std::size_t{0};

std::vector<std::string> fieldsOf(std::string_view line) {
  if (line.find(',') != std::string_view::npos) {
    return csvFields(line);
  }
  std::vector<std::string_view> words;
  splitWords(line, words);
  return {words.begin(), words.end()};
}

/// Which field holds x y z nx ny nz.
using Columns = std::array<std::size_t, 6>;

Columns columnsOf(const std::vector<std::string>& header, const Place& place) {
  constexpr std::array<std::array<std::string_view, 2>, 6> kNames{
      {{"x_m", "x"}, {"y_m", "y"}, {"z_m", "z"}, {"nx", "nx"}, {"ny", "ny"}, {"nz", "nz"}}};
  Columns columns{};
  for (std::size_t i = 0; i < 6; ++i) {
    const auto found = std::find_if(header.begin(), header.end(), [&](const std::string& field) {
      const std::string name = lowerCase(field);
      return name == kNames[i][0] || name == kNames[i][1];
    });
    columns[i] = found == header.end() ? kMissing : static_cast<std::size_t>(found - header.begin());
    const bool halfNormal = i > 3 && (columns[i] == kMissing) != (columns[3] == kMissing);
    if ((i < 3 && columns[i] == kMissing) || halfNormal) {
      failAt(place, "the header lacks a column \"" + std::string(kNames[i][0]) +
                        "\"; it is x_m,y_m,z_m or x_m,y_m,z_m,nx,ny,nz");
    }
  }
  return columns;
}

std::array<double, 6> pointOf(const std::vector<std::string>& fields, const Columns& columns,
                              const Place& place) {
  std::array<double, 6> point{0, 0, 0, 0, 0, 1};
  for (std::size_t i = 0; i < 6; ++i) {
    if (columns[i] == kMissing) {
      continue;
    }
    const auto value = columns[i] < fields.size() ? parseNumber(fields[columns[i]]) : std::nullopt;
    if (!value || std::abs(*value) > 1e9) {
      failAt(place, columns[i] < fields.size()
                        ? "\"" + cleanName(fields[columns[i]]) + "\" is not a coordinate"
                        : "the line has too few numbers");
    }
    point[i] = *value;
  }
  const double length = std::hypot(point[3], point[4], point[5]);
  if (length < 1e-9) {
    failAt(place, "the normal has no length");
  }
  for (std::size_t i = 3; i < 6; ++i) {
    point[i] /= length;
  }
  return point;
}

}  // namespace

std::vector<std::array<double, 6>> readSensorPoints(const std::filesystem::path& file) {
  const std::string text = decodedText(readWholeFile(file, "points", kMaxBytes), file.string());
  LineReader lines(text);
  std::vector<std::array<double, 6>> points;
  std::optional<Columns> columns;
  while (lines.next()) {
    const std::string_view line = trimmed(lines.line());
    if (line.empty() || line.starts_with('#')) {
      continue;
    }
    const Place place{file.string(), lines.number()};
    const std::vector<std::string> fields = fieldsOf(line);
    if (!columns) {
      if (!parseNumber(fields[0])) {
        columns = columnsOf(fields, place);
        continue;
      }
      columns = Columns{0, 1, 2, 3, 4, 5};
      if (fields.size() == 3) {
        columns = Columns{0, 1, 2, kMissing, kMissing, kMissing};
      }
    }
    points.push_back(pointOf(fields, *columns, place));
  }
  if (points.empty()) {
    throw InputError(file.string() + ": there is no sensor point in the file");
  }
  return points;
}

}  // namespace clerestory
