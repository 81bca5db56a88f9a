// SPDX-License-Identifier: GPL-3.0-or-later
// Where the points of a picture look to.
#pragma once

#include <glm/vec3.hpp>

#include <optional>

#include <import/study.hpp>

namespace clerestory {

class Camera {
 public:
  explicit Camera(const ViewSettings& view);

  /// Unit vector through a point of the picture, in pixels from its upper left corner; none outside the
  /// circle of a fisheye.
  [[nodiscard]] std::optional<glm::vec3> direction(float x, float y) const;

  /// Angle that a pixel in the middle of the picture spans. [radians]
  [[nodiscard]] float pixelAngle() const;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  Projection projection_;
  glm::vec3 forward_, right_, up_;
  float fieldOfView_rad_;
  int width_, height_;
  float perPixel_;  // of a perspective, in a picture plane at distance 1
};

}  // namespace clerestory
