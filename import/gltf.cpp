// SPDX-License-Identifier: GPL-3.0-or-later
// Reads glTF 2.0: walks the scene's nodes and makes polygons, or cages, of their meshes.
#include "gltf.hpp"

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "cage.hpp"
#include "gltfcage.hpp"
#include "gltfdocument.hpp"
#include "gltfmaterial.hpp"
#include "textfile.hpp"

namespace clerestory {
namespace {

constexpr auto kExtensions = std::to_array<std::string_view>(
    {"KHR_materials_emissive_strength", "KHR_materials_transmission", "KHR_materials_pbrSpecularGlossiness",
     "KHR_materials_ior", "KHR_materials_specular", "KHR_materials_clearcoat", "KHR_materials_sheen",
     "KHR_materials_volume", "KHR_materials_unlit", "KHR_materials_iridescence", "KHR_materials_anisotropy",
     "KHR_materials_dispersion", "KHR_texture_transform", "KHR_texture_basisu", "EXT_texture_webp"});

/// glTF's primitive modes that have faces.
enum Mode : std::size_t { kTriangles = 4, kStrip = 5, kFan = 6 };

class GltfReader {
 public:
  explicit GltfReader(const std::filesystem::path& file)
      : document_(file),
        stem_(cleanName(file.stem().string())),
        budget_(1'000'000 + 20 * document_.byteCount()) {}

  Scene read() {
    checkExtensions();
    visited_.resize(document_.countOf("nodes"));
    std::vector<Visit> pending = roots();
    while (!pending.empty()) {
      const Visit visit = pending.back();
      pending.pop_back();
      const std::vector<Visit> children = enter(visit);
      pending.insert(pending.end(), children.rbegin(), children.rend());
    }
    return std::move(scene_);
  }

 private:
  struct Visit {
    std::size_t node;
    glm::dmat4 parent;
  };
  /// Where an accessor's positions lie in the scene's points, for the node at hand.
  struct Span {
    std::uint32_t first;
    std::size_t count;
  };

  void checkExtensions() {
    for (const JsonNode& name : document_.root().elements("extensionsRequired")) {
      const std::string text = name.text();
      if (std::find(kExtensions.begin(), kExtensions.end(), text) == kExtensions.end()) {
        name.fail("the model needs the extension \"" + cleanName(text) +
                  "\", which is not read; export without it (compression, instancing)");
      }
    }
    for (const JsonNode& name : document_.root().elements("extensionsUsed")) {
      if (name.text() == "KHR_lights_punctual" || name.text() == "EXT_mesh_gpu_instancing") {
        addDiagnosis(scene_.diagnoses, {"C132", "lamps and instances from glTF extensions were left out",
                                        name.pointer() + " " + name.text()});
      }
    }
  }

  /// The default scene's nodes; without scenes all that are nobody's child.
  std::vector<Visit> roots() {
    const JsonNode root = document_.root();
    const std::size_t nodeCount = document_.countOf("nodes");
    std::vector<std::uint32_t> nodes;
    if (const std::size_t scenes = document_.countOf("scenes"); scenes > 0) {
      const std::size_t index = root.index("scene", scenes, "scene").value_or(0);
      if (const auto list = root.at("scenes")[index].find("nodes")) {
        nodes = list->indices(nodeCount);
      }
    } else {
      std::vector<bool> isChild(nodeCount);
      for (const JsonNode& node : root.elements("nodes")) {
        if (const auto children = node.find("children")) {
          for (const std::uint32_t child : children->indices(nodeCount)) {
            isChild[child] = true;
          }
        }
      }
      for (std::uint32_t i = 0; i < nodeCount; ++i) {
        if (!isChild[i]) {
          nodes.push_back(i);
        }
      }
    }
    std::vector<Visit> visits;
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
      visits.push_back({*node, glm::dmat4(1.0)});
    }
    return visits;
  }

