// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of equal illuminance between the sensors of a grid.
#include <algorithm>
#include <cmath>
#include <limits>

#include "plan.hpp"

namespace clerestory {

SensorLattice latticeOf(const SensorGrid& grid, double cell_m) {
  constexpr double mostOff = 0.02;       // of a cell
  constexpr double mostPlaces = 16.0e6;  // a scattered points file is no lattice
  double lowX = std::numeric_limits<double>::infinity();
  double lowY = lowX;
  double highX = -lowX;
  double highY = -lowX;
  for (const glm::dvec3& point : grid.points) {
    lowX = std::min(lowX, point.x);
    lowY = std::min(lowY, point.y);
    highX = std::max(highX, point.x);
    highY = std::max(highY, point.y);
  }
  const double columns = std::round((highX - lowX) / cell_m) + 1.0;
  const double rows = std::round((highY - lowY) / cell_m) + 1.0;
  if (grid.points.empty() || !(columns * rows <= mostPlaces)) return {};
  SensorLattice lattice{static_cast<std::size_t>(columns), static_cast<std::size_t>(rows), {}};
  lattice.sensors.assign(lattice.columns * lattice.rows, SensorLattice::none);
  for (std::size_t s = 0; s < grid.points.size(); ++s) {
    const double x = (grid.points[s].x - lowX) / cell_m;
    const double y = (grid.points[s].y - lowY) / cell_m;
    if (std::abs(x - std::round(x)) > mostOff || std::abs(y - std::round(y)) > mostOff) return {};
    lattice.sensors[static_cast<std::size_t>(std::lround(y)) * lattice.columns +
                    static_cast<std::size_t>(std::lround(x))] = s;
  }
  return lattice;
}

std::vector<IsoluxSegment> isoluxLine(const SensorGrid& grid, const SensorLattice& lattice,
                                      const GridValues& values, double level_lx) {
  const auto height = [&](std::size_t sensor) {
    return std::log(std::max(values.sensors[sensor].illuminance_lx, 1e-6) / level_lx);
  };
  std::vector<IsoluxSegment> segments;
  for (std::size_t row = 0; row + 1 < lattice.rows; ++row) {
    for (std::size_t column = 0; column + 1 < lattice.columns; ++column) {
      const std::size_t around[4] = {lattice.at(column, row), lattice.at(column + 1, row),
                                     lattice.at(column + 1, row + 1), lattice.at(column, row + 1)};
      if (std::find(around, around + 4, SensorLattice::none) != around + 4) continue;
      std::vector<glm::dvec2> crossings;  // in the order of the square's sides
      for (std::size_t side = 0; side < 4; ++side) {
        const std::size_t a = around[side];
        const std::size_t b = around[(side + 1) % 4];
        const double from = height(a);
        const double to = height(b);
        if ((from < 0.0) == (to < 0.0)) continue;
        const glm::dvec2 start(grid.points[a].x, grid.points[a].y);
        const glm::dvec2 end(grid.points[b].x, grid.points[b].y);
        crossings.push_back(start + from / (from - to) * (end - start));
      }
      if (crossings.size() == 2) segments.push_back({crossings[0], crossings[1]});
      if (crossings.size() != 4) continue;
      // A saddle: the mean of the corners tells which of them hang together.
      const double mean = height(around[0]) + height(around[1]) + height(around[2]) + height(around[3]);
      const std::size_t first = (mean < 0.0) == (height(around[0]) < 0.0) ? 0 : 3;
      segments.push_back({crossings[first], crossings[(first + 1) % 4]});
      segments.push_back({crossings[(first + 2) % 4], crossings[(first + 3) % 4]});
    }
  }
  return segments;
}

}  // namespace clerestory
