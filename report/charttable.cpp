// SPDX-License-Identifier: GPL-3.0-or-later
// The runs of a chart as a table, and the figures over them.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include <report/chart.hpp>

#include "escape.hpp"
#include "numbers.hpp"

namespace clerestory {
namespace {

constexpr std::size_t fields = 16;

/// A number of a CSV field; an empty one is what is not known.
std::optional<double> numberOf(const std::string& text) {
  if (text.empty()) return std::numeric_limits<double>::quiet_NaN();
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The fields of one line that holds no line breaks.
std::vector<std::string> fieldsOf(std::string_view line) {
  std::vector<std::string> found(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      const bool isDouble = quoted && i + 1 < line.size() && line[i + 1] == '"';
      if (isDouble) found.back() += line[i++];
      if (!isDouble) quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      found.emplace_back();
    } else {
      found.back() += line[i];
    }
  }
  return found;
}

std::optional<ChartRun> runOf(std::string_view line) {
  const std::vector<std::string> text = fieldsOf(line);
  if (text.size() != fields) return std::nullopt;
  ChartRun run;
  run.series = text[0];
  run.method = text[1];
  run.setting = text[2];
  std::vector<double> values;
  for (std::size_t i = 3; i < fields; ++i) {
    const std::optional<double> value = numberOf(text[i]);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  run.value = values[0];
  run.cpu_s = values[1];
  run.wall_s = values[2];
  run.memory_MiB = values[3];
  run.links = values[4];
  run.rays = values[5];
  run.elements = values[6];
  run.columns = std::isfinite(values[7]) ? static_cast<int>(values[7]) : 1;
  run.sensors = {values[8] / 100.0, values[9] / 100.0, values[10] / 100.0, values[11] / 100.0};
  run.surfaces = values[12] / 100.0;
  return run;
}

}  // namespace

std::string chartCsvHeader() {
  return "series,method,setting,value,cpu_s,wall_s,memory_mib,links,rays,elements,columns,bias_pct,rms_pct,"
         "p95_pct,max_pct,surfaces_pct\n";
}

std::string chartCsvRow(const ChartRun& run) {
  std::string line = csvText(run.series) + ',' + csvText(run.method) + ',' + csvText(run.setting);
  for (const double value :
       {run.value, run.cpu_s, run.wall_s, run.memory_MiB, run.links, run.rays, run.elements,
        static_cast<double>(run.columns), 100.0 * run.sensors.bias, 100.0 * run.sensors.rms,
        100.0 * run.sensors.p95, 100.0 * run.sensors.maximum, 100.0 * run.surfaces}) {
    line += ',' + shortestFloat(value);
  }
  return line + '\n';
}

std::string chartCsv(const std::vector<ChartRun>& runs) {
  std::string text = chartCsvHeader();
  for (const ChartRun& run : runs) text += chartCsvRow(run);
  return text;
}

std::vector<ChartRun> readChartCsv(std::string_view text) {
  std::vector<ChartRun> runs;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) break;
    if (const auto run = runOf(text.substr(0, end))) runs.push_back(*run);
    text.remove_prefix(end + 1);
  }
  return runs;
}

ErrorFigures errorsAgainst(const std::vector<double>& ours, const std::vector<double>& truth) {
  double mean = 0.0;
  for (const double value : truth) mean += value / static_cast<double>(truth.size());
  std::vector<double> errors;
  for (std::size_t i = 0; i < truth.size() && mean > 0.0; ++i)
    errors.push_back((ours[i] - truth[i]) / std::max(truth[i], 0.05 * mean));
  return figuresOf(errors);
}

std::vector<bool> paretoFront(const std::vector<std::pair<double, double>>& costAndError) {
  std::vector<bool> isOnFront;
  for (const auto& [cost, error] : costAndError) {
    isOnFront.push_back(std::none_of(costAndError.begin(), costAndError.end(), [&](const auto& other) {
      return other.first <= cost && other.second <= error && (other.first < cost || other.second < error);
    }));
  }
  return isOnFront;
}

std::optional<double> frontSlope(const std::vector<std::pair<double, double>>& costAndError) {
  const std::vector<bool> isOnFront = paretoFront(costAndError);
  double count = 0.0;
  double sumX = 0.0;
  double sumY = 0.0;
  double sumXX = 0.0;
  double sumXY = 0.0;
  for (std::size_t i = 0; i < costAndError.size(); ++i) {
    const auto& [cost, error] = costAndError[i];
    if (!isOnFront[i] || !(cost > 0.0) || !(error > 0.0)) continue;
    const double x = std::log(cost);
    const double y = std::log(error);
    count += 1.0;
    sumX += x;
    sumY += y;
    sumXX += x * x;
    sumXY += x * y;
  }
  const double spread = count * sumXX - sumX * sumX;
  if (count < 3.0 || !(spread > 0.0)) return std::nullopt;
  return (count * sumXY - sumX * sumY) / spread;
}

}  // namespace clerestory
