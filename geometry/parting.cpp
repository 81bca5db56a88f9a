// SPDX-License-Identifier: GPL-3.0-or-later
// A watershed of the distance to walls, parted further by floors, grown through doorways; then regions join
// again where what parts them is too wide.
#include "parting.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "borderline.hpp"

namespace clerestory {
namespace {

constexpr double doorwayMost_m = 1.6;      // width
constexpr double floorBorderMost_m = 2.0;  // where floors of two surfaces meet
constexpr double openShareMost = 0.35;     // of a region's outline, for its borders between floors
constexpr double neckShare = 0.7;          // of the width on both of its sides
constexpr double regionLeast_m2 = 1.0;
constexpr double circleLeast_m = 0.4;  // radius
constexpr std::uint32_t none = AirMap::none;

std::size_t at(std::int32_t index) {
  return static_cast<std::size_t>(index);
}

/// Chamfer distance (Borgefors 1986, 3-4) of high cells to others and to what stands between. [m]
std::vector<double> distanceToWalls(const AirMap& map, const StoreyCells& cells) {
  constexpr int far = 1 << 20;
  std::vector<int> way(map.size());
  for (std::uint32_t cell = 0; cell < map.size(); ++cell) way[cell] = cells.high[cell] ? far : 0;
  const auto relax = [&](std::uint32_t cell, int straightWay, int firstWay, int secondWay) {
    const std::uint32_t straight = cells.neighbourAbove(map, cell, straightWay);
    const std::uint32_t first = cells.neighbourAbove(map, cell, firstWay);
    way[cell] = std::min(way[cell], 3 + (straight == none ? 0 : way[straight]));
    way[cell] = std::min(way[cell], 3 + (first == none ? 0 : way[first]));
    for (const int sideways : {firstWay, secondWay}) {
      const std::uint32_t slant = straight == none ? none : cells.neighbourAbove(map, straight, sideways);
      if (slant != none) way[cell] = std::min(way[cell], 4 + way[slant]);
    }
  };
  for (std::uint32_t cell = 0; cell < map.size(); ++cell) relax(cell, 3, 2, 0);
  for (std::uint32_t cell = map.size(); cell-- > 0;) relax(cell, 1, 0, 2);
  std::vector<double> result(map.size());
  for (std::uint32_t cell = 0; cell < map.size(); ++cell) result[cell] = way[cell] / 3.0 * map.cell_m();
  return result;
}

/// The basins of the distance to walls: two meet where the way between them is a neck at its widest. Cells
/// are taken from the middles of rooms outwards (Meyer 1994, joining by height).
std::vector<std::int32_t> basinsOf(const AirMap& map, const StoreyCells& cells,
                                   const std::vector<double>& toWall_m) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t cell = 0; cell < map.size(); ++cell) {
    if (cells.high[cell]) order.push_back(cell);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return toWall_m[a] > toWall_m[b]; });
  std::vector<std::int32_t> label(map.size(), -1);
  std::vector<std::int32_t> parent;
  std::vector<double> peak_m;
  const auto root = [&](std::int32_t basin) {
    while (parent[at(basin)] != basin) basin = parent[at(basin)];
    return basin;
  };
  for (const std::uint32_t cell : order) {
    std::int32_t own = -1;
    for (int way = 0; way < 4; ++way) {
      const std::uint32_t next = cells.neighbourAbove(map, cell, way);
      if (next == none || label[next] < 0) continue;
      const std::int32_t other = root(label[next]);
      if (own < 0 || own == other) {
        own = other;
        continue;
      }
      const std::int32_t higher = peak_m[at(own)] >= peak_m[at(other)] ? own : other;
      const std::int32_t lower = own == higher ? other : own;
      const bool isNeck =
          2.0 * toWall_m[cell] <= doorwayMost_m && toWall_m[cell] < neckShare * peak_m[at(lower)];
      if (!isNeck) parent[at(lower)] = higher;
      own = higher;
    }
    if (own < 0) {
      own = static_cast<std::int32_t>(parent.size());
      parent.push_back(own);
      peak_m.push_back(toWall_m[cell]);
    }
    label[cell] = own;
  }
  for (std::int32_t& basin : label) basin = basin < 0 ? -1 : root(basin);
  return label;
}

