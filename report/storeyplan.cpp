// SPDX-License-Identifier: GPL-3.0-or-later
// Draws storeys as SVG files that stand alone.
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <report/storeyplan.hpp>

#include "escape.hpp"
#include "numbers.hpp"

namespace clerestory {
namespace {

constexpr double cut_m = 1.1;         // of the section, above the storey's floor
constexpr double sameStorey_m = 1.0;  // floors that differ by less are one storey's
constexpr double margin_m = 0.8;
constexpr double largest_px = 1400.0;
constexpr double largestScale = 90.0;  // pixels a metre
constexpr std::array fills{"#cfe3f5", "#fbe3c0", "#d8efd0", "#f6d3d8", "#e5dbf3", "#fbf3b8", "#d0efec"};

constexpr const char* style =
    "<style>text{font:12px sans-serif;text-anchor:middle;fill:#222;paint-order:stroke;stroke:#fff;"
    "stroke-width:4px;stroke-opacity:.85;stroke-linejoin:round}.name{font-weight:bold;font-size:14px}"
    ".wall{stroke:#222;stroke-width:1.6}.thing{stroke:#aaa;stroke-width:.7}"
    ".pane{stroke:#0a6fd6;stroke-width:5;fill:#0a6fd6;fill-opacity:.25}"
    ".border{stroke:#d02020;stroke-width:3;stroke-dasharray:6 4}</style>\n";

struct Box {
  glm::dvec2 low{1e300}, high{-1e300};
  void add(const glm::dvec2& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
};

/// A storey's rooms and where they lie in the drawing.
struct Sheet {
  std::vector<std::size_t> rooms;
  double floor_m = 0.0;
  Box box;
  double scale = 1.0;  ///< pixels a metre

  [[nodiscard]] std::string point(const glm::dvec2& p, const char* x, const char* y) const {
    return std::string(" ") + x + "=\"" + shortNumber((p.x - box.low.x) * scale) + "\" " + y + "=\"" +
           shortNumber((box.high.y - p.y) * scale) + '"';
  }
  [[nodiscard]] std::string line(const char* kind, const glm::dvec2& a, const glm::dvec2& b) const {
    return std::string("<line class=\"") + kind + '"' + point(a, "x1", "y1") + point(b, "x2", "y2") + "/>\n";
  }
  [[nodiscard]] std::string text(const glm::dvec2& at, double down_px, const char* kind,
                                 const std::string& words) const {
    return std::string("<text class=\"") + kind + '"' +
           point(at - glm::dvec2(0.0, down_px / scale), "x", "y") + ">" + words + "</text>\n";
  }
};

std::vector<Sheet> sheetsOf(const Building& building) {
  std::vector<Sheet> sheets;
  std::vector<std::size_t> order(building.rooms.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return building.rooms[a].floor_m < building.rooms[b].floor_m;
  });
  for (const std::size_t room : order) {
    const double floor_m = building.rooms[room].floor_m;
    if (sheets.empty() || floor_m - sheets.back().floor_m > sameStorey_m) {
      sheets.push_back({.rooms = {}, .floor_m = floor_m, .box = {}});
    }
    sheets.back().rooms.push_back(room);
    for (const std::uint32_t piece : building.rooms[room].floorPieces) {
      for (const std::uint32_t corner : building.model.pieces.polygons[piece]) {
        sheets.back().box.add(building.model.pieces.points[corner]);
      }
    }
  }
  double widest_m = 1.0;
  for (Sheet& sheet : sheets) {
    sheet.box.low -= margin_m;
    sheet.box.high += margin_m;
    const glm::dvec2 size_m = sheet.box.high - sheet.box.low;
    widest_m = std::max({widest_m, size_m.x, size_m.y});
  }
  for (Sheet& sheet : sheets) sheet.scale = std::min(largestScale, largest_px / widest_m);
  return sheets;
}

std::string floorsSvg(const Building& building, const Sheet& sheet) {
  const Pieces& pieces = building.model.pieces;
  std::string svg;
  for (const std::size_t room : sheet.rooms) {
    std::string path;
    for (const std::uint32_t piece : building.rooms[room].floorPieces) {
      // All wound alike: surfaces that lie on each other would take each other away.
      const auto loop = pieces.polygons[piece];
      std::vector<std::uint32_t> corners(loop.begin(), loop.end());
      if (pieces.normal[piece].z < 0.0) std::reverse(corners.begin(), corners.end());
      char move = 'M';
      for (const std::uint32_t corner : corners) {
        const glm::dvec2 p = glm::dvec2(pieces.points[corner]) - sheet.box.low;
        path += move + shortNumber(p.x * sheet.scale) + ' ' +
                shortNumber((sheet.box.high.y - sheet.box.low.y - p.y) * sheet.scale);
        move = 'L';
      }
      path += 'Z';
    }
    svg += "<path fill=\"" + std::string(fills[room % fills.size()]) + "\" d=\"" + path + "\"/>\n";
  }
  return svg;
}

/// Where the storey's cut meets the pieces: dark where a room or the outside sees them.
std::string sectionSvg(const Building& building, const Sheet& sheet) {
  const Pieces& pieces = building.model.pieces;
  const double height_m = sheet.floor_m + cut_m;
  std::string svg;
  for (std::uint32_t piece = 0; piece < pieces.size(); ++piece) {
    const auto loop = pieces.polygons[piece];
    std::vector<glm::dvec2> met;
    for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
      const glm::dvec3& a = pieces.points[loop[j]];
      const glm::dvec3& b = pieces.points[loop[i]];
      if ((a.z < height_m) != (b.z < height_m))
        met.emplace_back(a + (height_m - a.z) / (b.z - a.z) * (b - a));
    }
    if (met.size() != 2) continue;
    const bool outside = glm::any(glm::lessThan(glm::max(met[0], met[1]), sheet.box.low)) ||
                         glm::any(glm::greaterThan(glm::min(met[0], met[1]), sheet.box.high));
    if (outside) continue;
    const bool bothSame = building.sideDomain[2 * piece] == building.sideDomain[2 * piece + 1];
    svg += sheet.line(bothSame ? "thing" : "wall", met[0], met[1]);
  }
  return svg;
}

/// Panes by the line of their largest extent in plan; roof lights by their outline.
std::string panesSvg(const Building& building, const Sheet& sheet) {
  const Pieces& pieces = building.model.pieces;
  std::string svg;
  for (const Portal& portal : building.portals) {
    if (std::find(sheet.rooms.begin(), sheet.rooms.end(), static_cast<std::size_t>(portal.room)) ==
        sheet.rooms.end()) {
      continue;
    }
    const auto loop = pieces.polygons[portal.piece];
    for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
      svg += sheet.line("pane", pieces.points[loop[j]], pieces.points[loop[i]]);
    }
  }
  for (const RoomBorder& border : building.borders) {
    const auto a = static_cast<std::size_t>(border.rooms[0]);
    if (std::find(sheet.rooms.begin(), sheet.rooms.end(), a) == sheet.rooms.end()) continue;
    for (std::size_t i = 1; i < border.line_m.size(); ++i)
      svg += sheet.line("border", border.line_m[i - 1], border.line_m[i]);
  }
  return svg;
}

