// SPDX-License-Identifier: GPL-3.0-or-later
// Draws a grid's plan as a picture, for slides and documents.
#include <algorithm>
#include <cmath>

#include "numbers.hpp"
#include "plan.hpp"

namespace clerestory {
namespace {

constexpr DisplayColour paper = {255, 255, 255};
constexpr DisplayColour wall = {120, 116, 110};
constexpr DisplayColour floorGrey = {236, 234, 230};
constexpr DisplayColour glass = {70, 150, 200};
constexpr DisplayColour ink = {40, 38, 35};
constexpr int legendHeight_px = 96;
constexpr int leastWidth_px = 560;

/// Where metres lie in the picture.
struct Sheet {
  const Plan& plan;
  double scale, left;
  [[nodiscard]] glm::dvec2 at(const glm::dvec2& metres) const {
    return {left + (metres.x - plan.low_m.x) * scale, (plan.high_m.y - metres.y) * scale};
  }
};

/// Positive where `p` lies within the convex polygon, else the negative distance to the worst of its edges.
double depthInside(const std::vector<glm::dvec2>& polygon, const glm::dvec2& p) {
  double turn = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2& a = polygon[i];
    const glm::dvec2& b = polygon[(i + 1) % polygon.size()];
    turn += a.x * b.y - a.y * b.x;
  }
  double depth = 1e30;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2& a = polygon[i];
    const glm::dvec2 edge = polygon[(i + 1) % polygon.size()] - a;
    const double length = std::hypot(edge.x, edge.y);
    if (length < 1e-9) continue;
    const double side = (edge.x * (p.y - a.y) - edge.y * (p.x - a.x)) / length;
    depth = std::min(depth, turn >= 0.0 ? side : -side);
  }
  return depth;
}

/// Paints where a convex polygon, grown by `around` pixels, covers the centres of pixels.
void paintConvex(DisplayImage& image, const std::vector<glm::dvec2>& polygon, double around,
                 const DisplayColour& colour) {
  glm::dvec2 low(1e30);
  glm::dvec2 high(-1e30);
  for (const glm::dvec2& p : polygon) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const auto pixel = [](double at, int size) {
    return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(size)));
  };
  for (int y = pixel(low.y - around, image.height); y < pixel(high.y + around + 1.0, image.height); ++y) {
    for (int x = pixel(low.x - around, image.width); x < pixel(high.x + around + 1.0, image.width); ++x) {
      if (depthInside(polygon, {x + 0.5, y + 0.5}) > -around) image.fill(x, y, x + 1.0, y + 1.0, colour);
    }
  }
}

void paintLine(DisplayImage& image, const glm::dvec2& a, const glm::dvec2& b, double width,
               const DisplayColour& colour) {
  const glm::dvec2 along = b - a;
  const double length = std::hypot(along.x, along.y);
  if (length < 1e-9) return;
  const glm::dvec2 across = glm::dvec2(-along.y, along.x) * (0.5 * width / length);
  paintConvex(image, {a + across, a - across, b - across, b + across}, 0.0, colour);
}

void paintRoom(DisplayImage& image, const Sheet& sheet) {
  std::vector<std::vector<glm::dvec2>> pieces;
  for (const auto& piece : sheet.plan.floor_m) {
    pieces.emplace_back();
    for (const glm::dvec2& point : piece) pieces.back().push_back(sheet.at(point));
  }
  for (const auto& piece : pieces) paintConvex(image, piece, 0.12 * sheet.scale, wall);
  for (const auto& piece : pieces) paintConvex(image, piece, 0.0, floorGrey);
}

void paintSensors(DisplayImage& image, const Sheet& sheet, const SensorGrid& grid, const GridValues& values,
                  const PlanScale& scale) {
  const double half_m = 0.5 * sheet.plan.cell_m;
  for (std::size_t s = 0; s < grid.points.size(); ++s) {
    const glm::dvec2 centre(grid.points[s].x, grid.points[s].y);
    const glm::dvec2 low = sheet.at(centre + glm::dvec2(-half_m, half_m));
    const glm::dvec2 high = sheet.at(centre + glm::dvec2(half_m, -half_m));
    image.fill(low.x, low.y, high.x, high.y,
               falseColour(scale.fraction(values.sensors.at(s).illuminance_lx)));
  }
  for (const std::size_t s : labelledSensors(grid, sheet.plan, sheet.scale)) {
    const double lx = values.sensors[s].illuminance_lx;
    const glm::dvec2 at = sheet.at({grid.points[s].x, grid.points[s].y});
    drawText(image, static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y)) + 4,
             shortestFloat(std::round(lx)), 12, wantsBlackText(falseColour(scale.fraction(lx))) ? ink : paper,
             TextAlign::centre);
  }
}

void paintLegend(DisplayImage& image, const PlanScale& scale, int top, const std::string& name) {
  const int left = 30;
  const int width = std::min(image.width - 100, 640);
  for (int x = 0; x < width; ++x) {
    image.fill(left + x, top + 30, left + x + 1, top + 46, falseColour((x + 0.5) / width));
  }
  drawText(image, left, top + 18, name, 16, ink, TextAlign::left);
  for (const double tick : scale.ticks_lx) {
    const int x = left + static_cast<int>(std::lround(width * scale.fraction(tick)));
    drawText(image, x, top + 66, shortestFloat(tick), 14, ink, TextAlign::centre);
  }
  drawText(image, left + width + 26, top + 66, "lx", 14, ink, TextAlign::left);
}

}  // namespace

DisplayImage planPicture(const ReportInput& input, std::size_t g, const PlanScale& scale) {
  const SensorGrid& grid = input.building.grids.at(g);
  const Plan plan = planOf(input.building, grid);
  const double width_m = plan.high_m.x - plan.low_m.x;
  const double height_m = plan.high_m.y - plan.low_m.y;
  const double pixelsPerMetre = std::min({1100.0 / width_m, 1100.0 / height_m, 200.0});
  const int width = std::max(leastWidth_px, static_cast<int>(std::lround(width_m * pixelsPerMetre)));
  const int height = std::max(1, static_cast<int>(std::lround(height_m * pixelsPerMetre)));
  const Sheet sheet{plan, pixelsPerMetre, 0.5 * (width - width_m * pixelsPerMetre)};

  DisplayImage image(width, height + legendHeight_px, paper);
  paintRoom(image, sheet);
  paintSensors(image, sheet, grid, input.solution.grids.at(g), scale);
  for (const PlanWindow& window : plan.windows) {
    for (std::size_t i = 0; i + 1 < window.points_m.size(); ++i) {
      paintLine(image, sheet.at(window.points_m[i]), sheet.at(window.points_m[i + 1]), 5.0, glass);
    }
  }
  paintLegend(image, scale, height, grid.name);
  return image;
}

}  // namespace clerestory
