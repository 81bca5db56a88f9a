// SPDX-License-Identifier: GPL-3.0-or-later
// Makes control cages from objects' faces and checks them before OpenSubdiv sees them.
#include "cage.hpp"

#include <algorithm>
#include <set>
#include <unordered_set>
#include <utility>

namespace clerestory {
namespace {

constexpr std::uint32_t kGone = ~0U;

std::string whereOf(const Cage& cage, const Scene& scene) {
  return "object \"" + scene.objects[cage.object] + "\"";
}

/// The face without corners that repeat their neighbour.
std::vector<std::uint32_t> withoutRepeats(std::span<const std::uint32_t> face) {
  std::vector<std::uint32_t> corners(face.begin(), face.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  while (corners.size() > 1 && corners.front() == corners.back()) {
    corners.pop_back();
  }
  return corners;
}

/// Repairs the faces; holes follow to the faces' new places.
void checkFaces(Cage& cage, Scene& scene) {
  PolygonList faces;
  std::vector<std::uint32_t> newFace(cage.faces.size(), kGone);
  for (std::size_t f = 0; f < cage.faces.size(); ++f) {
    const std::vector<std::uint32_t> corners = withoutRepeats(cage.faces[f]);
    if (corners.size() != cage.faces[f].size()) {
      addDiagnosis(scene.diagnoses,
                   {"C140", "repeated corners of a cage's face were left out", whereOf(cage, scene)});
    }
    if (corners.size() < 3) {
      continue;
    }
    if (cage.scheme == Cage::Scheme::loop && corners.size() != 3) {
      throw InputError(whereOf(cage, scene) + ": Loop's scheme takes triangles only, a face has " +
                       std::to_string(corners.size()) + " corners; subdivide it with scheme \"catmark\"");
    }
    newFace[f] = static_cast<std::uint32_t>(faces.size());
    faces.add(corners);
  }
  std::set<std::uint32_t> holes;
  for (const std::uint32_t hole : cage.holes) {
    if (hole >= newFace.size()) {
      throw InputError(whereOf(cage, scene) + ": hole " + std::to_string(hole) +
                       " is not one of its faces (0 to " + std::to_string(newFace.size() - 1) + ")");
    }
    if (newFace[hole] != kGone) {
      holes.insert(newFace[hole]);
    }
  }
  cage.faces = std::move(faces);
  cage.holes.assign(holes.begin(), holes.end());
}

std::uint64_t edgeKey(std::uint32_t a, std::uint32_t b) {
  return (static_cast<std::uint64_t>(std::min(a, b)) << 32U) | std::max(a, b);
}

void checkTags(Cage& cage, Scene& scene) {
  std::unordered_set<std::uint32_t> points(cage.faces.corners.begin(), cage.faces.corners.end());
  std::unordered_set<std::uint64_t> edges;
  for (std::size_t f = 0; f < cage.faces.size(); ++f) {
    const auto face = cage.faces[f];
    for (std::size_t i = 0; i < face.size(); ++i) {
      edges.insert(edgeKey(face[i], face[(i + 1) % face.size()]));
    }
  }
  const std::size_t creases =
      std::erase_if(cage.creases, [&](const Cage::Crease& c) { return !edges.contains(edgeKey(c.a, c.b)); });
  const std::size_t corners =
      std::erase_if(cage.corners, [&](const Cage::Corner& c) { return !points.contains(c.point); });
  if (creases + corners > 0) {
    addDiagnosis(scene.diagnoses, {"C141", "creases and corners that are not on their cage were left out",
                                   whereOf(cage, scene), creases + corners});
  }
  for (Cage::Crease& crease : cage.creases) {
    crease.sharpness = std::clamp(crease.sharpness, 0.0F, 10.0F);
  }
  for (Cage::Corner& corner : cage.corners) {
    corner.sharpness = std::clamp(corner.sharpness, 0.0F, 10.0F);
  }
}

}  // namespace

std::optional<Cage::Scheme> parseScheme(std::string_view text) {
  if (text == "catmark") {
    return Cage::Scheme::catmark;
  }
  if (text == "loop") {
    return Cage::Scheme::loop;
  }
  if (text == "bilinear") {
    return Cage::Scheme::bilinear;
  }
  return std::nullopt;
}

std::optional<Cage::Boundary> parseBoundary(std::string_view text) {
  if (text == "none") {
    return Cage::Boundary::none;
  }
  if (text == "edge-only") {
    return Cage::Boundary::edgeOnly;
  }
  if (text == "edge-and-corner") {
    return Cage::Boundary::edgeAndCorner;
  }
  return std::nullopt;
}

void checkCage(Cage& cage, Scene& scene) {
  for (const std::uint32_t corner : cage.faces.corners) {
    if (corner >= scene.points.size()) {
      throw InputError(whereOf(cage, scene) + ": a cage's face has a corner that is no point of the model");
    }
  }
  checkFaces(cage, scene);
  checkTags(cage, scene);
}

void moveFacesToCages(Scene& scene, const std::map<std::uint32_t, Cage>& tags) {
  if (tags.empty()) {
    return;
  }
  std::map<std::uint32_t, Cage> cages = tags;
  PolygonList kept;
  std::vector<std::uint32_t> keptMaterial;
  std::vector<std::uint32_t> keptObject;
  for (std::size_t f = 0; f < scene.faces.size(); ++f) {
    const auto found = cages.find(scene.faceObject[f]);
    if (found == cages.end()) {
      kept.add(scene.faces[f]);
      keptMaterial.push_back(scene.faceMaterial[f]);
      keptObject.push_back(scene.faceObject[f]);
      continue;
    }
    Cage& cage = found->second;
    if (cage.faces.size() == 0) {
      cage.material = scene.faceMaterial[f];
    } else if (cage.material != scene.faceMaterial[f]) {
      addDiagnosis(scene.diagnoses, {"C142", "faces of a cage took the material of its first face",
                                     "object \"" + scene.objects[found->first] + "\""});
    }
    cage.faces.add(scene.faces[f]);
  }
  scene.faces = std::move(kept);
  scene.faceMaterial = std::move(keptMaterial);
  scene.faceObject = std::move(keptObject);
  for (auto& [object, cage] : cages) {
    if (cage.faces.size() > 0) {
      cage.object = object;
      checkCage(cage, scene);
      scene.cages.push_back(std::move(cage));
    }
  }
}

void moveCagesToFaces(Scene& scene, const std::vector<bool>& chosen) {
  std::vector<Cage> kept;
  for (std::size_t c = 0; c < scene.cages.size(); ++c) {
    Cage& cage = scene.cages[c];
    if (!chosen[c]) {
      kept.push_back(std::move(cage));
      continue;
    }
    for (std::uint32_t f = 0; f < cage.faces.size(); ++f) {
      if (!std::binary_search(cage.holes.begin(), cage.holes.end(), f)) {
        scene.faces.add(cage.faces[f]);
        scene.faceMaterial.push_back(cage.material);
        scene.faceObject.push_back(cage.object);
      }
    }
  }
  scene.cages = std::move(kept);
}

}  // namespace clerestory
