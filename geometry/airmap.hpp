// SPDX-License-Identifier: GPL-3.0-or-later
// The air of one domain in plan: a raster of columns, each with its free heights.
#pragma once

#include <glm/vec2.hpp>

#include <span>

#include <geometry/building.hpp>
#include <geometry/rays.hpp>

#include "stacks.hpp"

namespace clerestory {

/// Air of the domain over one cell of the plan.
struct AirSpan {
  double low_m, high_m;
};

/// An upward face below or in a column.
struct Tread {
  double height_m;
  std::uint32_t piece;
};

/// What stands over a place of the plan, from below.
struct AirColumn {
  std::vector<AirSpan> spans;
  std::vector<Tread> treads;
};

/// The column of a domain's air over a place, looked for from `bottom_m` upwards.
AirColumn airColumn(const Building& building, const RayScene& rays, std::int32_t domain,
                    const glm::dvec2& place, double bottom_m);

/// Square cells in the domain's frame, so that a model has the same cells however it is turned or mirrored.
/// Row by row.
class AirMap {
 public:
  static constexpr std::uint32_t none = 0xffffffffU;

  /// Covers what lies over or under the domain's `sides`.
  AirMap(const Building& building, const RayScene& rays, std::int32_t domain,
         std::span<const std::uint32_t> sides);

  [[nodiscard]] double cell_m() const { return raster_.cell_m; }
  [[nodiscard]] std::uint32_t columns() const { return raster_.columns; }
  [[nodiscard]] std::uint32_t rows() const { return raster_.rows; }
  [[nodiscard]] std::uint32_t size() const { return raster_.size(); }
  [[nodiscard]] std::uint32_t cellAt(const glm::dvec2& place) const;  ///< none outside the raster
  [[nodiscard]] glm::dvec2 middleOf(std::uint32_t cell) const { return raster_.middleOf(cell); }
  /// The neighbour east (0), north (1), west (2) or south (3) of a cell in the frame; none at the rim.
  [[nodiscard]] std::uint32_t neighbour(std::uint32_t cell, int way) const;
  /// The middle of the edge to that neighbour.
  [[nodiscard]] glm::dvec2 edgeTo(std::uint32_t cell, int way) const;

  [[nodiscard]] const AirColumn& column(std::uint32_t cell) const { return columnOf_[cell]; }
  [[nodiscard]] const std::vector<AirSpan>& spans(std::uint32_t cell) const { return column(cell).spans; }
  [[nodiscard]] const std::vector<Tread>& treads(std::uint32_t cell) const { return column(cell).treads; }
  /// False where nothing stands between a cell's places at any height, but level pieces.
  [[nodiscard]] bool mayStop(std::uint32_t cell) const { return mayStop_[cell] != 0; }
  [[nodiscard]] const PlanFrame& frame() const { return raster_.frame; }
  [[nodiscard]] double bottom_m() const { return bottom_m_; }

 private:
  PlanRaster raster_;
  double bottom_m_ = 0.0;
  std::vector<AirColumn> columnOf_;    // #cells
  std::vector<std::uint8_t> mayStop_;  // #cells
};

}  // namespace clerestory
