// SPDX-License-Identifier: GPL-3.0-or-later
// What pieces share that lie over each other in one plane.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <geometry/building.hpp>

#include "parts.hpp"

namespace clerestory {

/// Pieces cut at each other's outlines, so that those over each other have all corners in common.
class Overlaps {
 public:
  /// Looks `among` some pieces for two that share `least_m2` at the least and `count`.
  Overlaps(const Pieces& pieces, std::span<const std::uint32_t> among, double least_m2,
           const std::function<bool(std::uint32_t, std::uint32_t)>& count);

  /// The parts of a piece; itself where it is whole.
  [[nodiscard]] std::vector<Polygon> partsOf(std::uint32_t piece, const Polygon& whole) const;

 private:
  /// A part of one or several pieces.
  struct Cell {
    Polygon polygon;  ///< counterclockwise as seen from the front of the first
    std::vector<std::uint32_t> pieces;
  };

  [[nodiscard]] bool areInOnePlane(std::uint32_t a, std::uint32_t b) const;
  void cut(std::uint32_t a, std::uint32_t b);
  void makeCell(std::uint32_t piece);
  /// What two cells share becomes one, what is left of each stays with its pieces.
  void cutCells(std::size_t first, std::size_t second);
  void add(Cell cell);

  const Pieces& pieces_;
  double least_m2_;
  std::vector<Cell> cells_;
  std::vector<std::vector<std::size_t>> cellsOf_;  // #pieces; none of a whole one
};

/// Cuts a building's pieces so, and numbers what it knows by piece anew.
void cutOverlaps(Building& building, const Overlaps& overlaps);

/// Opaque pieces over each other, with all corners in common: two or more each.
std::vector<std::vector<std::uint32_t>> layersOf(const CleanModel& model);

/// Unit normal of the side that a piece is drawn for.
glm::dvec3 drawnNormal(const Pieces& pieces, std::uint32_t piece);

/// Moves a piece off its plane; its corners become points of its own.
void move(Pieces& pieces, std::uint32_t piece, const glm::dvec3& way_m);

/// Takes a side out of its domain and room.
void darken(Building& building, std::uint32_t side);

}  // namespace clerestory
