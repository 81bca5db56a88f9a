// SPDX-License-Identifier: GPL-3.0-or-later
// Upright rays through all that lies over a cell; sideDomain tells which of the heights between are the
// domain's air.
#include "airmap.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

#include <geometry/parallel.hpp>

#include "rooms.hpp"

namespace clerestory {
namespace {

constexpr double cellLeast_m = 0.05;
constexpr double cellsMost = 250000.0;
constexpr double offset = 0.37;  // of a cell: walls lie on round numbers, cells' middles do not
constexpr std::size_t meetingsMost = 1000;
constexpr double upward = 0.95;  // cosine of the steepest floor
constexpr float beneath_m = 0.1F;

/// Pieces that a domain has a side of.
std::vector<std::uint32_t> piecesOf(const Building& building, std::int32_t domain) {
  std::vector<std::uint32_t> pieces;
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
    if (building.sideDomain[side] == domain) pieces.push_back(side / 2);
  }
  return pieces;
}

}  // namespace

AirColumn airColumn(const Building& building, const RayScene& rays, std::int32_t domain,
                    const glm::dvec2& place, double bottom_m) {
  const Pieces& pieces = building.model.pieces;
  AirColumn column;
  glm::vec3 from(glm::dvec3(place, bottom_m) - rays.origin());
  from.z -= beneath_m;
  double last_m = 0.0;
  bool lastIsOurs = false;
  // A floor or a ceiling may run on over a hollow wall: what is seen from between the two decides.
  const auto isAir = [&](bool isOursBelow, bool isOursAbove, double middle_m) {
    if (isOursBelow == isOursAbove) return isOursBelow;
    return isInAir(building, rays, {place, middle_m}, domain);
  };
  for (std::size_t meeting = 0; meeting < meetingsMost; ++meeting) {
    const auto hit = rays.nearest(from, {0, 0, 1}, RayScene::Barrier::opaqueAndGlass);
    if (!hit) break;
    from.z += hit.distance_m + rayOffset_m;
    const glm::dvec3& normal = pieces.normal[hit.piece];
    if (std::abs(normal.z) < 1e-3) continue;  // grazed
    const glm::dvec3& corner = pieces.points[pieces.polygons[hit.piece][0]];
    const double height_m = corner.z - glm::dot(glm::dvec2(normal), place - glm::dvec2(corner)) / normal.z;
    const std::uint32_t below = hit.side();
    const bool belowIsOurs = building.sideDomain[below] == domain;
    if (meeting > 0 && height_m > last_m && isAir(lastIsOurs, belowIsOurs, 0.5 * (last_m + height_m)))
      column.spans.push_back({last_m, height_m});
    if (std::abs(normal.z) > upward) column.treads.push_back({height_m, hit.piece});
    last_m = height_m;
    lastIsOurs = building.sideDomain[below ^ 1U] == domain;
  }
  return column;
}

AirMap::AirMap(const Building& building, const RayScene& rays, std::int32_t domain,
               std::span<const std::uint32_t> sides)
    : frame_(planFrameOf(building.model.pieces.points, building.model.pieces.polygons,
                         piecesOf(building, domain))) {
  const Pieces& pieces = building.model.pieces;
  low_ = glm::dvec2(1e300);
  glm::dvec2 high(-1e300);
  bottom_m_ = 1e300;
  for (const std::uint32_t side : sides) {
    for (const std::uint32_t corner : pieces.polygons[side / 2]) {
      const glm::dvec2 place = frame_.toFrame(glm::dvec2(pieces.points[corner]));
      low_ = glm::min(low_, place);
      high = glm::max(high, place);
      bottom_m_ = std::min(bottom_m_, pieces.points[corner].z);
    }
  }
  const glm::dvec2 size_m = glm::max(high - low_, glm::dvec2(0.0));
  cell_m_ = std::max(cellLeast_m, std::sqrt(size_m.x * size_m.y / cellsMost));
  // Counted from the frame's origin: a side more or less moves no cell.
  low_ = cell_m_ * (glm::floor(low_ / cell_m_ - offset) + offset);
  columns_ = static_cast<std::uint32_t>(std::ceil((high.x - low_.x) / cell_m_)) + 1;
  rows_ = static_cast<std::uint32_t>(std::ceil((high.y - low_.y) / cell_m_)) + 1;
  columnOf_.resize(size());
  forEachIndex(size(), 256, [&](std::size_t cell) {
    columnOf_[cell] =
        airColumn(building, rays, domain, middleOf(static_cast<std::uint32_t>(cell)), bottom_m_);
  });
}

std::uint32_t AirMap::cellAt(const glm::dvec2& place) const {
  const glm::dvec2 cell = glm::floor((frame_.toFrame(place) - low_) / cell_m_);
  if (cell.x < 0.0 || cell.y < 0.0 || cell.x >= columns_ || cell.y >= rows_) return none;
  return static_cast<std::uint32_t>(cell.y) * columns_ + static_cast<std::uint32_t>(cell.x);
}

glm::dvec2 AirMap::middleOf(std::uint32_t cell) const {
  return frame_.toPlan(low_ + cell_m_ * (glm::dvec2(cell % columns_, cell / columns_) + 0.5));
}

std::uint32_t AirMap::neighbour(std::uint32_t cell, int way) const {
  const std::uint32_t x = cell % columns_;
  const std::uint32_t y = cell / columns_;
  if (way == 0) return x + 1 < columns_ ? cell + 1 : none;
  if (way == 1) return y + 1 < rows_ ? cell + columns_ : none;
  if (way == 2) return x > 0 ? cell - 1 : none;
  return y > 0 ? cell - columns_ : none;
}

glm::dvec2 AirMap::edgeTo(std::uint32_t cell, int way) const {
  const glm::dvec2 half = 0.5 * cell_m_ * (way % 2 == 0 ? frame_.along : frame_.across);
  return middleOf(cell) + (way < 2 ? half : -half);
}

}  // namespace clerestory
