// SPDX-License-Identifier: GPL-3.0-or-later
// The page's section on accuracy: what was asked, what the estimates say, how the light converged.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "escape.hpp"
#include "metrics.hpp"
#include "numbers.hpp"
#include "page_parts.hpp"

namespace clerestory {
namespace {

std::string count(std::uint64_t value) {
  return fixedNumber(static_cast<double>(value), 0);
}

std::string errorTable(const ReportInput& input) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t g = 0; g < input.building.grids.size(); ++g) {
    const GridMetrics m = metricsOf(input.solution.grids.at(g), input.study.sky);
    const bool met = m.p95ErrorEstimate_pct <= 100.0 * input.study.accuracy * (1.0 + 1e-9);
    rows.push_back({escapeHtml(input.building.grids[g].name), count(m.sensors),
                    fixedNumber(m.meanErrorEstimate_pct, 1), fixedNumber(m.p95ErrorEstimate_pct, 1),
                    met ? "met" : "not met"});
  }
  return tableHtml("Estimated numerical error of the sensors",
                   {{"Grid", "", false},
                    {"Sensors", ""},
                    {"Mean", "%"},
                    {"95th percentile", "%"},
                    {"Accuracy", "", false}},
                   rows);
}

/// Steps of all domains that have the same number, added up.
std::vector<IterationStatistics> stepsOfAll(const Solution& solution) {
  std::map<int, IterationStatistics> steps;
  for (const IterationStatistics& of : solution.iterations) {
    IterationStatistics& sum = steps[of.iteration];
    sum.iteration = of.iteration;
    sum.linksRequired += of.linksRequired;
    sum.linksCached += of.linksCached;
    sum.linksReused += of.linksReused;
    sum.visibilityTests += of.visibilityTests;
    sum.unshotPower_lm += of.unshotPower_lm;
    sum.elements += of.elements;
  }
  std::vector<IterationStatistics> list;
  for (const auto& [iteration, sum] : steps) list.push_back(sum);
  return list;
}

std::string iterationTable(const Solution& solution) {
  std::vector<std::vector<std::string>> rows;
  for (const IterationStatistics& step : stepsOfAll(solution)) {
    rows.push_back({std::to_string(step.iteration), count(step.linksRequired), count(step.linksCached),
                    count(step.linksReused), count(step.visibilityTests), count(step.elements),
                    roundedNumber(step.unshotPower_lm)});
  }
  return tableHtml("Shooting steps, all light domains together",
                   {{"Step", "", false},
                    {"Links required", ""},
                    {"Cached", ""},
                    {"Reused", ""},
                    {"Visibility tests", ""},
                    {"Elements", ""},
                    {"Unshot power", "lm"}},
                   rows);
}

/// The frame of the convergence chart: steps to the right, decades of unshot power upwards.
struct Chart {
  double left = 64, right = 580, top = 14, bottom = 214;
  int firstStep = 0, lastStep = 1;
  int lowDecade = 0, highDecade = 1;

  [[nodiscard]] double x(int step) const {
    return left + (right - left) * (step - firstStep) / std::max(1, lastStep - firstStep);
  }
  [[nodiscard]] double y(double power_lm) const {
    return bottom - (bottom - top) * (std::log10(power_lm) - lowDecade) / (highDecade - lowDecade);
  }
};

std::string powerOfTen(int decade) {
  if (decade >= 0 && decade <= 5) return fixedNumber(std::pow(10.0, decade), 0);
  if (decade < 0 && decade >= -3) return fixedNumber(std::pow(10.0, decade), -decade);
  return "10<tspan dy=\"-5\" font-size=\"8\">" + std::string(decade < 0 ? "\u2212" : "") +
         std::to_string(std::abs(decade)) + "</tspan>";
}

std::string svgText(double x, double y, const std::string& style, const std::string& text) {
  return "<text x=\"" + shortNumber(x) + "\" y=\"" + shortNumber(y) + "\" class=\"" + style + "\">" + text +
         "</text>\n";
}

