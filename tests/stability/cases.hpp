// SPDX-License-Identifier: GPL-3.0-or-later
// The scenes of the stability suite: small, and each of a kind that light transport is known to fail on.
#pragma once

#include <glm/trigonometric.hpp>

#include <cmath>
#include <string>
#include <vector>

#include "../scenes.hpp"

namespace clerestory::unstable {

using namespace drawn;

/// A scene and where it is looked at.
struct Case {
  Drawing drawing;
  Study study;
};

/// A sensor that looks along a direction.
inline std::array<double, 6> sensor(const glm::dvec3& at, const glm::dvec3& towards = {0, 0, 1}) {
  return {at.x, at.y, at.z, towards.x, towards.y, towards.z};
}

inline void look(Case& scene, const std::vector<std::array<double, 6>>& points) {
  GridSettings grid;
  grid.name = "points";
  grid.points = points;
  scene.study.grids = {grid};
}

/// Every surface sends 1 lm/m² and reflects `reflectance`: whatever the shape, every place has the
/// illuminance 1 / (1 - reflectance), whichever way it looks.
inline void makeFurnace(Case& scene, double reflectance) {
  for (Material& material : scene.drawing.scene.materials) {
    material.reflectance = glm::dvec3(reflectance);
    material.exitance_lm_m2 = glm::dvec3(1.0);
  }
}

inline std::uint32_t addLamp(Drawing& drawing, double exitance_lm_m2 = 1000.0) {
  return addMaterial(
      drawing,
      {.name = "lamp", .reflectance = glm::dvec3(0.0), .exitance_lm_m2 = glm::dvec3(exitance_lm_m2)});
}

/// A room of 4 x 4 x 3 m with a lamp in the middle of its ceiling.
inline Case litRoom(double reflectance, double exitance_lm_m2 = 1000.0) {
  Case room;
  Drawing& drawing = room.drawing;
  drawing.scene.materials[plaster].reflectance = glm::dvec3(reflectance);
  addBox(drawing, {0, 0, 0}, {4, 4, 3});
  const Outline panel = {{1.5, 1.5, 2.9}, {1.5, 2.5, 2.9}, {2.5, 2.5, 2.9}, {2.5, 1.5, 2.9}};
  drawing.face(panel, addLamp(drawing, exitance_lm_m2), addObject(drawing, "lamp"));
  room.study.grids = {gridOf(pointsOver({0, 0, 0}, {4, 4, 3}, 0.85, 0.5))};
  return room;
}

/// Two square plates, `gap_m` apart, in the middle of a room; all shines alike.
inline Case plates(double gap_m, double reflectance, double side_m = 1.0) {
  Case scene;
  const double end = 1.0 + side_m;
  addBox(scene.drawing, {0, 0, 0}, {end + 1.0, end + 1.0, 3});
  const std::uint32_t lower = addObject(scene.drawing, "lower");
  const std::uint32_t upper = addObject(scene.drawing, "upper");
  addBox(scene.drawing, {1, 1, 1}, {end, end, 1.2}, plaster, lower);
  addBox(scene.drawing, {1, 1, 1.2 + gap_m}, {end, end, 1.4 + gap_m}, plaster, upper);
  makeFurnace(scene, reflectance);
  look(scene, {sensor({0.5, 0.5, 1.2}), sensor({0.9, 1.5, 1.2}, {1, 0, 0}), sensor({1.5, 1.5, 1.5 + gap_m}),
               sensor({1.5, 1.5, 0.9}, {0, 0, -1}), sensor({end + 0.4, end + 0.4, 0.5}, {-1, -1, 1})});
  return scene;
}

/// A closed prism whose two legs of 2 m meet at `angle_deg`; all shines alike.
inline Case wedge(double angle_deg, double reflectance) {
  Case scene;
  const double angle = glm::radians(angle_deg);
  const glm::dvec3 a(0.0), b(2, 0, 0), c(2.0 * std::cos(angle), 0, 2.0 * std::sin(angle)), along(0, 3, 0);
  Drawing& drawing = scene.drawing;
  drawing.face({a, b, c});
  drawing.face({a + along, c + along, b + along});
  const std::uint32_t legs[2] = {addObject(drawing, "first leg"), addObject(drawing, "second leg")};
  drawing.face({a, a + along, b + along, b}, plaster, legs[0]);
  drawing.face({a, c, c + along, a + along}, plaster, legs[1]);
  drawing.face({b, b + along, c + along, c}, plaster, 1);
  makeFurnace(scene, reflectance);
  const glm::dvec3 middle = (a + b + c) / 3.0 + 0.5 * along;
  look(scene, {sensor(middle), sensor(middle, {1, 0, 0}), sensor(middle, {-1, 0, 0}),
               sensor(middle + glm::dvec3(0, 1, 0), {0, 0, -1})});
  return scene;
}

/// A room with a screen of 40 slivers of 2 m x 0.2 mm and as many triangles of that base, each an object.
inline Case slivers(double reflectance) {
  Case scene;
  Drawing& drawing = scene.drawing;
  addBox(drawing, {0, 0, 0}, {4, 4, 3});
  for (int i = 0; i < 40; ++i) {
    const double x = 0.5 + 0.05 * i;
    const std::uint32_t object = addObject(drawing, "sliver " + std::to_string(i));
    drawing.face({{x, 2, 0.5}, {x + 0.0002, 2, 0.5}, {x + 0.0002, 2, 2.5}, {x, 2, 2.5}}, wood, object);
    drawing.face({{x, 2.3, 0.5}, {x + 0.0002, 2.3, 0.5}, {x, 2.3, 2.5}}, wood, object);
  }
  makeFurnace(scene, reflectance);
  scene.study.grids = {gridOf(pointsOver({0, 0, 0}, {4, 4, 3}, 1.0, 1.0))};
  return scene;
}

/// A hall of 1 x 1 km, 100 m high, with a cube of 1 mm in it, at the place `origin`.
inline Case millimetreInKilometre(const glm::dvec3& origin, bool withCube) {
  Case scene;
  Drawing& drawing = scene.drawing;
  drawing.scene.materials[plaster].reflectance = glm::dvec3(0.5);
  addBox(drawing, origin, origin + glm::dvec3(1000, 1000, 100), plaster, 0, {1});
  const Outline ceiling = box(origin, origin + glm::dvec3(1000, 1000, 100))[1];
  drawing.face(ceiling, addLamp(drawing), addObject(drawing, "lamp"));
  const glm::dvec3 cube = origin + glm::dvec3(500, 500, 1);
  if (withCube) addBox(drawing, cube, cube + glm::dvec3(0.001), wood, addObject(drawing, "cube"));
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 9; ++i) points.push_back(origin + glm::dvec3(100.0 + 100.0 * i, 450.0, 0.85));
  points.push_back(cube + glm::dvec3(0.01, 0.01, 0.0));
  scene.study.grids = {gridOf(points)};
  return scene;
}

