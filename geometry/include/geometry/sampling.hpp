// SPDX-License-Identifier: GPL-3.0-or-later
// Low-discrepancy points seeded by stable keys, and where they fall on polygons and hemispheres.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

namespace clerestory {

/// A well mixed 64-bit value (the finaliser of splitmix64): equal keys give equal values on every machine.
constexpr std::uint64_t mixKey(std::uint64_t key) {
  key += 0x9e3779b97f4a7c15U;
  key = (key ^ (key >> 30U)) * 0xbf58476d1ce4e5b9U;
  key = (key ^ (key >> 27U)) * 0x94d049bb133111ebU;
  return key ^ (key >> 31U);
}

constexpr std::uint64_t mixKeys(std::uint64_t a, std::uint64_t b) {
  return mixKey(mixKey(a) ^ (b + 0x632be59bd9b4e019U));
}

/// Roberts' additive sequences, shifted by a key. [0, 1)^4. The first two dimensions are his R2, which most
/// points use alone; the other two are the last two of his R4.
class Sequence {
 public:
  explicit Sequence(std::uint64_t key)
      : shift_{mixKey(key), mixKey(key + 1), mixKey(key + 2), mixKey(key + 3)} {}

  /// Coordinate `dimension` (0 … 3) of point `index`; computed in integers, so it never drifts.
  [[nodiscard]] float operator()(std::uint32_t index, int dimension) const {
    constexpr std::uint64_t step[4] = {0xc13fa9a902a6328fU, 0x91e10da5c79e7b1cU, 0xa0f2ec75a1fe1575U,
                                       0x89e182857d9ed688U};
    const std::uint64_t turn = shift_[dimension] + step[dimension] * (std::uint64_t{index} + 1U);
    return static_cast<float>(turn >> 40U) * 0x1p-24F;
  }

 private:
  std::uint64_t shift_[4];
};

/// A point of the convex `polygon` (#≥3), uniform by area for uniform u, v in [0, 1).
template <class Vector>
Vector pointOnPolygon(std::span<const Vector> polygon, float u, float v) {
  using Scalar = typename Vector::value_type;
  Scalar total = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    total += glm::length(glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]));
  }
  // The fan triangle that holds the fraction u of the area; u is then stretched over it.
  Scalar target = static_cast<Scalar>(u) * total;
  std::size_t corner = 2;
  Scalar share = glm::length(glm::cross(polygon[1] - polygon[0], polygon[2] - polygon[0]));
  while (corner + 1 < polygon.size() && target >= share) {
    target -= share;
    ++corner;
    share = glm::length(glm::cross(polygon[corner - 1] - polygon[0], polygon[corner] - polygon[0]));
  }
  const Scalar a = share > 0 ? std::sqrt(glm::min(target / share, Scalar(1))) : Scalar(0);
  const Scalar b = static_cast<Scalar>(v) * a;
  return polygon[0] + (a - b) * (polygon[corner - 1] - polygon[0]) + b * (polygon[corner] - polygon[0]);
}

/// Two unit vectors that make a right-handed frame with the unit vector `normal` (Duff et al. 2017).
inline void tangentFrame(const glm::vec3& normal, glm::vec3& tangent, glm::vec3& bitangent) {
  const float sign = std::copysign(1.0F, normal.z);
  const float a = -1.0F / (sign + normal.z);
  const float b = normal.x * normal.y * a;
  tangent = {1.0F + sign * normal.x * normal.x * a, sign * b, -sign * normal.x};
  bitangent = {b, sign + normal.y * normal.y * a, -normal.y};
}

/// A direction about the unit vector `normal` with density cos(angle) / pi, for uniform u, v in [0, 1).
inline glm::vec3 cosineDirection(const glm::vec3& normal, float u, float v) {
  glm::vec3 tangent;
  glm::vec3 bitangent;
  tangentFrame(normal, tangent, bitangent);
  const float radius = std::sqrt(u);
  const float angle = 2.0F * std::numbers::pi_v<float> * v;
  return glm::normalize(radius * std::cos(angle) * tangent + radius * std::sin(angle) * bitangent +
                        std::sqrt(std::max(1.0F - u, 1e-12F)) * normal);
}

}  // namespace clerestory
