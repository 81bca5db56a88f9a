// SPDX-License-Identifier: GPL-3.0-or-later
// What an upright line meets of all that lies over a place; sideDomain tells which of the heights between are
// the domain's air.
#include "airmap.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include <geometry/parallel.hpp>

#include "rooms.hpp"

namespace clerestory {
namespace {

constexpr double cellLeast_m = 0.05;
constexpr double cellsMost = 250000.0;
constexpr double offset = 0.37;  // of a cell: walls lie on round numbers, cells' middles do not
constexpr std::size_t meetingsMost = 1000;
constexpr double upward = 0.95;  // cosine of the steepest floor
constexpr double beneath_m = 0.1;
constexpr std::uint32_t rowsOfTask = 32;  // so the stacks of a tower's plan need little memory

/// Pieces that a domain has a side of.
std::vector<std::uint32_t> piecesOf(const Building& building, std::int32_t domain) {
  std::vector<std::uint32_t> pieces;
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
    if (building.sideDomain[side] == domain) pieces.push_back(side / 2);
  }
  return pieces;
}

/// Whether air is a domain's of which neither the surface below nor the one above is.
enum class BetweenOthers { isNot, isAsked };

/// A domain's air among what an upright line meets, from below. What touches is one surface.
AirColumn columnOf(const Building& building, const RayScene& rays, std::int32_t domain,
                   const glm::dvec2& place, std::span<const Meeting> meetings, BetweenOthers between) {
  constexpr double touching_m = 1e-4;
  constexpr double nearSurface_m = 0.1;
  // A floor or a ceiling may run on over a hollow wall: what is seen from between the two decides or, since
  // hardly anything is from between bookcases, from near the one that is ours.
  const auto isAir = [&](bool isOursBelow, bool isOursAbove, double low_m, double high_m) {
    if (isOursBelow && isOursAbove) return true;
    if (!isOursBelow && !isOursAbove && between == BetweenOthers::isNot) return false;
    const double middle_m = 0.5 * (low_m + high_m);
    const double near_m = isOursBelow ? low_m + nearSurface_m : high_m - nearSurface_m;
    const bool hasNear = high_m - low_m > 2.0 * nearSurface_m;
    return isInAir(building, rays, {place, middle_m}, domain) ||
           (hasNear && isInAir(building, rays, {place, near_m}, domain));
  };
  AirColumn column;
  double last_m = 0.0;
  bool lastIsOurs = false;
  for (std::size_t i = 0; i < meetings.size();) {
    const double height_m = meetings[i].height_m;
    const bool isFirst = i == 0;
    bool lowerIsOurs = false;
    bool upperIsOurs = false;
    std::optional<Tread> tread;
    for (; i < meetings.size() && meetings[i].height_m < height_m + touching_m; ++i) {
      const std::uint32_t piece = meetings[i].piece;
      const double slope = building.model.pieces.normal[piece].z;
      const std::uint32_t lower = 2 * piece + (slope < 0.0 ? 0U : 1U);
      const bool isUnderOurs = building.sideDomain[lower ^ 1U] == domain;
      lowerIsOurs = lowerIsOurs || building.sideDomain[lower] == domain;
      if (std::abs(slope) > upward && (!tread || (isUnderOurs && !upperIsOurs))) tread = {height_m, piece};
      upperIsOurs = upperIsOurs || isUnderOurs;
    }
    if (!isFirst && isAir(lastIsOurs, lowerIsOurs, last_m, height_m))
      column.spans.push_back({last_m, height_m});
    if (tread) column.treads.push_back(*tread);
    last_m = height_m;
    lastIsOurs = upperIsOurs;
  }
  return column;
}

}  // namespace

AirColumn airColumn(const Building& building, const RayScene& rays, std::int32_t domain,
                    const glm::dvec2& place, double bottom_m) {
  const Pieces& pieces = building.model.pieces;
  std::vector<Meeting> meetings;
  glm::vec3 from(glm::dvec3(place, bottom_m - beneath_m) - rays.origin());
  for (std::size_t i = 0; i < meetingsMost; ++i) {
    const auto hit = rays.nearest(from, {0, 0, 1}, RayScene::Barrier::opaqueAndGlass);
    if (!hit) break;
    from.z += hit.distance_m + rayOffset_m;
    if (!isUpright(pieces, hit.piece)) meetings.push_back({heightOver(pieces, hit.piece, place), hit.piece});
  }
  return columnOf(building, rays, domain, place, meetings, BetweenOthers::isAsked);
}

