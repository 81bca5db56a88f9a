// SPDX-License-Identifier: GPL-3.0-or-later
// Edges of regions in a plane: summed, and divided until they meet at their ends alone, as `triangulate`
// wants them.
#pragma once

#include <functional>
#include <vector>

#include "triangulate.hpp"

namespace clerestory {

/// Directed edges in a plane; opposite ones cancel.
class EdgeSum {
 public:
  /// Edges that bound nothing (`times` 0) stay.
  void add(std::uint32_t from, std::uint32_t to, int times) {
    if (from < to) edges_.push_back({from, to, times});
    if (from > to) edges_.push_back({to, from, -times});
  }

  /// What is left, each with `times` that is not negative, by rising indices.
  std::vector<PlaneEdge> take();

 private:
  std::vector<PlaneEdge> edges_;
};

/// Divides edges at the ends of others that lie on them, so that neighbours with T-junctions cancel too.
std::vector<PlaneEdge> splitAtPoints(std::span<const glm::dvec2> points, std::span<const PlaneEdge> edges,
                                     double tolerance_m);

/// Divides edges where they cross. `pointAt` tells the index of the point at a place, perhaps a new one of
/// `points`.
std::vector<PlaneEdge> splitAtCrossings(const std::vector<glm::dvec2>& points,
                                        std::span<const PlaneEdge> edges,
                                        const std::function<std::uint32_t(const glm::dvec2&)>& pointAt);

}  // namespace clerestory
