// SPDX-License-Identifier: GPL-3.0-or-later
// A reveal is one quad in most models, yet its half before the glass is outdoors: it is split where the glass
// meets it.
#include "cut.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "parts.hpp"

namespace clerestory {
namespace {

constexpr double offPlane_m = 0.001;   // a part thinner than this stays with its other half
constexpr double frameReach_m = 0.15;  // between a pane and its reveal stands a frame of up to this width
constexpr double wallReach_m = 0.005;  // a wall that ends a little above the floor
constexpr double doorReach_m = 0.02;   // a door's frame stands in its cut
constexpr double overlapMin_m = 0.005;
constexpr double crossingLeast_m = 0.1;   // length of the line along which two surfaces cross
constexpr double crossingDepth_m = 0.03;  // on either side of both
constexpr double partitionLeast_m = 0.6;  // length and height of what stands on a surface and parts it
constexpr double parallelLeast = 0.95;    // cosine of the angle between planes

/// A polygon that others are cut at, in its plane.
struct Cutter {
  Polygon corners;  // counterclockwise about the normal
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

bool mustBeCut(const Polygon& polygon, const Cutter& pane) {
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

std::vector<Polygon> cutByAll(const Polygon& whole, std::span<const Cutter* const> cutters) {
  std::vector<Polygon> parts{whole};
  for (const Cutter* cutter : cutters) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (!mustBeCut(parts[i], *cutter)) continue;
      Parts halves = partAt(parts[i], cutter->corners[0], cutter->normal);
      if (halves.cut.size() < 2 || halves.front.size() < 3 || halves.back.size() < 3) continue;
      if (overlap(*cutter, halves.cut.front(), halves.cut.back()) < overlapMin_m) continue;
      parts[i] = std::move(halves.front);
      parts.push_back(std::move(halves.back));
    }
  }
  return parts;
}

/// How far the polygon reaches on either side of the other one's plane: before it and behind it. [m]
std::pair<double, double> reachOf(const Cutter& polygon, const Cutter& plane) {
  double before_m = 0.0;
  double behind_m = 0.0;
  for (const glm::dvec3& corner : polygon.corners) {
    const double height = glm::dot(corner - plane.corners[0], plane.normal);
    before_m = std::max(before_m, height);
    behind_m = std::max(behind_m, -height);
  }
  return {before_m, behind_m};
}

/// Length along which the other polygon, grown by its reach, touches this one. [m]
double lineOfContact(const Cutter& polygon, const Cutter& other) {
  const Parts halves = partAt(polygon.corners, other.corners[0], other.normal);
  if (halves.cut.size() < 2) return 0.0;
  return overlap(other, halves.cut.front(), halves.cut.back());
}

glm::dvec3 middleOfContact(const Cutter& polygon, const Cutter& other) {
  const Parts halves = partAt(polygon.corners, other.corners[0], other.normal);
  const glm::dvec3 low = glm::max(glm::min(halves.cut.front(), halves.cut.back()), other.low);
  const glm::dvec3 high = glm::min(glm::max(halves.cut.front(), halves.cut.back()), other.high);
  return 0.5 * (low + high);
}

/// Whether both reach through each other by more than inaccurate drawing does.
bool runsThrough(const Cutter& a, const Cutter& b) {
  const auto [before, behind] = reachOf(a, b);
  const auto [otherBefore, otherBehind] = reachOf(b, a);
  return std::min(std::min(before, behind), std::min(otherBefore, otherBehind)) >= crossingDepth_m;
}

/// Whether light on the two sides of `other` differs on `polygon`: it runs through or stands on it.
bool isMetBy(const Cutter& polygon, const Cutter& other, double length_m) {
  const auto [before, behind] = reachOf(polygon, other);
  if (std::min(before, behind) < crossingDepth_m) return false;
  const auto [otherBefore, otherBehind] = reachOf(other, polygon);
  return std::min(otherBefore, otherBehind) >= crossingDepth_m ||
         (length_m >= partitionLeast_m && std::max(otherBefore, otherBehind) >= partitionLeast_m);
}

bool shareAir(const std::vector<std::int32_t>& sideDomain, std::uint32_t a, std::uint32_t b) {
  for (const std::uint32_t side : {2 * a, 2 * a + 1}) {
    const std::int32_t domain = sideDomain[side];
    if (domain >= 0 && (domain == sideDomain[2 * b] || domain == sideDomain[2 * b + 1])) return true;
  }
  return false;
}

/// Calls `visit` with each pair whose boxes meet, of polygons that are longer than a line that counts.
template <class Visit>
void forEachPairThatMeets(const std::vector<Cutter>& all, const Visit& visit) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    if (glm::length(all[i].high - all[i].low) >= crossingLeast_m) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return all[a].low.x != all[b].low.x ? all[a].low.x < all[b].low.x : a < b;
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Cutter& a = all[order[i]];
    for (std::size_t j = i + 1; j < order.size() && all[order[j]].low.x <= a.high.x; ++j) {
      const Cutter& b = all[order[j]];
      if (a.low.y <= b.high.y && b.low.y <= a.high.y && a.low.z <= b.high.z && b.low.z <= a.high.z)
        visit(order[i], order[j]);
    }
  }
}

