// SPDX-License-Identifier: GPL-3.0-or-later
// Openings without glass and the ground, as faces.
#include <glm/common.hpp>

#include <algorithm>
#include <limits>
#include <string>

#include <import/study.hpp>

namespace clerestory {
namespace {

constexpr double groundBelow_m = 0.02;  // the model's lowest point: nothing of it lies in the ground's plane
constexpr double groundHeights = 10.0;  // the ground reaches so many heights of the model beyond it …
constexpr double groundLeast_m = 20.0;  // … but so far at least

std::uint32_t addMaterial(Scene& scene, Material material) {
  scene.materials.push_back(std::move(material));
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

void addFace(Scene& scene, const std::vector<glm::dvec3>& outline, std::uint32_t material,
             const std::string& name) {
  std::vector<std::uint32_t> corners;
  for (const glm::dvec3& point : outline) {
    corners.push_back(static_cast<std::uint32_t>(scene.points.size()));
    scene.points.push_back(point);
  }
  scene.faces.add(corners);
  scene.faceMaterial.push_back(material);
  scene.faceObject.push_back(static_cast<std::uint32_t>(scene.objects.size()));
  scene.objects.push_back(name);
}

void addGround(const Study& study, Scene& scene) {
  glm::dvec3 low(std::numeric_limits<double>::max());
  glm::dvec3 high(std::numeric_limits<double>::lowest());
  for (const glm::dvec3& point : scene.points) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  const double reach_m = std::max(groundLeast_m, groundHeights * (high.z - low.z));
  const double level_m = low.z - groundBelow_m;
  const glm::dvec2 a(low.x - reach_m, low.y - reach_m), b(high.x + reach_m, high.y + reach_m);
  const std::uint32_t ground =
      addMaterial(scene, {.name = "ground", .reflectance = glm::dvec3(study.groundReflectance)});
  addFace(scene, {{a.x, a.y, level_m}, {b.x, a.y, level_m}, {b.x, b.y, level_m}, {a.x, b.y, level_m}}, ground,
          "ground");
}

}  // namespace

void addSurroundings(const Study& study, Scene& scene) {
  if (!study.openings.empty()) {
    const std::uint32_t opening =
        addMaterial(scene, {.name = "opening", .glazing = true, .transmittance = glm::dvec3(1.0)});
    for (std::size_t i = 0; i < study.openings.size(); ++i)
      addFace(scene, study.openings[i], opening, "opening " + std::to_string(i + 1));
  }
  if (study.groundIsShaded && !scene.points.empty()) addGround(study, scene);
}

}  // namespace clerestory
