// SPDX-License-Identifier: GPL-3.0-or-later
// Draws runs as log-log charts of error against what it took, and as a table.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <report/chart.hpp>

#include "escape.hpp"
#include "numbers.hpp"
#include "page_parts.hpp"
#include "page_style.hpp"

namespace clerestory {
namespace {

constexpr double width_px = 760.0;
constexpr double height_px = 440.0;
constexpr double left_px = 70.0, right_px = 190.0, top_px = 16.0, bottom_px = 48.0;

// Told apart without red-green vision (Okabe and Ito), and by the shape of their marks.
constexpr std::array<const char*, 6> colours = {"#0072b2", "#d55e00", "#009e73",
                                                "#cc79a7", "#e69f00", "#56b4e9"};

struct Point {
  double x, y;
  std::string label;
};
struct Series {
  std::string name;
  std::vector<Point> points;
  bool hasFront = true;  ///< its Pareto front is drawn as a line
};
struct LogChart {
  std::string title, xTitle, yTitle;
  std::vector<Series> series;
  double floor = std::numeric_limits<double>::quiet_NaN();  ///< below it y says nothing
};

using Cost = double (*)(const ChartRun&);
using Error = double (*)(const ChartRun&);

/// A logarithmic axis from one round number to another.
struct Axis {
  double low = 1.0, high = 10.0, start_px = 0.0, end_px = 1.0;

  [[nodiscard]] double at(double value) const {
    return start_px + (end_px - start_px) * std::log(value / low) / std::log(high / low);
  }
  /// Of 1, 2 and 5 times powers of ten, as many as there is room for.
  [[nodiscard]] std::vector<double> ticks() const {
    const bool isWide = high / low > 3e3;
    std::vector<double> found;
    for (double decade = std::pow(10.0, std::floor(std::log10(low))); decade <= high; decade *= 10.0) {
      for (const double step : {1.0, 2.0, 5.0}) {
        const double tick = step * decade;
        if (tick >= low * 0.999 && tick <= high * 1.001 && (step == 1.0 || !isWide)) found.push_back(tick);
      }
    }
    return found;
  }
};

double roundDown(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  return (value >= 5.0 * decade ? 5.0 : value >= 2.0 * decade ? 2.0 : 1.0) * decade;
}
double roundUp(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  return (value <= 2.0 * decade ? 2.0 : value <= 5.0 * decade ? 5.0 : 10.0) * decade;
}

Axis axisOver(const LogChart& chart, double Point::*coordinate, double start_px, double end_px) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (const Series& series : chart.series) {
    for (const Point& point : series.points) {
      low = std::min(low, point.*coordinate);
      high = std::max(high, point.*coordinate);
    }
  }
  return {roundDown(low * 0.9), roundUp(high * 1.1), start_px, end_px};
}

std::string px(double value) {
  return '"' + shortNumber(value) + '"';
}

std::string text(double x, double y, const char* style, const std::string& html) {
  return "<text x=" + px(x) + " y=" + px(y) + " class=\"" + style + "\">" + html + "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, const std::string& attributes) {
  return "<line x1=" + px(x1) + " y1=" + px(y1) + " x2=" + px(x2) + " y2=" + px(y2) + ' ' + attributes +
         "/>\n";
}

/// A mark of one of four shapes.
std::string mark(double x, double y, std::size_t series, const std::string& label) {
  constexpr double r = 4.0;
  const std::string fill = std::string(" fill=\"") + colours[series % colours.size()] + "\"";
  const std::string title = "<title>" + label + "</title>";
  const auto polygon = [&](std::initializer_list<std::pair<double, double>> corners) {
    std::string points;
    for (const auto& [dx, dy] : corners) points += shortNumber(x + dx) + ',' + shortNumber(y + dy) + ' ';
    return "<polygon points=\"" + points + '"' + fill + '>' + title + "</polygon>\n";
  };
  switch (series % 4) {
    case 1:
      return polygon({{-r, -r}, {r, -r}, {r, r}, {-r, r}});
    case 2:
      return polygon({{0.0, -1.3 * r}, {1.2 * r, r}, {-1.2 * r, r}});
    case 3:
      return polygon({{0.0, -1.4 * r}, {1.4 * r, 0.0}, {0.0, 1.4 * r}, {-1.4 * r, 0.0}});
    default:
      return "<circle cx=" + px(x) + " cy=" + px(y) + " r=" + px(r) + fill + '>' + title + "</circle>\n";
  }
}

std::string frontPath(const Series& series, std::size_t number, const Axis& x, const Axis& y) {
  std::vector<std::pair<double, double>> points;
  for (const Point& point : series.points) points.emplace_back(point.x, point.y);
  const std::vector<bool> isOnFront = paretoFront(points);
  std::vector<std::pair<double, double>> front;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (isOnFront[i]) front.push_back(points[i]);
  }
  std::sort(front.begin(), front.end());
  std::string path;
  for (const auto& [cost, error] : front)
    path += (path.empty() ? "M" : "L") + shortNumber(x.at(cost)) + ' ' + shortNumber(y.at(error));
  return "<path d=\"" + path + "\" fill=\"none\" stroke-width=\"1.6\" stroke=\"" +
         colours[number % colours.size()] + "\"/>\n";
}

