// SPDX-License-Identifier: GPL-3.0-or-later
// Rays of view: what the eye of a picture meets through a point of it.
#pragma once

#include <glm/vec2.hpp>

#include <span>
#include <vector>

#include "camera.hpp"
#include "radiosity.hpp"

namespace clerestory {

/// What a ray of view meets.
struct Look {
  glm::vec2 at{0.0F};  ///< in the picture [pixels from its upper left corner]
  glm::vec3 direction{0.0F};
  bool isInPicture = false;  ///< a fisheye has corners that are not
  RayScene::Hit hit;
};

/// The rays of one picture. Those through the middles of its pixels are cast once.
template <int K>
class Looks {
 public:
  Looks(const SolvedLight<K>& light, const ViewSettings& view);

  [[nodiscard]] const Camera& camera() const { return camera_; }
  [[nodiscard]] const glm::vec3& eye() const { return eye_; }  ///< in local coordinates

  /// Through points of the picture, best in the order in which they lie beside each other. `looks` (#at)
  /// receives them.
  void through(std::span<const glm::vec2> at, std::span<Look> looks) const;
  /// Through `count` points a pixel apart in a row from `first` on.
  [[nodiscard]] std::vector<Look> row(const glm::vec2& first, std::size_t count) const;
  /// Through the middle of a pixel of the picture.
  [[nodiscard]] Look atMiddle(int x, int y) const;
  [[nodiscard]] glm::vec3 pointOf(const Look& look) const {
    return eye_ + look.hit.distance_m * look.direction;
  }
  /// Whether a ray ends on a surface whose light is known: not on glass, nor in the open.
  [[nodiscard]] bool isLit(const RayScene::Hit& hit) const;

 private:
  const SolvedLight<K>& light_;
  const World& world_;
  Camera camera_;
  glm::vec3 eye_;
  std::vector<RayScene::Hit> middles_;  // #pixels
};

}  // namespace clerestory