  static glm::dmat4 localMatrix(const JsonNode& node) {
    glm::dmat4 matrix(1.0);
    if (const auto stated = node.find("matrix")) {
      const std::vector<double> m = stated->numbers(16);
      for (int i = 0; i < 16; ++i) {
        matrix[i / 4][i % 4] = m[static_cast<std::size_t>(i)];
      }
      return matrix;
    }
    if (const auto rotation = node.find("rotation")) {
      const std::vector<double> q = rotation->numbers(4);
      const glm::dquat quaternion(q[3], q[0], q[1], q[2]);
      if (glm::length(quaternion) < 1e-9) {
        rotation->fail("has to be a unit quaternion");
      }
      matrix = glm::mat4_cast(glm::normalize(quaternion));
    }
    if (const auto scale = node.find("scale")) {
      const std::vector<double> s = scale->numbers(3);
      for (int axis = 0; axis < 3; ++axis) {
        matrix[axis] *= s[static_cast<std::size_t>(axis)];
      }
    }
    if (const auto translation = node.find("translation")) {
      const std::vector<double> t = translation->numbers(3);
      matrix[3] = glm::dvec4(t[0], t[1], t[2], 1.0);
    }
    return matrix;
  }

  /// Reads one node and returns its children.
  std::vector<Visit> enter(const Visit& visit) {
    const JsonNode node = document_.root().at("nodes")[visit.node];
    if (visited_[visit.node]) {
      node.fail("the node is met twice; nodes have to form a tree");
    }
    visited_[visit.node] = true;
    const glm::dmat4 matrix = visit.parent * localMatrix(node);
    if (const auto mesh = node.index("mesh", document_.countOf("meshes"), "mesh")) {
      if (node.find("skin")) {
        addDiagnosis(scene_.diagnoses,
                     {"C133", "skinned meshes were read in the pose they were modelled in", node.pointer()});
      }
      readMesh(node, document_.root().at("meshes")[*mesh], matrix);
    }
    std::vector<Visit> children;
    if (const auto list = node.find("children")) {
      for (const std::uint32_t child : list->indices(visited_.size())) {
        children.push_back({child, matrix});
      }
    }
    return children;
  }

