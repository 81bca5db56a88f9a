// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs sensors by place and judges their differences.
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include <import/error.hpp>
#include <report/compare.hpp>

namespace clerestory {
namespace {

constexpr double kReach_m = 1e-3;
constexpr double kRounding_m = 1e-9;      // 1 mm apart in decimals is 1 mm apart
constexpr double kSameDirection = 0.999;  // cosine: 2.6 degrees, more than rounded normals differ by
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Readings that have no partner yet, by grid and by cubes of four times the reach: what is within reach of a
/// place lies in eight of them, with room for rounding.
class Unpaired {
 public:
  Unpaired(const std::vector<SensorReading>& readings, bool byGrid) : readings_(readings), byGrid_(byGrid) {
    for (std::size_t i = 0; i < readings.size(); ++i) {
      cubes_.emplace(keyOf(readings[i].grid, cubeAt(readings[i].place_m)), i);
    }
  }

  /// Takes the reading nearest to `wanted` that is within reach and looks the same way.
  std::optional<std::size_t> take(const SensorReading& wanted) {
    auto best = cubes_.end();
    double nearest_m = kReach_m + kRounding_m;
    const glm::dvec3 lowest = cubeAt(wanted.place_m - glm::dvec3(2.0 * kReach_m));
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 cube = lowest + glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2);
      const auto [begin, end] = cubes_.equal_range(keyOf(wanted.grid, cube));
      for (auto candidate = begin; candidate != end && nearest_m > 0.0; ++candidate) {
        const SensorReading& reading = readings_[candidate->second];
        const double distance_m = glm::distance(reading.place_m, wanted.place_m);
        const bool looksElsewhere = reading.direction && wanted.direction &&
                                    glm::dot(*reading.direction, *wanted.direction) < kSameDirection;
        if (looksElsewhere || distance_m > nearest_m || (best != cubes_.end() && distance_m == nearest_m)) {
          continue;
        }
        nearest_m = distance_m;
        best = candidate;
      }
    }
    if (best == cubes_.end()) return std::nullopt;
    const std::size_t taken = best->second;
    cubes_.erase(best);
    return taken;
  }

  /// What is left, in the table's order.
  [[nodiscard]] std::vector<std::size_t> rest() const {
    std::vector<std::size_t> rest;
    for (const auto& [key, reading] : cubes_) rest.push_back(reading);
    std::sort(rest.begin(), rest.end());
    return rest;
  }

 private:
  using Key = std::tuple<std::string, double, double, double>;

  static glm::dvec3 cubeAt(const glm::dvec3& place_m) { return glm::floor(place_m / (4.0 * kReach_m)); }
  [[nodiscard]] Key keyOf(const std::string& grid, const glm::dvec3& cube) const {
    return {byGrid_ ? grid : std::string(), cube.x, cube.y, cube.z};
  }

  const std::vector<SensorReading>& readings_;
  bool byGrid_;
  std::multimap<Key, std::size_t> cubes_;
};

std::vector<double> errorsOf(const std::vector<SensorPair>& pairs) {
  std::vector<double> errors;
  for (const SensorPair& pair : pairs) errors.push_back(pair.error);
  return errors;
}

/// Means, errors and figures from the pairs' illuminances.
void judge(GridComparison& grid) {
  const auto count = static_cast<double>(grid.pairs.size());
  for (const SensorPair& pair : grid.pairs) {
    grid.mean_lx += pair.illuminance_lx;
    grid.referenceMean_lx += pair.reference_lx;
  }
  grid.mean_lx /= count;  // NaN without pairs, as said
  grid.referenceMean_lx /= count;
  for (SensorPair& pair : grid.pairs) {
    const double base_lx = std::max(pair.reference_lx, 0.05 * grid.referenceMean_lx);
    const double error = (pair.illuminance_lx - pair.reference_lx) / base_lx;
    pair.error = base_lx > 0.0 && std::isfinite(error) ? error : kNone;
  }
  grid.errors = figuresOf(errorsOf(grid.pairs));
}

