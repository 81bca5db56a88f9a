// SPDX-License-Identifier: GPL-3.0-or-later
// Irradiance by reflected light, known at few points and interpolated between them (Ward, Rubinstein and
// Clear, A ray tracing solution for diffuse interreflection, SIGGRAPH 1988).
#pragma once

#include <optional>

#include "radiosity.hpp"

namespace clerestory {

/// Reflected light at a point, which holds for points around it.
template <int K>
struct IrradianceRecord {
  glm::vec3 point{0.0F}, normal{0.0F};
  std::int32_t domain = -1;
  float radius_m = 0.0F;  ///< how far it holds
  Columns<K> irradiance_lx;

  /// How much it counts at another point: 1 at its own, 0 from its radius on, and on other surfaces.
  [[nodiscard]] float weightAt(std::int32_t domainThere, const glm::vec3& there,
                               const glm::vec3& normalThere) const;
};

/// What limits how far records hold. [m]
struct RecordReach {
  float least_m, most_m;
};

/// Gathers reflected light at a point by cosine rays. The nearer all that they meet, the less far the record
/// holds, and the fewer rays it needs, since others lie close to it.
template <int K>
IrradianceRecord<K> irradianceRecord(const SolvedLight<K>& light, std::int32_t domain, const glm::vec3& point,
                                     const glm::vec3& normal, const RecordReach& reach,
                                     std::uint32_t raysMost, std::uint64_t key);

/// Irradiance at a point between records: the level of the plane through them that fits best (moving least
/// squares), tied a little to the mean where few records tell no slope.
template <int K>
class IrradianceFit {
 public:
  explicit IrradianceFit(const glm::vec3& normal);
  /// `way_m` leads from the point to the record.
  void add(float weight, const glm::vec3& way_m, float radius_m, const Columns<K>& irradiance_lx);
  [[nodiscard]] float weights() const { return weights_; }
  /// To be asked only where something was added.
  [[nodiscard]] Columns<K> value() const;

 private:
  glm::vec3 u_, v_;
  float weights_ = 0.0F, x_ = 0.0F, y_ = 0.0F, xx_ = 0.0F, xy_ = 0.0F, yy_ = 0.0F, radii_ = 0.0F;
  Columns<K> sum_, xSum_, ySum_, low_, high_;
};

}  // namespace clerestory
