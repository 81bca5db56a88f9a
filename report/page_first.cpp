// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the page's first screen.
#include "page_first.hpp"

#include <algorithm>

#include "escape.hpp"
#include "falsepicture.hpp"
#include "metrics.hpp"
#include "norms.hpp"
#include "numbers.hpp"
#include "page_parts.hpp"

namespace clerestory {
namespace {

std::string pictureHtml(const std::string& png, const std::string& alt, int width, int height) {
  return "<img src=\"data:image/png;base64," + base64(png) + "\" width=\"" + std::to_string(width) +
         "\" height=\"" + std::to_string(height) + "\" alt=\"" + alt + "\">";
}

std::string viewFigure(const PageView& view) {
  const std::string name = escapeHtml(view.name);
  // Where middle grey lies: the luminance that a reader may compare with.
  return "<figure>" + pictureHtml(view.png, "Rendered view " + name, view.width, view.height) +
         "<figcaption>View “" + name + "”, exposed for EV " + fixedNumber(view.exposure_ev, 1) +
         " at ISO 100: middle grey is " + roundedNumber(0.18 * view.white_cd_m2) +
         " cd/m². Luminances are in <code>view-" + escapeHtml(view.fileName) +
         ".exr</code>.</figcaption></figure>\n";
}

/// The views in false colours, folded away until they are asked for.
std::string falseColours(const std::vector<PageView>& views) {
  std::string html =
      "<details class=\"falsecolours\"><summary>Views in false colours</summary>\n<div class=\"rest\">\n";
  for (const PageView& view : views) {
    for (const auto& [kind, png] :
         {std::pair{"Luminance", &view.luminancePng}, std::pair{"Illuminance", &view.illuminancePng}}) {
      if (png->empty()) continue;
      const std::string text = std::string(kind) + " in view “" + escapeHtml(view.name) + "”";
      html += "<figure>" + pictureHtml(*png, text, view.width, view.height + falseLegend_px) +
              "<figcaption>" + text + "</figcaption></figure>\n";
    }
  }
  return html + "</div>\n</details>\n";
}

/// The figures of a study that has one grid.
std::string figuresOfOne(const ReportInput& input) {
  const GridMetrics m = metricsOf(input.solution.grids.at(0), input.study.sky);
  std::string html = "<h2>At a glance</h2>\n<dl class=\"figures\">\n" +
                     figureHtml("Mean illuminance", illuminanceText(m.illuminance_lx.mean), "lx") +
                     figureHtml("Minimum illuminance", illuminanceText(m.illuminance_lx.min), "lx") +
                     figureHtml("Uniformity, min ÷ mean", fixedNumber(m.uniformity, 2), "");
  html += m.daylightFactor_pct
              ? figureHtml("Median daylight factor", factorText(m.daylightFactor_pct->median), "%") +
                    figureHtml("Minimum daylight factor", factorText(m.daylightFactor_pct->min), "%")
              : figureHtml("Median illuminance", illuminanceText(m.illuminance_lx.median), "lx") +
                    figureHtml("Area of 300 to 3000 lx", fixedNumber(m.share300To3000_pct, 0), "%");
  return html + figureHtml("Error, 95 % of sensors", errorText(m), "%, est.") + "</dl>\n";
}

/// The figures of the first grids of several.
std::string figuresOfMany(const ReportInput& input, bool withVerdict) {
  constexpr std::size_t mostRows = 8;
  const bool withFactor = hasDaylightFactor(input.study.sky);
  const std::size_t grids = input.building.grids.size();
  std::vector<std::vector<std::string>> rows;
  for (std::size_t g = 0; g < std::min(grids, mostRows); ++g) {
    const GridValues& grid = input.solution.grids.at(g);
    const GridMetrics m = metricsOf(grid, input.study.sky);
    rows.push_back({nameHtml(roomName(input.building, input.building.grids[g].room)),
                    illuminanceText(m.illuminance_lx.mean)});
    rows.back().push_back(withFactor ? factorText(m.daylightFactor_pct->median)
                                     : illuminanceText(m.illuminance_lx.min));
    rows.back().push_back(errorText(m));
    if (withVerdict) rows.back().push_back(en17037Verdict(grid, input.study));
  }
  std::vector<Column> columns = {{"Room", "", false}, {"Mean", "lx"}};
  columns.push_back(withFactor ? Column{"Median DF", "%"} : Column{"Minimum", "lx"});
  columns.push_back({"Error", "%"});
  if (withVerdict) columns.push_back({"EN 17037", "", false});
  std::string html = tableHtml("At a glance", columns, rows);
  if (grids > mostRows) {
    html += "<p class=\"note\"><a href=\"#overview\">All " + std::to_string(grids) + " grids</a></p>\n";
  }
  return html;
}

/// What a reader wants to know first: figures, what the norms say of them, and how far they may be off.
std::string glanceHtml(const ReportInput& input) {
  const std::size_t grids = input.building.grids.size();
  if (grids == 0) return {};
  const bool isJudged = en17037Of(input.solution.grids.at(0), input.study).has_value();
  const bool withFactor = hasDaylightFactor(input.study.sky);
  if (grids == 1) return figuresOfOne(input) + glanceNormsHtml(input);
  return figuresOfMany(input, isJudged) + glanceNormsHtml(input) +
         "<p class=\"note\">Error: estimated; 95 of 100 sensors are off by less." +
         (withFactor ? " DF: daylight factor." : "") + "</p>\n";
}

}  // namespace

std::string firstScreenHtml(const ReportInput& input, const std::vector<PageView>& views) {
  const std::string glance = "<div class=\"glance\">\n" + glanceHtml(input) + "</div>\n";
  if (views.empty()) return glance;
  std::string html =
      "<svg width=\"0\" height=\"0\" aria-hidden=\"true\" class=\"unseen\"><filter id=\"exposure\" "
      "color-interpolation-filters=\"linearRGB\"><feComponentTransfer><feFuncR type=\"linear\"/><feFuncG "
      "type=\"linear\"/><feFuncB type=\"linear\"/></feComponentTransfer></filter></svg>\n<div "
      "class=\"views\">\n<div class=\"first\">\n" +
      viewFigure(views.front()) + glance + "</div>\n";
  if (views.size() > 1) {
    html += "<div class=\"rest\">\n";
    for (std::size_t v = 1; v < views.size(); ++v) html += viewFigure(views[v]);
    html += "</div>\n";
  }
  return html + "</div>\n" + falseColours(views);
}

}  // namespace clerestory
