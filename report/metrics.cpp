// SPDX-License-Identifier: GPL-3.0-or-later
// Computes what a grid of sensors amounts to. Nothing is rounded here.
#include "metrics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

namespace clerestory {
namespace {

double shareAtLeast_pct(const std::vector<double>& values, double threshold) {
  if (values.empty()) return 0.0;
  const auto count = std::count_if(values.begin(), values.end(), [&](double v) { return v >= threshold; });
  return 100.0 * static_cast<double>(count) / static_cast<double>(values.size());
}

double shareBetween_pct(const std::vector<double>& values, double low, double high) {
  if (values.empty()) return 0.0;
  const auto count =
      std::count_if(values.begin(), values.end(), [&](double v) { return v >= low && v <= high; });
  return 100.0 * static_cast<double>(count) / static_cast<double>(values.size());
}

std::vector<double> daylightFactors_pct(const GridValues& grid, const SkySettings& sky) {
  std::vector<double> factors;
  for (const SensorValue& sensor : grid.sensors)
    factors.push_back(daylightFactor_pct(sky, sensor).value_or(0.0));
  return factors;
}

/// The errors' estimates as the program states errors everywhere: over max(value, 5 % of the grid's mean).
/// [%]
std::vector<double> relativeErrors_pct(const GridValues& grid, double mean_lx) {
  std::vector<double> errors;
  for (const SensorValue& sensor : grid.sensors) {
    const double reference_lx = std::max(sensor.illuminance_lx, 0.05 * mean_lx);
    errors.push_back(reference_lx > 0.0 ? 100.0 * sensor.error_lx / reference_lx : 0.0);
  }
  return errors;
}

double percentile(std::vector<double> values, double fraction) {
  if (values.empty()) return 0.0;
  const auto rank = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(values.size())));
  const std::size_t index = std::min(values.size(), std::max<std::size_t>(rank, 1)) - 1;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(index), values.end());
  return values[index];
}

}  // namespace

double luminousY(const glm::dvec3& colour) {
  return 0.2126 * colour.x + 0.7152 * colour.y + 0.0722 * colour.z;
}

bool hasDaylightFactor(const SkySettings& sky) {
  // Skies whose luminance does not depend on the sun's azimuth: uniform, CIE types 1, 3 and 5, the
  // traditional one.
  static constexpr std::array<int, 5> types = {0, 1, 3, 5, 16};
  return !sky.isPerez && sky.diffuseHorizontal_lx > 0.0 &&
         std::find(types.begin(), types.end(), sky.cieType) != types.end();
}

std::optional<double> daylightFactor_pct(const SkySettings& sky, const SensorValue& sensor) {
  if (!hasDaylightFactor(sky)) return std::nullopt;
  return 100.0 * sensor.sky_lx / sky.diffuseHorizontal_lx;
}

Distribution distributionOf(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return {sum / static_cast<double>(values.size()), median, values.front(), values.back()};
}

GridMetrics metricsOf(const GridValues& grid, const SkySettings& sky) {
  std::vector<double> illuminances;
  for (const SensorValue& sensor : grid.sensors) illuminances.push_back(sensor.illuminance_lx);

  GridMetrics metrics;
  metrics.sensors = grid.sensors.size();
  metrics.share300To3000_pct = shareBetween_pct(illuminances, 300.0, 3000.0);
  metrics.illuminance_lx = distributionOf(std::move(illuminances));
  const double mean_lx = metrics.illuminance_lx.mean;
  metrics.uniformity = mean_lx > 0.0 ? metrics.illuminance_lx.min / mean_lx : 0.0;
  if (hasDaylightFactor(sky)) {
    std::vector<double> factors = daylightFactors_pct(grid, sky);
    metrics.shareAbove2_pct = shareAtLeast_pct(factors, 2.0);
    metrics.daylightFactor_pct = distributionOf(std::move(factors));
  }
  const std::vector<double> errors = relativeErrors_pct(grid, mean_lx);
  metrics.meanErrorEstimate_pct = distributionOf(errors).mean;
  metrics.p95ErrorEstimate_pct = percentile(errors, 0.95);
  return metrics;
}

std::optional<En17037> en17037Of(const GridValues& grid, const Study& study) {
  // The norm's method 1 is defined under CIE type 1 or the traditional overcast sky.
  const bool isOvercast = !study.sky.isPerez && (study.sky.cieType == 1 || study.sky.cieType == 16);
  if (!isOvercast || !hasDaylightFactor(study.sky) || study.site.externalDiffuse_lx <= 0.0)
    return std::nullopt;
  struct Asked {
    const char* name;
    double target_lx, minimum_lx;
  };
  static constexpr std::array<Asked, 3> levels = {
      {{"minimum", 300, 100}, {"medium", 500, 300}, {"high", 750, 500}}};

  const std::vector<double> factors = daylightFactors_pct(grid, study.sky);
  En17037 result;
  for (const Asked& asked : levels) {
    En17037::Level level{};
    level.name = asked.name;
    level.target_pct = 100.0 * asked.target_lx / study.site.externalDiffuse_lx;
    level.minimum_pct = 100.0 * asked.minimum_lx / study.site.externalDiffuse_lx;
    level.shareTarget_pct = shareAtLeast_pct(factors, level.target_pct);
    level.shareMinimum_pct = shareAtLeast_pct(factors, level.minimum_pct);
    level.met = level.shareTarget_pct >= 50.0 && level.shareMinimum_pct >= 95.0;
    result.levels.push_back(level);
  }
  return result;
}

std::vector<std::size_t> gridsOfRoom(const Building& building, std::int32_t room) {
  std::vector<std::size_t> grids;
  for (std::size_t g = 0; g < building.grids.size(); ++g) {
    if (knownRoom(building, building.grids[g].room) == room) grids.push_back(g);
  }
  return grids;
}

std::int32_t knownRoom(const Building& building, std::int32_t room) {
  return room >= 0 && static_cast<std::size_t>(room) < building.rooms.size() ? room : -1;
}

std::string roomName(const Building& building, std::int32_t room) {
  const std::int32_t known = knownRoom(building, room);
  return known < 0 ? outsideName : building.rooms[static_cast<std::size_t>(known)].name;
}

std::vector<std::string> surfaceRowNames(const ReportInput& input) {
  std::set<std::pair<std::int32_t, std::string>> taken;
  std::vector<std::string> names;
  for (const SurfaceValue& value : input.solution.surfaces) {
    const std::string& name = input.building.model.surfaces.at(value.surface).name;
    std::string unique = name;
    for (int number = 2; !taken.insert({knownRoom(input.building, value.room), unique}).second; ++number) {
      unique = name + "#" + std::to_string(number);
    }
    names.push_back(unique);
  }
  return names;
}

std::string modelName(const Study& study) {
  const std::string written =
      study.modelFileAsWritten.empty() ? study.modelFile.generic_string() : study.modelFileAsWritten;
  // A study may have been written on another system: both kinds of slashes divide folders.
  return written.substr(written.find_last_of("/\\") + 1);
}

}  // namespace clerestory