/// Cuts each piece at the cutters that `cuttersOf` gives for it. The canonical order is kept. Returns the
/// piece that each of the new ones is a part of.
template <class CuttersOf>
std::vector<std::uint32_t> cutPieces(Pieces& pieces, const CuttersOf& cuttersOf) {
  return divide(pieces, [&](std::uint32_t piece, const Polygon& whole) {
    const std::vector<const Cutter*>& cutters = cuttersOf(piece);
    return cutByAll(whole, cutters);
  });
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

std::vector<std::uint32_t> cutWhereMet(Pieces& pieces, const std::vector<bool>& inTwoAirs,
                                       const std::vector<bool>& partAirs) {
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
      if (other != piece && partAirs[other] && !apart && !isParallel) cutters.push_back(&all[other]);
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

std::vector<std::uint32_t> cutWhereCrossed(Pieces& pieces, const std::vector<Material>& materials,
                                           const std::vector<std::int32_t>& sideDomain,
                                           std::vector<Crossing>& crossings) {
  std::vector<Cutter> all;
  for (std::uint32_t piece = 0; piece < pieces.size(); ++piece)
    all.push_back(cutterOf(pieces, piece, wallReach_m));
  std::vector<std::vector<const Cutter*>> cuttersOf(pieces.size());
  const auto tryCut = [&](std::uint32_t piece, std::uint32_t other) {
    const double length_m = lineOfContact(all[piece], all[other]);
    if (length_m < crossingLeast_m || !isMetBy(all[piece], all[other], length_m)) return;
    cuttersOf[piece].push_back(&all[other]);
    if (!runsThrough(all[piece], all[other])) return;
    crossings.push_back({piece, middleOfContact(all[piece], all[other]), length_m});
  };
  forEachPairThatMeets(all, [&](std::uint32_t a, std::uint32_t b) {
    const bool isGlass = materials[pieces.material[a]].glazing || materials[pieces.material[b]].glazing;
    if (isGlass || !shareAir(sideDomain, a, b)) return;
    if (std::abs(glm::dot(all[a].normal, all[b].normal)) > parallelLeast) return;
    tryCut(a, b);
    tryCut(b, a);
  });
  return cutPieces(pieces, [&](std::uint32_t piece) -> const std::vector<const Cutter*>& {
    std::sort(cuttersOf[piece].begin(), cuttersOf[piece].end());  // by number
    return cuttersOf[piece];
  });
}

void followCut(Building& building, std::size_t before, std::span<const std::uint32_t> wholeOf) {
  std::vector<std::uint32_t> partOf(before);  // glass is not cut: its only part
  std::vector<std::int32_t> sideDomain;
  std::vector<std::int32_t> sideRoom;  // none before rooms are known
  std::vector<bool> innerGlass;
  for (std::uint32_t piece = 0; piece < wholeOf.size(); ++piece) {
    partOf[wholeOf[piece]] = piece;
    sideDomain.push_back(building.sideDomain[2 * wholeOf[piece]]);
    sideDomain.push_back(building.sideDomain[2 * wholeOf[piece] + 1]);
    for (std::uint32_t side = 2 * wholeOf[piece]; side < 2 * wholeOf[piece] + 2 && !building.sideRoom.empty();
         ++side)
      sideRoom.push_back(building.sideRoom[side]);
    innerGlass.push_back(building.innerGlass[wholeOf[piece]]);
  }
  for (Room& room : building.rooms) {
    std::vector<std::uint32_t> floorPieces;
    for (const std::uint32_t whole : room.floorPieces) {
      const auto parts = std::ranges::equal_range(wholeOf, whole);
      for (auto part = parts.begin(); part != parts.end(); ++part)
        floorPieces.push_back(static_cast<std::uint32_t>(part - wholeOf.begin()));
    }
    room.floorPieces = std::move(floorPieces);
  }
  building.sideDomain = std::move(sideDomain);
  building.sideRoom = std::move(sideRoom);
  building.innerGlass = std::move(innerGlass);
  for (Portal& portal : building.portals) portal.piece = partOf[portal.piece];
}

}  // namespace clerestory
