// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs by the places of their corners; the winding that a domain sees by area.
#include "backtoback.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include <geometry/rays.hpp>

#include "cut.hpp"
#include "parts.hpp"

namespace clerestory {
namespace {

constexpr double apart_m = rayOffset_m;  // that each of a pair gives way

using Pair = std::array<std::uint32_t, 2>;
using Place = std::array<long, 3>;  // in steps of 10 µm

/// Unit normal of the side that a piece is drawn for.
glm::dvec3 drawnNormal(const Pieces& pieces, std::uint32_t piece) {
  return pieces.isDrawnForBack[piece] ? -pieces.normal[piece] : pieces.normal[piece];
}

/// Opaque pieces with the same corners that are drawn for opposite sides.
std::vector<Pair> pairsOf(const CleanModel& model) {
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
  std::vector<Pair> pairs;
  for (const auto& [corners, list] : byCorners) {
    if (list.size() == 2 && glm::dot(drawnNormal(pieces, list[0]), drawnNormal(pieces, list[1])) < 0.0)
      pairs.push_back({list[0], list[1]});
  }
  return pairs;
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

/// Pieces on their way to pairs: the parts of each, and which of them have found their partner.
class Overlaps {
 public:
  explicit Overlaps(const Building& building) : building_(building), parts_(building.model.pieces.size()) {
    const Pieces& pieces = building.model.pieces;
    std::vector<std::uint32_t> order;
    for (std::uint32_t piece = 0; piece < pieces.size(); ++piece) {
      if (pieces.area_m2[piece] >= sharedLeast_m2 && isBetweenLights(piece)) order.push_back(piece);
    }
    std::vector<Box> boxes(pieces.size());
    for (const std::uint32_t piece : order) boxes[piece] = boxOf(pieces, piece);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return boxes[a].low.x != boxes[b].low.x ? boxes[a].low.x < boxes[b].low.x : a < b;
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Box& box = boxes[order[i]];
      for (std::size_t j = i + 1; j < order.size() && boxes[order[j]].low.x <= box.high.x; ++j) {
        const Box& other = boxes[order[j]];
        const bool areApart =
            glm::any(glm::lessThan(other.high, box.low)) || glm::any(glm::lessThan(box.high, other.low));
        if (!areApart && areBackToBack(order[i], order[j])) part(order[i], order[j]);
      }
    }
  }

  /// The parts of a piece; none where it is whole.
  [[nodiscard]] std::vector<Polygon> partsOf(std::uint32_t piece) const {
    std::vector<Polygon> polygons;
    for (const Part& part : parts_[piece]) polygons.push_back(part.polygon);
    return polygons;
  }

 private:
  static constexpr double sharedLeast_m2 = 0.01;  ///< smaller ones are not worth a cut
  static constexpr double same_m = 1e-5;          ///< between planes

  struct Box {
    glm::dvec3 low{1e300}, high{-1e300};
  };
  struct Part {
    Polygon polygon;
    bool isPaired = false;
  };

  static Box boxOf(const Pieces& pieces, std::uint32_t piece) {
    Box box;
    for (const std::uint32_t corner : pieces.polygons[piece]) {
      box.low = glm::min(box.low, pieces.points[corner] - same_m);
      box.high = glm::max(box.high, pieces.points[corner] + same_m);
    }
    return box;
  }

  [[nodiscard]] bool isBetweenLights(std::uint32_t piece) const {
    if (building_.model.materials[building_.model.pieces.material[piece]].glazing) return false;
    return std::ranges::all_of(std::array{2 * piece, 2 * piece + 1}, [&](std::uint32_t side) {
      const std::int32_t domain = building_.sideDomain[side];
      return domain >= 0 && building_.domains[static_cast<std::size_t>(domain)].lit;
    });
  }

  [[nodiscard]] bool areBackToBack(std::uint32_t a, std::uint32_t b) const {
    constexpr double parallel = 1e-4;  // rad
    const Pieces& pieces = building_.model.pieces;
    const glm::dvec3 normal = drawnNormal(pieces, a);
    if (glm::length(normal + drawnNormal(pieces, b)) > parallel) return false;
    const glm::dvec3& onPlane = pieces.points[pieces.polygons[a][0]];
    return std::ranges::all_of(pieces.polygons[b], [&](std::uint32_t corner) {
      return std::abs(glm::dot(pieces.points[corner] - onPlane, normal)) <= same_m;
    });
  }

  /// Makes what two pieces share a part of both.
  void part(std::uint32_t a, std::uint32_t b) {
    const Pieces& pieces = building_.model.pieces;
    for (const std::uint32_t piece : {a, b})
      if (parts_[piece].empty()) parts_[piece].push_back({polygonOf(pieces, piece)});
    for (std::size_t i = 0; i < parts_[a].size(); ++i) {
      for (std::size_t j = 0; j < parts_[b].size(); ++j) {
        Part& first = parts_[a][i];
        Part& second = parts_[b][j];
        if (first.isPaired || second.isPaired) continue;
        Overlap ofFirst = overlapOf(first.polygon, second.polygon, pieces.normal[b]);
        if (ofFirst.shared.empty() || areaOf(ofFirst.shared) < sharedLeast_m2) continue;
        Overlap ofSecond = overlapOf(second.polygon, first.polygon, pieces.normal[a]);
        first = {ofFirst.shared, true};
        second = {std::move(ofFirst.shared), true};
        if (glm::dot(pieces.normal[a], pieces.normal[b]) < 0.0)
          std::reverse(second.polygon.begin(), second.polygon.end());
        for (Polygon& rest : ofFirst.rest) parts_[a].push_back({std::move(rest)});
        for (Polygon& rest : ofSecond.rest) parts_[b].push_back({std::move(rest)});
      }
    }
  }

  const Building& building_;
  std::vector<std::vector<Part>> parts_;  // #pieces; none of a whole one
};

/// By domain: area that is drawn for there, less that which is seen from behind. Pairs show both. [m²]
std::vector<double> drawnFor(const Building& building, const std::vector<Pair>& pairs) {
  const Pieces& pieces = building.model.pieces;
  std::vector<bool> isPaired(pieces.size(), false);
  for (const Pair& pair : pairs) isPaired[pair[0]] = isPaired[pair[1]] = true;
  std::vector<double> drawn_m2(building.domains.size(), 0.0);
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
    const std::int32_t domain = building.sideDomain[side];
    if (domain < 0 || isPaired[side / 2]) continue;
    const bool isDrawn = (side % 2 == 1) == pieces.isDrawnForBack[side / 2];
    drawn_m2[static_cast<std::size_t>(domain)] += (isDrawn ? 1.0 : -1.0) * pieces.area_m2[side / 2];
  }
  return drawn_m2;
}

void move(Pieces& pieces, std::uint32_t piece, const glm::dvec3& way_m) {
  for (std::uint32_t i = pieces.polygons.begin[piece]; i < pieces.polygons.begin[piece + 1]; ++i) {
    std::uint32_t& corner = pieces.polygons.corners[i];
    const glm::dvec3 place = pieces.points[corner] + way_m;
    corner = static_cast<std::uint32_t>(pieces.points.size());
    pieces.points.push_back(place);
  }
}

/// Takes a side out of its domain and room.
void darken(Building& building, std::uint32_t side) {
  std::int32_t& domain = building.sideDomain[side];
  if (domain >= 0)
    building.domains[static_cast<std::size_t>(domain)].area_m2 -= building.model.pieces.area_m2[side / 2];
  domain = -1;
  building.sideRoom[side] = -1;
}

}  // namespace

