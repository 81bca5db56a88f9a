// SPDX-License-Identifier: GPL-3.0-or-later
// Luminaires in the solver's terms: intensity by direction, spread over the luminous opening, and the light
// that a point gets from it.
//
// An opening is a set of polygons. Seen from afar in any direction they show one luminance together, the
// intensity over their projected area; so near by each part sends what its direction to the receiver asks
// for, and the far field is the file's.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <geometry/building.hpp>

namespace clerestory {

class World;

/// A polygon of an opening, or a part of one, in the luminaire's axes.
struct LuminousPart {
  std::vector<glm::vec3> polygon;  ///< counterclockwise seen from its front
  glm::vec3 centre, normal;
  float radius_m, area_m2;
  std::uint32_t firstChild;  ///< of its two halves; 0: none
};

/// A luminous opening as polygons, each halved some times for receivers near by. Round ones have twelve sides
/// of the same area.
class LuminousShape {
 public:
  explicit LuminousShape(const LuminousOpening& opening);

  [[nodiscard]] bool isPoint() const { return faces_ == 0; }
  [[nodiscard]] float radius_m() const { return radius_m_; }
  /// How far it reaches from the centre along a unit vector and against it.
  [[nodiscard]] float reach_m(const glm::vec3& direction) const;
  [[nodiscard]] float area_m2() const { return area_m2_; }
  /// Area seen from afar against the unit `direction` in which light leaves.
  [[nodiscard]] float projectedArea_m2(const glm::vec3& direction) const;
  /// The whole polygons; parts() begins with them.
  [[nodiscard]] std::span<const LuminousPart> faces() const { return std::span(parts_).first(faces_); }
  [[nodiscard]] std::span<const LuminousPart> parts() const { return parts_; }
  /// A point even by area for even u, v in [0, 1), and its polygon's normal.
  struct Spot {
    glm::vec3 point, normal;
  };
  [[nodiscard]] Spot spot(float u, float v) const;

 private:
  void addFace(std::vector<glm::vec3> polygon);
  void divideFaces();

  std::vector<LuminousPart> parts_;
  std::size_t faces_ = 0;
  float radius_m_ = 0.0F, area_m2_ = 0.0F;
};

/// A luminaire in its place.
class Lamp {
 public:
  /// `position` is in the solver's local coordinates.
  Lamp(const Luminaire& luminaire, std::shared_ptr<const LuminousShape> shape, const glm::vec3& position,
       std::int32_t domain);

  [[nodiscard]] const glm::vec3& position() const { return position_; }
  [[nodiscard]] float radius_m() const { return shape_->radius_m(); }
  [[nodiscard]] std::int32_t domain() const { return domain_; }
  [[nodiscard]] double flux_lm() const { return flux_lm_; }
  [[nodiscard]] const glm::dvec3& color() const { return color_; }

  /// Illuminance of a point with a unit normal, were nothing in the way. Relative error below 1 % down to a
  /// distance of half the opening's size. [lx]
  [[nodiscard]] float illuminance_lx(const glm::vec3& point, const glm::vec3& normal) const;
  /// Intensity towards a point from the centre. [cd]
  [[nodiscard]] float intensityTowards_cd(const glm::vec3& point) const;
  /// A bound of the intensity towards all that lies in a sphere and, if there are any, between `corners`.
  /// [cd]
  [[nodiscard]] float intensityBound_cd(const glm::vec3& centre, float radius_m,
                                        std::span<const glm::vec3> corners) const;

  /// One of even points of the opening for even u, v in [0, 1), and what a receiver gets from there as a
  /// share of what comes from all of them. Weights are comparable among points of one receiver.
  struct Ray {
    glm::vec3 from;
    float weight;
  };
  [[nodiscard]] Ray ray(const glm::vec3& point, const glm::vec3& normal, float u, float v) const;

  /// What a ray of view meets first of the opening: how far, and its luminance; dark sides are not there.
  struct Seen {
    float distance_m, luminance_cd_m2;
  };
  [[nodiscard]] std::optional<Seen> seenAlong(const glm::vec3& from, const glm::vec3& direction,
                                              float limit_m) const;

 private:
  [[nodiscard]] glm::vec3 turned(const glm::vec3& vector) const { return vector * axes_; }
  [[nodiscard]] float intensity_cd(const glm::vec3& ownDirection) const;
  [[nodiscard]] float luminance_cd_m2(const glm::vec3& ownDirection) const;
  [[nodiscard]] float partIlluminance_lx(const LuminousPart& part, const glm::vec3& point,
                                         const glm::vec3& normal) const;

  std::shared_ptr<const LuminousShape> shape_;
  std::shared_ptr<const Photometry> photometry_;
  std::vector<double> rowMost_cd_;  ///< #latitudes of the distribution: the greatest of all longitudes
  glm::vec3 position_;
  glm::mat3 axes_;
  double factor_, flux_lm_;
  glm::dvec3 color_;
  std::int32_t domain_;
};

/// The luminaires of a building that light something.
std::vector<Lamp> lampsOf(const Building& building, const glm::dvec3& origin);

/// Luminance of the nearest luminaire that a ray of view meets within `limit_m`. [cd/m²]
std::optional<glm::dvec3> lampLuminance(const World& world, const glm::vec3& from, const glm::vec3& direction,
                                        float limit_m);

}  // namespace clerestory
