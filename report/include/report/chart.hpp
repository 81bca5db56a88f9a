// SPDX-License-Identifier: GPL-3.0-or-later
// Error against time, memory and links over methods and settings: a table of runs and a page of charts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <report/compare.hpp>

namespace clerestory {

/// One run of a study with one method and setting. What a run does not have is NaN.
struct ChartRun {
  std::string series;   ///< what is varied along it: accuracy, epsilon, rays, cache, threads; or: given
  std::string method;   ///< shooting, gathering, plain; or another program's name
  std::string setting;  ///< for instance "5 %"
  double value = 0.0;   ///< of what is varied, as a number to order by
  double cpu_s = 0.0, wall_s = 0.0;
  double memory_MiB = 0.0;         ///< of hierarchy, light and links
  double links = 0.0, rays = 0.0;  ///< of all steps; rays between surfaces, not those of sensors
  double elements = 0.0;
  int columns = 1;
  ErrorFigures sensors;   ///< fractions
  double surfaces = 0.0;  ///< area-weighted RMS of the relative errors of surfaces' means, a fraction
};

/// What the runs' errors are measured against.
struct ChartReference {
  std::string text;           ///< what it is, in a sentence
  double sensorsError = 0.0;  ///< RMS that it may be off itself, a fraction; NaN: not known
};

/// Runs as CSV (RFC 4180) with a header. Errors in per cent.
std::string chartCsv(const std::vector<ChartRun>& runs);
/// Its header line, and one run's line.
std::string chartCsvHeader();
std::string chartCsvRow(const ChartRun& run);
/// The runs in such a text; lines that are not whole, as an interrupted run leaves one, are passed over.
std::vector<ChartRun> readChartCsv(std::string_view text);

/// Root mean square, mean and percentiles of (ours - true) / max(true, 5 % of the mean). Of equal lengths.
ErrorFigures errorsAgainst(const std::vector<double>& ours, const std::vector<double>& truth);

/// The slope of log error against log cost over the runs' Pareto front, by least squares; empty for less than
/// three runs on it.
std::optional<double> frontSlope(const std::vector<std::pair<double, double>>& costAndError);
/// Which of the points no other beats in both cost and error.
std::vector<bool> paretoFront(const std::vector<std::pair<double, double>>& costAndError);

/// A page by itself with the charts as SVG and the runs as a table.
std::string chartPage(const std::string& study, const ChartReference& reference,
                      const std::vector<ChartRun>& runs);

/// One of its charts alone, as an SVG file: RMS error of sensors against CPU seconds over accuracies.
std::string chartSvg(const std::string& study, const ChartReference& reference,
                     const std::vector<ChartRun>& runs);

}  // namespace clerestory
