// SPDX-License-Identifier: GPL-3.0-or-later
// Corners that a part has from its whole keep their number, others become points of their own.
#include "parts.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace clerestory {

Polygon polygonOf(const Pieces& pieces, std::uint32_t piece) {
  Polygon polygon;
  for (const std::uint32_t corner : pieces.polygons[piece]) polygon.push_back(pieces.points[corner]);
  return polygon;
}

namespace {

/// Along the normal.
glm::dvec3 areaVector(const Polygon& polygon) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    sum += glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  }
  return 0.5 * sum;
}

}  // namespace

double areaOf(const Polygon& polygon) {
  return glm::length(areaVector(polygon));
}

double areaAlong(const glm::dvec3& normal, const Polygon& polygon) {
  return std::abs(glm::dot(areaVector(polygon), normal));
}

Parts partAt(const Polygon& polygon, const glm::dvec3& onPlane, const glm::dvec3& normal) {
  Parts parts;
  const auto height = [&](const glm::dvec3& point) {
    const double h = glm::dot(point - onPlane, normal);
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

std::vector<std::uint32_t> divide(
    Pieces& pieces,
    const std::function<std::vector<Polygon>(std::uint32_t piece, const Polygon& whole)>& partsOf) {
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
      result.isDrawnForBack.push_back(pieces.isDrawnForBack[piece]);
      wholeOf.push_back(piece);
    };
    const Polygon whole = polygonOf(pieces, piece);
    const std::vector<Polygon> parts = partsOf(piece, whole);
    if (parts.size() == 1) {
      keep(pieces.polygons[piece], pieces.area_m2[piece]);
      continue;
    }
    for (const Polygon& part : parts) {
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
      keep(corners, areaAlong(pieces.normal[piece], part));
    }
  }
  pieces = std::move(result);
  return wholeOf;
}

}  // namespace clerestory