/// A room of 4 x 4 x 3 m under a uniform sky of 10,000 lx, with an opening `side_m` wide in its roof.
inline Case pinhole(double side_m, double reflectance) {
  Case scene;
  Drawing& drawing = scene.drawing;
  drawing.scene.materials[plaster].reflectance = glm::dvec3(reflectance);
  addBox(drawing, {0, 0, 0}, {4, 4, 3}, plaster, 0, {1});
  const double a = 2.0 - 0.5 * side_m;
  const double b = 2.0 + 0.5 * side_m;
  const auto strip = [&](double x0, double y0, double x1, double y1) {
    drawing.face({{x0, y0, 3}, {x1, y0, 3}, {x1, y1, 3}, {x0, y1, 3}});
  };
  strip(0, 0, 4, a);
  strip(0, b, 4, 4);
  strip(0, a, a, b);
  strip(b, a, 4, b);
  scene.study.openings = {{{a, a, 3}, {b, a, 3}, {b, b, 3}, {a, b, 3}}};
  scene.study.sky.cieType = 5;
  scene.study.grids = {gridOf({{2, 2, 0.001}, {1, 2, 0.001}, {3, 2, 0.001}, {2, 1, 0.001}, {2, 3, 0.001}})};
  return scene;
}

/// A room of 4 x 3 x 3 m with a pane, and behind a partition with a keyhole of 20 x 50 mm one without.
inline Case keyhole() {
  Case scene;
  Drawing& drawing = scene.drawing;
  addRoomWithPane(drawing, {0, 0, 0}, {8, 3, 3}, {1, 1, 3, 2});
  const auto part = [&](double y0, double z0, double y1, double z1) {
    drawing.face({{4, y0, z0}, {4, y1, z0}, {4, y1, z1}, {4, y0, z1}});
  };
  part(0, 0, 1.49, 3);
  part(1.51, 0, 3, 3);
  part(1.49, 0, 1.51, 1);
  part(1.49, 1.05, 1.51, 3);
  scene.study.grids = {gridOf({{2, 1.5, 0.85}, {6, 1.5, 0.85}})};
  return scene;
}