AirMap::AirMap(const Building& building, const RayScene& rays, std::int32_t domain,
               std::span<const std::uint32_t> sides) {
  const Pieces& pieces = building.model.pieces;
  const PlanFrame& frame = raster_.frame =
      planFrameOf(pieces.points, pieces.polygons, piecesOf(building, domain));
  glm::dvec2 low(1e300);
  glm::dvec2 high(-1e300);
  bottom_m_ = 1e300;
  for (const std::uint32_t side : sides) {
    for (const std::uint32_t corner : pieces.polygons[side / 2]) {
      const glm::dvec2 place = frame.toFrame(glm::dvec2(pieces.points[corner]));
      low = glm::min(low, place);
      high = glm::max(high, place);
      bottom_m_ = std::min(bottom_m_, pieces.points[corner].z);
    }
  }
  const glm::dvec2 size_m = glm::max(high - low, glm::dvec2(0.0));
  const double cell_m = raster_.cell_m = std::max(cellLeast_m, std::sqrt(size_m.x * size_m.y / cellsMost));
  // Counted from the frame's origin: a side more or less moves no cell.
  raster_.low = cell_m * (glm::floor(low / cell_m - offset) + offset);
  raster_.columns = static_cast<std::uint32_t>(std::ceil((high.x - raster_.low.x) / cell_m)) + 1;
  raster_.rows = static_cast<std::uint32_t>(std::ceil((high.y - raster_.low.y) / cell_m)) + 1;
  columnOf_.resize(size());
  mayStop_.resize(size());
  forEachIndex((raster_.rows + rowsOfTask - 1) / rowsOfTask, 1, [&](std::size_t task) {
    const auto firstRow = static_cast<std::uint32_t>(task) * rowsOfTask;
    PlanRaster strip = raster_;
    strip.low.y += cell_m * firstRow;
    strip.rows = std::min(rowsOfTask, raster_.rows - firstRow);
    const Stacks stacks(pieces, strip);
    for (std::uint32_t i = 0; i < strip.size(); ++i) {
      const std::uint32_t cell = firstRow * raster_.columns + i;
      const std::span<const Meeting> all = stacks.over(i);
      const auto first = std::ranges::find_if(
          all, [&](const Meeting& meeting) { return meeting.height_m >= bottom_m_ - beneath_m; });
      columnOf_[cell] =
          columnOf(building, rays, domain, middleOf(cell), {first, all.end()}, BetweenOthers::isNot);
      mayStop_[cell] = stacks.mayStop(i);
    }
  });
}

std::uint32_t AirMap::cellAt(const glm::dvec2& place) const {
  const glm::dvec2 cell = glm::floor((raster_.frame.toFrame(place) - raster_.low) / raster_.cell_m);
  if (cell.x < 0.0 || cell.y < 0.0 || cell.x >= raster_.columns || cell.y >= raster_.rows) return none;
  return static_cast<std::uint32_t>(cell.y) * raster_.columns + static_cast<std::uint32_t>(cell.x);
}

std::uint32_t AirMap::neighbour(std::uint32_t cell, int way) const {
  const std::uint32_t x = cell % raster_.columns;
  const std::uint32_t y = cell / raster_.columns;
  if (way == 0) return x + 1 < raster_.columns ? cell + 1 : none;
  if (way == 1) return y + 1 < raster_.rows ? cell + raster_.columns : none;
  if (way == 2) return x > 0 ? cell - 1 : none;
  return y > 0 ? cell - raster_.columns : none;
}

glm::dvec2 AirMap::edgeTo(std::uint32_t cell, int way) const {
  const glm::dvec2 half = 0.5 * raster_.cell_m * (way % 2 == 0 ? raster_.frame.along : raster_.frame.across);
  return middleOf(cell) + (way < 2 ? half : -half);
}

}  // namespace clerestory
