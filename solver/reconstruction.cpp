// SPDX-License-Identifier: GPL-3.0-or-later
// Planes of irradiance, refined down the tree where the means of elements tell more than noise.
#include "reconstruction.hpp"

#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>

#include <algorithm>
#include <cmath>

#include <geometry/parallel.hpp>
#include <geometry/sampling.hpp>

#include "neighbours.hpp"

namespace clerestory {
namespace {

constexpr float errorsOfNoise = 2.0F;  // of one interaction: departures up to here may be noise
constexpr float leastSpread = 0.02F;   // of neighbours about an element, so that they tell two slopes

/// The pseudo-inverse of (xx xy, xy yy), a sum of products of unit vectors with themselves. Where all of them
/// lie nearly in a row, only what is along it counts.
glm::mat2 inverseOf(float xx, float xy, float yy) {
  const float trace = xx + yy;
  const float determinant = xx * yy - xy * xy;
  if (determinant > leastSpread * trace * trace) return glm::mat2(yy, -xy, -xy, xx) / determinant;
  if (trace <= 0.0F) return glm::mat2(0.0F);
  const glm::vec2 row = glm::normalize(xx > yy ? glm::vec2(xx, xy) : glm::vec2(xy, yy));
  return glm::outerProduct(row, row) / trace;
}

template <int K>
class Reconstruction {
 public:
  Reconstruction(const World& world, float error_lm, Radiosity<K>& radiosity)
      : world_(world),
        tree_(radiosity.tree),
        noise_lm_(errorsOfNoise * error_lm),
        neighbours_(world, radiosity.tree),
        mean_lx_(radiosity.irradiance_lx),
        planes_(radiosity.planes) {
    planes_.assign(tree_.size(), {});
    for (NodeIndex node = static_cast<NodeIndex>(tree_.size()); node-- > 0;) {
      if (tree_.isCluster(node) || tree_.isLeaf(node)) continue;
      const NodeIndex first = tree_.firstChild[node];
      const float share = tree_.area_m2[first] / tree_.area_m2[node];
      mean_lx_[node] = share * mean_lx_[first] + (1.0F - share) * mean_lx_[first + 1];
    }
  }

  /// Wave by wave down the tree: a plane follows from its parent's and from means, which stay.
  void run() {
    std::vector<NodeIndex> wave;
    for (const TreeSide& side : tree_.sides) wave.push_back(side.root);
    forEachIndex(wave.size(), 16, [&](std::size_t i) { planes_[wave[i]] = ownPlane(wave[i]); });
    while (!wave.empty()) {
      std::erase_if(wave, [&](NodeIndex node) { return tree_.isLeaf(node); });
      forEachIndex(wave.size(), 16, [&](std::size_t i) { refine(wave[i]); });
      std::vector<NodeIndex> next;
      for (const NodeIndex node : wave) {
        next.push_back(tree_.firstChild[node]);
        next.push_back(tree_.firstChild[node] + 1);
      }
      wave = std::move(next);
    }
  }

 private:
  /// The plane that an element's mean tells, and the means of what lies beside it.
  [[nodiscard]] Plane<K> ownPlane(NodeIndex node) const {
    const Beside beside = neighbours_.of(node);
    Plane<K> plane{mean_lx_[node], fitted(node, beside)};
    for (int c = 0; c < K; ++c) limit(node, beside, c, plane.slope_lx_m[static_cast<std::size_t>(c)]);
    return plane;
  }

  /// Least squares, with weights of neighbours by the inverse square of their distance.
  [[nodiscard]] std::array<glm::vec3, K> fitted(NodeIndex node, const Beside& beside) const {
    glm::vec3 u;
    glm::vec3 v;
    tangentFrame(tree_.normal(node), u, v);
    float xx = 0.0F;
    float xy = 0.0F;
    float yy = 0.0F;
    std::array<glm::vec2, K> sums{};
    for (const NodeIndex other : beside.all()) {
      const glm::vec3 way = tree_.centre[other] - tree_.centre[node];
      const float distance_m = glm::length(way);
      const glm::vec2 direction = glm::vec2(glm::dot(way, u), glm::dot(way, v)) / distance_m;
      xx += direction.x * direction.x;
      xy += direction.x * direction.y;
      yy += direction.y * direction.y;
      const Columns<K> slope = (1.0F / distance_m) * (mean_lx_[other] - mean_lx_[node]);
      for (int c = 0; c < K; ++c) sums[static_cast<std::size_t>(c)] += slope[c] * direction;
    }
    const glm::mat2 inverse = inverseOf(xx, xy, yy);
    std::array<glm::vec3, K> slopes;
    for (std::size_t c = 0; c < K; ++c) {
      const glm::vec2 slope = inverse * sums[c];
      slopes[c] = slope.x * u + slope.y * v;
    }
    return slopes;
  }

