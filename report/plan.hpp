// SPDX-License-Identifier: GPL-3.0-or-later
// False-colour plans of sensor grids: as SVG for the page, as PNG for everything else.
#pragma once

#include <glm/vec2.hpp>

#include <string>
#include <vector>

#include <report/report.hpp>

#include "image.hpp"

namespace clerestory {

/// One logarithmic scale over all grids of a study, so that its plans can be compared.
struct PlanScale {
  double low_lx = 1.0, high_lx = 10.0;
  std::vector<double> ticks_lx;  ///< 1, 2, 5, 10 … from low to high

  [[nodiscard]] double fraction(double lx) const;  ///< [0, 1] along the scale
};
PlanScale planScale(const Solution& solution);

/// A window as it is drawn in plan: one line for a vertical pane, an outline for a roof light.
struct PlanWindow {
  std::vector<glm::dvec2> points_m;
};

/// What plans of a grid show, in metres.
struct Plan {
  glm::dvec2 low_m{0.0}, high_m{0.0};  ///< with a margin
  double cell_m = 0.25;                ///< width of a sensor's square
  std::vector<std::vector<glm::dvec2>> floor_m;
  std::vector<PlanWindow> windows;
};
Plan planOf(const Building& building, const SensorGrid& grid);

/// Sensors by column (to the right) and row (upwards) of their square lattice.
struct SensorLattice {
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  std::size_t columns = 0, rows = 0;
  std::vector<std::size_t> sensors;  ///< #columns × rows, none where there is no sensor

  [[nodiscard]] std::size_t at(std::size_t column, std::size_t row) const {
    return sensors[row * columns + column];
  }
};
/// Empty where the sensors lie on no lattice of `cell_m`, as those of a points file may.
SensorLattice latticeOf(const SensorGrid& grid, double cell_m);

/// A piece of a line of equal illuminance in plan.
struct IsoluxSegment {
  glm::dvec2 from_m, to_m;
};
/// Marching squares between the sensors of a lattice, bilinear in the logarithm of lux.
std::vector<IsoluxSegment> isoluxLine(const SensorGrid& grid, const SensorLattice& lattice,
                                      const GridValues& values, double level_lx);

/// A chart of illuminance along the line through the grid on which it varies most: with daylight from one
/// side, into the depth of the room. Empty where the sensors lie on no lattice.
std::string sectionChart(const ReportInput& input, std::size_t grid, const PlanScale& scale);

/// The numbers that stand on a plan: few enough to be read.
std::vector<std::size_t> labelledSensors(const SensorGrid& grid, const Plan& plan, double pixelsPerMetre);

/// The plan for the page, with a legend; every sensor tells its value when pointed at.
std::string planSvg(const ReportInput& input, std::size_t grid, const PlanScale& scale);

/// The plan as a picture with a legend.
DisplayImage planPicture(const ReportInput& input, std::size_t grid, const PlanScale& scale);

}  // namespace clerestory
