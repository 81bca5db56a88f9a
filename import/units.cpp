// SPDX-License-Identifier: GPL-3.0-or-later
// Judges which unit makes a building of a possible size from a model's coordinates.
#include "units.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace clerestory {
namespace {

struct Box {
  glm::dvec3 low{std::numeric_limits<double>::max()};
  glm::dvec3 high{std::numeric_limits<double>::lowest()};

  void add(const glm::dvec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  /// Smallest first.
  [[nodiscard]] glm::dvec3 sortedExtent() const {
    glm::dvec3 e = high - low;
    std::sort(&e.x, &e.x + 3);
    return e;
  }
};

/// Calls `visit` with each polygon of the scene, cages included.
template <typename Visit>
void forEachPolygon(const Scene& scene, const Visit& visit) {
  for (std::size_t f = 0; f < scene.faces.size(); ++f) {
    visit(scene.faces[f]);
  }
  for (const Cage& cage : scene.cages) {
    for (std::size_t f = 0; f < cage.faces.size(); ++f) {
      visit(cage.faces[f]);
    }
  }
}

/// Normal of the polygon, as long as its area.
glm::dvec3 areaVector(const Scene& scene, std::span<const std::uint32_t> polygon) {
  glm::dvec3 sum(0.0);
  const glm::dvec3 first = scene.points[polygon[0]];
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    sum += glm::cross(scene.points[polygon[i]] - first, scene.points[polygon[i + 1]] - first);
  }
  return 0.5 * sum;
}

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

namespace {

Box boxOf(const Scene& scene) {
  Box box;
  forEachPolygon(scene, [&](std::span<const std::uint32_t> polygon) {
    for (const std::uint32_t corner : polygon) {
      box.add(scene.points[corner]);
    }
  });
  return box;
}

}  // namespace

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

bool looksYUp(const Scene& scene) {
  const Box box = boxOf(scene);
  const glm::dvec3 extent = box.high - box.low;
  glm::dvec3 facing(0.0);
  forEachPolygon(
      scene, [&](std::span<const std::uint32_t> polygon) { facing += glm::abs(areaVector(scene, polygon)); });
  const double others = std::max(facing.x, facing.z);
  const bool low = extent.y < 0.6 * std::min(extent.x, extent.z);
  return facing.y > (low ? 0.9 : 1.5) * others;
}

}  // namespace clerestory