std::string gridSvg(const LogChart& chart, const Axis& x, const Axis& y) {
  std::string svg;
  for (const double tick : x.ticks()) {
    svg += line(x.at(tick), y.start_px, x.at(tick), y.end_px, "class=\"rule\"") +
           text(x.at(tick), y.start_px + 16.0, "tick", shortestFloat(tick));
  }
  for (const double tick : y.ticks()) {
    svg += line(x.start_px, y.at(tick), x.end_px, y.at(tick), "class=\"rule\"") +
           text(x.start_px - 7.0, y.at(tick) + 4.0, "right", shortestFloat(tick));
  }
  svg += text(0.5 * (x.start_px + x.end_px), height_px - 8.0, "tick", escapeHtml(chart.xTitle));
  svg += "<text transform=\"translate(14 " + shortNumber(0.5 * (y.start_px + y.end_px)) +
         ") rotate(-90)\" class=\"tick\">" + escapeHtml(chart.yTitle) + "</text>\n";
  if (chart.floor > y.low && chart.floor < y.high) {
    svg += line(x.start_px, y.at(chart.floor), x.end_px, y.at(chart.floor),
                "class=\"floor\" stroke-dasharray=\"5 4\"") +
           text(x.end_px + 8.0, y.at(chart.floor) + 4.0, "faint", "the reference's own error");
  }
  return svg;
}

std::string slopeText(const Series& series) {
  std::vector<std::pair<double, double>> points;
  for (const Point& point : series.points) points.emplace_back(point.x, point.y);
  const std::optional<double> slope = series.hasFront ? frontSlope(points) : std::nullopt;
  return slope ? ", slope " + fixedNumber(*slope, 2) : "";
}

std::string legendSvg(const LogChart& chart, const Axis& x) {
  std::string svg;
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const double y = top_px + 10.0 + 18.0 * static_cast<double>(i);
    svg += mark(x.end_px + 14.0, y - 4.0, i, "") +
           text(x.end_px + 26.0, y, "name", escapeHtml(chart.series[i].name) + slopeText(chart.series[i]));
  }
  return svg;
}

