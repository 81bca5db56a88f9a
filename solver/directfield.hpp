// SPDX-License-Identifier: GPL-3.0-or-later
// Direct light at the many points of a picture: by exact form factors were nothing in the way, and by rays as
// the share of that which arrives.
#pragma once

#include <span>
#include <vector>

#include "direct.hpp"
#include "radiosity.hpp"

namespace clerestory {

/// Direct light as rays tell it.
template <int K>
struct MeasuredLight {
  DirectLight<K> light;
  float grain_lx = 0.0F;  ///< what a single ray brought that met the bright among the dark; 0 where none did
};

/// All that shines on the surfaces of a domain: its portals, emitting sides, bright parts and luminaires.
template <int K>
class DirectField {
 public:
  DirectField(const SolvedLight<K>& light, std::int32_t domain);

  /// Polygons that shine: how many form factors a point has.
  [[nodiscard]] std::size_t shiners() const { return shiners_.size(); }

  /// Light at a point with unit `normal`, were nothing in the way and every polygon of its mean luminance.
  /// What arrives divided by this varies only where something casts a shadow, and slowly with the angle.
  /// `formFactors` (#shiners) receives those of the polygons, 0 where one does not shine there. [lx]
  [[nodiscard]] Columns<K> unhidden(const glm::vec3& point, const glm::vec3& normal,
                                    std::span<float> formFactors) const;

  /// Light at a point of which `unhidden` has told the form factors, by about `rays` rays, shared out by what
  /// each polygon would send unhidden; then by more where its deviation is above `deviationMost` of all
  /// light, `known_lx` of other light among it. `key` seeds them.
  [[nodiscard]] MeasuredLight<K> light(const glm::vec3& point, const glm::vec3& normal,
                                       std::span<const float> formFactors, float rays, float deviationMost,
                                       float known_lx, std::uint64_t key) const;

 private:
  struct Shiner {
    std::span<const glm::vec3> polygon;
    bool isParallelogram;
    glm::vec3 inward;
    std::uint32_t side;
    const Portal* portal;  ///< where it is one
    bool isBrightPart;     ///< of a side that does not emit
    std::uint64_t key;
    Columns<K> luminance_cd_m2;  ///< mean over its area, of a portal over directions by cosine too
    float strength;              ///< of that luminance
  };
  /// A shiner as a point has sampled it.
  struct Part {
    const Shiner* shiner;
    float formFactor;
    std::uint32_t rays = 0;
    Columns<K> sum;
    float weights = 0.0F, strengths = 0.0F, squares = 0.0F;
    float most = 0.0F;  ///< that a single ray added to `strengths`
  };
  /// Rays to be cast to one kind of shiners.
  struct Probes {
    std::vector<std::size_t> part;
    std::vector<float> weight;
    std::vector<RayScene::Segment> ray;
  };

  [[nodiscard]] std::vector<Part> partsOf(std::span<const float> formFactors) const;
  void sample(std::vector<Part>& parts, std::span<const std::uint32_t> counts, const glm::vec3& point,
              const glm::vec3& normal, std::uint64_t key) const;
  [[nodiscard]] Columns<K> seenOfBrightPart(const Shiner& shiner, const RayScene::Segment& ray) const;
  [[nodiscard]] DirectLight<K> lightOf(const Part& part) const;
  [[nodiscard]] float grainOf(const Part& part) const;

  const SolvedLight<K>& light_;
  const World& world_;
  std::int32_t domain_;
  std::vector<Shiner> shiners_;
};

}  // namespace clerestory
