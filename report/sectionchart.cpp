// SPDX-License-Identifier: GPL-3.0-or-later
// Draws illuminance along a line through a grid, with the range beside the line.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "escape.hpp"
#include "numbers.hpp"
#include "plan.hpp"

namespace clerestory {
namespace {

/// A lattice seen along one axis: `along` counts into the depth, `across` beside it.
struct Line {
  const SensorLattice& lattice;
  bool alongY;
  std::size_t across = 0;

  [[nodiscard]] std::size_t length() const { return alongY ? lattice.rows : lattice.columns; }
  [[nodiscard]] std::size_t width() const { return alongY ? lattice.columns : lattice.rows; }
  [[nodiscard]] std::size_t at(std::size_t along, std::size_t beside) const {
    return alongY ? lattice.at(beside, along) : lattice.at(along, beside);
  }
};

/// Illuminances of the sensors beside each other at one depth.
std::vector<double> besides_lx(const Line& line, const GridValues& values, std::size_t along) {
  std::vector<double> found;
  for (std::size_t beside = 0; beside < line.width(); ++beside) {
    const std::size_t sensor = line.at(along, beside);
    if (sensor != SensorLattice::none) found.push_back(values.sensors[sensor].illuminance_lx);
  }
  return found;
}

/// How far the means at each depth lie apart.
double variation_lx(const Line& line, const GridValues& values) {
  double low = 1e300;
  double high = 0.0;
  for (std::size_t along = 0; along < line.length(); ++along) {
    const std::vector<double> lx = besides_lx(line, values, along);
    if (lx.empty()) continue;
    const double mean = std::accumulate(lx.begin(), lx.end(), 0.0) / static_cast<double>(lx.size());
    low = std::min(low, mean);
    high = std::max(high, mean);
  }
  return high - low;
}

/// The line with the most sensors, and of these the one nearest to the middle.
std::size_t middleLine(const Line& line) {
  std::size_t best = 0;
  std::size_t most = 0;
  for (std::size_t i = 0; i < line.width(); ++i) {
    const std::size_t half = line.width() / 2;  // from the middle outwards: 0, +1, -1 …
    const std::size_t beside =
        i % 2 == 0 ? half - std::min(half, i / 2) : std::min(half + (i + 1) / 2, line.width() - 1);
    std::size_t sensors = 0;
    for (std::size_t along = 0; along < line.length(); ++along) {
      if (line.at(along, beside) != SensorLattice::none) ++sensors;
    }
    if (sensors > most) {
      most = sensors;
      best = beside;
    }
  }
  return best;
}

struct Frame {
  double left = 64, right = 700, top = 12, bottom = 202;
  double start_m = 0.0, end_m = 1.0;
  const PlanScale& scale;

  [[nodiscard]] double x(double metres) const {
    return left + (right - left) * (metres - start_m) / (end_m - start_m);
  }
  [[nodiscard]] double y(double lx) const { return bottom - (bottom - top) * scale.fraction(lx); }
};

std::string text(double x, double y, const char* style, const std::string& content) {
  return "<text x=\"" + shortNumber(x) + "\" y=\"" + shortNumber(y) + "\" class=\"" + style + "\">" +
         content + "</text>\n";
}

std::string frameSvg(const Frame& frame, bool alongY) {
  std::string svg;
  for (const double tick_lx : frame.scale.ticks_lx) {
    const double y = frame.y(tick_lx);
    svg += "<path class=\"gridline\" d=\"M" + shortNumber(frame.left) + " " + shortNumber(y) + "H" +
           shortNumber(frame.right) + "\"/>";
    const double digit = tick_lx / std::pow(10.0, std::floor(std::log10(tick_lx) + 1e-9));
    const bool isCrowded = frame.scale.ticks_lx.size() > 7 && digit > 1.5;
    if (!isCrowded) {
      svg += text(frame.left - 10, y + 4, "right",
                  tick_lx >= 10.0 ? fixedNumber(tick_lx, 0) : roundedNumber(tick_lx, 1));
    }
  }
  double step_m = 0.5;
  for (const double wider : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0}) {
    if ((frame.end_m - frame.start_m) / step_m > 12.0) step_m = wider;
  }
  for (double at = std::ceil(frame.start_m / step_m) * step_m; at <= frame.end_m; at += step_m) {
    svg += text(frame.x(at), frame.bottom + 20, "tick", fixedNumber(at, step_m < 1.0 ? 1 : 0));
  }
  return svg + text(frame.right, frame.bottom + 38, "right", std::string(alongY ? "y" : "x") + " in m") +
         text(frame.left - 10, frame.bottom + 38, "right", "lx");
}

}  // namespace

std::string sectionChart(const ReportInput& input, std::size_t g, const PlanScale& scale) {
  const SensorGrid& grid = input.building.grids.at(g);
  const GridValues& values = input.solution.grids.at(g);
  const SensorLattice lattice = latticeOf(grid, planOf(input.building, grid).cell_m);
  if (lattice.sensors.empty()) return {};
  Line line{lattice, true};
  Line other{lattice, false};
  if (variation_lx(other, values) > variation_lx(line, values)) line.alongY = false;
  line.across = middleLine(line);

  std::string path;
  std::string upper;
  std::string lower;
  std::vector<std::pair<double, std::size_t>> sensors;
  for (std::size_t along = 0; along < line.length(); ++along) {
    const std::size_t sensor = line.at(along, line.across);
    if (sensor == SensorLattice::none) continue;
    sensors.emplace_back(line.alongY ? grid.points[sensor].y : grid.points[sensor].x, along);
  }
  if (sensors.size() < 3) return {};
  Frame frame{.start_m = sensors.front().first, .end_m = sensors.back().first, .scale = scale};
  for (const auto& [at_m, along] : sensors) {
    const std::vector<double> lx = besides_lx(line, values, along);
    const auto [low, high] = std::minmax_element(lx.begin(), lx.end());
    const std::string x = shortNumber(frame.x(at_m));
    const double here_lx = values.sensors[line.at(along, line.across)].illuminance_lx;
    path += (path.empty() ? "M" : "L") + x + " " + shortNumber(frame.y(here_lx));
    upper += (upper.empty() ? "M" : "L") + x + " " + shortNumber(frame.y(*high));
    lower = "L" + x + " " + shortNumber(frame.y(*low)) + lower;
  }
  const glm::dvec3& some = grid.points[line.at(sensors.front().second, line.across)];
  const std::string place =
      std::string(line.alongY ? "x" : "y") + " = " + fixedNumber(line.alongY ? some.x : some.y, 2) + " m";
  return "<figure><svg class=\"chart\" role=\"img\" viewBox=\"0 0 720 246\" aria-label=\"Illuminance along " +
         place + " on " + escapeHtml(grid.name) + "\">\n" + frameSvg(frame, line.alongY) +
         "<path class=\"band\" d=\"" + upper + lower + "Z\"/><path class=\"line\" d=\"" + path +
         "\"/></svg>\n<figcaption>Section: illuminance along " + place +
         "; the band is the range over all sensors beside it.</figcaption></figure>\n";
}

}  // namespace clerestory
