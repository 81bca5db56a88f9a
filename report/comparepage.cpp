// SPDX-License-Identifier: GPL-3.0-or-later
// The page of a comparison: figures, largest errors, and a plan of the errors of each grid.
#include <algorithm>
#include <cmath>

#include <report/compare.hpp>

#include "colormap.hpp"
#include "escape.hpp"
#include "numbers.hpp"
#include "page_parts.hpp"
#include "page_style.hpp"
#include "plan.hpp"

namespace clerestory {
namespace {

constexpr double largestWidth_px = 760.0;
constexpr double largestHeight_px = 560.0;
constexpr double largestScale = 130.0;   // pixels a metre
constexpr double leastWidth_px = 420.0;  // for the legend
constexpr double legendHeight_px = 60.0;

/// Blue where there is less light than the reference has, orange where there is more; all light enough for
/// dark numbers, and told apart without red-green vision. `fraction` is in [-1, 1].
DisplayColour differenceColour(double fraction) {
  constexpr DisplayColour less = {0x5b, 0x9b, 0xd5};
  constexpr DisplayColour same = {0xf4, 0xf1, 0xeb};
  constexpr DisplayColour more = {0xe0, 0x8a, 0x2e};
  const DisplayColour& end = fraction < 0.0 ? less : more;
  const double part = std::min(std::abs(fraction), 1.0);
  DisplayColour colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    colour[c] = static_cast<std::uint8_t>(std::lround(same[c] + part * (end[c] - same[c])));
  }
  return colour;
}

/// The end of the plans' scale: 1, 2 or 5 times a power of ten that 95 % of the errors keep within, from 1 %
/// on.
double scaleEnd(double p95) {
  if (!(p95 > 0.01)) return 0.01;
  const double decade = std::pow(10.0, std::floor(std::log10(p95)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (p95 <= step * decade * (1.0 + 1e-9)) return step * decade;
  }
  return 10.0 * decade;
}

std::string percentText(double fraction, int decimals = 2) {
  return fixedNumber(100.0 * fraction, decimals);
}

/// A percentage of the plans' scale: no more decimals than it has, with a sign.
std::string tickText(double fraction) {
  const double size = 100.0 * std::abs(fraction);
  const std::string text =
      size >= 1.0 ? fixedNumber(size, size == std::floor(size) ? 0 : 1) : roundedNumber(size, 1);
  return (fraction > 0.0 ? "+" : fraction < 0.0 ? "\u2212" : "") + text;
}

std::string nameOf(const GridComparison& grid) {
  return grid.name.empty() ? "Sensors" : escapeHtml(grid.name);
}

std::string attribute(const char* name, double value) {
  return std::string(" ") + name + "=\"" + shortNumber(value) + '"';
}

std::string textAt(double x, double y, const char* style, const std::string& text) {
  return "<text" + attribute("x", x) + attribute("y", y) + " class=\"" + style + "\">" + text + "</text>\n";
}

std::string legendSvg(double top, double width, double end, std::size_t grid) {
  const std::string id = "scale" + std::to_string(grid);
  std::string svg = "<linearGradient id=\"" + id + "\">";
  for (const double fraction : {-1.0, 0.0, 1.0}) {
    svg += "<stop" + attribute("offset", 0.5 + 0.5 * fraction) + " stop-color=\"" +
           hexColour(differenceColour(fraction)) + "\"/>";
  }
  svg += "</linearGradient>\n<rect" + attribute("x", 24.0) + attribute("y", top) + attribute("width", width) +
         " height=\"10\" fill=\"url(#" + id + ")\"/>\n";
  for (const double fraction : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    svg += textAt(24.0 + width * (0.5 + 0.5 * fraction), top + 25.0, "tick", tickText(fraction * end));
  }
  return svg + textAt(24.0 + width + 26.0, top + 25.0, "unit", "%");
}

std::string planSvg(const GridComparison& grid, double end, std::size_t number) {
  SensorGrid sensors;
  for (const SensorPair& pair : grid.pairs) sensors.points.push_back(pair.place_m);
  const Plan plan = planOf(Building{}, sensors);
  const double width_m = plan.high_m.x - plan.low_m.x;
  const double height_m = plan.high_m.y - plan.low_m.y;
  const double scale = std::min({largestWidth_px / width_m, largestHeight_px / height_m, largestScale});
  const double width = std::max(leastWidth_px, width_m * scale);
  const double height = height_m * scale;
  const double cell = plan.cell_m * scale;
  const auto x = [&](const SensorPair& pair) { return (pair.place_m.x - plan.low_m.x) * scale; };
  const auto y = [&](const SensorPair& pair) { return (plan.high_m.y - pair.place_m.y) * scale; };

  std::string svg =
      "<svg class=\"plan\" role=\"img\" tabindex=\"0\" viewBox=\"0 0 " + shortNumber(width) + " " +
      shortNumber(height + legendHeight_px) + "\" style=\"max-width:" + shortNumber(width) +
      "px\" aria-label=\"Plan of the errors of " + nameOf(grid) + "\">\n<g class=\"sensors\">\n";
  for (const SensorPair& pair : grid.pairs) {
    svg += "<rect" + attribute("x", x(pair) - 0.5 * cell) + attribute("y", y(pair) - 0.5 * cell) +
           attribute("width", cell) + attribute("height", cell) + " fill=\"" +
           hexColour(differenceColour(pair.error / end)) + "\"><title>" + percentText(pair.error) + " % at " +
           fixedNumber(pair.place_m.x, 2) + ", " + fixedNumber(pair.place_m.y, 2) + ", " +
           fixedNumber(pair.place_m.z, 2) + " m: " + illuminanceText(pair.illuminance_lx) +
           " lx, reference " + illuminanceText(pair.reference_lx) + " lx</title></rect>\n";
  }
  svg += "</g>\n<g class=\"values\">\n";
  for (const std::size_t s : labelledSensors(sensors, plan, scale)) {
    const SensorPair& pair = grid.pairs[s];
    svg += textAt(x(pair), y(pair) + 3.5, "on-light", percentText(pair.error, 1));
  }
  return svg + "</g>\n" + legendSvg(height + 12.0, std::min(380.0, width - 90.0), end, number) + "</svg>\n";
}

std::string figuresTable(const Comparison& comparison) {
  const auto countText = [](std::size_t count) { return fixedNumber(static_cast<double>(count), 0); };
  std::vector<std::vector<std::string>> rows;
  std::size_t onlyFirst = 0, onlyReference = 0;
  for (const GridComparison& grid : comparison.grids) {
    const ErrorFigures& errors = grid.errors;
    rows.push_back({nameOf(grid), countText(grid.pairs.size()), countText(grid.onlyFirst),
                    countText(grid.onlyReference), fixedNumber(grid.mean_lx, 1),
                    fixedNumber(grid.referenceMean_lx, 1), percentText(errors.bias), percentText(errors.rms),
                    percentText(errors.p95), percentText(errors.maximum)});
    onlyFirst += grid.onlyFirst;
    onlyReference += grid.onlyReference;
  }
  if (rows.size() > 1) {
    const ErrorFigures& errors = comparison.errors;
    rows.push_back({"All", countText(comparison.pairs), countText(onlyFirst), countText(onlyReference), "",
                    "", percentText(errors.bias), percentText(errors.rms), percentText(errors.p95),
                    percentText(errors.maximum)});
  }
  return tableHtml("Errors by grid",
                   {{"Grid", "", false},
                    {"Sensors", ""},
                    {"Only in the first", ""},
                    {"Only in the reference", ""},
                    {"Mean", "lx"},
                    {"Reference", "lx"},
                    {"Bias", "%"},
                    {"RMS", "%"},
                    {"95th percentile", "%"},
                    {"Maximum", "%"}},
                   rows);
}

std::string worstTable(const Comparison& comparison) {
  constexpr std::size_t mostPlaces = 10;
  std::vector<std::vector<std::string>> rows;
  for (const PairPlace& place : worstPlaces(comparison, mostPlaces)) {
    const GridComparison& grid = comparison.grids[place.grid];
    const SensorPair& pair = grid.pairs[place.pair];
    rows.push_back({nameOf(grid), fixedNumber(pair.place_m.x, 3), fixedNumber(pair.place_m.y, 3),
                    fixedNumber(pair.place_m.z, 3), illuminanceText(pair.illuminance_lx),
                    illuminanceText(pair.reference_lx), percentText(pair.error)});
  }
  return tableHtml("Largest errors",
                   {{"Grid", "", false},
                    {"x", "m"},
                    {"y", "m"},
                    {"z", "m"},
                    {"Illuminance", "lx"},
                    {"Reference", "lx"},
                    {"Error", "%"}},
                   rows);
}

std::string plansSection(const Comparison& comparison) {
  const double end = scaleEnd(comparison.errors.p95);
  std::string html = sectionOpening("plans", "Where they differ") +
                     "<p class=\"note\">Errors in %: orange where there is more light than in the reference, "
                     "blue where there is "
                     "less. The scale is the same in all plans; larger errors have the colours of its ends. "
                     "Seen from above, y "
                     "upwards.</p>\n";
  for (std::size_t g = 0; g < comparison.grids.size(); ++g) {
    const GridComparison& grid = comparison.grids[g];
    html += "<h3>" + nameOf(grid) + "</h3>\n";
    if (grid.pairs.empty()) {
      html += "<p>No sensor of this grid is in both.</p>\n";
    } else if (std::isnan(grid.errors.rms)) {
      html += "<p>The reference is dark: there is no error to state.</p>\n";
    } else {
      html += "<figure>" + planSvg(grid, end, g) + "</figure>\n";
    }
  }
  return html + "</section>\n";
}

}  // namespace

std::string comparisonPage(const Comparison& comparison) {
  const std::string first = escapeHtml(comparison.first);
  const std::string reference = escapeHtml(comparison.reference);
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
         "'unsafe-inline'; base-uri 'none'; form-action 'none'\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         first + " against " + reference + "</title>\n<style>" + pageStyle +
         "</style>\n</head>\n<body>\n<header>\n<p class=\"over\">Comparison</p>\n<h1>" + first + " against " +
         reference + "</h1>\n<p class=\"lead\">How far the illuminances of " + first + " lie from those of " +
         reference +
         ", the reference.</p>\n<p class=\"note\">The error of a sensor is its difference from the "
         "reference, over the reference or 5 % of the grid's mean, whichever is more. Sensors pair where "
         "their "
         "grids have one name and they lie within 1 mm.</p>\n</header>\n<main>\n" +
         figuresTable(comparison) + worstTable(comparison) + plansSection(comparison) +
         "</main>\n<footer>Clerestory</footer>\n</body>\n</html>\n";
}

}  // namespace clerestory