  /// Keeps corners within the range of the neighbours' means. Where the surface ends there is nobody to ask,
  /// and light may go on rising or falling as far as it came.
  void limit(NodeIndex node, const Beside& beside, int column, glm::vec3& slope) const {
    const float own = mean_lx_[node][column];
    float up = 0.0F;
    float down = 0.0F;
    for (const NodeIndex other : beside.all()) {
      up = std::max(up, mean_lx_[other][column] - own);
      down = std::max(down, own - mean_lx_[other][column]);
    }
    const auto polygon = tree_.polygon(node);
    float factor = 1.0F;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const float rise = glm::dot(slope, polygon[i] - tree_.centre[node]);
      const float asFar = beside.endsAtCorner(i, polygon.size()) ? std::max(up, down) : 0.0F;
      const float most =
          rise > 0.0F ? std::max(up, asFar) : std::max(std::min(std::max(down, asFar), own), 0.0F);
      if (std::abs(rise) > most) factor = std::min(factor, most / std::abs(rise));
    }
    slope *= factor;
  }

  /// Gives the halves of an element their planes: its own, and from there towards what they tell themselves.
  void refine(NodeIndex node) {
    const NodeIndex first = tree_.firstChild[node];
    std::array<Plane<K>, 2> wholes;
    for (NodeIndex k = 0; k < 2; ++k) {
      wholes[k] = planes_[node];
      wholes[k].level_lx = planes_[node].at(tree_.centre[first + k] - tree_.centre[node]);
      planes_[first + k] = wholes[k];
    }
    float share = shareBeyondNoise(node);
    if (share <= 0.0F) return;
    // What the levels above have taken for noise stays out.
    const Columns<K> shift_lx = planes_[node].level_lx - mean_lx_[node];
    std::array<Plane<K>, 2> owns;
    for (NodeIndex k = 0; k < 2; ++k) {
      owns[k] = ownPlane(first + k);
      owns[k].level_lx += shift_lx;
      share = std::min(share, sharePositive(first + k, wholes[k], owns[k]));
    }
    for (NodeIndex k = 0; k < 2; ++k) planes_[first + k] = between(wholes[k], owns[k], share);
  }

  /// How far the halves of an element may leave its plane: James and Stein's share of their departure.
  [[nodiscard]] float shareBeyondNoise(NodeIndex node) const {
    const NodeIndex first = tree_.firstChild[node];
    if (noise_lm_ <= 0.0F || tree_.isOverGap(node) || neighbours_.areParted(first, first + 1)) return 1.0F;
    float departure_lm = 0.0F;
    for (NodeIndex child = first; child < first + 2; ++child) {
      Columns<K> departure_lx =
          mean_lx_[child] - mean_lx_[node] - (planes_[child].level_lx - planes_[node].level_lx);
      for (int c = 0; c < K; ++c) departure_lx[c] = std::abs(departure_lx[c]);
      departure_lm = std::max(departure_lm, tree_.weight[child] * world_.layout.strength(departure_lx));
    }
    if (departure_lm <= noise_lm_) return 0.0F;
    const float noise = noise_lm_ / departure_lm;
    return 1.0F - noise * noise;
  }

  /// How far a half may go from one plane, which is nowhere negative on it, to another.
  [[nodiscard]] float sharePositive(NodeIndex node, const Plane<K>& from, const Plane<K>& to) const {
    float share = 1.0F;
    for (const glm::vec3& corner : tree_.polygon(node)) {
      const Columns<K> here = from.at(corner - tree_.centre[node]);
      const Columns<K> there = to.at(corner - tree_.centre[node]);
      for (int c = 0; c < K; ++c) {
        if (there[c] < 0.0F) share = std::min(share, std::max(here[c], 0.0F) / (here[c] - there[c]));
      }
    }
    return share;
  }

  [[nodiscard]] static Plane<K> between(const Plane<K>& from, const Plane<K>& to, float share) {
    Plane<K> plane = from;
    plane.level_lx += share * (to.level_lx - from.level_lx);
    for (std::size_t c = 0; c < K; ++c)
      plane.slope_lx_m[c] += share * (to.slope_lx_m[c] - from.slope_lx_m[c]);
    return plane;
  }

  const World& world_;
  const Hierarchy& tree_;
  float noise_lm_;
  Neighbours neighbours_;
  std::vector<Columns<K>> mean_lx_;  // #nodes
  std::vector<Plane<K>>& planes_;    // #nodes
};

}  // namespace

template <int K>
void reconstruct(const World& world, float error_lm, Radiosity<K>& radiosity) {
  Reconstruction<K>(world, error_lm, radiosity).run();
}

template void reconstruct<1>(const World&, float, Radiosity<1>&);
template void reconstruct<2>(const World&, float, Radiosity<2>&);
template void reconstruct<4>(const World&, float, Radiosity<4>&);
template void reconstruct<8>(const World&, float, Radiosity<8>&);
template void reconstruct<12>(const World&, float, Radiosity<12>&);

}  // namespace clerestory