void cutBackToBack(Building& building) {
  const Overlaps overlaps(building);
  const std::size_t before = building.model.pieces.size();
  const std::vector<std::uint32_t> wholeOf =
      divide(building.model.pieces, [&](std::uint32_t piece, const Polygon& whole) {
        std::vector<Polygon> parts = overlaps.partsOf(piece);
        if (parts.empty()) parts.push_back(whole);
        return parts;
      });
  if (wholeOf.size() != before) followCut(building, before, wholeOf);
}

void partBackToBack(Building& building) {
  const std::vector<Pair> pairs = pairsOf(building.model);
  if (pairs.empty()) return;
  Pieces& pieces = building.model.pieces;
  const std::vector<double> drawn_m2 = drawnFor(building, pairs);
  /// The side that a piece is drawn for, or the one behind it.
  const auto sideOf = [&](std::uint32_t piece, bool isDrawn) {
    return 2 * piece + (isDrawn == pieces.isDrawnForBack[piece] ? 1U : 0U);
  };
  const auto drawnBefore = [&](std::uint32_t piece) {
    const std::int32_t domain = building.sideDomain[sideOf(piece, true)];
    return domain < 0 ? 0.0 : drawn_m2[static_cast<std::size_t>(domain)];
  };
  for (const auto& [a, b] : pairs) {
    // Before `a` it is seen as drawn and b from behind, behind it the other way round: where the first is the
    // rule on both sides each piece has the side that it is drawn for, else the other one.
    const bool areAsDrawn = drawnBefore(a) + drawnBefore(b) >= 0.0;
    darken(building, sideOf(a, !areAsDrawn));
    darken(building, sideOf(b, !areAsDrawn));
    const glm::dvec3 way_m = (areAsDrawn ? apart_m : -apart_m) * drawnNormal(pieces, a);
    move(pieces, a, way_m);
    move(pieces, b, -way_m);
  }
}

}  // namespace clerestory
