// SPDX-License-Identifier: GPL-3.0-or-later
// Draws a grid's plan as SVG, to stand in the page and take its colours for light and dark.
#include <algorithm>
#include <cmath>

#include "escape.hpp"
#include "metrics.hpp"
#include "numbers.hpp"
#include "plan.hpp"

namespace clerestory {
namespace {

constexpr double largestWidth_px = 760.0;
constexpr double largestHeight_px = 560.0;
constexpr double largestScale = 130.0;  // pixels a metre
constexpr double legendHeight_px = 74.0;
constexpr double leastWidth_px = 600.0;  // for the legend

/// Where metres lie in the drawing.
struct Sheet {
  const Plan& plan;
  double scale;          ///< pixels a metre
  double width, height;  ///< of the plan, without the legend

  [[nodiscard]] double x(double metres) const { return (metres - plan.low_m.x) * scale; }
  [[nodiscard]] double y(double metres) const { return (plan.high_m.y - metres) * scale; }
};

Sheet sheetOf(const Plan& plan) {
  const double width_m = plan.high_m.x - plan.low_m.x;
  const double height_m = plan.high_m.y - plan.low_m.y;
  const double scale = std::min({largestWidth_px / width_m, largestHeight_px / height_m, largestScale});
  const double width = std::max(leastWidth_px, width_m * scale);
  return {plan, scale, width, height_m * scale};
}

std::string attribute(const char* name, double value) {
  return std::string(" ") + name + "=\"" + shortNumber(value) + '"';
}

/// 0.05, 0.5, 20 or 10 000: no more decimals than the number has.
std::string tickText(double value) {
  return value >= 10.0 ? fixedNumber(value, 0) : roundedNumber(value, 1);
}

std::string textAt(double x, double y, const char* style, const std::string& text) {
  return "<text" + attribute("x", x) + attribute("y", y) + " class=\"" + style + "\">" + text + "</text>\n";
}

std::string pathOf(const Sheet& sheet, const std::vector<glm::dvec2>& points, bool closed) {
  std::string path;
  for (const glm::dvec2& point : points) {
    path += (path.empty() ? "M" : "L") + shortNumber(sheet.x(point.x)) + " " + shortNumber(sheet.y(point.y));
  }
  return closed ? path + "Z" : path;
}

/// The walls are the floor's pieces drawn broadly and then again without an edge: only their outline remains.
std::string floorSvg(const Sheet& sheet) {
  std::string path;
  for (const auto& piece : sheet.plan.floor_m) path += pathOf(sheet, piece, true);
  if (path.empty()) return {};
  const double wall = std::clamp(0.24 * sheet.scale, 4.0, 20.0);
  std::string svg = "<path class=\"wall\"" + attribute("stroke-width", wall) + " d=\"" + path + "\"/>\n";
  svg += "<path class=\"floor\" d=\"" + path + "\"/>\n";
  return svg;
}

std::string windowsSvg(const Sheet& sheet) {
  std::string path;
  for (const PlanWindow& window : sheet.plan.windows) path += pathOf(sheet, window.points_m, false);
  return path.empty() ? "" : "<path class=\"window\" d=\"" + path + "\"><title>Glazing</title></path>\n";
}

std::string sensorTitle(const ReportInput& input, const glm::dvec3& point, const SensorValue& value) {
  std::string title = illuminanceText(value.illuminance_lx) + " lx";
  if (const auto factor = daylightFactor_pct(input.study.sky, value)) {
    title += " · daylight factor " + factorText(*factor) + " %";
  }
  return title + " · ± " + roundedNumber(value.error_lx, 2) + " lx · x " + fixedNumber(point.x, 2) + ", y " +
         fixedNumber(point.y, 2) + ", z " + fixedNumber(point.z, 2) + " m";
}

/// Lines of equal illuminance at the legend's numbers, light on dark so that they show on every colour.
std::string isoluxSvg(const SensorGrid& grid, const GridValues& values, const Sheet& sheet,
                      const PlanScale& scale) {
  const SensorLattice lattice = latticeOf(grid, sheet.plan.cell_m);
  std::string svg;
  for (const double level_lx : scale.ticks_lx) {
    std::string path;
    for (const IsoluxSegment& segment : isoluxLine(grid, lattice, values, level_lx)) {
      path += pathOf(sheet, {segment.from_m, segment.to_m}, false);
    }
    if (path.empty()) continue;
    svg += "<path class=\"under\" d=\"" + path + "\"/><path d=\"" + path + "\"><title>" + tickText(level_lx) +
           " lx</title></path>\n";
  }
  return svg.empty() ? svg : "<g class=\"isolux\">\n" + svg + "</g>\n";
}

std::string sensorsSvg(const ReportInput& input, std::size_t g, const Sheet& sheet, const PlanScale& scale) {
  const SensorGrid& grid = input.building.grids[g];
  const std::vector<SensorValue>& values = input.solution.grids.at(g).sensors;
  const double size = sheet.plan.cell_m * sheet.scale;
  std::string svg = "<g class=\"sensors\">\n";
  for (std::size_t s = 0; s < grid.points.size(); ++s) {
    const glm::dvec3& point = grid.points[s];
    svg += "<rect" + attribute("x", sheet.x(point.x) - 0.5 * size) +
           attribute("y", sheet.y(point.y) - 0.5 * size) + attribute("width", size) +
           attribute("height", size) + " fill=\"" +
           hexColour(falseColour(scale.fraction(values.at(s).illuminance_lx))) + "\"><title>" +
           sensorTitle(input, point, values[s]) + "</title></rect>\n";
  }
  svg += "</g>\n" + isoluxSvg(grid, input.solution.grids.at(g), sheet, scale) + "<g class=\"values\">\n";
  for (const std::size_t s : labelledSensors(grid, sheet.plan, sheet.scale)) {
    const double lx = values[s].illuminance_lx;
    svg +=
        textAt(sheet.x(grid.points[s].x), sheet.y(grid.points[s].y) + 3.5,
               wantsBlackText(falseColour(scale.fraction(lx))) ? "on-light" : "on-dark", illuminanceText(lx));
  }
  return svg + "</g>\n";
}

/// The scale of colours with its numbers in lux, and in daylight factors where these are in proportion.
std::string legendSvg(const ReportInput& input, const PlanScale& scale, double left, double top, double width,
                      bool withFactors, std::size_t grid) {
  const std::string id = "scale" + std::to_string(grid);
  std::string svg = "<linearGradient id=\"" + id + "\">";
  for (int i = 0; i <= 12; ++i) {
    svg += "<stop" + attribute("offset", i / 12.0) + " stop-color=\"" + hexColour(falseColour(i / 12.0)) +
           "\"/>";
  }
  svg += "</linearGradient>\n<rect" + attribute("x", left) + attribute("y", top) + attribute("width", width) +
         " height=\"10\" fill=\"url(#" + id + ")\"/>\n";
  double free = left - 100.0;  // where the numbers so far leave room
  for (const double tick_lx : scale.ticks_lx) {
    const double x = left + width * scale.fraction(tick_lx);
    if (x < free) continue;
    free = x + 32.0;
    svg += textAt(x, top + 25, "tick", tickText(tick_lx));
    if (withFactors) {
      svg +=
          textAt(x, top + 40, "tick faint", tickText(100.0 * tick_lx / input.study.sky.diffuseHorizontal_lx));
    }
  }
  svg += textAt(left + width + 18, top + 25, "unit", "lx");
  if (withFactors) svg += textAt(left + width + 18, top + 40, "unit faint", "% DF");
  return svg;
}

std::string northSvg(double x, double y, double north_deg) {
  return "<g class=\"north\" transform=\"translate(" + shortNumber(x) + " " + shortNumber(y) +
         ")\"><g transform=\"rotate(" + shortNumber(north_deg) +
         ")\"><circle r=\"11\"/><path d=\"M0 -11L4 5L0 2L-4 5Z\"/></g><title>North</title></g>\n";
}

std::string scaleBarSvg(double right, double y, double pixelsPerMetre) {
  double length_m = 1.0;  // the longest that leaves room for the scale of colours
  for (const double longer : {2.0, 5.0, 10.0, 20.0, 50.0}) {
    if (longer * pixelsPerMetre <= 110.0) length_m = longer;
  }
  const double left = right - length_m * pixelsPerMetre;
  return "<path class=\"bar\" d=\"M" + shortNumber(left) + " " + shortNumber(y - 4) + "V" + shortNumber(y) +
         "H" + shortNumber(right) + "V" + shortNumber(y - 4) + "\"/>\n" +
         textAt(0.5 * (left + right), y + 15, "tick", fixedNumber(length_m, 0) + " m");
}

/// Whether every sensor's light is the sky's, so that lux and daylight factors share one scale.
bool isSkyOnly(const GridValues& grid) {
  return std::all_of(grid.sensors.begin(), grid.sensors.end(), [](const SensorValue& value) {
    return value.sun_lx == 0.0 && value.electric_lx == 0.0;
  });
}

}  // namespace

std::string planSvg(const ReportInput& input, std::size_t g, const PlanScale& scale) {
  const Plan plan = planOf(input.building, input.building.grids.at(g));
  const Sheet sheet = sheetOf(plan);
  const double legendWidth = std::min(380.0, sheet.width - 230.0);
  const double top = sheet.height + 18.0;
  const bool withFactors = hasDaylightFactor(input.study.sky) && isSkyOnly(input.solution.grids.at(g));

  std::string svg = "<svg class=\"plan\" role=\"img\" preserveAspectRatio=\"xMinYMin\" viewBox=\"0 0 " +
                    shortNumber(sheet.width) + " " + shortNumber(sheet.height + legendHeight_px) +
                    "\" style=\"max-width:" + shortNumber(sheet.width) +
                    "px\" aria-label=\"Illuminance plan of " + escapeHtml(input.building.grids[g].name) +
                    "\">\n";
  svg += floorSvg(sheet) + sensorsSvg(input, g, sheet, scale) + windowsSvg(sheet);
  svg += legendSvg(input, scale, 12.0, top, legendWidth, withFactors, g);
  svg += scaleBarSvg(sheet.width - 44.0, top + 10.0, sheet.scale);
  svg += northSvg(sheet.width - 16.0, top + 12.0, input.study.site.north_deg);
  return svg + "</svg>\n";
}

}  // namespace clerestory