/// The grids of a table, for a message.
std::string gridNames(const SensorTable& table) {
  constexpr std::size_t mostNames = 5;
  std::vector<std::string> names;
  for (const SensorReading& reading : table.readings) {
    if (std::find(names.begin(), names.end(), reading.grid) != names.end()) continue;
    if (names.size() == mostNames) {
      names.emplace_back("...");
      break;
    }
    names.push_back(reading.grid);
  }
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "\"" : ", \"") + name + "\"";
  return text;
}

[[noreturn]] void failWithoutPairs(const std::string& firstName, const SensorTable& first,
                                   const std::string& referenceName, const SensorTable& reference) {
  std::string text = firstName + " and " + referenceName + " have no sensor in common: ";
  if (first.hasGrids && reference.hasGrids) {
    text += "the first has the grids " + gridNames(first) + ", the second " + gridNames(reference) +
            "; sensors pair where their grids have one name and they lie within 1 mm";
  } else {
    text += "no two lie within 1 mm; are both in metres and from the same origin?";
  }
  throw InputError(text);
}

}  // namespace

ErrorFigures figuresOf(const std::vector<double>& errors) {
  const bool isKnown = std::none_of(errors.begin(), errors.end(), [](double e) { return std::isnan(e); });
  if (errors.empty() || !isKnown) return {kNone, kNone, kNone, kNone};
  ErrorFigures figures;
  std::vector<double> sizes;
  for (const double error : errors) {
    figures.bias += error;
    figures.rms += error * error;
    sizes.push_back(std::abs(error));
  }
  const auto count = static_cast<double>(errors.size());
  figures.bias /= count;
  figures.rms = std::sqrt(figures.rms / count);
  std::sort(sizes.begin(), sizes.end());
  figures.p95 = sizes[static_cast<std::size_t>(std::ceil(0.95 * count)) - 1];
  figures.maximum = sizes.back();
  return figures;
}

Comparison compareTables(const std::string& firstName, const SensorTable& first,
                         const std::string& referenceName, const SensorTable& reference) {
  Comparison comparison{firstName, referenceName, {}, 0, {}};
  std::map<std::string, std::size_t> known;
  const auto gridNamed = [&](const std::string& name) -> GridComparison& {
    const auto [place, isNew] = known.emplace(name, comparison.grids.size());
    if (isNew) comparison.grids.push_back({name, {}, 0, 0, 0.0, 0.0, {}});
    return comparison.grids[place->second];
  };

  Unpaired unpaired(reference.readings, first.hasGrids && reference.hasGrids);
  for (const SensorReading& reading : first.readings) {
    const auto partner = unpaired.take(reading);
    const bool namedByReference = partner && !first.hasGrids;
    GridComparison& grid = gridNamed(namedByReference ? reference.readings[*partner].grid : reading.grid);
    if (partner) {
      grid.pairs.push_back(
          {reading.place_m, reading.illuminance_lx, reference.readings[*partner].illuminance_lx, 0.0});
    } else {
      ++grid.onlyFirst;
    }
  }
  for (const std::size_t left : unpaired.rest()) ++gridNamed(reference.readings[left].grid).onlyReference;

  std::vector<double> errors;
  bool hasPairs = false;
  for (GridComparison& grid : comparison.grids) {
    judge(grid);
    hasPairs = hasPairs || !grid.pairs.empty();
    for (const SensorPair& pair : grid.pairs) {
      if (!std::isnan(pair.error)) errors.push_back(pair.error);
    }
  }
  if (!hasPairs) failWithoutPairs(firstName, first, referenceName, reference);
  comparison.pairs = errors.size();
  comparison.errors = figuresOf(errors);
  return comparison;
}

std::vector<PairPlace> worstPlaces(const Comparison& comparison, std::size_t most) {
  std::vector<PairPlace> places;
  const auto size = [&](const PairPlace& place) {
    return std::abs(comparison.grids[place.grid].pairs[place.pair].error);
  };
  for (std::size_t g = 0; g < comparison.grids.size(); ++g) {
    for (std::size_t p = 0; p < comparison.grids[g].pairs.size(); ++p) {
      if (!std::isnan(size({g, p}))) places.push_back({g, p});
    }
  }
  std::stable_sort(places.begin(), places.end(),
                   [&](const PairPlace& a, const PairPlace& b) { return size(a) > size(b); });
  if (places.size() > most) places.resize(most);
  return places;
}

}  // namespace clerestory