  void readMesh(const JsonNode& node, const JsonNode& mesh, const glm::dmat4& matrix) {
    std::string name = cleanName(node.textOr("name", ""));
    if (name.empty()) {
      name = cleanName(mesh.textOr("name", ""));
    }
    object_ = static_cast<std::uint32_t>(scene_.objects.size());
    scene_.objects.push_back(name.empty() ? stem_ : name);
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

  /// The points of accessor `index` in the scene, transformed; read once for each node.
  Span points(std::size_t index, const JsonNode& user) {
    const auto found = spans_.find(index);
    if (found != spans_.end()) {
      return found->second;
    }
    const std::vector<glm::dvec3> local = document_.positions(index);
    spend(local.size(), user);
    const Span span{static_cast<std::uint32_t>(scene_.points.size()), local.size()};
    for (const glm::dvec3& point : local) {
      const glm::dvec3 placed(matrix_ * glm::dvec4(point, 1.0));
      if (!(glm::all(glm::lessThan(glm::abs(placed), glm::dvec3(1e12))))) {
        user.fail("its node's transformation sends a point beyond 1e12");
      }
      scene_.points.push_back(placed);
    }
    return spans_.emplace(index, span).first->second;
  }

  /// Small files can place large meshes often: more than twenty elements a byte is not a building.
  void spend(std::size_t elements, const JsonNode& user) {
    if (elements > budget_) {
      user.fail("the model repeats its meshes too often: more geometry than its size allows");
    }
    budget_ -= elements;
  }

  Span positionSpan(const JsonNode& primitive) {
    const auto index =
        primitive.at("attributes").index("POSITION", document_.countOf("accessors"), "accessor");
    if (!index) {
      primitive.fail("has no POSITION; compressed geometry is not read, export without compression");
    }
    return points(*index, primitive);
  }

  void readPrimitive(const JsonNode& primitive) {
    const std::size_t mode = primitive.countOr("mode", kTriangles);
    if (mode > kFan) {
      primitive.fail("mode " + std::to_string(mode) + " is not one of glTF's");
    }
    if (mode < kTriangles) {
      addDiagnosis(scene_.diagnoses, {"C111", "points, lines, curves and free-form surfaces were left out",
                                      primitive.pointer()});
      return;
    }
    if (!primitive.at("attributes").find("POSITION") && !primitive.find("extensions")) {
      addDiagnosis(scene_.diagnoses,
                   {"C134", "primitives without positions were left out", primitive.pointer()});
      return;
    }
    const Span span = positionSpan(primitive);
    std::vector<std::uint32_t> corners(0);
    if (const auto index = primitive.index("indices", document_.countOf("accessors"), "accessor")) {
      corners = document_.indices(*index);
      const auto beyond =
          std::find_if(corners.begin(), corners.end(), [&](std::uint32_t c) { return c >= span.count; });
      if (beyond != corners.end()) {
        primitive.fail("index " + std::to_string(*beyond) + " is out of range: there are " +
                       std::to_string(span.count) + " positions");
      }
    } else {
      corners.resize(span.count);
      for (std::uint32_t i = 0; i < corners.size(); ++i) {
        corners[i] = i;
      }
    }
    spend(corners.size(), primitive);
    addTriangles(corners, mode, span.first, material(primitive));
  }

  void addTriangles(const std::vector<std::uint32_t>& corners, std::size_t mode, std::uint32_t first,
                    std::uint32_t material) {
    const std::size_t count = mode == kTriangles    ? corners.size() / 3
                              : corners.size() >= 3 ? corners.size() - 2
                                                    : 0;
    for (std::size_t i = 0; i < count; ++i) {
      std::array<std::uint32_t, 3> t{};
      if (mode == kTriangles) {
        t = {corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]};
      } else if (mode == kStrip) {
        t = {corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]};
      } else {
        t = {corners[i + 1], corners[i + 2], corners[0]};
      }
      const bool joint = mode != kTriangles && (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]);
      if (joint) {
        continue;  // only there to join strips
      }
      if (mirrored_) {
        std::swap(t[1], t[2]);
      }
      for (std::uint32_t& corner : t) {
        corner += first;
      }
      scene_.faces.add(t);
      scene_.faceMaterial.push_back(material);
      scene_.faceObject.push_back(object_);
    }
  }

  void readCage(const JsonNode& mesh, const JsonNode& tags) {
    const JsonNode primitives = mesh.at("primitives");
    if (primitives.size() == 0) {
      mesh.fail("a cage needs a primitive with its points");
    }
    const Span span = positionSpan(primitives[0]);
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

  /// The primitive's material in the scene, numbered in the order of first use.
  std::uint32_t material(const JsonNode& primitive) {
    const auto index = primitive.index("material", document_.countOf("materials"), "material");
    const auto next = static_cast<std::uint32_t>(scene_.materials.size());
    const auto [found, isNew] = materialOf_.try_emplace(index, next);
    if (isNew) {
      DisplayMaterial display;
      if (index) {
        display = gltfMaterial(document_.root().at("materials")[*index], scene_.diagnoses);
      } else {
        display.color = glm::dvec3(1.0);  // glTF's default material is white
      }
      if (display.name.empty()) {
        display.name = index ? "material " + std::to_string(*index) : "default";
      }
      scene_.materials.push_back(materialOf(display, scene_.diagnoses));
    }
    return found->second;
  }

  GltfDocument document_;
  std::string stem_;
  std::size_t budget_;  // points and corners that may still be made
  Scene scene_;
  std::vector<bool> visited_;
  std::map<std::optional<std::size_t>, std::uint32_t> materialOf_;

  // Of the node at hand:
  std::uint32_t object_ = 0;
  glm::dmat4 matrix_{1.0};
  bool mirrored_ = false;
  std::map<std::size_t, Span> spans_;
};

}  // namespace

Scene readGltf(const std::filesystem::path& file) {
  return GltfReader(file).read();
}

}  // namespace clerestory
