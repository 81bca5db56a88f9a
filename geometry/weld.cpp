// SPDX-License-Identifier: GPL-3.0-or-later
// Repair of single faces: points on a grid and welded, degenerate and repeated faces dropped, warped ones
// split.
#include "weld.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "dividing.hpp"
#include "triangulate.hpp"

namespace clerestory {
namespace {

/// Kept points in cells as wide as the weld tolerance.
class NearPoints {
 public:
  explicit NearPoints(double tolerance_m) : tolerance_m_(tolerance_m) {}

  void add(const glm::dvec3& point, std::uint32_t index) {
    cells_[key(cell(point))].push_back({point, index});
  }

  /// The nearest point within the tolerance (the first of equals), or `none`.
  [[nodiscard]] std::uint32_t nearest(const glm::dvec3& point) const {
    const Cell centre = cell(point);
    double best = tolerance_m_ - same_m;
    std::uint32_t result = none;
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        for (std::int64_t dz = -1; dz <= 1; ++dz) {
          const auto found = cells_.find(key({centre.x + dx, centre.y + dy, centre.z + dz}));
          if (found == cells_.end()) continue;
          for (const auto& [position, index] : found->second) {
            const double distance = glm::length(position - point);
            const bool isNearer = distance < best - same_m;
            const bool isFirst = result != none && distance < best + same_m && index < result;
            if (isNearer || isFirst) {
              best = distance;
              result = index;
            }
          }
        }
      }
    }
    return result;
  }

  static constexpr std::uint32_t none = 0xffffffffU;

 private:
  struct Cell {
    std::int64_t x, y, z;
  };
  [[nodiscard]] Cell cell(const glm::dvec3& point) const {
    const auto along = [&](double value) {
      return static_cast<std::int64_t>(std::floor(value / tolerance_m_));
    };
    return {along(point.x), along(point.y), along(point.z)};
  }
  /// Cells that share a key are told apart by the distance test.
  static std::uint64_t key(const Cell& c) {
    return static_cast<std::uint64_t>(c.x) * 0x9e3779b97f4a7c15U ^
           static_cast<std::uint64_t>(c.y) * 0xc2b2ae3d27d4eb4fU ^
           static_cast<std::uint64_t>(c.z) * 0x165667b19e3779f9U;
  }

  static constexpr double same_m = 1e-7;  ///< distances that rounding alone tells apart
  double tolerance_m_;
  std::unordered_map<std::uint64_t, std::vector<std::pair<glm::dvec3, std::uint32_t>>> cells_;
};

/// Calls `keep(corners)` for each face, which may change the corners or return false to drop the face.
template <class Keep>
void filterFaces(Soup& soup, Keep keep) {
  PolygonList faces;
  std::size_t kept = 0;
  Loop corners;
  for (std::size_t face = 0; face < soup.faces.size(); ++face) {
    corners.assign(soup.faces[face].begin(), soup.faces[face].end());
    if (!keep(face, corners)) continue;
    faces.add(corners);
    soup.material[kept] = soup.material[face];
    soup.object[kept] = soup.object[face];
    soup.drawn[kept] = soup.drawn[face];
    soup.bentFrom[kept] = soup.bentFrom[face];
    ++kept;
  }
  soup.faces = std::move(faces);
  soup.material.resize(kept);
  soup.object.resize(kept);
  soup.drawn.resize(kept);
  soup.bentFrom.resize(kept);
}

/// Drops corners that repeat the one before, and spikes that go out and back on one edge.
void dropRepeatedCorners(Loop& corners) {
  bool changed = true;
  while (changed && corners.size() >= 3) {
    changed = false;
    Loop kept;
    for (const std::uint32_t corner : corners) {
      if (!kept.empty() && kept.back() == corner) continue;
      if (kept.size() >= 2 && kept[kept.size() - 2] == corner) {
        kept.pop_back();
        continue;
      }
      kept.push_back(corner);
    }
    while (kept.size() >= 2 && kept.front() == kept.back()) kept.pop_back();
    while (kept.size() >= 3 && kept[kept.size() - 2] == kept.front()) kept.pop_back();
    while (kept.size() >= 3 && kept[1] == kept.back()) kept.erase(kept.begin());
    changed = kept.size() != corners.size();
    corners = std::move(kept);
  }
}

