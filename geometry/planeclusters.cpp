// SPDX-License-Identifier: GPL-3.0-or-later
// Gathers faces by plane through the points they share, and by a hash of planes where they share none.
#include "planeclusters.hpp"

#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <map>
#include <unordered_map>

namespace clerestory {
namespace {

struct Cluster {
  std::uint32_t seed;  ///< the largest face, as place in the list of faces
  std::uint32_t parent;
  glm::dvec3 low{1e300}, high{-1e300};
};

Face describe(const Soup& soup, std::uint32_t index) {
  const auto corners = soup.faces[index];
  const glm::dvec3 vector = doubleAreaVector(soup.points, corners);
  const glm::dvec3 bentNormal = glm::normalize(vector);
  Face face{index,
            soup.isBent(index) ? soup.bentFrom[index] : bentNormal,
            bentNormal,
            glm::dvec3(0.0),
            0.5 * glm::length(vector),
            0.0};
  double longest_m = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    face.middle += soup.points[corners[i]] / static_cast<double>(corners.size());
    longest_m = std::max(
        longest_m, glm::length(soup.points[corners[(i + 1) % corners.size()]] - soup.points[corners[i]]));
  }
  face.thickness_m = 2.0 * face.area_m2 / longest_m;
  return face;
}

/// Gathers the faces of one object and material by plane: a face joins the plane of a larger one that it
/// touches.
class PlaneClusters {
 public:
  PlaneClusters(const Soup& soup, const Tolerances& tolerances)
      : soup_(soup), tolerances_(tolerances), atPoint_(soup.points.size()) {}

  /// `faces` by falling area. Returns the groups, each by falling area.
  std::vector<std::vector<std::uint32_t>> gather(std::span<const Face> faces) {
    clusters_.clear();
    std::vector<std::uint32_t> clusterOf(faces.size());
    for (std::uint32_t i = 0; i < faces.size(); ++i) clusterOf[i] = assign(faces, i);
    for (const Face& face : faces) {
      for (const std::uint32_t corner : soup_.faces[face.index]) atPoint_[corner].clear();
    }
    joinOverlapping(faces, clusterOf);
    std::map<std::uint32_t, std::vector<std::uint32_t>> groups;
    for (std::uint32_t i = 0; i < faces.size(); ++i) groups[find(clusterOf[i])].push_back(i);
    std::vector<std::vector<std::uint32_t>> result;
    for (auto& [root, members] : groups) result.push_back(std::move(members));
    return result;
  }

 private:
  std::uint32_t find(std::uint32_t cluster) {
    while (clusters_[cluster].parent != cluster) {
      cluster = clusters_[cluster].parent = clusters_[clusters_[cluster].parent].parent;
    }
    return cluster;
  }

  [[nodiscard]] bool fits(const Face& face, const Face& seed) const {
    const auto sineBetween = [](const glm::dvec3& a, const glm::dvec3& b) {
      return glm::length(glm::cross(a, b));
    };
    // Thin faces have uncertain normals.
    const double thickness_m = std::max(face.thickness_m, 1e-9);
    const double angle_rad =
        std::min(0.5, tolerances_.coplanarAngle_rad + 4.0 * tolerances_.drawn_m / thickness_m);
    const bool areBent = soup_.isBent(face.index) || soup_.isBent(seed.index);
    // Faces that the weld has bent are taken for the planes they were, and for those it may have made one.
    const double bentAngle_rad =
        std::min(tolerances_.displacedAngle_rad, 4.0 * tolerances_.weld_m / thickness_m);
    if (sineBetween(face.normal, seed.normal) > angle_rad &&
        !(areBent && sineBetween(face.bentNormal, seed.bentNormal) <= bentAngle_rad))
      return false;
    const double height_m = areBent ? 2.0 * tolerances_.weld_m : tolerances_.coplanar_m;
    return std::ranges::all_of(soup_.faces[face.index], [&](std::uint32_t corner) {
      return std::abs(glm::dot(soup_.points[corner] - seed.middle, seed.normal)) <= height_m;
    });
  }

  std::uint32_t assign(std::span<const Face> faces, std::uint32_t i) {
    const auto corners = soup_.faces[faces[i].index];
    std::vector<std::uint32_t> candidates;
    for (const std::uint32_t corner : corners) {
      for (const std::uint32_t cluster : atPoint_[corner]) candidates.push_back(find(cluster));
    }
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());

    std::uint32_t own = none;
    for (const std::uint32_t cluster : candidates) {  // by falling area of the seeds
      if (!fits(faces[i], faces[clusters_[cluster].seed])) continue;
      if (own == none) {
        own = cluster;
      } else if (fits(faces[clusters_[cluster].seed], faces[clusters_[own].seed])) {
        clusters_[cluster].parent = own;
      }
    }
    if (own == none) {
      own = static_cast<std::uint32_t>(clusters_.size());
      clusters_.push_back({.seed = i, .parent = own});
    }
    for (const std::uint32_t corner : corners) {
      auto& list = atPoint_[corner];
      if (std::find(list.begin(), list.end(), own) == list.end()) list.push_back(own);
    }
    return own;
  }