/// A room with 3,000 triangles of 2 cm strewn through it, each turned its own way; all shines alike.
inline Case tinyPolygons(double reflectance) {
  Case scene;
  Drawing& drawing = scene.drawing;
  addBox(drawing, {0, 0, 0}, {4, 4, 3});
  const std::uint32_t object = addObject(drawing, "chaff");
  std::mt19937 random(7);
  const auto even = [&] { return static_cast<double>(random()) / 4294967296.0; };
  for (int i = 0; i < 3000; ++i) {
    const glm::dvec3 at(1.0 + 2.0 * even(), 1.0 + 2.0 * even(), 0.8 + 1.2 * even());
    const auto corner = [&] { return at + 0.02 * glm::dvec3(even(), even(), even()); };
    const glm::dvec3 a = corner();
    const glm::dvec3 b = corner();
    drawing.face({a, b, corner()}, wood, object);
  }
  makeFurnace(scene, reflectance);
  look(scene, {sensor({0.5, 0.5, 0.85}), sensor({2, 2, 0.5}), sensor({2, 0.7, 1.4}, {0, 1, 0}),
               sensor({3.5, 3.5, 0.85}), sensor({2, 2, 2.5}, {0, 0, -1})});
  return scene;
}

/// A small lamp in the middle of a clump of 64 boxes of 5 cm.
inline Case lampInCluster(double reflectance) {
  Case scene;
  Drawing& drawing = scene.drawing;
  drawing.scene.materials[plaster].reflectance = glm::dvec3(reflectance);
  addBox(drawing, {0, 0, 0}, {4, 4, 3});
  const std::uint32_t clump = addObject(drawing, "clump");
  for (int i = 0; i < 64; ++i) {
    const glm::dvec3 low = glm::dvec3(1.82, 1.82, 1.32) + 0.1 * glm::dvec3(i % 4, i / 4 % 4, i / 16);
    addBox(drawing, low, low + glm::dvec3(0.05), wood, clump);
  }
  const std::uint32_t lamp = addLamp(drawing, 100000.0);
  addBox(drawing, {1.985, 1.985, 1.485}, {2.005, 2.005, 1.505}, lamp, addObject(drawing, "lamp"));
  scene.study.grids = {gridOf(pointsOver({0, 0, 0}, {4, 4, 3}, 0.85, 0.5))};
  return scene;
}

/// Plates of 10 x 10 m, 0.1 m apart, the lower one of which shines; around them a hall.
inline Case nearPlates(double reflectance) {
  Case scene;
  Drawing& drawing = scene.drawing;
  drawing.scene.materials[plaster].reflectance = glm::dvec3(reflectance);
  addBox(drawing, {-1, -1, -1}, {11, 11, 3});
  const std::uint32_t lamp = addMaterial(
      drawing,
      {.name = "shining", .reflectance = glm::dvec3(reflectance), .exitance_lm_m2 = glm::dvec3(1000.0)});
  drawing.face({{0, 0, 1}, {10, 0, 1}, {10, 10, 1}, {0, 10, 1}}, lamp, addObject(drawing, "lower"));
  drawing.face({{0, 0, 1.1}, {0, 10, 1.1}, {10, 10, 1.1}, {10, 0, 1.1}}, wood, addObject(drawing, "upper"));
  drawing.scene.materials[wood].reflectance = glm::dvec3(reflectance);
  look(scene, {sensor({5, 5, 1.05}, {0, 0, -1}), sensor({2, 7, 1.05}, {0, 0, -1}),
               sensor({7, 3, 1.05}, {0, 0, -1}), sensor({5, 5, 2})});
  return scene;
}

/// A room of 4 x 6 x 3 m, whose window of 3 x 2 m stands behind 500 blades, 60 mm deep and 4 mm apart.
inline Case louvres(double reflectance) {
  Case scene;
  Drawing& drawing = scene.drawing;
  drawing.scene.materials[plaster].reflectance = glm::dvec3(0.5);
  drawing.scene.materials[wood].reflectance = glm::dvec3(reflectance);
  addRoomWithPane(drawing, {0, 0, 0}, {4, 6, 3}, {0.5, 0.5, 3.5, 2.5});
  const std::uint32_t object = addObject(drawing, "louvres");
  for (int i = 0; i < 500; ++i) {
    const double z = 0.502 + 0.004 * i;
    drawing.face({{0.5, -0.08, z}, {3.5, -0.08, z}, {3.5, -0.02, z}, {0.5, -0.02, z}}, wood, object);
  }
  scene.study.sky.cieType = 5;
  scene.study.groundReflectance = 0.0;
  scene.study.grids = {gridOf({{2, 1, 0.85}, {2, 2, 0.85}, {2, 3, 0.85}, {2, 4, 0.85}, {2, 5, 0.85}})};
  return scene;
}

/// A room of 4 x 6 x 3 m with an opening of 2 x 1.4 m to the south.
inline Case openRoom(double reflectance) {
  Case scene;
  scene.drawing.scene.materials[plaster].reflectance = glm::dvec3(reflectance);
  addRoomWithPane(scene.drawing, {0, 0, 0}, {4, 6, 3}, {1, 0.8, 3, 2.2});
  scene.study.grids = {gridOf(pointsOver({0, 0, 0}, {4, 6, 3}, 0.85, 0.5))};
  return scene;
}

}  // namespace clerestory::unstable
