// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of a plane by cutting one outline at another, layers by the places of their corners.
#include "overlaps.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "cut.hpp"

namespace clerestory {
namespace {

constexpr double same_m = 1e-5;  // between planes

using Place = std::array<long, 3>;  // in steps of 10 µm

struct Box {
  glm::dvec3 low{1e300}, high{-1e300};
};

Box boxOf(const Pieces& pieces, std::uint32_t piece) {
  Box box;
  for (const std::uint32_t corner : pieces.polygons[piece]) {
    box.low = glm::min(box.low, pieces.points[corner] - same_m);
    box.high = glm::max(box.high, pieces.points[corner] + same_m);
  }
  return box;
}

/// What two convex polygons of one plane share, and the parts of the first that are left.
struct Overlap {
  Polygon shared;
  std::vector<Polygon> rest;
};

Overlap overlapOf(const Polygon& polygon, const Polygon& window, const glm::dvec3& windowNormal) {
  Overlap overlap{polygon, {}};
  for (std::size_t i = 0, j = window.size() - 1; i < window.size() && !overlap.shared.empty(); j = i++) {
    const glm::dvec3 inward = glm::normalize(glm::cross(windowNormal, window[i] - window[j]));
    Parts parts = partAt(overlap.shared, window[j], inward);
    if (parts.back.size() >= 3) overlap.rest.push_back(std::move(parts.back));
    overlap.shared = parts.front.size() >= 3 ? std::move(parts.front) : Polygon();
  }
  return overlap;
}

}  // namespace

Overlaps::Overlaps(const Pieces& pieces, std::span<const std::uint32_t> among, double least_m2,
                   const std::function<bool(std::uint32_t, std::uint32_t)>& count)
    : pieces_(pieces), least_m2_(least_m2), cellsOf_(pieces.size()) {
  std::vector<std::uint32_t> order;
  std::vector<Box> boxes(pieces.size());
  for (const std::uint32_t piece : among) {
    if (pieces.area_m2[piece] < least_m2) continue;
    order.push_back(piece);
    boxes[piece] = boxOf(pieces, piece);
  }
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return boxes[a].low.x != boxes[b].low.x ? boxes[a].low.x < boxes[b].low.x : a < b;
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Box& box = boxes[order[i]];
    for (std::size_t j = i + 1; j < order.size() && boxes[order[j]].low.x <= box.high.x; ++j) {
      const Box& other = boxes[order[j]];
      const bool areApart =
          glm::any(glm::lessThan(other.high, box.low)) || glm::any(glm::lessThan(box.high, other.low));
      if (!areApart && areInOnePlane(order[i], order[j]) && count(order[i], order[j]))
        cut(order[i], order[j]);
    }
  }
}

std::vector<Polygon> Overlaps::partsOf(std::uint32_t piece, const Polygon& whole) const {
  if (cellsOf_[piece].size() < 2) return {whole};
  std::vector<Polygon> parts;
  for (const std::size_t cell : cellsOf_[piece]) {
    Polygon& part = parts.emplace_back(cells_[cell].polygon);
    if (glm::dot(pieces_.normal[piece], pieces_.normal[cells_[cell].pieces[0]]) < 0.0)
      std::reverse(part.begin(), part.end());
  }
  return parts;
}

bool Overlaps::areInOnePlane(std::uint32_t a, std::uint32_t b) const {
  constexpr double parallel = 1e-4;  // rad
  const glm::dvec3& normal = pieces_.normal[a];
  if (glm::length(glm::cross(normal, pieces_.normal[b])) > parallel) return false;
  const glm::dvec3& onPlane = pieces_.points[pieces_.polygons[a][0]];
  return std::ranges::all_of(pieces_.polygons[b], [&](std::uint32_t corner) {
    return std::abs(glm::dot(pieces_.points[corner] - onPlane, normal)) <= same_m;
  });
}

void Overlaps::makeCell(std::uint32_t piece) {
  if (cellsOf_[piece].empty()) add({polygonOf(pieces_, piece), {piece}});
}