double longestEdge_m(std::span<const glm::dvec3> points, std::span<const std::uint32_t> loop) {
  double longest = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    longest = std::max(longest, glm::length(points[loop[(i + 1) % loop.size()]] - points[loop[i]]));
  }
  return longest;
}

/// Largest distance of a corner from the plane through the corners' mean. [m]
double warp_m(std::span<const glm::dvec3> points, std::span<const std::uint32_t> loop,
              const glm::dvec3& unitNormal) {
  double low = 1e300;
  double high = -1e300;
  for (const std::uint32_t corner : loop) {
    const double height = glm::dot(points[corner] - points[loop[0]], unitNormal);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  return 0.5 * (high - low);
}

/// Triangles of a warped polygon: Delaunay in its best plane where its outline is simple there, else a fan.
std::vector<std::array<std::uint32_t, 3>> trianglesOf(std::span<const glm::dvec3> points, const Loop& loop,
                                                      const glm::dvec3& unitNormal) {
  const PlaneFrame frame(unitNormal, points[loop[0]]);
  Loop corners = loop;  // once each, though a keyhole's bridge is walked twice
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::vector<glm::dvec2> flat;
  for (const std::uint32_t corner : corners) flat.push_back(frame.project(points[corner]));
  const auto place = [&](std::size_t i) {
    const auto found = std::lower_bound(corners.begin(), corners.end(), loop[i % loop.size()]);
    return static_cast<std::uint32_t>(found - corners.begin());
  };
  std::vector<PlaneEdge> edges;
  for (std::size_t i = 0; i < loop.size(); ++i) edges.push_back({place(i), place(i + 1), 1});
  std::vector<std::array<std::uint32_t, 3>> result;
  for (const auto& triangle : triangulate(flat, edges).triangles) {
    if (triangle.winding % 2 == 0) continue;
    result.push_back({corners[triangle.corner[0]], corners[triangle.corner[1]], corners[triangle.corner[2]]});
  }
  if (result.empty()) {
    for (std::size_t i = 2; i < loop.size(); ++i) result.push_back({loop[0], loop[i - 1], loop[i]});
  }
  return result;
}

/// Fills `places` with where points lie that faces use, once each and in lexicographic order; tells the place
/// of each point, NearPoints::none for one that no face uses.
std::vector<std::uint32_t> distinctPlaces(const Soup& soup, std::span<const glm::dvec3> points,
                                          std::vector<glm::dvec3>& places) {
  std::vector<bool> used(points.size(), false);
  for (const std::uint32_t corner : soup.faces.corners) used[corner] = true;
  Loop order;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (used[i]) order.push_back(i);
  }
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return lexicographicallyLess(points[a], points[b]); });
  std::vector<std::uint32_t> placeOf(points.size(), NearPoints::none);
  for (const std::uint32_t point : order) {
    if (places.empty() || places.back() != points[point]) places.push_back(points[point]);
    placeOf[point] = static_cast<std::uint32_t>(places.size() - 1);
  }
  return placeOf;
}

