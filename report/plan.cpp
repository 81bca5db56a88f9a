// SPDX-License-Identifier: GPL-3.0-or-later
// What a plan shows: its scale of colours, the outline of the floor, windows and the squares of sensors.
#include "plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace clerestory {
namespace {

constexpr double margin_m = 0.4;
constexpr double largestRatio = 500.0;  // of the scale's ends: below it, dark is simply dark

/// 1, 2 or 5 times a power of ten, at or below `value`.
double stepBelow(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value) + 1e-12));
  for (const double step : {5.0, 2.0}) {
    if (value >= step * decade * (1.0 - 1e-9)) return step * decade;
  }
  return decade;
}

double stepAfter(double step) {
  const double decade = std::pow(10.0, std::floor(std::log10(step) + 1e-9));
  const double digit = std::round(step / decade);
  return digit < 1.5 ? 2.0 * decade : digit < 3.5 ? 5.0 * decade : 10.0 * decade;
}

glm::dvec2 inPlan(const glm::dvec3& point) {
  return {point.x, point.y};
}

/// Half of the sensors have their nearest neighbour within this distance; the grid's own spacing if none has
/// one.
double usualSpacing_m(const SensorGrid& grid) {
  std::vector<glm::dvec2> points;
  for (const glm::dvec3& point : grid.points) points.push_back(inPlan(point));
  std::sort(points.begin(), points.end(),
            [](const glm::dvec2& a, const glm::dvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<double> nearest;
  for (std::size_t i = 0; i < points.size(); ++i) {
    double best = std::numeric_limits<double>::infinity();
    const auto look = [&](const glm::dvec2& other) {
      const double distance = std::hypot(other.x - points[i].x, other.y - points[i].y);
      if (distance > 1e-3) best = std::min(best, distance);  // points above each other are one in plan
      return std::abs(other.x - points[i].x) < best;
    };
    for (std::size_t j = i + 1; j < points.size() && look(points[j]);) ++j;
    for (std::size_t j = i; j > 0 && look(points[j - 1]);) --j;
    if (std::isfinite(best)) nearest.push_back(best);
  }
  if (nearest.empty()) return grid.spacing_m > 0.0 ? grid.spacing_m : 0.25;
  const auto middle = nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2);
  std::nth_element(nearest.begin(), middle, nearest.end());
  return *middle;
}

/// The two points of a polygon that are farthest apart in plan.
std::vector<glm::dvec2> longestLine(const std::vector<glm::dvec2>& polygon) {
  std::vector<glm::dvec2> line = {polygon.front(), polygon.front()};
  double longest = 0.0;
  for (const glm::dvec2& a : polygon) {
    for (const glm::dvec2& b : polygon) {
      const double length = std::hypot(a.x - b.x, a.y - b.y);
      if (length > longest) {
        longest = length;
        line = {a, b};
      }
    }
  }
  return line;
}

std::vector<glm::dvec2> pieceInPlan(const Pieces& pieces, std::size_t piece) {
  std::vector<glm::dvec2> polygon;
  for (const std::uint32_t corner : pieces.polygons[piece]) polygon.push_back(inPlan(pieces.points[corner]));
  return polygon;
}

/// The windows of a room's air that are near its storey and its plan.
std::vector<PlanWindow> windowsOf(const Building& building, std::int32_t roomIndex, const Plan& plan) {
  constexpr double storey_m = 3.5;
  const Room& room = building.rooms[static_cast<std::size_t>(roomIndex)];
  const Pieces& pieces = building.model.pieces;
  std::vector<PlanWindow> windows;
  for (const Portal& portal : building.portals) {
    if (portal.room != roomIndex) continue;
    double top = -std::numeric_limits<double>::infinity();
    double bottom = -top;
    for (const std::uint32_t corner : pieces.polygons[portal.piece]) {
      top = std::max(top, pieces.points[corner].z);
      bottom = std::min(bottom, pieces.points[corner].z);
    }
    const bool isVertical = std::abs(pieces.normal[portal.piece].z) < 0.7;
    if (top < room.floor_m || (isVertical && bottom > room.floor_m + storey_m)) continue;
    std::vector<glm::dvec2> polygon = pieceInPlan(pieces, portal.piece);
    const bool isInside = std::all_of(polygon.begin(), polygon.end(), [&](const glm::dvec2& p) {
      return p.x >= plan.low_m.x && p.y >= plan.low_m.y && p.x <= plan.high_m.x && p.y <= plan.high_m.y;
    });
    if (!isInside) continue;
    if (isVertical) {
      polygon = longestLine(polygon);
    } else {
      polygon.push_back(polygon.front());
    }
    windows.push_back({std::move(polygon)});
  }
  return windows;
}

}  // namespace

