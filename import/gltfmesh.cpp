// SPDX-License-Identifier: GPL-3.0-or-later
// Reads glTF's meshes: triangles, strips, fans, cages, plain or compressed by Draco.
#include "gltfmesh.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "cage.hpp"
#include "gltfcage.hpp"

namespace clerestory {
namespace {

/// glTF's primitive modes that have faces.
enum Mode : std::size_t { kTriangles = 4, kStrip = 5, kFan = 6 };

constexpr const char* kDraco = "KHR_draco_mesh_compression";

/// The i-th triangle of a list, strip or fan (glTF 2.0, 3.7.2.1).
std::array<std::uint32_t, 3> triangleAt(const std::vector<std::uint32_t>& corners, std::size_t mode,
                                        std::size_t i) {
  if (mode == kTriangles) {
    return {corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]};
  }
  if (mode == kStrip) {
    return {corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]};
  }
  return {corners[i + 1], corners[i + 2], corners[0]};
}

void checkRange(const std::vector<std::uint32_t>& indices, std::size_t count, const JsonNode& primitive) {
  const auto beyond =
      std::find_if(indices.begin(), indices.end(), [&](std::uint32_t index) { return index >= count; });
  if (beyond != indices.end()) {
    primitive.fail("index " + std::to_string(*beyond) + " is out of range: there are " +
                   std::to_string(count) + " positions");
  }
}

}  // namespace

void GltfMeshes::add(const JsonNode& mesh, const std::string& object, const glm::dmat4& matrix) {
  object_ = static_cast<std::uint32_t>(scene_.objects.size());
  scene_.objects.push_back(object);
  matrix_ = matrix;
  mirrored_ = glm::determinant(glm::dmat3(matrix)) < 0.0;
  spans_.clear();
  const auto extras = mesh.find("extras");
  const bool isObject = extras && extras->isObject();
  if (const auto cage = isObject ? extras->find("clerestory") : std::nullopt) {
    readCage(mesh, *cage);
    return;
  }
  for (const JsonNode& primitive : mesh.elements("primitives")) {
    readPrimitive(primitive);
  }
}

/// Small files can place large meshes often: more than twenty elements a byte is not a building.
void GltfMeshes::spend(std::size_t elements, const JsonNode& user) {
  if (elements > budget_) {
    user.fail("the model repeats its meshes too often: more geometry than its size allows");
  }
  budget_ -= elements;
}

/// Adds the points, transformed, to the scene.
GltfMeshes::Span GltfMeshes::place(const std::vector<glm::dvec3>& local, const JsonNode& user) {
  spend(local.size(), user);
  const Span span{static_cast<std::uint32_t>(scene_.points.size()), local.size()};
  for (const glm::dvec3& point : local) {
    const glm::dvec3 placed(matrix_ * glm::dvec4(point, 1.0));
    if (!(glm::all(glm::lessThan(glm::abs(placed), glm::dvec3(1e12))))) {
      user.fail("its node's transformation sends a point beyond 1e12");
    }
    scene_.points.push_back(placed);
  }
  return span;
}

/// The primitive's POSITION in the scene; an accessor that several primitives share is placed once.
GltfMeshes::Span GltfMeshes::points(const JsonNode& primitive) {
  const auto index = primitive.at("attributes").index("POSITION", document_.countOf("accessors"), "accessor");
  if (!index) {
    primitive.at("attributes").fail("\"POSITION\" is missing");
  }
  const auto found = spans_.find(*index);
  return found != spans_.end()
             ? found->second
             : spans_.emplace(*index, place(document_.positions(*index), primitive)).first->second;
}

void GltfMeshes::readPrimitive(const JsonNode& primitive) {
  const std::size_t mode = primitive.countOr("mode", kTriangles);
  if (mode > kFan) {
    primitive.fail("mode " + std::to_string(mode) + " is not one of glTF's");
  }
  if (mode < kTriangles) {
    addDiagnosis(scene_.diagnoses,
                 {"C111", "points, lines, curves and free-form surfaces were left out", primitive.pointer()});
    return;
  }
  if (!primitive.at("attributes").find("POSITION")) {
    addDiagnosis(scene_.diagnoses,
                 {"C134", "primitives without positions were left out", primitive.pointer()});
    return;
  }
  const std::uint32_t number = material(primitive);
  const auto draco = primitive.extension(kDraco);
  const Corners read = draco ? dracoCorners(primitive, *draco, number) : corners(primitive, number);
  spend(read.indices.size(), primitive);
  addTriangles(read, mode, number);
}