/// The area of the largest surface (one object in one material) at each place, as its logarithm in steps so
/// wide that rounding does not tell surfaces of one size apart. Neither turning a model nor dividing its
/// faces changes it.
std::vector<long> weightsOf(const Soup& soup, std::span<const std::uint32_t> placeOf, std::size_t places) {
  constexpr double stepsOfE = 1e4;
  constexpr double least_m2 = 1e-12;
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> surfaces_m2;
  for (std::size_t face = 0; face < soup.faces.size(); ++face) {
    if (soup.faces[face].empty()) continue;
    surfaces_m2[{soup.object[face], soup.material[face]}] +=
        0.5 * glm::length(doubleAreaVector(soup.points, soup.faces[face]));
  }
  std::vector<long> weights(places, std::numeric_limits<long>::min());
  for (std::size_t face = 0; face < soup.faces.size(); ++face) {
    const double area_m2 = surfaces_m2[{soup.object[face], soup.material[face]}];
    const long weight = std::lround(stepsOfE * std::log(std::max(area_m2, least_m2)));
    for (const std::uint32_t corner : soup.faces[face]) {
      long& most = weights[placeOf[corner]];
      most = std::max(most, weight);
    }
  }
  return weights;
}

/// How far a place lies along a direction askew to the model's axes, which tells any two apart. [m]
double rankOf(const glm::dvec3& place) {
  return glm::dot(place, glm::dvec3(0.612, 0.275, 0.741));
}

/// Where a place that divides an edge comes to lie, whose ends are kept at other places.
glm::dvec3 following(std::uint32_t place, const EdgeEnds& ends, std::span<const glm::dvec3> places,
                     std::span<const std::uint32_t> keptOf) {
  const auto& [a, b] = ends;
  if (keptOf[a] == a && keptOf[b] == b) return places[place];
  const glm::dvec3 way = places[b] - places[a];
  const double share = glm::dot(places[place] - places[a], way) / glm::dot(way, way);
  return glm::mix(places[keptOf[a]], places[keptOf[b]], share);
}

}  // namespace

Soup weld(const Soup& soup, const Tolerances& tolerances, CleanupCounts& counts) {
  std::vector<glm::dvec3> onTheGrid(soup.points.size());
  for (std::size_t i = 0; i < soup.points.size(); ++i)
    onTheGrid[i] = onGrid(soup.points[i], tolerances.grid_m);
  std::vector<glm::dvec3> places;
  const std::vector<std::uint32_t> placeOf = distinctPlaces(soup, onTheGrid, places);
  const std::vector<long> weights = weightsOf(soup, placeOf, places.size());
  Loop order(places.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return weights[a] != weights[b] ? weights[a] > weights[b] : rankOf(places[a]) < rankOf(places[b]);
  });

  NearPoints near(tolerances.weld_m);
  Loop keptOf(places.size());
  std::vector<bool> isKept(places.size(), false);
  const auto divided = dividedEdges(soup, placeOf, places, tolerances);
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const std::uint32_t place = order[i];
    if (divided.contains(place)) continue;
    const std::uint32_t found = near.nearest(places[place]);
    keptOf[place] = found == NearPoints::none ? place : order[found];
    if (found != NearPoints::none) continue;
    isKept[place] = true;
    near.add(places[place], i);
  }
  NearPoints same(tolerances.drawn_m);
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    if (isKept[order[i]]) same.add(places[order[i]], i);
  }
  std::vector<glm::dvec3> moved = places;
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const std::uint32_t place = order[i];
    const auto edge = divided.find(place);
    if (edge == divided.end()) continue;
    moved[place] = onGrid(following(place, edge->second, places, keptOf), tolerances.grid_m);
    const std::uint32_t found = same.nearest(moved[place]);
    keptOf[place] = found == NearPoints::none ? place : order[found];
    if (found != NearPoints::none) continue;
    isKept[place] = true;
    same.add(moved[place], i);
  }
  Loop kept;
  for (std::uint32_t place = 0; place < places.size(); ++place) {
    if (isKept[place]) kept.push_back(place);
  }
  std::sort(kept.begin(), kept.end(),
            [&](std::uint32_t a, std::uint32_t b) { return lexicographicallyLess(moved[a], moved[b]); });
  Soup result;
  Loop numberOf(places.size());
  for (const std::uint32_t place : kept) {
    numberOf[place] = static_cast<std::uint32_t>(result.points.size());
    result.points.push_back(moved[place]);
  }
  Loop renumbered(soup.points.size());
  std::size_t used = 0;
  for (std::uint32_t point = 0; point < soup.points.size(); ++point) {
    if (placeOf[point] == NearPoints::none) continue;
    renumbered[point] = numberOf[keptOf[placeOf[point]]];
    ++used;
  }
  counts.pointsWelded += used - result.points.size();
  result.faces = soup.faces;
  result.drawn = soup.drawn;
  result.bentFrom.resize(soup.faces.size(), glm::dvec3(0.0));
  for (std::size_t face = 0; face < soup.faces.size(); ++face) {
    const bool isDisplaced = std::ranges::any_of(soup.faces[face], [&](std::uint32_t corner) {
      return glm::length(result.points[renumbered[corner]] - onTheGrid[corner]) > tolerances.collinear_m;
    });
    const glm::dvec3 vector = doubleAreaVector(onTheGrid, soup.faces[face]);
    if (isDisplaced && glm::length(vector) > 0.0) result.bentFrom[face] = glm::normalize(vector);
  }
  for (std::uint32_t& corner : result.faces.corners) corner = renumbered[corner];
  result.material = soup.material;
  result.object = soup.object;
  return result;
}

