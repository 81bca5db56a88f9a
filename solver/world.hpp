// SPDX-License-Identifier: GPL-3.0-or-later
// What stays the same during a solve: the building in local coordinates, its glass, the sky, the rays.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <geometry/building.hpp>
#include <geometry/rays.hpp>
#include <solver/daylight.hpp>
#include <solver/glass.hpp>

#include "columns.hpp"
#include "lamps.hpp"

namespace clerestory {

inline constexpr int mirrorDepth = 4;         ///< panes that a ray is followed by reflection
inline constexpr float sameImage = 0.99999F;  ///< cosine between directions to images that are one

/// The sun's beam.
struct SunBeam {
  glm::vec3 towards;                       ///< unit vector to the middle of its disc
  float normal_lx;                         ///< illuminance square to the beam
  double ground_cd_m2 = 0.0;               ///< what the beam adds to the luminance of the uniform ground
  std::vector<glm::vec3> towardsImages{};  ///< unit vectors to where panes show it to the outside
};

class World {
 public:
  World(const Building& building, const Study& study);

  const Building& building;
  RayScene rays;
  Sky sky;
  std::optional<SunBeam> sun;  ///< where it shines
  ColumnLayout layout;
  std::vector<Lamp> lamps;

  [[nodiscard]] const Pieces& pieces() const { return building.model.pieces; }
  [[nodiscard]] const Material& materialOf(std::uint32_t piece) const {
    return building.model.materials[pieces().material[piece]];
  }
  [[nodiscard]] glm::vec3 local(const glm::dvec3& world) const { return glm::vec3(world - rays.origin()); }

  /// Corners of a piece in local coordinates, counterclockwise from its front.
  [[nodiscard]] std::span<const glm::vec3> polygon(std::uint32_t piece) const {
    return std::span(corners_).subspan(firstCorner_[piece], firstCorner_[piece + 1] - firstCorner_[piece]);
  }
  [[nodiscard]] glm::vec3 normalOf(std::uint32_t side) const {
    return glm::vec3(side % 2 == 0 ? pieces().normal[side / 2] : -pieces().normal[side / 2]);
  }
  /// Whether a piece is clear glass, which mirrors by its angle.
  [[nodiscard]] bool isMirror(std::uint32_t piece) const {
    return materialOf(piece).glazing && !materialOf(piece).diffusing;
  }
  /// Glass of a glazing piece, and the factor on its transmittance by dirt and undrawn frames.
  [[nodiscard]] const Glass& glassOf(std::uint32_t piece) const { return *glass_[pieces().material[piece]]; }
  /// An opening has neither.
  [[nodiscard]] float portalFactor(std::uint32_t piece) const {
    return materialOf(piece).transmittance == glm::dvec3(1.0) ? 1.0F : portalFactor_;
  }
  /// Colour of a glazing's transmittance beside its luminance, 1 where it is grey.
  [[nodiscard]] glm::dvec3 tintOf(std::uint32_t piece) const;

  /// Diffuse reflectance of a side; glass counts with its hemispherical one.
  [[nodiscard]] glm::dvec3 reflectanceOf(std::uint32_t piece) const;
  /// Transmittance of the inner glass between two points, 1 without any.
  [[nodiscard]] float innerTransmittance(const glm::vec3& from, const glm::vec3& to) const;
  /// 0 where something opaque or domain-bounding stands between, else the inner glass's transmittance.
  [[nodiscard]] float visibility(const glm::vec3& from, const glm::vec3& to) const;
  /// The same of many segments; `blocked` is room to work in. All #segments.
  void visibility(std::span<const RayScene::Segment> segments, std::span<std::uint8_t> blocked,
                  std::span<float> visible) const;

 private:
  [[nodiscard]] std::vector<glm::vec3> imagesOf(const glm::vec3& towardsSun) const;
  World(const Building& building, const Study& study, const Daylight& daylight);

  std::vector<std::optional<Glass>> glass_;  // #materials
  std::vector<glm::vec3> corners_;
  std::vector<std::size_t> firstCorner_;
  float portalFactor_;
};

}  // namespace clerestory