/// Cells without a value take that of the nearest one that has one, going from cell to cell by `neighbour`
/// where `mayPass`.
template <class Neighbour, class MayPass>
void growInto(std::vector<std::int32_t>& value, const Neighbour& neighbour, const MayPass& mayPass) {
  std::vector<std::uint32_t> front;
  for (std::uint32_t cell = 0; cell < value.size(); ++cell) {
    if (value[cell] >= 0) front.push_back(cell);
  }
  for (std::size_t first = 0; first < front.size(); ++first) {
    const std::uint32_t cell = front[first];
    for (int way = 0; way < 4; ++way) {
      const std::uint32_t next = neighbour(cell, way);
      if (next == none || value[next] >= 0 || !mayPass(cell, next)) continue;
      value[next] = value[cell];
      front.push_back(next);
    }
  }
}

/// Numbers sets of high cells that are connected over neighbours that are `alike`; -1 for others.
template <class Alike>
std::vector<std::int32_t> connected(const AirMap& map, const StoreyCells& cells, const Alike& alike) {
  std::vector<std::int32_t> label(map.size(), -1);
  std::int32_t count = 0;
  std::vector<std::uint32_t> front;
  for (std::uint32_t start = 0; start < map.size(); ++start) {
    if (!cells.high[start] || label[start] >= 0) continue;
    front.assign(1, start);
    label[start] = count;
    while (!front.empty()) {
      const std::uint32_t cell = front.back();
      front.pop_back();
      for (int way = 0; way < 4; ++way) {
        const std::uint32_t next = cells.neighbourAbove(map, cell, way);
        if (next == none || label[next] >= 0 || !alike(cell, next)) continue;
        label[next] = count;
        front.push_back(next);
      }
    }
    ++count;
  }
  return label;
}

/// An edge of a cell, to its neighbour east (0) or north (1).
struct Edge {
  std::uint32_t cell;
  int way;
};

/// An opening between two regions, edge by edge.
struct Border {
  std::array<std::int32_t, 2> regions;
  std::vector<Edge> edges;
  double width_m = 0.0;
  bool alongFloors = false;  ///< under one ceiling and without a neck
  bool oneFloor = false;     ///< most of it crosses one floor
  bool parts = false;
};

/// Edges that lie within two cells of each other.
std::vector<std::vector<Edge>> clustersOf(const AirMap& map, std::vector<Edge> edges) {
  std::vector<std::vector<Edge>> result;
  const auto near = [&](const Edge& a, const Edge& b) {
    return glm::length(map.edgeTo(a.cell, a.way) - map.edgeTo(b.cell, b.way)) < 2.3 * map.cell_m();
  };
  while (!edges.empty()) {
    std::vector<Edge> cluster{edges.back()};
    edges.pop_back();
    for (std::size_t i = 0; i < cluster.size(); ++i) {
      const auto rest = std::stable_partition(edges.begin(), edges.end(),
                                              [&](const Edge& edge) { return !near(cluster[i], edge); });
      cluster.insert(cluster.end(), rest, edges.end());
      edges.erase(rest, edges.end());
    }
    result.push_back(std::move(cluster));
  }
  return result;
}

/// A storey's cells on their way to regions.
class Parting {
 public:
  Parting(const AirMap& map, const StoreyCells& cells)
      : map_(map),
        cells_(cells),
        toWall_m_(distanceToWalls(map, cells)),
        basin_(basinsOf(map, cells, toWall_m_)) {
    const auto neighbour = [&](std::uint32_t cell, int way) { return cells_.neighbour(map_, cell, way); };
    floor_.assign(map.size(), -1);
    for (std::uint32_t cell = 0; cell < map.size(); ++cell) {
      if (cells.high[cell]) floor_[cell] = cells.surface[cell];
    }
    growInto(floor_, neighbour, [&](std::uint32_t a, std::uint32_t b) { return basin_[a] == basin_[b]; });
    region_ = connected(map, cells, [&](std::uint32_t a, std::uint32_t b) {
      return basin_[a] == basin_[b] && floor_[a] == floor_[b];
    });
    growInto(region_, neighbour, [&](std::uint32_t, std::uint32_t next) { return bool{cells_.any[next]}; });
  }

