// SPDX-License-Identifier: GPL-3.0-or-later
// Free space in voxels with the distance to the nearest surface; the widest way out by a search that always
// goes on where there is most room (Prim's order), and the narrowest voxel that it came through.
#include "gaps.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace clerestory {
namespace {

constexpr double voxel_m = 0.03;
constexpr double voxelsMax = 1.2e7;
constexpr std::uint16_t step = 3, diagonal = 4, corner = 5;  // chamfer distances; 3 is one voxel
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// A box of voxels, x running fastest, with a rim of one voxel that is never stood on.
class Voxels {
 public:
  Voxels(const glm::dvec3& low, const glm::dvec3& high) {
    const glm::dvec3 size_m = high - low;
    edge_m_ = std::max(voxel_m, std::cbrt(size_m.x * size_m.y * size_m.z / voxelsMax));
    count_ = glm::ivec3(glm::ceil(size_m / edge_m_)) + 3;
    low_ = low - 1.5 * edge_m_;
    const auto total = static_cast<std::size_t>(count_.x) * static_cast<std::size_t>(count_.y) *
                       static_cast<std::size_t>(count_.z);
    room_.assign(total, std::numeric_limits<std::uint16_t>::max() / 2);
  }

  [[nodiscard]] std::uint32_t indexOf(const glm::ivec3& cell) const {
    return static_cast<std::uint32_t>((cell.z * count_.y + cell.y) * count_.x + cell.x);
  }
  [[nodiscard]] glm::ivec3 cellOf(const glm::dvec3& point) const {
    return glm::clamp(glm::ivec3(glm::floor((point - low_) / edge_m_)), glm::ivec3(0), count_ - 1);
  }
  [[nodiscard]] glm::ivec3 cellAt(std::uint32_t index) const {
    const auto i = static_cast<int>(index);
    return {i % count_.x, i / count_.x % count_.y, i / (count_.x * count_.y)};
  }
  [[nodiscard]] glm::dvec3 middleOf(std::uint32_t index) const {
    return low_ + edge_m_ * (glm::dvec3(cellAt(index)) + 0.5);
  }
  [[nodiscard]] bool isRim(const glm::ivec3& cell) const {
    return glm::any(glm::lessThan(cell, glm::ivec3(1))) || glm::any(glm::greaterThan(cell, count_ - 2));
  }
  [[nodiscard]] std::uint16_t room(std::uint32_t index) const { return room_[index]; }
  [[nodiscard]] std::size_t size() const { return room_.size(); }
  [[nodiscard]] double edge_m() const { return edge_m_; }

  /// Marks the voxels that a convex polygon passes through: a fan of triangles, sampled twice a voxel.
  void fill(const std::vector<glm::dvec3>& polygon) {
    const glm::dvec3 high = low_ + edge_m_ * glm::dvec3(count_);
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      const glm::dvec3& a = polygon[0];
      const glm::dvec3 b = polygon[i - 1] - a;
      const glm::dvec3 c = polygon[i] - a;
      const double rows = std::ceil(2.0 * glm::length(c) / edge_m_) + 1.0;
      for (double row = 0.0; row <= rows; ++row) {
        const double v = row / rows;
        const double columns = std::ceil(2.0 * (1.0 - v) * glm::length(b) / edge_m_) + 1.0;
        for (double column = 0.0; column <= columns; ++column) {
          const glm::dvec3 point = a + (1.0 - v) * (column / columns) * b + v * c;
          if (glm::all(glm::greaterThan(point, low_)) && glm::all(glm::lessThan(point, high)))
            room_[indexOf(cellOf(point))] = 0;
        }
      }
    }
  }

  /// Chamfer distance of every voxel to the nearest filled one (Borgefors 1986, 3-4-5), in two sweeps.
  void measureRoom() {
    for (const int sign : {1, -1}) {
      const glm::ivec3 first = sign > 0 ? glm::ivec3(0) : count_ - 1;
      for (int z = first.z; z >= 0 && z < count_.z; z += sign) {
        for (int y = first.y; y >= 0 && y < count_.y; y += sign) {
          for (int x = first.x; x >= 0 && x < count_.x; x += sign) relax({x, y, z}, sign);
        }
      }
    }
  }