void dropDegenerateFaces(Soup& soup, const Tolerances& tolerances, CleanupCounts& counts,
                         Findings& findings) {
  filterFaces(soup, [&](std::size_t face, Loop& corners) {
    const Loop drawn = corners;
    dropRepeatedCorners(corners);
    if (corners.size() >= 3) {
      startAtSmallest(soup.points, corners);
      const double area_m2 = 0.5 * glm::length(doubleAreaVector(soup.points, corners));
      // Thin faces whose corners were kept apart by the weld stay: dropping them would open a slit.
      if (area_m2 >= tolerances.degenerateArea_m2 &&
          2.0 * area_m2 >= tolerances.collinear_m * longestEdge_m(soup.points, corners)) {
        return true;
      }
    }
    findings.note("G201", soup.points, drawn, soup.object[face], longestEdge_m(soup.points, drawn));
    return false;
  });
  counts.degenerateFaces += findings.count("G201");
  findings.tell("G201", "faces without area were dropped; the longest is named");
}

void sortFaces(Soup& soup, const NameRanks& ranks) {
  Loop order(soup.faces.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const auto p = soup.faces[a];
    const auto q = soup.faces[b];
    if (!std::ranges::equal(p, q)) return std::ranges::lexicographical_compare(p, q);
    const auto ranksOfFace = [&](std::uint32_t face) {
      return std::tuple(ranks.material[soup.material[face]], ranks.object[soup.object[face]]);
    };
    if (ranksOfFace(a) != ranksOfFace(b)) return ranksOfFace(a) < ranksOfFace(b);
    return lexicographicallyLess(soup.bentFrom[a], soup.bentFrom[b]);
  });
  Soup sorted{std::move(soup.points), {}, {}, {}, {}, {}};
  for (const std::uint32_t face : order) {
    sorted.faces.add(soup.faces[face]);
    sorted.material.push_back(soup.material[face]);
    sorted.object.push_back(soup.object[face]);
    sorted.drawn.push_back(soup.drawn[face]);
    sorted.bentFrom.push_back(soup.bentFrom[face]);
  }
  soup = std::move(sorted);
}

void markDuplicates(std::vector<Footprint>& footprints, const NameRanks& ranks) {
  Loop order(footprints.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    const Footprint& a = footprints[i];
    const Footprint& b = footprints[j];
    if (a.corners != b.corners) return a.corners < b.corners;
    if (a.material != b.material) return ranks.material[a.material] < ranks.material[b.material];
    if (a.object != b.object) return ranks.object[a.object] < ranks.object[b.object];
    return i < j;
  });
  DrawnSides taken;
  for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
    Footprint& kept = footprints[order[first]];
    if (first == 0 || footprints[order[first - 1]].corners != kept.corners) taken = {false, false};
    for (end = first + 1; end < order.size(); ++end) {
      Footprint& other = footprints[order[end]];
      const bool isLike = other.material == kept.material && (kept.isGlass || other.object == kept.object);
      if (other.corners != kept.corners || !isLike) break;
      other.isDrawnAlready = true;
      kept.drawn.front = kept.drawn.front || other.drawn.front;
      kept.drawn.back = kept.drawn.back || other.drawn.back;
    }
    const DrawnSides wanted = kept.drawn;
    kept.drawn = {wanted.front && !taken.front, wanted.back && !taken.back};
    kept.isDrawnAlready = !kept.drawn.front && !kept.drawn.back;
    taken = {taken.front || wanted.front, taken.back || wanted.back};
  }
}