  Parted settle() {
    measures_ = measure();
    collectEdges();
    while (joinOnce()) {
    }
    dropSmall();
    measures_ = measure();
    collectEdges();
    Parted parted{region_, {}, count_, {}};
    for (const auto& [regions, borders] : bordersOf_) {
      for (const Border& border : borders) parted.openings.push_back(openingOf(border));
    }
    parted.toWall_m = std::move(toWall_m_);
    return parted;
  }

 private:
  using Pair = std::array<std::int32_t, 2>;  ///< of regions, the lower first

  struct Measure {
    std::size_t cells = 0;  ///< high ones
    double area_m2 = 0.0, circle_m = 0.0;
    std::size_t outline = 0;     ///< edges around its high cells
    std::size_t floorEdges = 0;  ///< of these, where only floors differ

    [[nodiscard]] bool isRoom() const { return area_m2 >= regionLeast_m2 && circle_m >= circleLeast_m; }
    [[nodiscard]] bool isOpen() const {
      return static_cast<double>(floorEdges) > openShareMost * static_cast<double>(outline);
    }
  };

  [[nodiscard]] bool onlyFloorsDiffer(std::uint32_t a, std::uint32_t b) const {
    return cells_.high[a] && cells_.high[b] && basin_[a] == basin_[b];
  }

  [[nodiscard]] std::vector<Measure> measure() const {
    std::vector<Measure> measures;
    for (std::uint32_t cell = 0; cell < map_.size(); ++cell) {
      if (region_[cell] < 0) continue;
      if (at(region_[cell]) >= measures.size()) measures.resize(at(region_[cell]) + 1);
      if (!cells_.high[cell]) continue;
      Measure& own = measures[at(region_[cell])];
      ++own.cells;
      own.circle_m = std::max(own.circle_m, toWall_m_[cell]);
      for (int way = 0; way < 4; ++way) {
        const std::uint32_t next = cells_.neighbourAbove(map_, cell, way);
        if (next != none && region_[next] == region_[cell]) continue;
        ++own.outline;
        if (next != none && onlyFloorsDiffer(cell, next)) ++own.floorEdges;
      }
    }
    for (Measure& own : measures) own.area_m2 = areaOf(own.cells);
    return measures;
  }

  [[nodiscard]] double areaOf(std::size_t cells) const {
    return static_cast<double>(cells) * map_.cell_m() * map_.cell_m();
  }

  /// All edges between regions, and what they are.
  void collectEdges() {
    edgesOf_.clear();
    bordersOf_.clear();
    for (std::uint32_t cell = 0; cell < map_.size(); ++cell) {
      for (int way = 0; way < 2; ++way) {
        const std::uint32_t next = cells_.neighbour(map_, cell, way);
        if (next == none || region_[cell] < 0 || region_[next] < 0 || region_[cell] == region_[next])
          continue;
        const auto [low, high] = std::minmax(region_[cell], region_[next]);
        edgesOf_[{low, high}].push_back({cell, way});
      }
    }
    for (const auto& [regions, edges] : edgesOf_) describeAll(regions);
  }

  void describeAll(const Pair& regions) {
    const bool isOpen = measures_[at(regions[0])].isOpen() || measures_[at(regions[1])].isOpen();
    std::vector<Border>& borders = bordersOf_[regions];
    borders.clear();
    for (std::vector<Edge>& cluster : clustersOf(map_, edgesOf_.at(regions)))
      borders.push_back(describe(regions, std::move(cluster), isOpen));
  }

