// SPDX-License-Identifier: GPL-3.0-or-later
// Judges which unit makes a building of a possible size from a model's coordinates.
#include "units.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "extent.hpp"

namespace clerestory {
namespace {

/// Area-weighted median of the polygons' shorter sides, of those not longer than `longest`.
double typicalSide(const Scene& scene, double longest) {
  std::vector<std::pair<double, double>> sides;  // length, area
  double total = 0.0;
  forEachPolygon(scene, [&](std::span<const std::uint32_t> polygon) {
    Box box;
    for (const std::uint32_t corner : polygon) {
      box.add(scene.points[corner]);
    }
    const glm::dvec3 extent = box.sortedExtent();
    if (extent.z <= longest) {
      sides.emplace_back(extent.y, glm::length(areaVector(scene, polygon)));
      total += sides.back().second;
    }
  });
  std::sort(sides.begin(), sides.end());
  double sum = 0.0;
  for (const auto& [length, area] : sides) {
    sum += area;
    if (sum >= 0.5 * total) {
      return length;
    }
  }
  return 0.0;
}

bool within(double value, double low, double high) {
  return value >= low && value <= high;
}

}  // namespace

std::optional<double> metresOf(std::string_view unit) {
  constexpr std::pair<std::string_view, double> kUnits[] = {
      {"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"ft", 0.3048}, {"in", 0.0254}};
  for (const auto& [name, metres] : kUnits) {
    if (unit == name) {
      return metres;
    }
  }
  return std::nullopt;
}

SizeJudgement judgeSize(const Scene& scene) {
  const Box box = boxOf(scene);
  const glm::dvec3 extent = box.sortedExtent();
  const bool flat = extent.x < 1e-4 * extent.z;
  const double smallest = flat ? extent.y : extent.x;
  SizeJudgement judgement;
  judgement.extent = box.high - box.low;
  judgement.metresArePossible = smallest <= 90.0 && extent.z >= 0.3;
  if (judgement.metresArePossible) {
    return judgement;
  }
  const double mean = std::sqrt(smallest * typicalSide(scene, 8.0 * smallest));
  for (const char* unit : {"cm", "mm", "ft"}) {
    const double metres = *metresOf(unit);
    if (within(smallest * metres, 1.8, 60.0) && within(mean * metres, 1.0, 9.9)) {
      judgement.others.emplace_back(unit);
    }
  }
  return judgement;
}

}  // namespace clerestory
