// SPDX-License-Identifier: GPL-3.0-or-later
// A room with a table, four chairs and a luminous panel, some 400 polygons: of the kind of Peter Shirley's
// test scene, on which the paper measured its Figures 2 and 3.
#pragma once

#include "../scenes.hpp"

namespace clerestory {

/// Boxes whose outlines are given about a place, turned by quarters.
class QuarterTurned {
 public:
  QuarterTurned(drawn::Drawing& drawing, const glm::dvec3& place, int quarters)
      : drawing_(drawing), place_(place), quarters_(quarters) {}

  void box(const glm::dvec3& low, const glm::dvec3& high) const {
    const glm::dvec3 a = turned(low);
    const glm::dvec3 b = turned(high);
    drawn::addBox(drawing_, glm::min(a, b), glm::max(a, b), drawn::wood, 1);
  }

 private:
  [[nodiscard]] glm::dvec3 turned(glm::dvec3 point) const {
    for (int i = 0; i < quarters_; ++i) point = {-point.y, point.x, point.z};
    return place_ + point;
  }

  drawn::Drawing& drawing_;
  glm::dvec3 place_;
  int quarters_;
};

/// A square top or seat on four legs with rails between them; parts keep `gap` off each other.
inline void addFourLegged(const QuarterTurned& at, const glm::dvec2& half, double height, double thick,
                          double leg, double rail_z) {
  constexpr double gap = 0.005;
  at.box({-half.x, -half.y, height - thick}, {half.x, half.y, height});
  const double x = half.x - leg;
  const double y = half.y - leg;
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      at.box({sx * x - 0.5 * leg, sy * y - 0.5 * leg, gap},
             {sx * x + 0.5 * leg, sy * y + 0.5 * leg, height - thick - gap});
    }
    at.box({sx * x - 0.3 * leg, -y + 0.5 * leg + gap, rail_z},
           {sx * x + 0.3 * leg, y - 0.5 * leg - gap, rail_z + leg});
    at.box({-x + 0.5 * leg + gap, sx * y - 0.3 * leg, rail_z},
           {x - 0.5 * leg - gap, sx * y + 0.3 * leg, rail_z + leg});
  }
}

inline void addChair(const QuarterTurned& at) {
  addFourLegged(at, {0.22, 0.22}, 0.45, 0.03, 0.04, 0.2);
  for (const double side : {-0.18, 0.18}) at.box({side - 0.02, 0.16, 0.455}, {side + 0.02, 0.2, 0.95});
  for (const double low : {0.56, 0.74}) at.box({-0.155, 0.17, low}, {0.155, 0.19, low + 0.08});
}

inline Scene tableRoom() {
  drawn::Drawing drawing;
  drawing.scene.materials[drawn::plaster].reflectance = glm::dvec3(0.7);
  drawing.scene.materials[drawn::wood].reflectance = glm::dvec3(0.4);
  const std::uint32_t lamp = drawn::addMaterial(
      drawing, {.name = "lamp", .reflectance = glm::dvec3(0.7), .exitance_lm_m2 = glm::dvec3(10000.0)});
  drawn::addBox(drawing, {-2.5, -2.0, 0.0}, {2.5, 2.0, 2.7});
  drawn::addBox(drawing, {-0.6, -0.6, 2.6}, {0.6, 0.6, 2.69}, drawn::plaster, 0, {0});
  drawing.face({{-0.6, -0.6, 2.6}, {-0.6, 0.6, 2.6}, {0.6, 0.6, 2.6}, {0.6, -0.6, 2.6}}, lamp);
  addFourLegged(QuarterTurned(drawing, glm::dvec3(0.0), 0), {0.8, 0.5}, 0.74, 0.04, 0.06, 0.6);
  const glm::dvec3 places[] = {{0.35, 0.62, 0.0}, {-1.0, 0.1, 0.0}, {-0.35, -0.62, 0.0}, {1.0, -0.1, 0.0}};
  for (int i = 0; i < 4; ++i) addChair(QuarterTurned(drawing, places[i], i));
  return drawing.scene;
}

}  // namespace clerestory
