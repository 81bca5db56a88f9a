// SPDX-License-Identifier: GPL-3.0-or-later
// Builds tables, figures and headings for the page.
#include "page_parts.hpp"

#include "colormap.hpp"
#include "escape.hpp"
#include "numbers.hpp"

namespace clerestory {

std::string tableHtml(const std::string& caption, const std::vector<Column>& columns,
                      const std::vector<std::vector<std::string>>& rows, const std::vector<std::string>& ids,
                      std::size_t mostRows) {
  constexpr std::size_t mostUnbroken = 8;  // rows that paper keeps on one page
  std::string html = std::string("<div class=\"table") + (rows.size() <= mostUnbroken ? " short" : "") +
                     "\" role=\"group\" tabindex=\"0\" aria-label=\"" + caption + "\"><table>\n<caption>" +
                     caption + "</caption>\n<thead><tr>";
  for (const Column& column : columns) {
    html += "<th scope=\"col\" data-name=\"" + column.title + "\" data-unit=\"" + column.unit + '"' +
            (column.isNumber ? " class=\"n\">" : ">") + column.title;
    if (!column.unit.empty()) html += " <span class=\"u\">" + column.unit + "</span>";
    html += "</th>";
  }
  html += "</tr></thead>\n<tbody>\n";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const std::vector<std::string>& row = rows[r];
    html += std::string("<tr") + (r >= mostRows ? " class=\"more\"" : "");
    html += ids.empty() ? ">" : " id=\"" + ids.at(r) + "\">";
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string style = columns.at(c).isNumber ? " class=\"n\"" : "";
      html += c == 0 ? "<th scope=\"row\"" + style + ">" + row[c] + "</th>"
                     : "<td" + style + ">" + row[c] + "</td>";
    }
    html += "</tr>\n";
  }
  html += "</tbody></table></div>\n";
  if (rows.size() > mostRows) {
    html += "<p class=\"note paper\">" + fixedNumber(static_cast<double>(mostRows), 0) + " of " +
            fixedNumber(static_cast<double>(rows.size()), 0) + " rows; the CSV table has all.</p>\n";
  }
  return html;
}

std::string figureHtml(const std::string& label, const std::string& value, const std::string& unit) {
  return "<div><dt>" + label + "</dt><dd>" + value +
         (unit.empty() ? "" : " <span class=\"u\">" + unit + "</span>") + "</dd></div>\n";
}

std::string errorText(const GridMetrics& metrics) {
  return "± " + roundedNumber(metrics.p95ErrorEstimate_pct, 2);
}

std::string sectionOpening(const std::string& id, const std::string& title, const std::string& style) {
  return "<section" + (style.empty() ? "" : " class=\"" + style + "\"") + " aria-labelledby=\"" + id +
         "\">\n<h2 id=\"" + id + "\">" + title + "</h2>\n";
}

std::string swatchHtml(const glm::dvec3& reflectance) {
  const DisplayColour colour = {srgbByte(reflectance.x), srgbByte(reflectance.y), srgbByte(reflectance.z)};
  return "<span class=\"swatch\" style=\"background:" + hexColour(colour) + "\"></span>";
}

std::string nameHtml(const std::string& name) {
  std::string html;
  for (const char c : escapeHtml(name)) {
    html += c;
    if (c == '_') html += "<wbr>";
  }
  return html;
}

std::string domainName(const Building& building, std::int32_t domain) {
  constexpr std::size_t mostNames = 3;
  std::string names;
  std::size_t count = 0;
  for (const Room& room : building.rooms) {
    if (room.domain != domain) continue;
    if (++count <= mostNames) names += (names.empty() ? "" : ", ") + escapeHtml(room.name);
  }
  if (count > mostNames) names += " and " + std::to_string(count - mostNames) + " more";
  if (!names.empty()) return names;
  const bool known = domain >= 0 && static_cast<std::size_t>(domain) < building.domains.size();
  if (!known || building.domains[static_cast<std::size_t>(domain)].open) return "Outside";
  return "Enclosed air " + std::to_string(domain);
}

}  // namespace clerestory
