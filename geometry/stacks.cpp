// SPDX-License-Identifier: GPL-3.0-or-later
// A convex piece covers one stretch of each row: of the row's middle line for what stands over cells, of all
// of the row for what may stop a level line.
#include "stacks.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace clerestory {
namespace {

constexpr double upright = 1e-3;  // a normal's z
constexpr double level = 0.9999;  // likewise
constexpr double aside = 1e-6;    // of a cell: rounding decides nothing

/// Corners of a piece in cells.
using Outline = std::vector<glm::dvec2>;

struct Stretch {
  double from = std::numeric_limits<double>::infinity();
  double to = -std::numeric_limits<double>::infinity();

  void hold(double x) {
    from = std::min(from, x);
    to = std::max(to, x);
  }
};

/// What an outline covers of the line at `y`.
Stretch alongLine(const Outline& outline, double y) {
  Stretch stretch;
  for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    const glm::dvec2& a = outline[j];
    const glm::dvec2& b = outline[i];
    if ((a.y <= y) != (b.y <= y)) stretch.hold(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
  }
  return stretch;
}

/// What an outline covers of the strip between two lines, its edges included.
Stretch alongStrip(const Outline& outline, double low, double high) {
  Stretch stretch;
  for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    const glm::dvec2& a = outline[j];
    const glm::dvec2& b = outline[i];
    if (b.y >= low && b.y <= high) stretch.hold(b.x);
    for (const double y : {low, high}) {
      if ((a.y < y) != (b.y < y)) stretch.hold(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
    }
  }
  return stretch;
}

/// Calls `visit` with each whole number from `from` to `to` that lies in [0, count).
template <class Visit>
void forEachWithin(double from, double to, std::uint32_t count, const Visit& visit) {
  if (!(from <= to) || to < 0.0 || from >= count) return;
  const auto last = static_cast<std::uint32_t>(std::min(std::floor(to), count - 1.0));
  for (auto i = static_cast<std::uint32_t>(std::ceil(std::max(from, 0.0))); i <= last; ++i) visit(i);
}

}  // namespace

bool isUpright(const Pieces& pieces, std::uint32_t piece) {
  return std::abs(pieces.normal[piece].z) < upright;
}

double heightOver(const Pieces& pieces, std::uint32_t piece, const glm::dvec2& place) {
  const glm::dvec3& normal = pieces.normal[piece];
  const glm::dvec3& corner = pieces.points[pieces.polygons[piece][0]];
  return corner.z - glm::dot(glm::dvec2(normal), place - glm::dvec2(corner)) / normal.z;
}

Stacks::Stacks(const Pieces& pieces, const PlanRaster& raster)
    : first_(raster.size() + 1, 0), mayStop_(raster.size(), false) {
  struct Entry {
    std::uint32_t cell;
    Meeting meeting;
  };
  std::vector<Entry> entries;
  Outline outline;
  for (std::uint32_t piece = 0; piece < pieces.size(); ++piece) {
    outline.clear();
    Stretch y;
    for (const std::uint32_t corner : pieces.polygons[piece]) {
      outline.push_back((raster.frame.toFrame(glm::dvec2(pieces.points[corner])) - raster.low) /
                        raster.cell_m);
      y.hold(outline.back().y);
    }
    if (!isUpright(pieces, piece)) {
      forEachWithin(y.from - 0.5, y.to - 0.5, raster.rows, [&](std::uint32_t row) {
        const Stretch x = alongLine(outline, row + 0.5);
        forEachWithin(x.from - 0.5, x.to - 0.5, raster.columns, [&](std::uint32_t column) {
          const std::uint32_t cell = row * raster.columns + column;
          entries.push_back({cell, {heightOver(pieces, piece, raster.middleOf(cell)), piece}});
          ++first_[cell + 1];
        });
      });
    }
    if (std::abs(pieces.normal[piece].z) > level) continue;
    forEachWithin(std::floor(y.from - aside), y.to + aside, raster.rows, [&](std::uint32_t row) {
      const Stretch x = alongStrip(outline, row - aside, row + 1.0 + aside);
      forEachWithin(std::floor(x.from - aside), x.to + aside, raster.columns,
                    [&](std::uint32_t column) { mayStop_[row * raster.columns + column] = true; });
    });
  }
  for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
  meetings_.resize(entries.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const Entry& entry : entries) meetings_[next[entry.cell]++] = entry.meeting;
  for (std::size_t cell = 0; cell + 1 < first_.size(); ++cell)
    std::stable_sort(meetings_.begin() + first_[cell], meetings_.begin() + first_[cell + 1],
                     [](const Meeting& a, const Meeting& b) { return a.height_m < b.height_m; });
}

}  // namespace clerestory