std::string svgOf(const LogChart& chart, bool isAlone) {
  std::string svg = "<svg viewBox=\"0 0 " + shortNumber(width_px) + ' ' + shortNumber(height_px) +
                    "\" role=\"img\" aria-label=\"" + escapeHtml(chart.title) + "\"" +
                    (isAlone ? " xmlns=\"http://www.w3.org/2000/svg\" width=\"760\" height=\"440\"" : "") +
                    ">\n";
  if (isAlone) {
    svg +=
        "<style>text{font:12px sans-serif;fill:#1d1c1a}.tick{text-anchor:middle}.right{text-anchor:end}"
        ".rule{stroke:#e3dfd7}.floor{stroke:#68645e}.faint{fill:#68645e}</style>\n"
        "<rect width=\"760\" height=\"440\" fill=\"#fff\"/>\n";
  }
  const Axis x = axisOver(chart, &Point::x, left_px, width_px - right_px);
  const Axis y = axisOver(chart, &Point::y, height_px - bottom_px, top_px);
  svg += gridSvg(chart, x, y);
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    if (chart.series[i].hasFront) svg += frontPath(chart.series[i], i, x, y);
    for (const Point& point : chart.series[i].points)
      svg += mark(x.at(point.x), y.at(point.y), i, point.label);
  }
  return svg + legendSvg(chart, x) + "</svg>\n";
}

/// The runs of a series by method, in the order in which methods first come, and with `withGiven` what other
/// programs need.
LogChart chartOf(const std::vector<ChartRun>& runs, const std::string& series, bool withGiven,
                 const std::string& xTitle, Cost cost, const std::string& yTitle, Error error) {
  LogChart chart{yTitle + " against " + xTitle, xTitle, yTitle, {}};
  for (const ChartRun& run : runs) {
    const bool isGiven = withGiven && run.series == "given";
    if (run.series != series && !isGiven) continue;
    const double x = cost(run);
    const double y = error(run);
    if (!(x > 0.0) || !(y > 0.0)) continue;
    auto found = std::find_if(chart.series.begin(), chart.series.end(),
                              [&](const Series& own) { return own.name == run.method; });
    if (found == chart.series.end()) found = chart.series.insert(found, {run.method, {}});
    found->points.push_back({x, y,
                             escapeHtml(run.method + ", " + run.setting) + ": " + roundedNumber(y, 2) + ", " +
                                 roundedNumber(x, 3)});
  }
  return chart;
}

double cpuOf(const ChartRun& run) {
  return run.cpu_s;
}
double memoryOf(const ChartRun& run) {
  return run.memory_MiB;
}
double linksOf(const ChartRun& run) {
  return run.links;
}
double valueOf(const ChartRun& run) {
  return run.value;
}
double rmsOf(const ChartRun& run) {
  return 100.0 * run.sensors.rms;
}
double p95Of(const ChartRun& run) {
  return 100.0 * run.sensors.p95;
}
double biasOf(const ChartRun& run) {
  return 100.0 * std::abs(run.sensors.bias);
}
double maximumOf(const ChartRun& run) {
  return 100.0 * run.sensors.maximum;
}
double surfacesOf(const ChartRun& run) {
  return 100.0 * run.surfaces;
}

std::string figure(const LogChart& chart) {
  if (chart.series.empty()) return {};
  return "<h3>" + escapeHtml(chart.title) + "</h3>\n<figure>" + svgOf(chart, false) + "</figure>\n";
}

std::string runsTable(const std::string& caption, const std::vector<ChartRun>& runs,
                      const std::vector<std::string>& series) {
  std::vector<std::vector<std::string>> rows;
  for (const ChartRun& run : runs) {
    if (std::find(series.begin(), series.end(), run.series) == series.end()) continue;
    const auto percent = [](double fraction) { return fixedNumber(100.0 * fraction, 2); };
    rows.push_back({escapeHtml(run.method), escapeHtml(run.setting), fixedNumber(run.cpu_s, 3),
                    fixedNumber(run.wall_s, 3), fixedNumber(run.memory_MiB, 1), fixedNumber(run.links, 0),
                    fixedNumber(run.rays, 0), fixedNumber(run.elements, 0), std::to_string(run.columns),
                    percent(run.sensors.bias), percent(run.sensors.rms), percent(run.sensors.p95),
                    percent(run.sensors.maximum), percent(run.surfaces)});
  }
  if (rows.empty()) return {};
  return tableHtml(caption,
                   {{"Method", "", false},
                    {"Setting", "", false},
                    {"CPU", "s"},
                    {"Wall", "s"},
                    {"Memory", "MiB"},
                    {"Links", ""},
                    {"Rays", ""},
                    {"Elements", ""},
                    {"Columns", ""},
                    {"Bias", "%"},
                    {"RMS", "%"},
                    {"p95", "%"},
                    {"Maximum", "%"},
                    {"Surfaces", "%"}},
                   rows);
}

}  // namespace