std::string chartFrame(const Chart& chart) {
  std::string svg;
  const int everyDecade = std::max(1, (chart.highDecade - chart.lowDecade + 5) / 6);
  for (int decade = chart.lowDecade; decade <= chart.highDecade; decade += everyDecade) {
    const double y = chart.y(std::pow(10.0, decade));
    svg += "<path class=\"gridline\" d=\"M" + shortNumber(chart.left) + " " + shortNumber(y) + "H" +
           shortNumber(chart.right) + "\"/>" + svgText(chart.left - 10, y + 4, "right", powerOfTen(decade));
  }
  const int everyStep = std::max(1, (chart.lastStep - chart.firstStep + 11) / 12);
  for (int step = chart.firstStep; step <= chart.lastStep; step += everyStep) {
    svg += svgText(chart.x(step), chart.bottom + 20, "tick", std::to_string(step));
  }
  return svg + svgText(chart.right, chart.bottom + 38, "right", "shooting step");
}

constexpr std::size_t mostNamedLines = 4;

/// Unshot power by step, one line for each light domain.
std::string convergenceChart(const ReportInput& input) {
  std::map<std::int32_t, std::vector<const IterationStatistics*>> domains;
  Chart chart;
  double least = 1e300;
  double most = 0.0;
  bool any = false;
  for (const IterationStatistics& step : input.solution.iterations) {
    if (!(step.unshotPower_lm > 0.0) || !std::isfinite(step.unshotPower_lm)) continue;
    domains[step.domain].push_back(&step);
    least = std::min(least, step.unshotPower_lm);
    most = std::max(most, step.unshotPower_lm);
    chart.firstStep = any ? std::min(chart.firstStep, step.iteration) : step.iteration;
    chart.lastStep = any ? std::max(chart.lastStep, step.iteration) : step.iteration;
    any = true;
  }
  if (!any || chart.lastStep == chart.firstStep) return {};
  chart.lowDecade = static_cast<int>(std::floor(std::log10(least)));
  chart.highDecade = std::max(chart.lowDecade + 1, static_cast<int>(std::ceil(std::log10(most))));

  std::string svg =
      "<figure><svg class=\"chart\" role=\"img\" viewBox=\"0 0 720 260\" aria-label=\"Unshot power by "
      "shooting step\">\n" +
      chartFrame(chart);
  for (const auto& [domain, steps] : domains) {
    std::string path;
    std::string dots;
    for (const IterationStatistics* step : steps) {
      const std::string x = shortNumber(chart.x(step->iteration));
      const std::string y = shortNumber(chart.y(step->unshotPower_lm));
      path += (path.empty() ? "M" : "L") + x + " " + y;
      dots += "<circle cx=\"" + x + "\" cy=\"" + y + "\" r=\"3\"><title>" +
              domainName(input.building, domain) + ", step " + std::to_string(step->iteration) + ": " +
              roundedNumber(step->unshotPower_lm) + " lm</title></circle>";
    }
    svg += "<path class=\"line\" d=\"" + path + "\"/>" + dots + "\n";
    if (domains.size() <= mostNamedLines) {
      const IterationStatistics& last = *steps.back();
      svg += svgText(chart.x(last.iteration) + 10, chart.y(last.unshotPower_lm) + 4, "faint",
                     domainName(input.building, domain));
    }
  }
  return svg +
         "</svg>\n<figcaption>Light that has not been passed on yet, in lumens, after each shooting step; " +
         (domains.size() > 1 ? "one line for each light domain." : "a straight line is steady convergence.") +
         "</figcaption></figure>\n";
}

std::string energyTable(const ReportInput& input) {
  std::vector<std::vector<std::string>> rows;
  for (const EnergyBalance& balance : input.solution.balances) {
    const double left_lm = balance.emitted_lm - balance.absorbed_lm - balance.escaped_lm;
    const double left_pct = balance.emitted_lm > 0.0 ? 100.0 * left_lm / balance.emitted_lm : 0.0;
    rows.push_back({domainName(input.building, balance.domain), roundedNumber(balance.emitted_lm, 4),
                    roundedNumber(balance.absorbed_lm, 4), roundedNumber(balance.escaped_lm, 4),
                    fixedNumber(left_pct, 3), fixedNumber(100.0 * balance.unscaledDefect, 2)});
  }
  return tableHtml("Energy balance of the light domains",
                   {{"Light domain", "", false},
                    {"Emitted", "lm"},
                    {"Absorbed", "lm"},
                    {"Escaped", "lm"},
                    {"Unaccounted", "%"},
                    {"Defect before scaling", "%"}},
                   rows);
}