GltfMeshes::Corners GltfMeshes::corners(const JsonNode& primitive, std::uint32_t material) {
  Corners result;
  result.points = points(primitive);
  if (const auto index = primitive.index("indices", document_.countOf("accessors"), "accessor")) {
    result.indices = document_.indices(*index);
    checkRange(result.indices, result.points.count, primitive);
  } else {
    result.indices.resize(result.points.count);
    std::iota(result.indices.begin(), result.indices.end(), 0U);
  }
  for (const GltfMaterials::Texture& texture : materials_.textures(material)) {
    const std::string key = "TEXCOORD_" + std::to_string(texture.coordinateSet);
    const auto index =
        primitive.at("attributes").index(key.c_str(), document_.countOf("accessors"), "accessor");
    if (index && !result.coordinates.contains(texture.coordinateSet)) {
      std::vector<double> values = document_.numbers(*index, "VEC2", 2);
      if (values.size() != 2 * result.points.count) {
        primitive.fail(key + " has " + std::to_string(values.size() / 2) + " elements, POSITION has " +
                       std::to_string(result.points.count));
      }
      result.coordinates.emplace(texture.coordinateSet, std::move(values));
    }
  }
  return result;
}

/// Of several sets of texture coordinates, that of the material's first texture is decoded.
GltfMeshes::Corners GltfMeshes::dracoCorners(const JsonNode& primitive, const JsonNode& extension,
                                             std::uint32_t material) {
  const auto textures = materials_.textures(material);
  const auto set = textures.empty() ? std::nullopt : std::optional(textures.front().coordinateSet);
  auto found = dracoMeshes_.find(primitive.pointer());
  if (found == dracoMeshes_.end()) {
    found =
        dracoMeshes_.emplace(primitive.pointer(), decodeDraco(extension, document_.viewBytes(extension), set))
            .first;
  }
  const DracoMesh& mesh = found->second;
  Corners result{place(mesh.positions, primitive), mesh.corners, {}};
  if (set && !mesh.coordinates.empty()) {
    std::vector<double>& values = result.coordinates[*set];
    for (const glm::dvec2& uv : mesh.coordinates) {
      values.insert(values.end(), {uv.x, uv.y});
    }
  }
  return result;
}

void GltfMeshes::addTriangles(const Corners& corners, std::size_t mode, std::uint32_t material) {
  const std::size_t size = corners.indices.size();
  const std::size_t count = mode == kTriangles ? size / 3 : size >= 3 ? size - 2 : 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::array<std::uint32_t, 3> t = triangleAt(corners.indices, mode, i);
    const bool isJoint = mode != kTriangles && (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]);
    if (!isJoint) {  // only there to join strips
      addTriangle(corners, t, material);
    }
  }
}

void GltfMeshes::addTriangle(const Corners& corners, const std::array<std::uint32_t, 3>& triangle,
                             std::uint32_t material) {
  std::array<std::uint32_t, 3> placed{};
  for (std::size_t i = 0; i < 3; ++i) {
    placed[i] = corners.points.first + triangle[i];
  }
  const glm::dvec3 a = scene_.points[placed[0]];
  const double area =
      corners.coordinates.empty()
          ? 0.0
          : 0.5 * glm::length(glm::cross(scene_.points[placed[1]] - a, scene_.points[placed[2]] - a));
  for (GltfMaterials::Texture& texture : materials_.textures(material)) {
    const auto values = corners.coordinates.find(texture.coordinateSet);
    if (values != corners.coordinates.end()) {
      const auto uv = [&](std::size_t i) {
        return glm::dvec2(values->second[2 * triangle[i]], values->second[2 * triangle[i] + 1]);
      };
      texture.mean.add(area, {uv(0), uv(1), uv(2)});
    }
  }
  if (mirrored_) {
    std::swap(placed[1], placed[2]);
  }
  scene_.faces.add(placed);
  scene_.faceMaterial.push_back(material);
  scene_.faceObject.push_back(object_);
}

void GltfMeshes::readCage(const JsonNode& mesh, const JsonNode& tags) {
  const JsonNode primitives = mesh.at("primitives");
  if (primitives.size() == 0) {
    mesh.fail("a cage needs a primitive with its points");
  }
  const Span span = points(primitives[0]);
  Cage cage = readGltfCage(tags, span.first, span.count);
  spend(cage.faces.corners.size(), tags);
  cage.object = object_;
  cage.material = material(primitives[0]);
  if (mirrored_) {
    for (std::size_t f = 0; f < cage.faces.size(); ++f) {
      std::reverse(cage.faces.corners.begin() + cage.faces.begin[f],
                   cage.faces.corners.begin() + cage.faces.begin[f + 1]);
    }
  }
  checkCage(cage, scene_);
  scene_.cages.push_back(std::move(cage));
}

std::uint32_t GltfMeshes::material(const JsonNode& primitive) {
  return materials_.number(primitive.index("material", document_.countOf("materials"), "material"));
}

}  // namespace clerestory
