// SPDX-License-Identifier: GPL-3.0-or-later
// Points of a picture at which light is found, before it is shaded: of every surface in every tile of a few
// pixels one.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <geometry/parallel.hpp>

#include "looks.hpp"

namespace clerestory {

inline constexpr int tileSide_px = 3;

/// A visible point whose irradiance is known.
template <int K>
struct ViewSample {
  glm::vec2 pixel{0.0F};         ///< where it is seen
  float reach_px = tileSide_px;  ///< how far from there others count more
  glm::vec3 point{0.0F}, normal{0.0F};
  float distance_m = 0.0F;
  std::int32_t domain = -1;
  Columns<K> reflected_lx;
  Columns<K> unhidden_lx;     ///< direct light were nothing in the way
  Columns<K> share;           ///< of it that arrives
  float deviation_lx = 0.0F;  ///< of direct light
  float grain_lx = 0.0F;      ///< of that light, what a single ray brought that met the bright
  bool isMeasured = false;    ///< direct light, by rays of its own
  bool seemsSure = false;     ///< that light, after the first of them

  [[nodiscard]] Columns<K> irradiance_lx() const { return share * unhidden_lx + reflected_lx; }
  /// Whether it stands for a single pixel.
  [[nodiscard]] bool isOfPixel() const { return reach_px < tileSide_px; }
};

/// Whether two points lie on one surface, or on facets that stand for a curved one.
template <int K>
bool isOneSurface(const ViewSample<K>& a, const ViewSample<K>& b) {
  return a.domain == b.domain && glm::dot(a.normal, b.normal) > 0.95F &&
         std::abs(glm::dot(a.point - b.point, a.normal)) < 0.004F * a.distance_m;
}

/// All samples of a picture, by tiles in rows.
template <int K>
class ViewSamples {
 public:
  /// Finds them; their light is still to be told.
  ViewSamples(const World& world, const Looks<K>& looks);

  std::vector<ViewSample<K>> all;

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] std::size_t tiles() const { return first_.size() - 1; }
  [[nodiscard]] std::size_t tileAt(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] int columnOf(std::size_t tile) const {
    return static_cast<int>(tile % static_cast<std::size_t>(columns_));
  }
  [[nodiscard]] int rowOf(std::size_t tile) const {
    return static_cast<int>(tile / static_cast<std::size_t>(columns_));
  }
  /// Number of the first sample of a tile; of the tile after the last one, #all.
  [[nodiscard]] std::size_t firstOf(std::size_t tile) const { return first_[tile]; }
  [[nodiscard]] std::span<const ViewSample<K>> in(int column, int row) const {
    const std::size_t at = tileAt(column, row);
    return std::span(all).subspan(first_[at], first_[at + 1] - first_[at]);
  }

  /// Calls visit(tile, number) for all samples, in parallel.
  template <class Visit>
  void forEach(const Visit& visit) const;
  /// Numbers of those samples, in tiles of every `stride`-th column and row, that isNeeded(tile, number).
  template <class IsNeeded>
  [[nodiscard]] std::vector<std::size_t> inLattice(int stride, const IsNeeded& isNeeded) const;
  /// Makes each sample anew from those around it: change(result, tile, number), in parallel.
  template <class Change>
  void changeAll(const Change& change);

  /// Calls `visit` for each sample on the surface of `own` in every `stride`-th tile of those at most `reach`
  /// from a tile.
  template <class Visit>
  void onSurface(const ViewSample<K>& own, std::size_t tile, int reach, int stride, const Visit& visit) const;

  /// Extent of a tile where a sample lies, as if all of it were seen at the same cosine. [m]
  [[nodiscard]] float tile_m(const ViewSample<K>& sample) const {
    return sample.distance_m * tileSide_px * looks_.camera().pixelAngle() /
           std::sqrt(std::max(aslantOf(sample), 0.1F));
  }
  /// Extent of a pixel there, as if it were seen squarely. [m]
  [[nodiscard]] float pixel_m(const ViewSample<K>& sample) const {
    return sample.distance_m * looks_.camera().pixelAngle();
  }

 private:
  [[nodiscard]] std::vector<ViewSample<K>> ofTile(std::size_t tile) const;
  [[nodiscard]] std::optional<ViewSample<K>> atPixel(int x, int y) const;
  /// Cosine at which a sample is seen.
  [[nodiscard]] float aslantOf(const ViewSample<K>& sample) const {
    return std::abs(glm::dot(sample.normal, sample.point - looks_.eye())) / sample.distance_m;
  }

  const World& world_;
  const Looks<K>& looks_;
  int columns_, rows_;
  std::vector<std::size_t> first_;  // of a tile, and one past the last
};

template <int K>
template <class Visit>
void ViewSamples<K>::forEach(const Visit& visit) const {
  forEachIndex(tiles(), 64, [&](std::size_t tile) {
    for (std::size_t s = first_[tile]; s < first_[tile + 1]; ++s) visit(tile, s);
  });
}

template <int K>
template <class IsNeeded>
std::vector<std::size_t> ViewSamples<K>::inLattice(int stride, const IsNeeded& isNeeded) const {
  std::vector<std::uint8_t> areNeeded(all.size(), 0);
  forEach([&](std::size_t tile, std::size_t s) {
    if (columnOf(tile) % stride == 0 && rowOf(tile) % stride == 0) areNeeded[s] = isNeeded(tile, s) ? 1 : 0;
  });
  std::vector<std::size_t> needed;
  for (std::size_t s = 0; s < all.size(); ++s) {
    if (areNeeded[s] != 0) needed.push_back(s);
  }
  return needed;
}

template <int K>
template <class Change>
void ViewSamples<K>::changeAll(const Change& change) {
  std::vector<ViewSample<K>> changed = all;
  forEach([&](std::size_t tile, std::size_t s) { change(changed[s], tile, s); });
  std::swap(all, changed);
}

template <int K>
template <class Visit>
void ViewSamples<K>::onSurface(const ViewSample<K>& own, std::size_t tile, int reach, int stride,
                               const Visit& visit) const {
  const auto firstFrom = [&](int at) { return (std::max(at, 0) + stride - 1) / stride * stride; };
  const int column = columnOf(tile);
  const int row = rowOf(tile);
  for (int y = firstFrom(row - reach); y <= std::min(row + reach, rows_ - 1); y += stride) {
    for (int x = firstFrom(column - reach); x <= std::min(column + reach, columns_ - 1); x += stride) {
      for (const ViewSample<K>& other : in(x, y)) {
        if (isOneSurface(own, other)) visit(other);
      }
    }
  }
}

}  // namespace clerestory