std::string namesSvg(const Building& building, const Sheet& sheet) {
  const Pieces& pieces = building.model.pieces;
  std::string svg;
  for (const std::size_t index : sheet.rooms) {
    const Room& room = building.rooms[index];
    glm::dvec2 middle(0.0);
    double area_m2 = 0.0;
    for (const std::uint32_t piece : room.floorPieces) {
      glm::dvec2 centre(0.0);
      for (const std::uint32_t corner : pieces.polygons[piece]) centre += glm::dvec2(pieces.points[corner]);
      middle += pieces.area_m2[piece] / static_cast<double>(pieces.polygons[piece].size()) * centre;
      area_m2 += pieces.area_m2[piece];
    }
    middle /= std::max(area_m2, 1e-9);
    const auto panes = std::count_if(building.portals.begin(), building.portals.end(), [&](const Portal& p) {
      return p.room == static_cast<std::int32_t>(index);
    });
    svg += sheet.text(middle, 0.0, "name", escapeHtml(room.name));
    svg += sheet.text(middle, 16.0, "", fixedNumber(room.floorArea_m2, 2) + " m²");
    svg += sheet.text(middle, 31.0, "", std::to_string(panes) + (panes == 1 ? " pane" : " panes"));
  }
  return svg;
}

}  // namespace

std::vector<StoreyPlan> storeyPlans(const Building& building) {
  std::vector<StoreyPlan> plans;
  for (const Sheet& sheet : sheetsOf(building)) {
    const glm::dvec2 size_px = sheet.scale * (sheet.box.high - sheet.box.low);
    const std::string width = shortNumber(size_px.x);
    const std::string height = shortNumber(size_px.y);
    std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height +
                      "\" viewBox=\"0 0 " + width + " " + height +
                      "\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" + style;
    svg += floorsSvg(building, sheet) + sectionSvg(building, sheet) + panesSvg(building, sheet) +
           namesSvg(building, sheet);
    svg += "</svg>\n";
    plans.push_back({sheet.floor_m, std::move(svg)});
  }
  return plans;
}

}  // namespace clerestory
