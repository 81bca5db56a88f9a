// SPDX-License-Identifier: GPL-3.0-or-later
// A reveal is one quad in most models, yet its half before the glass is outdoors: it is split where the glass
// meets it.
#include "cut.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace clerestory {
namespace {

constexpr double offPlane_m = 0.001;   // a part thinner than this stays with its other half
constexpr double frameReach_m = 0.15;  // between a pane and its reveal stands a frame of up to this width
constexpr double wallReach_m = 0.005;  // a wall that ends a little above the floor
constexpr double doorReach_m = 0.02;   // a door's frame stands in its cut
constexpr double overlapMin_m = 0.005;

/// A polygon that others are cut at, in its plane.
struct Cutter {
  std::vector<glm::dvec3> corners;  // counterclockwise about the normal
  glm::dvec3 normal;
  glm::dvec3 low, high;  // bounding box, grown by the reach
  double reach_m;        // how far beyond its outline it cuts
};

Cutter cutterOf(const Pieces& pieces, std::uint32_t piece, double reach_m) {
  Cutter pane{{}, pieces.normal[piece], glm::dvec3(1e300), glm::dvec3(-1e300), reach_m};
  for (const std::uint32_t corner : pieces.polygons[piece]) {
    pane.corners.push_back(pieces.points[corner]);
    pane.low = glm::min(pane.low, pieces.points[corner] - reach_m);
    pane.high = glm::max(pane.high, pieces.points[corner] + reach_m);
  }
  return pane;
}

/// Length of the part of a segment in the cutter's plane that lies within the cutter grown by its reach.
double overlap(const Cutter& pane, const glm::dvec3& a, const glm::dvec3& b) {
  double first = 0.0;
  double last = 1.0;
  for (std::size_t i = 0, j = pane.corners.size() - 1; i < pane.corners.size(); j = i++) {
    const glm::dvec3 inward = glm::normalize(glm::cross(pane.normal, pane.corners[i] - pane.corners[j]));
    const double from = glm::dot(a - pane.corners[j], inward) + pane.reach_m;
    const double to = glm::dot(b - pane.corners[j], inward) + pane.reach_m;
    if (from < 0.0 && to < 0.0) return 0.0;
    if (from < 0.0) first = std::max(first, from / (from - to));
    if (to < 0.0) last = std::min(last, from / (from - to));
  }
  return std::max(last - first, 0.0) * glm::length(b - a);
}

/// A convex polygon parted by a plane; `cut` holds the two points where its outline meets it.
struct Parts {
  std::vector<glm::dvec3> front, back, cut;
};

Parts partPolygon(const std::vector<glm::dvec3>& polygon, const Cutter& pane) {
  Parts parts;
  const auto height = [&](const glm::dvec3& point) {
    const double h = glm::dot(point - pane.corners[0], pane.normal);
    return std::abs(h) < 1e-7 ? 0.0 : h;
  };
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const double from = height(polygon[j]);
    const double to = height(polygon[i]);
    if (from * to < 0.0) {
      const glm::dvec3 point = polygon[j] + from / (from - to) * (polygon[i] - polygon[j]);
      parts.front.push_back(point);
      parts.back.push_back(point);
      parts.cut.push_back(point);
    }
    if (to >= 0.0) parts.front.push_back(polygon[i]);
    if (to <= 0.0) parts.back.push_back(polygon[i]);
    if (to == 0.0) parts.cut.push_back(polygon[i]);
  }
  return parts;
}

bool mustBeCut(const std::vector<glm::dvec3>& polygon, const Cutter& pane) {
  glm::dvec3 low(1e300);
  glm::dvec3 high(-1e300);
  double lowest = 1e300;
  double highest = -1e300;
  for (const glm::dvec3& corner : polygon) {
    low = glm::min(low, corner);
    high = glm::max(high, corner);
    const double height = glm::dot(corner - pane.corners[0], pane.normal);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  if (lowest > -offPlane_m || highest < offPlane_m) return false;
  return glm::all(glm::lessThanEqual(low, pane.high)) && glm::all(glm::lessThanEqual(pane.low, high));
}

double areaOf(const std::vector<glm::dvec3>& polygon) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    sum += glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  }
  return 0.5 * glm::length(sum);
}

std::vector<std::vector<glm::dvec3>> cutByAll(const std::vector<glm::dvec3>& whole,
                                              std::span<const Cutter* const> cutters) {
  std::vector<std::vector<glm::dvec3>> parts{whole};
  for (const Cutter* cutter : cutters) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (!mustBeCut(parts[i], *cutter)) continue;
      Parts halves = partPolygon(parts[i], *cutter);
      if (halves.cut.size() < 2 || halves.front.size() < 3 || halves.back.size() < 3) continue;
      if (overlap(*cutter, halves.cut.front(), halves.cut.back()) < overlapMin_m) continue;
      parts[i] = std::move(halves.front);
      parts.push_back(std::move(halves.back));
    }
  }
  return parts;
}

