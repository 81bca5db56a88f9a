// SPDX-License-Identifier: GPL-3.0-or-later
// Rays against a building's pieces, through Embree; the only file that knows it is rays.cpp.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <geometry/building.hpp>

namespace clerestory {

/// How far off a surface the rays that leave it start. [m]
inline constexpr float rayOffset_m = 1e-4F;

/// Pieces as an acceleration structure in float, in local coordinates: local = world - origin().
/// Queries may run on many threads.
class RayScene {
 public:
  struct Hit {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t piece = none;
    float distance_m = std::numeric_limits<float>::infinity();
    bool front = true;  ///< met from the side that the piece's normal looks to

    explicit operator bool() const { return piece != none; }
    [[nodiscard]] std::uint32_t side() const { return 2 * piece + (front ? 0U : 1U); }
  };
  /// What stops a ray: opaque pieces alone, or these and the glass that bounds a domain.
  enum class Barrier { opaque, opaqueAndGlass };
  /// From a point along a unit vector.
  struct Ray {
    glm::vec3 from, direction;
  };
  /// From a point to a point, either of which may lie on a surface.
  struct Segment {
    glm::vec3 from, to;
  };

  /// `innerGlass` (#pieces, or empty before it is known): glass that bounds no domain.
  RayScene(const CleanModel& model, const std::vector<bool>& innerGlass);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  [[nodiscard]] glm::dvec3 origin() const;

  /// The first piece that the ray meets within `limit_m`. `direction` is a unit vector. A ray that leaves a
  /// surface starts rayOffset_m off it; a start on the surface itself may meet that surface.
  [[nodiscard]] Hit nearest(const glm::vec3& from, const glm::vec3& direction, Barrier barrier,
                            float limit_m = std::numeric_limits<float>::infinity()) const;

  /// How neighbours in a list of rays run: alike, as those of a picture's pixels do, or every way.
  enum class Course { alike, scattered };
  /// The same for many rays at once, in packets: four times as quick for rays that run alike, a fifth quicker
  /// for others if they are said to be scattered. `hits` (#rays) receives what each meets.
  void nearest(std::span<const Ray> rays, Barrier barrier, std::span<Hit> hits,
               Course course = Course::alike) const;

  /// Whether `nearest` would meet something.
  [[nodiscard]] bool meetsAny(const glm::vec3& from, const glm::vec3& direction, Barrier barrier,
                              float limit_m) const;

  /// Whether something stands between two points, which may lie on surfaces themselves.
  [[nodiscard]] bool occluded(const glm::vec3& from, const glm::vec3& to, Barrier barrier) const;

  /// The same for many segments at once, in packets; quickest where neighbours in the list lie close.
  /// `blocked` (#segments) becomes 1 where something stands between, else 0.
  void occluded(std::span<const Segment> segments, Barrier barrier, std::span<std::uint8_t> blocked) const;

  /// The panes of inner glass between two points, for their transmittance. `limit` of them at most.
  [[nodiscard]] std::vector<std::uint32_t> innerGlassBetween(const glm::vec3& from, const glm::vec3& to,
                                                             std::size_t limit = 8) const;
  [[nodiscard]] bool hasInnerGlass() const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace clerestory
