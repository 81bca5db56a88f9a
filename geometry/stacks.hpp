// SPDX-License-Identifier: GPL-3.0-or-later
// What stands over each cell of a raster in plan, by scan conversion of a model's pieces.
#pragma once

#include <glm/vec2.hpp>

#include <cstdint>
#include <span>
#include <vector>

#include <geometry/building.hpp>

#include "planframe.hpp"

namespace clerestory {

/// Square cells in a frame, row by row.
struct PlanRaster {
  PlanFrame frame;
  glm::dvec2 low{0.0};  ///< corner of the first cell, in the frame
  double cell_m = 1.0;
  std::uint32_t columns = 0, rows = 0;

  [[nodiscard]] std::uint32_t size() const { return columns * rows; }
  [[nodiscard]] glm::dvec2 middleOf(std::uint32_t cell) const {
    return frame.toPlan(low + cell_m * (glm::dvec2(cell % columns, cell / columns) + 0.5));
  }
};

/// Where an upright line meets a piece.
struct Meeting {
  double height_m;
  std::uint32_t piece;
};

/// Whether a piece stands so upright that no upright line counts as meeting it.
bool isUpright(const Pieces& pieces, std::uint32_t piece);

/// Height of a piece's plane over a place of the plan; the piece is not upright. [m]
double heightOver(const Pieces& pieces, std::uint32_t piece, const glm::dvec2& place);

/// The pieces over and under the middles of a raster's cells.
class Stacks {
 public:
  Stacks(const Pieces& pieces, const PlanRaster& raster);

  /// From the lowest up, of equals that of the lower number first; upright pieces are left out.
  [[nodiscard]] std::span<const Meeting> over(std::uint32_t cell) const {
    return std::span(meetings_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
  }
  /// False where a level line within the cell can meet no piece: all that reach into it are level.
  [[nodiscard]] bool mayStop(std::uint32_t cell) const { return mayStop_[cell]; }

 private:
  std::vector<std::uint32_t> first_;  // #cells + 1
  std::vector<Meeting> meetings_;
  std::vector<bool> mayStop_;  // #cells
};

}  // namespace clerestory
