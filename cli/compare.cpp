// SPDX-License-Identifier: GPL-3.0-or-later
// Reads two tables of sensors, prints how far the first lies from the second, and writes it where asked.
#include "compare.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <import/error.hpp>
#include <report/compare.hpp>

#include "input.hpp"
#include "progress.hpp"
#include "texttable.hpp"

namespace clerestory {

namespace {

namespace fs = std::filesystem;

struct CompareArguments {
  fs::path first, reference;
  std::optional<fs::path> folder;
};

std::string nameOf(const GridComparison& grid) {
  return grid.name.empty() ? "(no name)" : printable(grid.name);
}

// 100 times a fraction, or a dash where the reference is dark.
std::string percentText(double fraction) {
  return fraction == fraction ? number(100.0 * fraction, 2) : "-";
}

std::string luxText(double lx) {
  return lx == lx ? number(lx, 1) : "-";
}

std::string missingText(const GridComparison& grid) {
  std::string text;
  if (grid.onlyFirst > 0) text = std::to_string(grid.onlyFirst) + " only in the first";
  if (grid.onlyReference > 0) {
    text += (text.empty() ? "" : ", ") + std::to_string(grid.onlyReference) + " only in the reference";
  }
  return text;
}

std::string figuresText(const Comparison& comparison) {
  TextTable table(
      {"grid", "sensors", "mean lx", "reference lx", "bias %", "RMS %", "p95 %", "max %", "without partner"});
  const auto add = [&](const std::string& name, std::size_t sensors, const std::string& mean,
                       const std::string& referenceMean, const ErrorFigures& errors,
                       const std::string& missing) {
    table.add({name, std::to_string(sensors), mean, referenceMean, percentText(errors.bias),
               percentText(errors.rms), percentText(errors.p95), percentText(errors.maximum), missing});
  };
  for (const GridComparison& grid : comparison.grids) {
    add(nameOf(grid), grid.pairs.size(), luxText(grid.mean_lx), luxText(grid.referenceMean_lx), grid.errors,
        missingText(grid));
  }
  if (comparison.grids.size() > 1) add("all", comparison.pairs, "", "", comparison.errors, "");
  return table.text();
}

std::string worstText(const Comparison& comparison) {
  constexpr std::size_t mostPlaces = 5;
  TextTable table({"grid", "x m", "y m", "z m", "lx", "reference lx", "error %", ""});
  for (const PairPlace& place : worstPlaces(comparison, mostPlaces)) {
    const GridComparison& grid = comparison.grids[place.grid];
    const SensorPair& pair = grid.pairs[place.pair];
    table.add({nameOf(grid), number(pair.place_m.x, 3), number(pair.place_m.y, 3), number(pair.place_m.z, 3),
               luxText(pair.illuminance_lx), luxText(pair.reference_lx), percentText(pair.error), ""});
  }
  return table.text();
}

std::string comparisonText(const Comparison& comparison) {
  return printable(comparison.first) + " against " + printable(comparison.reference) +
         ", the reference\nerror: (first - reference) / max(reference, 5 % of the grid's mean)\n\n" +
         figuresText(comparison) + "\nLargest errors\n" + worstText(comparison);
}

void runCompare(const CompareArguments& arguments) {
  const SensorTable first = readSensorTable(arguments.first);
  const SensorTable reference = readSensorTable(arguments.reference);
  const Comparison comparison =
      compareTables(arguments.first.string(), first, arguments.reference.string(), reference);
  if (arguments.folder) writeComparison(*arguments.folder, comparison);
  printResult(comparisonText(comparison));
}

}  // namespace

void addCompareCommand(CLI::App& program, std::function<void()>& run) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App& command =
      *program.add_subcommand("compare", "Tell how far one report or table of sensors lies from another.");
  command.add_option("A", arguments->first, "a report's folder, or a table of sensors (CSV)")
      ->required()
      ->option_text(" ");
  command.add_option("B", arguments->reference, "the same, as the reference")->required()->option_text(" ");
  command
      .add_option("-o,--output", arguments->folder,
                  "write compare.html, compare.csv and differences.csv there")
      ->option_text("DIR");
  command.footer(
      "Prints bias, RMS, 95th percentile and maximum of the errors of A for each grid, and where they are\n"
      "largest. Sensors pair where their grids have one name and they lie within 1 mm; those without a\n"
      "partner are counted. A table has the columns x_m,y_m,z_m,illuminance_lx or x,y,z,lux, and perhaps\n"
      "grid and nx,ny,nz.\n\n"
      "Examples:\n"
      "  clerestory compare variant-report office-report\n"
      "  clerestory compare office-report measured.csv -o differences");
  command.callback([arguments, &run] { run = [arguments] { runCompare(*arguments); }; });
}

}  // namespace clerestory