void Overlaps::add(Cell cell) {
  for (const std::uint32_t piece : cell.pieces) cellsOf_[piece].push_back(cells_.size());
  cells_.push_back(std::move(cell));
}

void Overlaps::cut(std::uint32_t a, std::uint32_t b) {
  makeCell(a);
  makeCell(b);
  // Further cells of both are made on the way; they share nothing with those that made them.
  for (std::size_t i = 0; i < cellsOf_[a].size(); ++i) {
    for (std::size_t j = 0; j < cellsOf_[b].size(); ++j)
      if (cellsOf_[a][i] != cellsOf_[b][j]) cutCells(cellsOf_[a][i], cellsOf_[b][j]);
  }
}

void Overlaps::cutCells(std::size_t first, std::size_t second) {
  const Cell one = cells_[first];
  const Cell other = cells_[second];
  Overlap ofOne = overlapOf(one.polygon, other.polygon, pieces_.normal[other.pieces[0]]);
  if (ofOne.shared.empty() || areaOf(ofOne.shared) < least_m2_) return;
  Overlap ofOther = overlapOf(other.polygon, one.polygon, pieces_.normal[one.pieces[0]]);
  cells_[first].polygon = std::move(ofOne.shared);
  for (const std::uint32_t piece : other.pieces) {
    std::ranges::replace(cellsOf_[piece], second, first);
    cells_[first].pieces.push_back(piece);
  }
  cells_[second] = {};
  for (Polygon& rest : ofOne.rest) add({std::move(rest), one.pieces});
  for (Polygon& rest : ofOther.rest) add({std::move(rest), other.pieces});
}

void cutOverlaps(Building& building, const Overlaps& overlaps) {
  const std::size_t before = building.model.pieces.size();
  const std::vector<std::uint32_t> wholeOf =
      divide(building.model.pieces,
             [&](std::uint32_t piece, const Polygon& whole) { return overlaps.partsOf(piece, whole); });
  if (wholeOf.size() != before) followCut(building, before, wholeOf);
}

std::vector<std::vector<std::uint32_t>> layersOf(const CleanModel& model) {
  constexpr double stepsPerMetre = 1e5;
  const Pieces& pieces = model.pieces;
  std::map<std::vector<Place>, std::vector<std::uint32_t>> byCorners;
  for (std::uint32_t piece = 0; piece < pieces.size(); ++piece) {
    if (model.materials[pieces.material[piece]].glazing) continue;
    std::vector<Place> corners;
    for (const std::uint32_t corner : pieces.polygons[piece]) {
      const glm::dvec3 steps = stepsPerMetre * pieces.points[corner];
      corners.push_back({std::lround(steps.x), std::lround(steps.y), std::lround(steps.z)});
    }
    std::sort(corners.begin(), corners.end());
    byCorners[std::move(corners)].push_back(piece);
  }
  std::vector<std::vector<std::uint32_t>> layers;
  for (auto& [corners, list] : byCorners)
    if (list.size() > 1) layers.push_back(std::move(list));
  return layers;
}

glm::dvec3 drawnNormal(const Pieces& pieces, std::uint32_t piece) {
  return pieces.isDrawnForBack[piece] ? -pieces.normal[piece] : pieces.normal[piece];
}

void move(Pieces& pieces, std::uint32_t piece, const glm::dvec3& way_m) {
  for (std::uint32_t i = pieces.polygons.begin[piece]; i < pieces.polygons.begin[piece + 1]; ++i) {
    std::uint32_t& corner = pieces.polygons.corners[i];
    const glm::dvec3 place = pieces.points[corner] + way_m;
    corner = static_cast<std::uint32_t>(pieces.points.size());
    pieces.points.push_back(place);
  }
}

void darken(Building& building, std::uint32_t side) {
  std::int32_t& domain = building.sideDomain[side];
  if (domain >= 0)
    building.domains[static_cast<std::size_t>(domain)].area_m2 -= building.model.pieces.area_m2[side / 2];
  domain = -1;
  building.sideRoom[side] = -1;
}

}  // namespace clerestory
