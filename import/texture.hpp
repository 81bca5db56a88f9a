// SPDX-License-Identifier: GPL-3.0-or-later
// A texture as a material names it, and its mean over the surfaces that wear it.
#pragma once

#include <glm/mat3x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstddef>
#include <memory>
#include <string>

#include "picture.hpp"

namespace clerestory {

enum class TextureWrap { repeat, mirror, clamp };

/// How a picture lies on a surface.
struct TextureMapping {
  /// Turns a surface's texture coordinates into the picture's: (u', v') = transform * (u, v, 1), with u' from
  /// left to right and v' from top to bottom, each 0 to 1.
  glm::dmat3x2 transform{1.0, 0.0, 0.0, 1.0, 0.0, 0.0};
  TextureWrap wrapU = TextureWrap::repeat;
  TextureWrap wrapV = TextureWrap::repeat;
  bool weighsByAlpha = false;  ///< where the picture is transparent there is no surface
};

/// Mean colour of a picture over triangles, weighted by their areas in space.
class TextureMean {
 public:
  TextureMean(std::shared_ptr<const Picture> picture, const TextureMapping& mapping);

  /// Adds a triangle of `area` (any unit, the same for all) with its corners' texture coordinates.
  void add(double area, const std::array<glm::dvec2, 3>& corners);
  /// Linear. Of the whole picture where no triangle was added.
  [[nodiscard]] glm::dvec3 color() const;

 private:
  [[nodiscard]] glm::dvec4 sample(const glm::dvec2& uv) const;
  [[nodiscard]] glm::dvec4 meanOver(const std::array<glm::dvec2, 3>& uv);
  [[nodiscard]] std::size_t stepsFor(const std::array<glm::dvec2, 3>& uv);

  std::shared_ptr<const Picture> picture_;
  TextureMapping mapping_;
  glm::dvec4 whole_{0.0};  // mean of the whole picture, colours times weight, weight
  glm::dvec4 sum_{0.0};    // likewise of what was added
  std::size_t samplesLeft_;
};

}  // namespace clerestory