  /// Joins clusters of one plane that share no corner but whose boxes meet: their edges may.
  void joinOverlapping(std::span<const Face> faces, std::span<const std::uint32_t> clusterOf) {
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
      Cluster& cluster = clusters_[find(clusterOf[i])];
      for (const std::uint32_t corner : soup_.faces[faces[i].index]) {
        cluster.low = glm::min(cluster.low, soup_.points[corner] - tolerances_.coplanar_m);
        cluster.high = glm::max(cluster.high, soup_.points[corner] + tolerances_.coplanar_m);
      }
    }
    glm::dvec3 low(1e300);
    glm::dvec3 high(-1e300);
    for (const Cluster& cluster : clusters_) {
      low = glm::min(low, cluster.low);
      high = glm::max(high, cluster.high);
    }
    const glm::dvec3 centre = 0.5 * (low + high);
    const double offsetSlack_m = 2.0 * tolerances_.coplanar_m + normalSlack * glm::length(high - low);
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> byPlane;
    for (std::uint32_t c = 0; c < clusters_.size(); ++c) {
      if (find(c) != c) continue;
      const Face& seed = faces[clusters_[c].seed];
      for (const double sign : {1.0, -1.0}) {
        const glm::dvec3 normal = sign * seed.normal;
        const glm::dvec4 plane(normal / normalSlack, glm::dot(normal, seed.middle - centre) / offsetSlack_m);
        forCellsAround(plane, [&](std::uint64_t cell) {
          const auto found = byPlane.find(cell);
          if (found != byPlane.end()) joinWith(faces, c, found->second);
        });
      }
      const glm::dvec4 plane(seed.normal / normalSlack,
                             glm::dot(seed.normal, seed.middle - centre) / offsetSlack_m);
      byPlane[cellKey(glm::floor(plane / cellWidth))].push_back(c);
    }
  }

  // Planes are looked up in cells that are wide against the slack, so that mostly one cell is looked at.
  static constexpr double normalSlack = 2.5e-3;
  static constexpr double cellWidth = 20.0;  ///< in units of the slack

  /// Planes that fall together by chance are told apart by their boxes and `fits`.
  static std::uint64_t cellKey(const glm::dvec4& cell) {
    std::uint64_t key = 0;
    for (int i = 0; i < 4; ++i) {
      key = (key + static_cast<std::uint64_t>(static_cast<std::int64_t>(cell[i]))) * 0x9e3779b97f4a7c15U;
      key ^= key >> 29U;
    }
    return key;
  }

  template <class Visit>
  static void forCellsAround(const glm::dvec4& plane, Visit visit) {
    const glm::dvec4 low = glm::floor((plane - 1.0) / cellWidth);
    const glm::dvec4 high = glm::floor((plane + 1.0) / cellWidth);
    for (double x = low.x; x <= high.x; ++x) {
      for (double y = low.y; y <= high.y; ++y) {
        for (double z = low.z; z <= high.z; ++z) {
          for (double w = low.w; w <= high.w; ++w) visit(cellKey({x, y, z, w}));
        }
      }
    }
  }

  void joinWith(std::span<const Face> faces, std::uint32_t cluster, std::span<const std::uint32_t> others) {
    const Face& seed = faces[clusters_[cluster].seed];
    for (const std::uint32_t other : others) {
      const Cluster& a = clusters_[cluster];
      const Cluster& b = clusters_[other];
      if (a.low.x > b.high.x || a.low.y > b.high.y || a.low.z > b.high.z || b.low.x > a.high.x ||
          b.low.y > a.high.y || b.low.z > a.high.z || !fits(seed, faces[b.seed])) {
        continue;
      }
      const std::uint32_t first = std::min(find(cluster), find(other));  // the one of the larger seed
      clusters_[std::max(find(cluster), find(other))].parent = first;
    }
  }

  static constexpr std::uint32_t none = 0xffffffffU;
  const Soup& soup_;
  const Tolerances& tolerances_;
  std::vector<std::vector<std::uint32_t>> atPoint_;
  std::vector<Cluster> clusters_;
};

}  // namespace

std::vector<std::vector<Face>> facesByPlane(const Soup& soup, const Tolerances& tolerances) {
  std::vector<Face> faces;
  for (std::uint32_t i = 0; i < soup.faces.size(); ++i) faces.push_back(describe(soup, i));
  const auto less = [&](const Face& a, const Face& b) {
    if (soup.object[a.index] != soup.object[b.index]) return soup.object[a.index] < soup.object[b.index];
    if (soup.material[a.index] != soup.material[b.index])
      return soup.material[a.index] < soup.material[b.index];
    if (a.area_m2 != b.area_m2) return a.area_m2 > b.area_m2;
    const auto p = soup.faces[a.index];
    const auto q = soup.faces[b.index];
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  std::sort(faces.begin(), faces.end(), less);

  PlaneClusters clusters(soup, tolerances);
  std::vector<std::vector<Face>> result;
  for (std::size_t first = 0; first < faces.size();) {
    std::size_t end = first;
    while (end < faces.size() && soup.object[faces[end].index] == soup.object[faces[first].index] &&
           soup.material[faces[end].index] == soup.material[faces[first].index]) {
      ++end;
    }
    const std::span<const Face> group(faces.begin() + static_cast<std::ptrdiff_t>(first), end - first);
    for (const auto& members : clusters.gather(group)) {
      std::vector<Face>& plane = result.emplace_back();
      for (const std::uint32_t member : members) plane.push_back(group[member]);
    }
    first = end;
  }
  return result;
}

}  // namespace clerestory