/// Cuts each piece at the cutters that `cuttersOf` gives for it. The canonical order is kept. Returns the
/// piece that each of the new ones is a part of.
template <class CuttersOf>
std::vector<std::uint32_t> cutPieces(Pieces& pieces, const CuttersOf& cuttersOf) {
  Pieces result;
  result.points = pieces.points;
  std::vector<std::uint32_t> wholeOf;
  for (std::uint32_t piece = 0; piece < pieces.size(); ++piece) {
    const auto keep = [&](std::span<const std::uint32_t> corners, double area_m2) {
      result.polygons.add(corners);
      result.normal.push_back(pieces.normal[piece]);
      result.area_m2.push_back(area_m2);
      result.polygon.push_back(pieces.polygon[piece]);
      result.surface.push_back(pieces.surface[piece]);
      result.material.push_back(pieces.material[piece]);
      wholeOf.push_back(piece);
    };
    std::vector<glm::dvec3> whole;
    for (const std::uint32_t corner : pieces.polygons[piece]) whole.push_back(pieces.points[corner]);
    const std::vector<const Cutter*>& cutters = cuttersOf(piece);
    const auto parts = cutByAll(whole, cutters);
    if (parts.size() == 1) {
      keep(pieces.polygons[piece], pieces.area_m2[piece]);
      continue;
    }
    for (const std::vector<glm::dvec3>& part : parts) {
      std::vector<std::uint32_t> corners;
      for (const glm::dvec3& point : part) {
        const auto same = std::find(whole.begin(), whole.end(), point);
        if (same != whole.end()) {
          corners.push_back(pieces.polygons[piece][static_cast<std::size_t>(same - whole.begin())]);
        } else {
          corners.push_back(static_cast<std::uint32_t>(result.points.size()));
          result.points.push_back(point);
        }
      }
      keep(corners, areaOf(part));
    }
  }
  pieces = std::move(result);
  return wholeOf;
}

}  // namespace

void cutAtPanes(Pieces& pieces, const std::vector<Material>& materials) {
  std::vector<Cutter> panes;
  for (std::uint32_t piece = 0; piece < pieces.size(); ++piece) {
    if (materials[pieces.material[piece]].glazing) panes.push_back(cutterOf(pieces, piece, frameReach_m));
  }
  if (panes.empty()) return;
  std::vector<const Cutter*> all;
  for (const Cutter& pane : panes) all.push_back(&pane);
  const std::vector<const Cutter*> none;
  cutPieces(pieces, [&](std::uint32_t piece) -> const std::vector<const Cutter*>& {
    return materials[pieces.material[piece]].glazing ? none : all;
  });
}

std::vector<std::uint32_t> cutWhereMet(Pieces& pieces, const std::vector<bool>& inTwoAirs) {
  std::vector<Cutter> all;
  for (std::uint32_t piece = 0; piece < pieces.size(); ++piece)
    all.push_back(cutterOf(pieces, piece, wallReach_m));
  return cutPieces(pieces, [&](std::uint32_t piece) {
    std::vector<const Cutter*> cutters;
    if (!inTwoAirs[piece]) return cutters;
    for (std::uint32_t other = 0; other < all.size(); ++other) {
      const bool apart = glm::any(glm::lessThan(all[other].high, all[piece].low)) ||
                         glm::any(glm::lessThan(all[piece].high, all[other].low));
      const bool isParallel = std::abs(glm::dot(all[other].normal, all[piece].normal)) > 0.999;
      if (other != piece && !apart && !isParallel) cutters.push_back(&all[other]);
    }
    return cutters;
  });
}

std::vector<std::uint32_t> cutUpright(Pieces& pieces, const std::vector<Material>& materials,
                                      const std::vector<std::int32_t>& sideDomain,
                                      const std::vector<UprightCut>& cuts) {
  std::vector<Cutter> cutters;
  for (const UprightCut& cut : cuts) {
    const glm::dvec3 up(0.0, 0.0, cut.height_m);
    Cutter cutter{{cut.from_m, cut.to_m, cut.to_m + up, cut.from_m + up},
                  glm::normalize(glm::cross(cut.to_m - cut.from_m, up)),
                  glm::dvec3(1e300),
                  glm::dvec3(-1e300),
                  doorReach_m};
    for (const glm::dvec3& corner : cutter.corners) {
      cutter.low = glm::min(cutter.low, corner - doorReach_m);
      cutter.high = glm::max(cutter.high, corner + doorReach_m);
    }
    cutters.push_back(std::move(cutter));
  }
  return cutPieces(pieces, [&](std::uint32_t piece) {
    std::vector<const Cutter*> chosen;
    if (materials[pieces.material[piece]].glazing) return chosen;
    for (std::size_t i = 0; i < cuts.size(); ++i) {
      if (sideDomain[2 * piece] == cuts[i].domain || sideDomain[2 * piece + 1] == cuts[i].domain)
        chosen.push_back(&cutters[i]);
    }
    return chosen;
  });
}

}  // namespace clerestory
