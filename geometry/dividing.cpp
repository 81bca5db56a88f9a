// SPDX-License-Identifier: GPL-3.0-or-later
// Edges that faces of one plane and surface share cancel; what is left at a place tells whether it is a
// corner.
#include "dividing.hpp"

#include <algorithm>
#include <optional>

namespace clerestory {
namespace {

/// A face as seen from one of its corners.
struct Wedge {
  std::uint32_t place, material, object, before, after;
  glm::dvec3 normal;
};

std::vector<Wedge> wedgesOf(const Soup& soup, std::span<const std::uint32_t> placeOf) {
  std::vector<Wedge> wedges;
  for (std::size_t face = 0; face < soup.faces.size(); ++face) {
    const auto corners = soup.faces[face];
    if (corners.size() < 3) continue;
    const glm::dvec3 vector = doubleAreaVector(soup.points, corners);
    const double length = glm::length(vector);
    if (length <= 0.0) continue;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t before = placeOf[corners[(i + corners.size() - 1) % corners.size()]];
      wedges.push_back({placeOf[corners[i]], soup.material[face], soup.object[face], before,
                        placeOf[corners[(i + 1) % corners.size()]], vector / length});
    }
  }
  std::ranges::stable_sort(wedges, {}, &Wedge::place);
  return wedges;
}

/// The neighbours along the outline of what the wedges of one surface cover in the plane of `own`; none where
/// it is not one line.
std::optional<EdgeEnds> outlineAt(std::span<const Wedge> wedges, const Wedge& own, double angle_rad) {
  std::map<std::uint32_t, int> leaving;  // by the place at the other end, less those that arrive
  for (const Wedge& wedge : wedges) {
    if (wedge.object != own.object || wedge.material != own.material) continue;
    if (glm::length(glm::cross(wedge.normal, own.normal)) > angle_rad) continue;
    const bool isAlong = glm::dot(wedge.normal, own.normal) > 0.0;
    ++leaving[isAlong ? wedge.after : wedge.before];
    --leaving[isAlong ? wedge.before : wedge.after];
  }
  std::erase_if(leaving, [](const auto& each) { return each.second == 0; });
  if (leaving.size() != 2) return std::nullopt;
  return EdgeEnds{leaving.begin()->first, leaving.rbegin()->first};
}

class DividedEdges {
 public:
  DividedEdges(std::span<const glm::dvec3> places, const Tolerances& tolerances)
      : places_(places), tolerances_(tolerances) {}

  /// All wedges at one place.
  void add(std::span<const Wedge> wedges) {
    std::optional<EdgeEnds> edge;
    for (const Wedge& wedge : wedges) {
      edge = outlineAt(wedges, wedge, tolerances_.coplanarAngle_rad);
      if (!edge || !isBetween(wedge.place, *edge)) return;
    }
    if (edge) neighbours_[wedges.front().place] = *edge;
  }

  /// Of those whose whole edges are straight.
  [[nodiscard]] std::map<std::uint32_t, EdgeEnds> whole() const {
    std::map<std::uint32_t, EdgeEnds> edges;
    for (const auto& [place, ends] : neighbours_) {
      if (const auto edge = wholeEdge(place, ends)) edges[place] = *edge;
    }
    return edges;
  }

 private:
  [[nodiscard]] bool isBetween(std::uint32_t place, const EdgeEnds& ends) const {
    const glm::dvec3 way = places_[ends[1]] - places_[ends[0]];
    const glm::dvec3 offset = places_[place] - places_[ends[0]];
    const double along = glm::dot(offset, way);
    const double length = glm::length(way);
    return along > 0.0 && along < length * length &&
           glm::length(glm::cross(offset, way)) <= tolerances_.drawn_m * length;
  }

  /// On to both sides, past other places that divide it; none where the way bends.
  [[nodiscard]] std::optional<EdgeEnds> wholeEdge(std::uint32_t place, EdgeEnds ends) const {
    for (std::size_t i = 0; i < 2; ++i) {
      std::uint32_t last = place;
      for (auto at = neighbours_.find(ends[i]); at != neighbours_.end(); at = neighbours_.find(ends[i])) {
        const EdgeEnds& next = at->second;
        ends[i] = next[0] == last ? next[1] : next[0];
        last = at->first;
        if (!isBetween(place, ends)) return std::nullopt;
      }
    }
    return ends;
  }

  std::span<const glm::dvec3> places_;
  const Tolerances& tolerances_;
  std::map<std::uint32_t, EdgeEnds> neighbours_;
};

}  // namespace

std::map<std::uint32_t, EdgeEnds> dividedEdges(const Soup& soup, std::span<const std::uint32_t> placeOf,
                                               std::span<const glm::dvec3> places,
                                               const Tolerances& tolerances) {
  const std::vector<Wedge> wedges = wedgesOf(soup, placeOf);
  DividedEdges edges(places, tolerances);
  for (auto first = wedges.begin(); first != wedges.end();) {
    const auto end =
        std::find_if(first, wedges.end(), [&](const Wedge& w) { return w.place != first->place; });
    edges.add({first, end});
    first = end;
  }
  return edges.whole();
}

}  // namespace clerestory