void dropDuplicateFaces(Soup& soup, std::span<const Material> materials, const NameRanks& ranks,
                        CleanupCounts& counts, Findings& findings) {
  std::vector<Footprint> footprints;
  for (std::size_t face = 0; face < soup.faces.size(); ++face) {
    Footprint footprint{Loop(soup.faces[face].begin(), soup.faces[face].end()), soup.material[face],
                        soup.object[face], materials[soup.material[face]].glazing, soup.drawn[face]};
    std::sort(footprint.corners.begin(), footprint.corners.end());
    footprints.push_back(std::move(footprint));
  }
  markDuplicates(footprints, ranks);
  filterFaces(soup, [&](std::size_t face, Loop& corners) {
    if (footprints[face].isDrawnAlready) {
      findings.note("G202", soup.points, corners, soup.object[face],
                    0.5 * glm::length(doubleAreaVector(soup.points, corners)));
    }
    soup.drawn[face] = footprints[face].drawn;
    return !footprints[face].isDrawnAlready;
  });
  counts.duplicateFaces += findings.count("G202");
  findings.tell("G202", "faces drawn twice were dropped; the largest is named");
}

void splitWarpedFaces(Soup& soup, const Tolerances& tolerances, CleanupCounts& counts, Findings& findings) {
  Soup result;
  double worst_m = 0.0;
  const auto add = [&](std::span<const std::uint32_t> corners, std::size_t face, const glm::dvec3& bentFrom) {
    result.faces.add(corners);
    result.material.push_back(soup.material[face]);
    result.object.push_back(soup.object[face]);
    result.drawn.push_back(soup.drawn[face]);
    result.bentFrom.push_back(bentFrom);
  };
  for (std::size_t face = 0; face < soup.faces.size(); ++face) {
    const Loop loop(soup.faces[face].begin(), soup.faces[face].end());
    const glm::dvec3 normal = glm::normalize(doubleAreaVector(soup.points, loop));
    const double warp = loop.size() > 3 ? warp_m(soup.points, loop, normal) : 0.0;
    if (warp <= tolerances.planar_m) {
      add(loop, face, soup.bentFrom[face]);
      continue;
    }
    findings.note("G203", soup.points, loop, soup.object[face], warp);
    worst_m = std::max(worst_m, warp);
    for (const auto& triangle : trianglesOf(soup.points, loop, normal)) {
      Loop corners(triangle.begin(), triangle.end());
      startAtSmallest(soup.points, corners);
      const glm::dvec3 vector = doubleAreaVector(soup.points, corners);
      if (glm::length(vector) < 2.0 * tolerances.degenerateArea_m2) continue;
      add(corners, face, soup.isBent(face) ? glm::normalize(vector) : glm::dvec3(0.0));
    }
  }
  soup.faces = std::move(result.faces);
  soup.material = std::move(result.material);
  soup.object = std::move(result.object);
  soup.drawn = std::move(result.drawn);
  soup.bentFrom = std::move(result.bentFrom);
  counts.nonPlanarFaces += findings.count("G203");
  const auto worst_mm = static_cast<long>(std::lround(worst_m * 1e3));
  findings.tell("G203", "non-planar faces were split into triangles; the worst leaves its plane by " +
                            std::to_string(worst_mm) + " mm");
}

}  // namespace clerestory
