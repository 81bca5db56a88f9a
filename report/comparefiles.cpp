// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a comparison's tables and page.
#include <filesystem>
#include <system_error>
#include <utility>

#include <import/error.hpp>
#include <report/compare.hpp>

#include "escape.hpp"
#include "folder.hpp"
#include "numbers.hpp"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

std::string percent(double fraction) {
  return shortestFloat(100.0 * fraction);
}

void makeFolder(const fs::path& folder) {
  std::error_code failure;
  if (fs::exists(folder / "study.json", failure)) {
    throw InputError(folder.string() + ": a report is in this folder; choose another with -o");
  }
  fs::create_directories(folder, failure);
  if (failure) {
    throw InputError(folder.string() + ": the folder cannot be made: " + failure.message() +
                     "; choose another with -o");
  }
}

}  // namespace

std::string comparisonCsv(const Comparison& comparison) {
  std::string table =
      "grid,sensors,only_first,only_reference,illuminance_mean_lx,reference_mean_lx,bias_pct,rms_pct,p95_pct,"
      "max_pct\r\n";
  for (const GridComparison& grid : comparison.grids) {
    table += csvText(grid.name) + ',' + std::to_string(grid.pairs.size()) + ',' +
             std::to_string(grid.onlyFirst) + ',' + std::to_string(grid.onlyReference) + ',' +
             shortestFloat(grid.mean_lx) + ',' + shortestFloat(grid.referenceMean_lx) + ',' +
             percent(grid.errors.bias) + ',' + percent(grid.errors.rms) + ',' + percent(grid.errors.p95) +
             ',' + percent(grid.errors.maximum) + "\r\n";
  }
  return table;
}

std::string differencesCsv(const Comparison& comparison) {
  std::string table = "grid,x_m,y_m,z_m,illuminance_lx,reference_lx,difference_lx,error_pct\r\n";
  for (const GridComparison& grid : comparison.grids) {
    const std::string name = csvText(grid.name);
    for (const SensorPair& pair : grid.pairs) {
      table += name + ',' + coordinate(pair.place_m.x) + ',' + coordinate(pair.place_m.y) + ',' +
               coordinate(pair.place_m.z) + ',' + shortestFloat(pair.illuminance_lx) + ',' +
               shortestFloat(pair.reference_lx) + ',' +
               shortestFloat(pair.illuminance_lx - pair.reference_lx) + ',' + percent(pair.error) + "\r\n";
    }
  }
  return table;
}

void writeComparison(const fs::path& folder, const Comparison& comparison) {
  const std::vector<std::pair<std::string, std::string>> files = {
      {"compare.csv", comparisonCsv(comparison)},
      {"differences.csv", differencesCsv(comparison)},
      {"compare.html", comparisonPage(comparison)}};
  const auto partial = [&](const std::string& name) { return folder / ("." + name + ".partial"); };
  makeFolder(folder);
  try {
    for (const auto& [name, bytes] : files) writeFile(partial(name), bytes);
    for (const auto& [name, bytes] : files) fs::rename(partial(name), folder / name);
  } catch (const std::exception& error) {
    std::error_code ignored;
    for (const auto& [name, bytes] : files) fs::remove(partial(name), ignored);
    throw MachineError(folder.string() + ": the comparison could not be written: " + error.what());
  }
}

}  // namespace clerestory