  /// Makes `other` a part of `region`; what lies apart from both stays as it is.
  void join(std::int32_t region, std::int32_t other) {
    Measure& own = measures_[at(region)];
    const Measure gone = std::exchange(measures_[at(other)], Measure{});
    own.cells += gone.cells;
    own.area_m2 = areaOf(own.cells);
    own.circle_m = std::max(own.circle_m, gone.circle_m);
    own.outline += gone.outline;
    own.floorEdges += gone.floorEdges;
    const Pair both{std::min(region, other), std::max(region, other)};
    for (const Edge& edge : edgesOf_.at(both)) {  // counted by either, now within
      const std::uint32_t next = cells_.neighbourAbove(map_, edge.cell, edge.way);
      if (!cells_.high[edge.cell] || next == none) continue;
      own.outline -= 2;
      if (onlyFloorsDiffer(edge.cell, next)) own.floorEdges -= 2;
    }
    edgesOf_.erase(both);
    bordersOf_.erase(both);
    for (std::int32_t& cell : region_) {
      if (cell == other) cell = region;
    }
    std::vector<Pair> moved;
    std::vector<Pair> changed;
    for (const auto& [regions, edges] : edgesOf_) {
      if (regions[0] == other || regions[1] == other) moved.push_back(regions);
      if (regions[0] == region || regions[1] == region) changed.push_back(regions);
    }
    for (const Pair& regions : moved) {
      const std::int32_t third = regions[0] == other ? regions[1] : regions[0];
      const Pair pair{std::min(region, third), std::max(region, third)};
      std::vector<Edge>& edges = edgesOf_[pair];
      if (edges.empty()) changed.push_back(pair);
      const std::vector<Edge>& more = edgesOf_.at(regions);
      edges.insert(edges.end(), more.begin(), more.end());
      std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return a.cell != b.cell ? a.cell < b.cell : a.way < b.way;
      });
      edgesOf_.erase(regions);
      bordersOf_.erase(regions);
    }
    for (const Pair& regions : changed) describeAll(regions);
  }

  [[nodiscard]] Border describe(const std::array<std::int32_t, 2>& regions, std::vector<Edge> edges,
                                bool isOpen) const {
    std::array<std::size_t, 2> steps{};
    std::size_t high = 0;
    std::size_t floors = 0;
    std::size_t same = 0;
    for (const Edge& edge : edges) {
      const std::uint32_t next = map_.neighbour(edge.cell, edge.way);
      ++steps[static_cast<std::size_t>(edge.way)];
      if (cells_.high[edge.cell] && cells_.neighbourAbove(map_, edge.cell, edge.way) == next) {
        ++high;
        if (onlyFloorsDiffer(edge.cell, next)) ++floors;
      }
      if (floor_[edge.cell] == floor_[next]) ++same;
    }
    Border border{regions, std::move(edges)};
    border.oneFloor = 2 * same > border.edges.size();
    border.width_m = map_.cell_m() * std::hypot(static_cast<double>(steps[0]), static_cast<double>(steps[1]));
    border.alongFloors = 2 * floors > border.edges.size();
    const bool isNeck = !border.alongFloors && 2 * high > border.edges.size();
    border.parts = isNeck || (border.alongFloors ? !isOpen && border.width_m <= floorBorderMost_m
                                                 : border.width_m <= doorwayMost_m);
    return border;
  }

  /// Joins a region that cannot stay by itself with a neighbour: one that is too small, else one that is open
  /// along its floor's edge, else the two with the widest border that does not part them. False where nothing
  /// is left to join.
  bool joinOnce() {
    const Border* chosen = bestBorder([](const Measure& own) { return !own.isRoom(); });
    if (chosen == nullptr) chosen = bestBorder([](const Measure& own) { return own.isOpen(); });
    for (const auto& [regions, borders] : bordersOf_) {
      for (const Border& border : borders) {
        if (chosen == nullptr && !border.parts) chosen = &border;
      }
    }
    if (chosen == nullptr) return false;
    const Pair regions = chosen->regions;
    join(regions[0], regions[1]);
    return true;
  }

  /// The border over which the smallest of the regions that `mustJoin` joins: rather to one of its own floor,
  /// then over the widest. Null where there is none.
  template <class MustJoin>
  [[nodiscard]] const Border* bestBorder(const MustJoin& mustJoin) const {
    const Border* best = nullptr;
    double leastArea_m2 = std::numeric_limits<double>::infinity();
    for (const auto& [regions, borders] : bordersOf_) {
      for (const Border& border : borders) {
        for (const std::int32_t region : border.regions) {
          const Measure& own = measures_[at(region)];
          if (!mustJoin(own) || own.area_m2 > leastArea_m2) continue;
          const bool isBetter =
              best == nullptr || own.area_m2 < leastArea_m2 ||
              (border.oneFloor != best->oneFloor ? border.oneFloor : border.width_m > best->width_m);
          if (!isBetter) continue;
          best = &border;
          leastArea_m2 = own.area_m2;
        }
      }
    }
    return best;
  }

  void dropSmall() {
    const std::vector<Measure> measures = measure();
    std::vector<std::int32_t> number(measures.size(), -1);
    for (std::size_t i = 0; i < measures.size(); ++i) {
      if (measures[i].isRoom()) number[i] = count_++;
    }
    for (std::int32_t& region : region_) region = region < 0 ? -1 : number[at(region)];
  }

  [[nodiscard]] Opening openingOf(const Border& border) const {
    Opening opening{border.regions, {}, {}, border.alongFloors, {}, {}};
    double longest_m = -1.0;
    std::vector<glm::dvec2> places;
    for (const Edge& edge : border.edges) {
      places.push_back(map_.edgeTo(edge.cell, edge.way));
      opening.cells.push_back(edge.cell);
    }
    for (const glm::dvec2& a : places) {
      for (const glm::dvec2& b : places) {
        if (glm::length(b - a) <= longest_m) continue;
        longest_m = glm::length(b - a);
        opening.from_m = a;
        opening.to_m = b;
      }
    }
    if (border.alongFloors) bend(border, opening);
    return opening;
  }

  /// Lets an opening follow its border round corners.
  void bend(const Border& border, Opening& opening) const {
    std::vector<std::array<glm::dvec2, 2>> edges;
    for (const Edge& edge : border.edges) {
      const glm::dvec2 middle = map_.edgeTo(edge.cell, edge.way);
      const glm::dvec2 half =
          0.5 * map_.cell_m() * (edge.way == 0 ? map_.frame().across : map_.frame().along);
      edges.push_back({middle - half, middle + half});
    }
    const std::vector<glm::dvec2> line = lineAlong(edges, map_.cell_m());
    if (line.size() < 3) return;
    opening.from_m = line.front();
    opening.to_m = line.back();
    opening.bends_m.assign(line.begin() + 1, line.end() - 1);
  }

  const AirMap& map_;
  const StoreyCells& cells_;
  std::vector<double> toWall_m_;     // in air above the doors
  std::vector<std::int32_t> basin_;  // #cells; -1 where it is not high
  std::vector<std::int32_t> floor_;  // #cells: surface, carried on where none is met; -1 where it is not high
  std::vector<std::int32_t> region_;  // #cells; -1
  std::int32_t count_ = 0;
  std::vector<Measure> measures_;                  // by region
  std::map<Pair, std::vector<Edge>> edgesOf_;      // in the order of cells
  std::map<Pair, std::vector<Border>> bordersOf_;  // the same pairs
};

}  // namespace

Parted partAtNecks(const AirMap& map, const StoreyCells& cells) {
  return Parting(map, cells).settle();
}

std::vector<std::int32_t> nearestRegion(const AirMap& map, std::vector<std::int32_t> region) {
  growInto(
      region, [&](std::uint32_t cell, int way) { return map.neighbour(cell, way); },
      [](std::uint32_t, std::uint32_t) { return true; });
  return region;
}

}  // namespace clerestory