double PlanScale::fraction(double lx) const {
  if (!(lx > low_lx)) return 0.0;
  return std::min(1.0, std::log(lx / low_lx) / std::log(high_lx / low_lx));
}

PlanScale planScale(const Solution& solution) {
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (const GridValues& grid : solution.grids) {
    for (const SensorValue& sensor : grid.sensors) {
      if (!std::isfinite(sensor.illuminance_lx) || sensor.illuminance_lx <= 0.0) continue;
      least = std::min(least, sensor.illuminance_lx);
      most = std::max(most, sensor.illuminance_lx);
    }
  }
  PlanScale scale;
  if (most > 0.0) {
    scale.low_lx = stepBelow(std::max(least, most / largestRatio));
    scale.high_lx = stepAfter(scale.low_lx);
    while (scale.high_lx < most) scale.high_lx = stepAfter(scale.high_lx);
  }
  for (double tick = scale.low_lx; tick < scale.high_lx * 1.01; tick = stepAfter(tick))
    scale.ticks_lx.push_back(tick);
  return scale;
}

Plan planOf(const Building& building, const SensorGrid& grid) {
  Plan plan;
  plan.cell_m = usualSpacing_m(grid);
  plan.low_m = glm::dvec2(std::numeric_limits<double>::infinity());
  plan.high_m = -plan.low_m;
  const auto include = [&](const glm::dvec2& point, double around) {
    plan.low_m = {std::min(plan.low_m.x, point.x - around), std::min(plan.low_m.y, point.y - around)};
    plan.high_m = {std::max(plan.high_m.x, point.x + around), std::max(plan.high_m.y, point.y + around)};
  };
  for (const glm::dvec3& point : grid.points) include(inPlan(point), 0.5 * plan.cell_m);

  const bool inRoom = grid.room >= 0 && static_cast<std::size_t>(grid.room) < building.rooms.size();
  if (inRoom) {
    for (const std::uint32_t piece : building.rooms[static_cast<std::size_t>(grid.room)].floorPieces) {
      plan.floor_m.push_back(pieceInPlan(building.model.pieces, piece));
      for (const glm::dvec2& point : plan.floor_m.back()) include(point, 0.0);
    }
  }
  if (!(plan.low_m.x <= plan.high_m.x)) plan.low_m = plan.high_m = glm::dvec2(0.0);  // nothing to show
  plan.low_m -= glm::dvec2(margin_m);
  plan.high_m += glm::dvec2(margin_m);
  if (inRoom) plan.windows = windowsOf(building, grid.room, plan);
  return plan;
}

std::vector<std::size_t> labelledSensors(const SensorGrid& grid, const Plan& plan, double pixelsPerMetre) {
  constexpr double labelWidth_px = 46.0;
  constexpr double labelHeight_px = 40.0;
  const double cell_px = plan.cell_m * pixelsPerMetre;
  const auto everyX = static_cast<long long>(std::ceil(labelWidth_px / cell_px));
  const auto everyY = static_cast<long long>(std::ceil(labelHeight_px / cell_px));
  double lowX = std::numeric_limits<double>::infinity();
  double lowY = lowX;
  for (const glm::dvec3& point : grid.points) {
    lowX = std::min(lowX, point.x);
    lowY = std::min(lowY, point.y);
  }
  std::vector<std::size_t> labelled;
  for (std::size_t s = 0; s < grid.points.size(); ++s) {
    const long long column = std::llround((grid.points[s].x - lowX) / plan.cell_m);
    const long long row = std::llround((grid.points[s].y - lowY) / plan.cell_m);
    if (column % everyX == everyX / 2 && row % everyY == everyY / 2) labelled.push_back(s);
  }
  return labelled;
}

}  // namespace clerestory