 private:
  void relax(const glm::ivec3& cell, int sign) {
    std::uint16_t& own = room_[indexOf(cell)];
    for (int dz = -1; dz <= 0; ++dz) {
      for (int dy = -1; dy <= (dz < 0 ? 1 : 0); ++dy) {
        for (int dx = -1; dx <= (dz < 0 || dy < 0 ? 1 : -1); ++dx) {
          const glm::ivec3 other = cell + sign * glm::ivec3(dx, dy, dz);
          if (glm::any(glm::lessThan(other, glm::ivec3(0))) ||
              glm::any(glm::greaterThanEqual(other, count_))) {
            continue;
          }
          const int axes = std::abs(dx) + std::abs(dy) + std::abs(dz);
          const auto way = static_cast<std::uint16_t>(room_[indexOf(other)] + (axes == 1   ? step
                                                                               : axes == 2 ? diagonal
                                                                                           : corner));
          own = std::min(own, way);
        }
      }
    }
  }

  double edge_m_ = voxel_m;
  glm::ivec3 count_{0};
  glm::dvec3 low_{0.0};
  std::vector<std::uint16_t> room_;  // chamfer units
};

/// Voxels by their room, the roomiest first, the last added of equals first.
class Front {
 public:
  void add(std::uint32_t voxel, std::uint16_t room) {
    if (room >= byRoom_.size()) byRoom_.resize(std::size_t{room} + 1);
    byRoom_[room].push_back(voxel);
    top_ = std::max<std::size_t>(top_, room);
  }
  /// none where it is empty.
  std::uint32_t take() {
    while (top_ > 0 && (top_ >= byRoom_.size() || byRoom_[top_].empty())) --top_;
    if (top_ == 0) return none;
    const std::uint32_t voxel = byRoom_[top_].back();
    byRoom_[top_].pop_back();
    return voxel;
  }

 private:
  std::vector<std::vector<std::uint32_t>> byRoom_;
  std::size_t top_ = 0;
};

}  // namespace

std::optional<Gap> widestGap(const Pieces& pieces, const glm::dvec3& inside, const glm::dvec3& low,
                             const glm::dvec3& high) {
  Voxels voxels(low, high);
  std::vector<glm::dvec3> polygon;
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    polygon.clear();
    for (const std::uint32_t point : pieces.polygons[piece]) polygon.push_back(pieces.points[point]);
    voxels.fill(polygon);
  }
  voxels.measureRoom();

  std::vector<bool> seen(voxels.size(), false);
  Front front;
  const std::uint32_t start = voxels.indexOf(voxels.cellOf(inside));
  front.add(start, voxels.room(start));
  seen[start] = true;
  std::uint32_t narrowest = start;
  for (std::uint32_t voxel = front.take(); voxel != none; voxel = front.take()) {
    if (voxels.room(voxel) <= voxels.room(narrowest)) narrowest = voxel;
    const glm::ivec3 cell = voxels.cellAt(voxel);
    if (voxels.isRim(cell)) {
      return Gap{voxels.middleOf(narrowest), 2.0 * voxels.room(narrowest) * voxels.edge_m() / step};
    }
    for (const glm::ivec3& way : {glm::ivec3(1, 0, 0), glm::ivec3(-1, 0, 0), glm::ivec3(0, 1, 0),
                                  glm::ivec3(0, -1, 0), glm::ivec3(0, 0, 1), glm::ivec3(0, 0, -1)}) {
      const std::uint32_t next = voxels.indexOf(cell + way);
      if (seen[next] || voxels.room(next) == 0) continue;
      seen[next] = true;
      front.add(next, voxels.room(next));
    }
  }
  return {};
}

}  // namespace clerestory
