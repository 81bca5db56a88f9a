// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes of a glTF as polygons, or cages, of a scene.
#pragma once

#include <glm/mat4x4.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "gltfcompression.hpp"
#include "gltfdocument.hpp"
#include "gltfmaterial.hpp"

namespace clerestory {

/// Adds meshes to a scene, each placed by a matrix as often as it is asked for.
class GltfMeshes {
 public:
  GltfMeshes(const GltfDocument& document, Scene& scene)
      : document_(document),
        scene_(scene),
        materials_(document, scene.diagnoses),
        budget_(std::min<std::size_t>(1'000'000 + 20 * document.byteCount(), UINT32_MAX)) {}

  /// Adds `mesh` as an object of this name.
  void add(const JsonNode& mesh, const std::string& object, const glm::dmat4& matrix);

  /// Gives the scene its materials, once every mesh is added.
  void finish() { scene_.materials = materials_.finish(); }

 private:
  /// Where an accessor's positions lie in the scene's points, for the mesh at hand.
  struct Span {
    std::uint32_t first = 0;
    std::size_t count = 0;
  };
  /// A primitive's corners within its points, and its texture coordinates by their set, two for each point.
  struct Corners {
    Span points;
    std::vector<std::uint32_t> indices;
    std::map<std::size_t, std::vector<double>> coordinates;
  };

  Span place(const std::vector<glm::dvec3>& local, const JsonNode& user);
  Span points(const JsonNode& primitive);
  void spend(std::size_t elements, const JsonNode& user);
  void readPrimitive(const JsonNode& primitive);
  Corners corners(const JsonNode& primitive, std::uint32_t material);
  Corners dracoCorners(const JsonNode& primitive, const JsonNode& extension, std::uint32_t material);
  void addTriangles(const Corners& corners, std::size_t mode, std::uint32_t material);
  void addTriangle(const Corners& corners, const std::array<std::uint32_t, 3>& triangle,
                   std::uint32_t material);
  void readCage(const JsonNode& mesh, const JsonNode& tags);
  std::uint32_t material(const JsonNode& primitive);

  const GltfDocument& document_;
  Scene& scene_;
  GltfMaterials materials_;
  std::size_t budget_;                            // points and corners that may still be made
  std::map<std::string, DracoMesh> dracoMeshes_;  // by the primitive's pointer

  // Of the mesh at hand:
  std::uint32_t object_ = 0;
  glm::dmat4 matrix_{1.0};
  bool mirrored_ = false;
  std::map<std::size_t, Span> spans_;
};

}  // namespace clerestory