std::string chartSvg(const std::string& study, const ChartReference& reference,
                     const std::vector<ChartRun>& runs) {
  LogChart chart = chartOf(runs, "accuracy", true, "CPU seconds", cpuOf, "RMS error of sensors, %", rmsOf);
  chart.title = study + ": " + chart.title;
  chart.floor = 100.0 * reference.sensorsError;
  return chart.series.empty() ? std::string() : svgOf(chart, true);
}

std::string chartPage(const std::string& study, const ChartReference& reference,
                      const std::vector<ChartRun>& runs) {
  const auto sensors = [&](const char* xTitle, Cost cost, const char* yTitle, Error error) {
    LogChart chart = chartOf(runs, "accuracy", cost == &cpuOf, xTitle, cost, yTitle, error);
    if (error == &rmsOf) chart.floor = 100.0 * reference.sensorsError;
    return figure(chart);
  };
  const std::string name = escapeHtml(study);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'; base-uri 'none'; form-action 'none'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      name + ": error against time</title>\n<style>" + pageStyle +
      "svg .rule{stroke:var(--line)}svg .floor{stroke:var(--soft)}</style>\n</head>\n<body>\n<header>\n"
      "<p class=\"over\">Accuracy against speed</p>\n<h1>" +
      name + "</h1>\n<p class=\"lead\">" + escapeHtml(reference.text) +
      "</p>\n<p class=\"note\">The error of a sensor is its difference from the reference, over the "
      "reference "
      "or 5 % of the mean, whichever is more; that of surfaces is the area-weighted RMS of the relative "
      "errors of their means. Lines join the runs that no other of the same method beats in both; the slope "
      "is that of error against cost along them. CPU seconds are those of the solve on all threads, without "
      "reading the model and writing the report; other programs' are of the whole run.</p>\n</header>\n"
      "<main>\n";
  html += sectionOpening("time", "Against time") +
          sensors("CPU seconds", cpuOf, "RMS error of sensors, %", rmsOf) +
          sensors("CPU seconds", cpuOf, "95th percentile of sensors' errors, %", p95Of) +
          sensors("CPU seconds", cpuOf, "Largest error of a sensor, %", maximumOf) +
          sensors("CPU seconds", cpuOf, "Mean error of sensors by size, %", biasOf) +
          sensors("CPU seconds", cpuOf, "RMS error of surfaces' means, %", surfacesOf) + "</section>\n";
  html += sectionOpening("memory", "Against memory and links") +
          sensors("MiB of hierarchy, light and links", memoryOf, "RMS error of sensors, %", rmsOf) +
          sensors("Links of all steps", linksOf, "RMS error of sensors, %", rmsOf) +
          sensors("Links of all steps", linksOf, "RMS error of surfaces' means, %", surfacesOf) +
          "</section>\n";
  html +=
      sectionOpening("settings", "One setting at a time") +
      figure(chartOf(runs, "epsilon", false, "Threshold ε", valueOf, "RMS error of surfaces' means, %",
                     surfacesOf)) +
      figure(chartOf(runs, "epsilon", false, "Threshold ε", valueOf, "RMS error of sensors, %", rmsOf)) +
      figure(chartOf(runs, "rays", false, "Rays of a sensor", valueOf, "RMS error of sensors, %", rmsOf)) +
      runsTable("Link cache", runs, {"cache"}) + runsTable("Threads", runs, {"threads"}) + "</section>\n";
  html += sectionOpening("runs", "All runs") +
          runsTable("Runs", runs, {"accuracy", "epsilon", "rays", "given"}) + "</section>\n";
  return html + "</main>\n<footer>Clerestory</footer>\n</body>\n</html>\n";
}

}  // namespace clerestory
