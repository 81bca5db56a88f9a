// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes drawn by hand for the tests of the clean-up, and measures of what becomes of them.
#pragma once

#include <glm/geometric.hpp>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <geometry/building.hpp>
#include <import/scene.hpp>

namespace clerestory::drawn {

using Outline = std::vector<glm::dvec3>;

/// One face with points of its own, as most exports write it.
struct Drawing {
  Scene scene;

  Drawing() {
    scene.materials.push_back({.name = "plaster"});
    scene.materials.push_back({.name = "glass", .glazing = true});
    scene.materials.push_back({.name = "wood"});
    scene.objects = {"room", "other"};
  }

  void face(const Outline& outline, std::uint32_t material = 0, std::uint32_t object = 0) {
    std::vector<std::uint32_t> corners;
    for (const glm::dvec3& point : outline) {
      corners.push_back(static_cast<std::uint32_t>(scene.points.size()));
      scene.points.push_back(point);
    }
    scene.faces.add(corners);
    scene.faceMaterial.push_back(material);
    scene.faceObject.push_back(object);
  }

  /// A convex outline as a fan about its corner `centre`.
  void fan(const Outline& outline, std::size_t centre = 0, std::uint32_t material = 0,
           std::uint32_t object = 0) {
    const std::size_t n = outline.size();
    for (std::size_t i = 1; i + 1 < n; ++i) {
      face({outline[centre], outline[(centre + i) % n], outline[(centre + i + 1) % n]}, material, object);
    }
  }
};

/// The six faces of a box, outwards.
inline std::vector<Outline> box(const glm::dvec3& a, const glm::dvec3& b) {
  return {{{a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, a.y, a.z}},
          {{a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}},
          {{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z}},
          {{b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z}},
          {{b.x, b.y, a.z}, {a.x, b.y, a.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z}},
          {{a.x, b.y, a.z}, {a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}}};
}

/// A rectangle in the plane y = `y`, from (x0, z0) to (x1, z1), looking to -y.
inline Outline upright(double x0, double z0, double x1, double z1, double y = 0.0) {
  return {{x0, y, z0}, {x1, y, z0}, {x1, y, z1}, {x0, y, z1}};
}

/// The scene with its faces in another order and each starting at another corner.
inline Scene shuffled(const Scene& scene, unsigned seed) {
  Scene result = scene;
  std::vector<std::uint32_t> order(scene.faces.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::mt19937 random(seed);
  std::shuffle(order.begin(), order.end(), random);
  std::vector<std::uint32_t> place(scene.points.size());
  for (std::uint32_t i = 0; i < place.size(); ++i) place[i] = i;
  std::shuffle(place.begin(), place.end(), random);
  for (std::size_t i = 0; i < place.size(); ++i) result.points[place[i]] = scene.points[i];
  result.faces = PolygonList();
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto face = scene.faces[order[i]];
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t corner : face) corners.push_back(place[corner]);
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(random() % corners.size()),
                corners.end());
    result.faces.add(corners);
    result.faceMaterial[i] = scene.faceMaterial[order[i]];
    result.faceObject[i] = scene.faceObject[order[i]];
  }
  return result;
}

/// Unit normal of the side that a piece was drawn for.
inline glm::dvec3 drawnNormal(const CleanModel& model, std::size_t piece) {
  return (model.pieces.isDrawnForBack[piece] ? -1.0 : 1.0) * model.pieces.normal[piece];
}

inline double totalArea_m2(const CleanModel& model) {
  double sum = 0.0;
  for (const double area : model.pieces.area_m2) sum += area;
  return sum;
}

inline bool samePieces(const CleanModel& a, const CleanModel& b) {
  return a.pieces.points == b.pieces.points && a.pieces.polygons.begin == b.pieces.polygons.begin &&
         a.pieces.polygons.corners == b.pieces.polygons.corners && a.pieces.normal == b.pieces.normal &&
         a.pieces.area_m2 == b.pieces.area_m2 && a.pieces.polygon == b.pieces.polygon &&
         a.pieces.surface == b.pieces.surface && a.pieces.material == b.pieces.material;
}

/// Whether every piece is convex about its normal, but for 20 µm.
inline bool allConvex(const CleanModel& model) {
  const Pieces& pieces = model.pieces;
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    const auto loop = pieces.polygons[piece];
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const glm::dvec3 edge =
          glm::normalize(pieces.points[loop[(i + 1) % loop.size()]] - pieces.points[loop[i]]);
      const glm::dvec3 inwards = glm::cross(pieces.normal[piece], edge);
      for (const std::uint32_t corner : loop) {
        if (glm::dot(pieces.points[corner] - pieces.points[loop[i]], inwards) < -2e-5) return false;
      }
    }
  }
  return true;
}

/// How many pieces hold the point, which lies in their plane.
inline int cover(const CleanModel& model, const glm::dvec3& point) {
  const Pieces& pieces = model.pieces;
  int count = 0;
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    const auto loop = pieces.polygons[piece];
    bool inside = std::abs(glm::dot(point - pieces.points[loop[0]], pieces.normal[piece])) < 1e-4;
    for (std::size_t i = 0; i < loop.size() && inside; ++i) {
      const glm::dvec3 edge = pieces.points[loop[(i + 1) % loop.size()]] - pieces.points[loop[i]];
      inside = glm::dot(glm::cross(edge, point - pieces.points[loop[i]]), pieces.normal[piece]) >= 0.0;
    }
    count += inside ? 1 : 0;
  }
  return count;
}

inline std::size_t countOf(const CleanModel& model, const std::string& code) {
  std::size_t count = 0;
  for (const Diagnosis& diagnosis : model.diagnoses) count += diagnosis.code == code ? diagnosis.count : 0;
  return count;
}

}  // namespace clerestory::drawn