/// What was dropped and moved before anything was computed.
std::string repairText(const CleanupCounts& counts) {
  const std::string dropped = counts.degenerateFaces + counts.duplicateFaces == 0
                                  ? "No face was dropped"
                                  : count(counts.degenerateFaces) + " faces without area and " +
                                        count(counts.duplicateFaces) +
                                        " drawn twice were dropped, which takes no light away";
  return dropped + "; " + count(counts.pointsWelded) + " points were moved onto others, by 1 mm at most.";
}

/// What of the model was computed, what was not, and what the figures took.
std::string modelledList(const ReportInput& input) {
  const CleanupCounts& counts = input.building.model.counts;
  const Solution& solution = input.solution;
  std::set<std::int32_t> solved;
  std::uint64_t links = 0;
  for (const IterationStatistics& step : solution.iterations) {
    solved.insert(step.domain);
    links += step.linksRequired;
  }
  std::uint64_t dark = 0;
  std::uint64_t unasked = 0;
  for (std::size_t d = 0; d < input.building.domains.size(); ++d) {
    const bool isLit = input.building.domains[d].lit;
    dark += isLit ? 0 : 1;
    unasked += isLit && !solved.contains(static_cast<std::int32_t>(d)) ? 1 : 0;
  }
  std::string rooms;  // that are left out
  for (const Room& room : input.building.rooms) {
    if (input.building.domains[static_cast<std::size_t>(room.domain)].lit && !solved.contains(room.domain))
      rooms += (rooms.empty() ? "" : ", ") + nameHtml(room.name);
  }
  std::uint64_t figures = solution.surfaces.size();
  for (const GridValues& grid : solution.grids) figures += grid.sensors.size();
  std::string html = "<h3>What was modelled</h3>\n<ul class=\"list\">\n<li>" + count(counts.facesRead) +
                     " faces were read; " + count(counts.polygons) + " planar polygons, in " +
                     count(input.building.model.pieces.size()) +
                     " convex pieces, are left of them.</li>\n<li>" + repairText(counts) +
                     "</li>\n<li>The light has " + count(solution.elements) + " elements with " +
                     std::to_string(solution.columns) +
                     (solution.columns == 1 ? " value each.</li>\n" : " values each.</li>\n");
  if (figures > 0) {
    html += "<li>" + count(links) + " links were made, " +
            roundedNumber(static_cast<double>(links) / static_cast<double>(figures)) + " for each of the " +
            count(figures) + " figures of sensors and surfaces.</li>\n";
  }
  html += "<li>Volumes of air left out: " + count(dark) + " that no light reaches, " + count(unasked) +
          " that nothing asks for" + (rooms.empty() ? "" : ", with " + rooms) +
          ".</li>\n<li>Neglected: light that leaves a room through its glazing, is "
          "reflected outside and comes back.</li>\n</ul>\n";
  return html;
}

}  // namespace

std::string accuracySection(const ReportInput& input) {
  std::string html = sectionOpening("accuracy", "Accuracy");
  html +=
      "<p>Asked for was an accuracy of <b>" + shortNumber(100.0 * input.study.accuracy) +
      " %</b>: at 95 of 100 sensors the numerical error is at most this share of the value, where values "
      "below "
      "5 % of their grid's mean count as that. The estimates bound the error of the computation; they do not "
      "know how well the model's reflectances and transmittances describe the building.</p>\n";
  if (!input.building.grids.empty()) html += errorTable(input);
  html += convergenceChart(input);
  if (!input.solution.iterations.empty()) html += iterationTable(input.solution);
  if (!input.solution.balances.empty()) html += energyTable(input);
  html += modelledList(input);
  return html + "</section>\n";
}

}  // namespace clerestory
