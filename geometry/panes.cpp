// SPDX-License-Identifier: GPL-3.0-or-later
// Panes that are drawn as solids or as several sheets become one sheet each.
#include "panes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace clerestory {
namespace {

constexpr double parallel_rad = 5e-3;
constexpr double overlapShare = 0.6;     ///< of the smaller of two sheets, for them to be one unit
constexpr double wholeSheetShare = 0.9;  ///< of the largest level's area, for a level to stand for its unit

struct Sheet {
  std::uint32_t polygon;
  glm::dvec3 normal;  ///< unit, canonical sign
  glm::dvec3 middle, low, high;
  double area_m2;
};

Sheet describe(std::span<const glm::dvec3> points, const DividedPolygon& divided, std::uint32_t index) {
  Sheet sheet{index, glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(1e300), glm::dvec3(-1e300), 0.0};
  for (const Loop& piece : divided.pieces) sheet.normal += 0.5 * doubleAreaVector(points, piece);
  sheet.area_m2 = glm::length(sheet.normal);
  sheet.normal *= canonicalSign(sheet.normal / sheet.area_m2) / sheet.area_m2;
  for (const std::uint32_t corner : divided.polygon.outer) {
    sheet.middle += points[corner] / static_cast<double>(divided.polygon.outer.size());
    sheet.low = glm::min(sheet.low, points[corner]);
    sheet.high = glm::max(sheet.high, points[corner]);
  }
  return sheet;
}

/// Area that two convex loops share, seen along the frame's normal.
double sharedArea_m2(std::vector<glm::dvec2> subject, const std::vector<glm::dvec2>& window) {
  for (std::size_t k = 0; k < window.size() && subject.size() >= 3; ++k) {
    const glm::dvec2& a = window[k];
    const glm::dvec2 edge = window[(k + 1) % window.size()] - a;
    std::vector<glm::dvec2> kept;
    for (std::size_t i = 0; i < subject.size(); ++i) {
      const glm::dvec2& p = subject[i];
      const glm::dvec2& q = subject[(i + 1) % subject.size()];
      const double sideP = cross2(edge, p - a);
      const double sideQ = cross2(edge, q - a);
      if (sideP >= 0.0) kept.push_back(p);
      if ((sideP >= 0.0) != (sideQ >= 0.0)) kept.push_back(p + sideP / (sideP - sideQ) * (q - p));
    }
    subject = std::move(kept);
  }
  double twice = 0.0;
  for (std::size_t i = 2; i < subject.size(); ++i) {
    twice += cross2(subject[i - 1] - subject[0], subject[i] - subject[0]);
  }
  return 0.5 * twice;
}

/// Loop in the frame, counterclockwise there.
std::vector<glm::dvec2> flatten(std::span<const glm::dvec3> points, const Loop& loop,
                                const PlaneFrame& frame) {
  std::vector<glm::dvec2> flat;
  for (const std::uint32_t corner : loop) flat.push_back(frame.project(points[corner]));
  if (glm::dot(doubleAreaVector(points, loop), frame.normal) < 0.0) std::reverse(flat.begin(), flat.end());
  return flat;
}

/// The sheets of one material: which belong to one unit, and which of these stay.
class PaneUnits {
 public:
  PaneUnits(std::span<const glm::dvec3> points, const std::vector<DividedPolygon>& polygons,
            const Tolerances& tolerances, std::vector<Sheet> sheets)
      : points_(points), polygons_(polygons), tolerances_(tolerances), sheets_(std::move(sheets)) {
    std::sort(sheets_.begin(), sheets_.end(),
              [](const Sheet& a, const Sheet& b) { return a.low.x < b.low.x; });
    parent_.resize(sheets_.size());
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  /// Marks the polygons that a unit does not need.
  void markNeedless(std::vector<bool>& needless) {
    for (std::size_t i = 0; i < sheets_.size(); ++i) {
      const double reach = sheets_[i].high.x + tolerances_.paneGapHigh_m;
      for (std::size_t j = i + 1; j < sheets_.size() && sheets_[j].low.x <= reach; ++j) {
        if (areOneUnit(sheets_[i], sheets_[j])) parent_[find(j)] = find(i);
      }
    }
    std::map<std::size_t, std::vector<std::size_t>> units;
    for (std::size_t i = 0; i < sheets_.size(); ++i) units[find(i)].push_back(i);
    for (const auto& [root, members] : units) {
      if (members.size() > 1) reduce(members, needless);
    }
  }

 private:
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  [[nodiscard]] bool areOneUnit(const Sheet& a, const Sheet& b) const {
    if (glm::length(glm::cross(a.normal, b.normal)) > parallel_rad) return false;
    const double gap = std::abs(glm::dot(b.middle - a.middle, a.normal));
    if (gap < tolerances_.paneGapLow_m - tolerances_.collinear_m ||
        gap > tolerances_.paneGapHigh_m + tolerances_.collinear_m) {
      return false;
    }
    const glm::dvec3 reach(tolerances_.paneGapHigh_m);
    if (glm::any(glm::greaterThan(a.low, b.high + reach)) ||
        glm::any(glm::greaterThan(b.low, a.high + reach))) {
      return false;
    }
    const PlaneFrame frame(a.normal, a.middle);
    double shared_m2 = 0.0;
    for (const Loop& mine : polygons_[a.polygon].pieces) {
      const auto subject = flatten(points_, mine, frame);
      for (const Loop& other : polygons_[b.polygon].pieces) {
        shared_m2 += sharedArea_m2(subject, flatten(points_, other, frame));
      }
    }
    return shared_m2 >= overlapShare * std::min(a.area_m2, b.area_m2);
  }

  /// Keeps the first level of the unit that covers it, marks its other sheets and its rims.
  void reduce(const std::vector<std::size_t>& members, std::vector<bool>& needless) const {
    const glm::dvec3 normal =
        sheets_[*std::max_element(members.begin(), members.end(), [&](std::size_t a, std::size_t b) {
          return sheets_[a].area_m2 < sheets_[b].area_m2;
        })].normal;
    std::vector<std::pair<double, std::size_t>> byHeight;
    for (const std::size_t i : members) byHeight.emplace_back(glm::dot(sheets_[i].middle, normal), i);
    std::sort(byHeight.begin(), byHeight.end());

    struct Level {
      double area_m2 = 0.0;
      std::vector<std::size_t> sheets;
    };
    std::vector<Level> levels;
    double last = -1e300;
    for (const auto& [height, i] : byHeight) {
      if (height - last > tolerances_.weld_m) levels.emplace_back();
      levels.back().area_m2 += sheets_[i].area_m2;
      levels.back().sheets.push_back(i);
      last = height;
    }
    const double largest_m2 =
        std::max_element(levels.begin(), levels.end(), [](const Level& a, const Level& b) {
          return a.area_m2 < b.area_m2;
        })->area_m2;
    const auto kept = std::find_if(levels.begin(), levels.end(), [&](const Level& level) {
      return level.area_m2 >= wholeSheetShare * largest_m2;
    });
    for (auto level = levels.begin(); level != levels.end(); ++level) {
      if (level == kept) continue;
      for (const std::size_t i : level->sheets) needless[sheets_[i].polygon] = true;
    }
    markRims(members, normal, byHeight.front().first, byHeight.back().first, needless);
  }

  /// Rims stand on the sheets, between the first and the last of them.
  void markRims(const std::vector<std::size_t>& members, const glm::dvec3& normal, double lowest,
                double highest, std::vector<bool>& needless) const {
    glm::dvec3 low(1e300);
    glm::dvec3 high(-1e300);
    for (const std::size_t i : members) {
      low = glm::min(low, sheets_[i].low - tolerances_.weld_m);
      high = glm::max(high, sheets_[i].high + tolerances_.weld_m);
    }
    for (const Sheet& sheet : sheets_) {
      if (sheet.low.x > high.x) break;
      if (std::abs(glm::dot(sheet.normal, normal)) > 0.1) continue;
      if (glm::any(glm::lessThan(sheet.low, low)) || glm::any(glm::greaterThan(sheet.high, high))) continue;
      const Loop& outer = polygons_[sheet.polygon].polygon.outer;
      needless[sheet.polygon] =
          needless[sheet.polygon] || std::ranges::all_of(outer, [&](std::uint32_t corner) {
            const double height = glm::dot(points_[corner], normal);
            return height >= lowest - tolerances_.weld_m && height <= highest + tolerances_.weld_m;
          });
    }
  }

  std::span<const glm::dvec3> points_;
  const std::vector<DividedPolygon>& polygons_;
  const Tolerances& tolerances_;
  std::vector<Sheet> sheets_;
  std::vector<std::size_t> parent_;
};

}  // namespace

void dropFurtherPaneSheets(std::span<const glm::dvec3> points, std::span<const Material> materials,
                           const Tolerances& tolerances, std::vector<DividedPolygon>& polygons,
                           CleanupCounts& counts) {
  std::map<std::uint32_t, std::vector<Sheet>> sheetsOf;
  for (std::uint32_t i = 0; i < polygons.size(); ++i) {
    const std::uint32_t material = polygons[i].polygon.material;
    if (materials[material].glazing && !polygons[i].pieces.empty()) {
      sheetsOf[material].push_back(describe(points, polygons[i], i));
    }
  }
  std::vector<bool> needless(polygons.size(), false);
  for (auto& [material, sheets] : sheetsOf) {
    PaneUnits(points, polygons, tolerances, std::move(sheets)).markNeedless(needless);
  }
  std::vector<DividedPolygon> kept;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    if (!needless[i]) kept.push_back(std::move(polygons[i]));
  }
  counts.paneSheetsDropped += polygons.size() - kept.size();
  polygons = std::move(kept);
}

}  // namespace clerestory
