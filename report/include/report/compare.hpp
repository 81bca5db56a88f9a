// SPDX-License-Identifier: GPL-3.0-or-later
// How far the illuminances of one study or table lie from another's, grid by grid.
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <import/sensortable.hpp>

namespace clerestory {

/// A sensor that both tables have.
struct SensorPair {
  glm::dvec3 place_m{0.0};
  double illuminance_lx = 0.0, reference_lx = 0.0;
  double error = 0.0;  ///< (illuminance - reference) / max(reference, 5 % of the grid's mean reference)
};

/// Of the sensors of a grid, or of all; errors are fractions. NaN where the reference is dark.
struct ErrorFigures {
  double bias = 0.0;     ///< mean of the errors
  double rms = 0.0;      ///< root of the mean of their squares
  double p95 = 0.0;      ///< size that 95 % of them keep within
  double maximum = 0.0;  ///< largest size
};

/// NaN where there are no errors, or one of them is.
ErrorFigures figuresOf(const std::vector<double>& errors);

struct GridComparison {
  std::string name;                              ///< empty where neither table has grids
  std::vector<SensorPair> pairs;                 ///< in the first table's order; may be empty
  std::size_t onlyFirst = 0, onlyReference = 0;  ///< sensors without a partner
  double mean_lx = 0.0, referenceMean_lx = 0.0;  ///< over the pairs; NaN where there is none
  ErrorFigures errors;                           ///< likewise
};

struct Comparison {
  std::string first, reference;  ///< what was compared, as the user named it
  std::vector<GridComparison> grids;
  std::size_t pairs = 0;  ///< of all grids, but those that are dark in the reference
  ErrorFigures errors;    ///< over these
};

/// Pairs the sensors of both tables: those of grids of one name that lie within 1 mm and look the same way.
/// Where only one table has grids its names count for both. Throws InputError where there is no pair.
Comparison compareTables(const std::string& firstName, const SensorTable& first,
                         const std::string& referenceName, const SensorTable& reference);

/// A sensor of a comparison.
struct PairPlace {
  std::size_t grid, pair;
};
/// The `most` sensors with the largest errors by size, the largest first.
std::vector<PairPlace> worstPlaces(const Comparison& comparison, std::size_t most);

/// A row of figures for each grid. RFC 4180.
std::string comparisonCsv(const Comparison& comparison);

/// A row for each pair of sensors. RFC 4180.
std::string differencesCsv(const Comparison& comparison);

/// A page by itself: figures, largest errors, and a plan of the errors of each grid.
std::string comparisonPage(const Comparison& comparison);

/// Writes these as compare.csv, differences.csv and compare.html into `folder`, which is made where there is
/// none. Throws InputError where it holds a report or cannot be made, MachineError where the disk fails.
void writeComparison(const std::filesystem::path& folder, const Comparison& comparison);

}  // namespace clerestory
