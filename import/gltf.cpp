// SPDX-License-Identifier: GPL-3.0-or-later
// Reads glTF 2.0: walks the scene's nodes, places their meshes and lamps.
#include "gltf.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "gltfdocument.hpp"
#include "gltfmesh.hpp"
#include "textfile.hpp"

namespace clerestory {
namespace {

/// Extensions that are read, and those whose absence changes no figure.
constexpr auto kExtensions = std::to_array<std::string_view>(
    {"EXT_mesh_gpu_instancing",    "EXT_meshopt_compression",   "EXT_texture_webp",
     "KHR_draco_mesh_compression", "KHR_lights_punctual",       "KHR_materials_anisotropy",
     "KHR_materials_clearcoat",    "KHR_materials_dispersion",  "KHR_materials_emissive_strength",
     "KHR_materials_ior",          "KHR_materials_iridescence", "KHR_materials_pbrSpecularGlossiness",
     "KHR_materials_sheen",        "KHR_materials_specular",    "KHR_materials_transmission",
     "KHR_materials_unlit",        "KHR_materials_variants",    "KHR_materials_volume",
     "KHR_mesh_quantization",      "KHR_texture_transform",     "KHR_xmp_json_ld"});
constexpr std::size_t kMaxInstances = 1'000'000;

bool isKnown(std::string_view extension) {
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

glm::dmat4 matrixOf(const glm::dvec3& translation, const glm::dquat& rotation, const glm::dvec3& scale) {
  glm::dmat4 matrix = glm::mat4_cast(glm::normalize(rotation));
  for (int axis = 0; axis < 3; ++axis) {
    matrix[axis] *= scale[axis];
  }
  matrix[3] = glm::dvec4(translation, 1.0);
  return matrix;
}

glm::dmat4 localMatrix(const JsonNode& node) {
  if (const auto stated = node.find("matrix")) {
    const std::vector<double> m = stated->numbers(16);
    glm::dmat4 matrix(1.0);
    for (int i = 0; i < 16; ++i) {
      matrix[i / 4][i % 4] = m[static_cast<std::size_t>(i)];
    }
    return matrix;
  }
  const auto vector = [&](const char* key, double otherwise) {
    const auto value = node.find(key);
    const std::vector<double> v = value ? value->numbers(3) : std::vector<double>(3, otherwise);
    return glm::dvec3(v[0], v[1], v[2]);
  };
  glm::dquat rotation(1.0, 0.0, 0.0, 0.0);
  if (const auto stated = node.find("rotation")) {
    const std::vector<double> q = stated->numbers(4);
    rotation = glm::dquat(q[3], q[0], q[1], q[2]);
    if (glm::length(rotation) < 1e-9) {
      stated->fail("has to be a unit quaternion");
    }
  }
  return matrixOf(vector("translation", 0.0), rotation, vector("scale", 1.0));
}

class GltfReader {
 public:
  explicit GltfReader(const std::filesystem::path& file)
      : document_(file), stem_(cleanName(file.stem().string())), meshes_(document_, scene_) {}

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
    meshes_.finish();
    return std::move(scene_);
  }

 private:
  struct Visit {
    std::size_t node;
    glm::dmat4 parent;
  };

  void checkExtensions() {
    for (const JsonNode& name : document_.root().elements("extensionsRequired")) {
      if (!isKnown(name.text())) {
        name.fail("the model needs the extension \"" + cleanName(name.text()) +
                  "\", which is not read; export without it");
      }
    }
    for (const JsonNode& name : document_.root().elements("extensionsUsed")) {
      if (!isKnown(name.text())) {
        addDiagnosis(scene_.diagnoses, {"C137",
                                        "the extension \"" + cleanName(name.text()) +
                                            "\" is not known, and what it says is left out",
                                        name.pointer()});
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
      addMesh(node, document_.root().at("meshes")[*mesh], matrix);
    }
    if (const auto light = node.extension("KHR_lights_punctual")) {
      addLight(node, *light, matrix);
    }
    std::vector<Visit> children;
    if (const auto list = node.find("children")) {
      for (const std::uint32_t child : list->indices(visited_.size())) {
        children.push_back({child, matrix});
      }
    }
    return children;
  }

  void addMesh(const JsonNode& node, const JsonNode& mesh, const glm::dmat4& matrix) {
    std::string name = cleanName(node.textOr("name", ""));
    if (name.empty()) {
      name = cleanName(mesh.textOr("name", ""));
    }
    if (name.empty()) {
      name = stem_;
    }
    if (const auto instancing = node.extension("EXT_mesh_gpu_instancing")) {
      for (const glm::dmat4& instance : instances(*instancing)) {
        meshes_.add(mesh, name, matrix * instance);
      }
    } else {
      meshes_.add(mesh, name, matrix);
    }
  }

  /// Matrices of EXT_mesh_gpu_instancing: as many as its accessors have elements.
  std::vector<glm::dmat4> instances(const JsonNode& extension) const {
    const JsonNode attributes = extension.at("attributes");
    std::optional<std::size_t> count;
    const auto values = [&](const char* key, const char* type, std::size_t components) {
      const auto index = attributes.index(key, document_.countOf("accessors"), "accessor");
      std::vector<double> read = index ? document_.numbers(*index, type, components) : std::vector<double>{};
      if (index) {
        if (count.value_or(read.size() / components) != read.size() / components) {
          attributes.fail("TRANSLATION, ROTATION and SCALE differ in their number of elements");
        }
        count = read.size() / components;
      }
      return read;
    };
    const std::vector<double> t = values("TRANSLATION", "VEC3", 3);
    const std::vector<double> r = values("ROTATION", "VEC4", 4);
    const std::vector<double> s = values("SCALE", "VEC3", 3);
    if (count.value_or(0) > kMaxInstances) {
      attributes.fail("more than " + std::to_string(kMaxInstances) + " instances");
    }
    std::vector<glm::dmat4> matrices;
    for (std::size_t i = 0; i < count.value_or(0); ++i) {
      const glm::dvec3 translation =
          t.empty() ? glm::dvec3(0.0) : glm::dvec3(t[3 * i], t[3 * i + 1], t[3 * i + 2]);
      const glm::dvec3 scale = s.empty() ? glm::dvec3(1.0) : glm::dvec3(s[3 * i], s[3 * i + 1], s[3 * i + 2]);
      const glm::dquat rotation = r.empty() ? glm::dquat(1.0, 0.0, 0.0, 0.0)
                                            : glm::dquat(r[4 * i + 3], r[4 * i], r[4 * i + 1], r[4 * i + 2]);
      matrices.push_back(matrixOf(translation, rotation, scale));
    }
    return matrices;
  }

  /// KHR_lights_punctual: they shine along the node's -z.
  void addLight(const JsonNode& node, const JsonNode& use, const glm::dmat4& matrix) {
    const JsonNode lights = document_.root().at("extensions").at("KHR_lights_punctual").at("lights");
    const auto index = use.index("light", lights.size(), "light");
    if (!index) {
      use.fail("\"light\" is missing");
    }
    const JsonNode light = lights[*index];
    PunctualLight placed;
    placed.name = cleanName(node.textOr("name", light.textOr("name", "light " + std::to_string(*index))));
    const std::string type = light.at("type").text();
    if (type != "point" && type != "spot" && type != "directional") {
      light.at("type").fail("is none of point, spot, directional");
    }
    placed.kind = type == "point"  ? PunctualLight::Kind::point
                  : type == "spot" ? PunctualLight::Kind::spot
                                   : PunctualLight::Kind::directional;
    placed.position_m = glm::dvec3(matrix[3]);
    const glm::dvec3 axis = -glm::dvec3(matrix[2]);
    const bool isPlaced = glm::all(glm::lessThan(glm::abs(placed.position_m), glm::dvec3(1e12)));
    if (!isPlaced || !(glm::length(axis) > 0.0) || !std::isfinite(glm::length(axis))) {
      node.fail("its transformation leaves its lamp no place or no direction");
    }
    placed.direction = glm::normalize(axis);
    const auto color = light.find("color");
    const std::vector<double> rgb = color ? color->numbers(3) : std::vector<double>(3, 1.0);
    placed.intensity = light.numberOr("intensity", 1.0) * glm::dvec3(rgb[0], rgb[1], rgb[2]);
    if (const auto spot = light.find("spot")) {
      placed.innerCone_rad = spot->numberOr("innerConeAngle", 0.0);
      placed.outerCone_rad = spot->numberOr("outerConeAngle", std::numbers::pi / 4.0);
    } else {
      placed.outerCone_rad = std::numbers::pi / 4.0;
    }
    if (placed.kind == PunctualLight::Kind::directional) {
      addDiagnosis(scene_.diagnoses,
                   {"C132", "directional lights were left out; state the sun in [sky]", node.pointer()});
    }
    scene_.lights.push_back(std::move(placed));
  }

  GltfDocument document_;
  std::string stem_;
  Scene scene_;
  GltfMeshes meshes_;
  std::vector<bool> visited_;
};

}  // namespace

Scene readGltf(const std::filesystem::path& file) {
  return GltfReader(file).read();
}

}  // namespace clerestory
