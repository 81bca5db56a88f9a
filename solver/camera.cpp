// SPDX-License-Identifier: GPL-3.0-or-later
// The three projections: perspective, equidistant fisheye, equirectangular panorama.
#include "camera.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace clerestory {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

}  // namespace

Camera::Camera(const ViewSettings& view)
    : projection_(view.projection),
      forward_(glm::normalize(view.target_m - view.eye_m)),
      right_(glm::normalize(glm::cross(forward_, glm::vec3(view.up)))),
      up_(glm::cross(right_, forward_)),
      fieldOfView_rad_(static_cast<float>(view.fieldOfView_deg * std::numbers::pi / 180.0)),
      width_(view.size_px[0]),
      height_(view.size_px[1]),
      perPixel_(2.0F * std::tan(0.5F * fieldOfView_rad_) / static_cast<float>(height_)) {
  if (projection_ != Projection::panorama) return;
  up_ = glm::normalize(glm::vec3(view.up));
  forward_ = glm::cross(up_, right_);
}

std::optional<glm::vec3> Camera::direction(float x, float y) const {
  const float right = x - 0.5F * static_cast<float>(width_);
  const float up = 0.5F * static_cast<float>(height_) - y;
  const float perHeight = 1.0F / static_cast<float>(height_);
  if (projection_ == Projection::panorama) {
    const float azimuth = 2.0F * pi * right / static_cast<float>(width_);
    const float altitude = pi * up * perHeight;
    return std::cos(altitude) * (std::cos(azimuth) * forward_ + std::sin(azimuth) * right_) +
           std::sin(altitude) * up_;
  }
  if (projection_ == Projection::fisheye) {
    const float radius = std::hypot(right, up);
    const float angle = radius * fieldOfView_rad_ * perHeight;
    if (angle > 0.5F * fieldOfView_rad_) return std::nullopt;
    const float across = radius > 0.0F ? std::sin(angle) / radius : 0.0F;
    return std::cos(angle) * forward_ + across * (right * right_ + up * up_);
  }
  return glm::normalize(forward_ + perPixel_ * (right * right_ + up * up_));
}

float Camera::pixelAngle() const {
  const float perHeight = 1.0F / static_cast<float>(height_);
  return projection_ == Projection::perspective ? perPixel_
         : projection_ == Projection::fisheye   ? fieldOfView_rad_ * perHeight
                                                : pi * perHeight;
}

}  // namespace clerestory
