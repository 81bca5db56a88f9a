// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts a storey's air at necks the size of a door.
#pragma once

#include <array>

#include "airmap.hpp"

namespace clerestory {

/// What is seen of a storey, by cell of its map.
struct StoreyCells {
  std::vector<bool> high;             ///< has air above the doors
  std::vector<bool> any;              ///< has air
  std::vector<std::int32_t> surface;  ///< of its floor; -1 where none is met
  using ByWay = std::array<std::vector<bool>, 2>;
  ByWay isClosed;       ///< something stands between it and its neighbour east, north
  ByWay isClosedAbove;  ///< likewise above the doors, if both are high: a lintel

  /// The neighbour that nothing keeps a cell from, as AirMap::neighbour has them.
  [[nodiscard]] std::uint32_t neighbour(const AirMap& map, std::uint32_t cell, int way) const {
    return neighbourBut(isClosed, map, cell, way);
  }
  /// The neighbour above the doors of a high cell.
  [[nodiscard]] std::uint32_t neighbourAbove(const AirMap& map, std::uint32_t cell, int way) const {
    const std::uint32_t next = neighbourBut(isClosedAbove, map, cell, way);
    return next == AirMap::none || !high[next] ? AirMap::none : next;
  }

 private:
  static std::uint32_t neighbourBut(const ByWay& closed, const AirMap& map, std::uint32_t cell, int way) {
    const std::uint32_t next = map.neighbour(cell, way);
    if (next == AirMap::none) return next;
    return closed[static_cast<std::size_t>(way % 2)][way < 2 ? cell : next] ? AirMap::none : next;
  }
};

/// Where two regions meet.
struct Opening {
  std::array<std::int32_t, 2> regions;
  glm::dvec2 from_m, to_m;           ///< its ends in plan, to a cell
  bool alongFloors;                  ///< only the floors' surfaces tell the two apart
  std::vector<std::uint32_t> cells;  ///< at its edge
  std::vector<glm::dvec2> bends_m;   ///< on the way between its ends, to a cell; of one along floors
};

struct Parted {
  std::vector<std::int32_t> region;  ///< #cells; -1 where there is no air, or too little
  std::vector<double> toWall_m;      ///< #cells: in air above the doors
  std::int32_t count = 0;
  std::vector<Opening> openings;
};

/// A region holds a circle of 0.8 m and 1 m² at least. Regions part where
/// * the air under a lintel is 1.6 m wide at most: a doorway,
/// * the air above the doors is 1.6 m wide at most, and less than 0.7 times as wide as on both sides,
/// * floors of two surfaces meet along 2 m at most, and along a third of either region's outline.
Parted partAtNecks(const AirMap& map, const StoreyCells& cells);

/// Cells without a region take that of the nearest cell that has one, walls or not.
std::vector<std::int32_t> nearestRegion(const AirMap& map, std::vector<std::int32_t> region);

}  // namespace clerestory
