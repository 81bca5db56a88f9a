// SPDX-License-Identifier: GPL-3.0-or-later
// Lays the elements out as glTF's buffers: for each surface its corners, its light and its triangles.
#include "glb.hpp"

#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "escape.hpp"
#include "image.hpp"
#include "metrics.hpp"

namespace clerestory {
namespace {

using Json = nlohmann::ordered_json;

// glTF's numbers for what they name.
constexpr int typeFloat = 5126;
constexpr int typeUnsigned = 5125;
constexpr int targetVertices = 34962;
constexpr int targetIndices = 34963;

static_assert(std::endian::native == std::endian::little, "glTF's numbers have their low bytes first");

template <class Value>
void append(std::string& bytes, Value value) {
  char raw[sizeof(Value)];
  std::memcpy(raw, &value, sizeof(Value));
  bytes.append(raw, sizeof(Value));
}

glm::vec3 yUp(const glm::vec3& p) {
  return {p.x, p.z, -p.y};
}

Json list(const glm::vec3& v) {
  return Json::array({v.x, v.y, v.z});
}

/// What a luminance is multiplied with to become a colour: as a picture of all corners would be exposed.
double colourScale(const ElementMesh& mesh) {
  LuminanceImage corners;
  corners.pixels_cd_m2.reserve(mesh.exitance_lm_m2.size());
  for (const glm::vec3& exitance : mesh.exitance_lm_m2)
    corners.pixels_cd_m2.push_back(std::numbers::inv_pi_v<float> * exitance);
  return exposureScale(corners, std::nullopt);
}

/// A document and its one buffer, filled surface by surface.
class SceneFile {
 public:
  explicit SceneFile(const ElementMesh& mesh)
      : mesh_(mesh), colourOfExitance_(static_cast<float>(colourScale(mesh) / std::numbers::pi)) {}

  /// `elements` are indices into the mesh, of one surface.
  void addSurface(const std::string& name, const Json& extras, const std::vector<std::uint32_t>& elements) {
    std::vector<std::uint32_t> corners;
    std::vector<std::uint32_t> triangles;
    for (const std::uint32_t e : elements) {
      const auto first = static_cast<std::uint32_t>(corners.size());
      const std::uint32_t count = mesh_.firstCorner[e + 1] - mesh_.firstCorner[e];
      for (std::uint32_t c = 0; c < count; ++c) corners.push_back(mesh_.firstCorner[e] + c);
      for (std::uint32_t c = 2; c < count; ++c)
        triangles.insert(triangles.end(), {first, first + c - 1, first + c});
    }
    if (triangles.empty()) return;
    const Json attributes = {{"POSITION", addPositions(corners)},
                             {"COLOR_0", addColours(corners)},
                             {"_ILLUMINANCE", addIlluminances(corners)}};
    const std::size_t indices = beginView(targetIndices);
    for (const std::uint32_t corner : triangles) append(buffer_, corner);
    endView(typeUnsigned, triangles.size(), "SCALAR");
    const Json primitive = {{"attributes", attributes}, {"indices", indices}, {"material", 0}};
    meshes_.push_back({{"name", name}, {"primitives", Json::array({primitive})}});
    nodes_.push_back({{"name", name}, {"mesh", meshes_.size() - 1}, {"extras", extras}});
  }

  /// The whole file.
  [[nodiscard]] std::string bytes(const std::string& version) {
    Json roots = Json::array();
    for (std::size_t i = 0; i < nodes_.size(); ++i) roots.push_back(i);
    Json document = {{"asset", {{"version", "2.0"}, {"generator", "Clerestory " + version}}}, {"scene", 0}};
    if (nodes_.empty()) {
      const Json empty = {{"name", "nothing is lit"}};
      document["scenes"] = Json::array({empty});
      return packed(document);
    }
    const glm::dvec3& origin = mesh_.origin_m;
    nodes_.push_back(
        {{"name", "building"}, {"translation", {origin.x, origin.z, -origin.y}}, {"children", roots}});
    const Json scene = {{"nodes", Json::array({nodes_.size() - 1})},
                        {"extras", {{"radiosity_lm_m2_of_1", 1.0 / static_cast<double>(colourOfExitance_)}}}};
    const Json material = {{"name", "radiosity"},
                           {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}},
                           {"extensions", {{"KHR_materials_unlit", Json::object()}}}};
    const Json buffer = {{"byteLength", buffer_.size()}};
    document["scenes"] = Json::array({scene});
    document["extensionsUsed"] = Json::array({"KHR_materials_unlit"});
    document["nodes"] = nodes_;
    document["meshes"] = meshes_;
    document["materials"] = Json::array({material});
    document["accessors"] = accessors_;
    document["bufferViews"] = views_;
    document["buffers"] = Json::array({buffer});
    return packed(document);
  }

 private:
  /// Gives the index of the accessor that endView will add.
  std::size_t beginView(int target) {
    views_.push_back({{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", 0}, {"target", target}});
    return accessors_.size();
  }

  void endView(int componentType, std::size_t count, const char* type) {
    Json& view = views_.back();
    view["byteLength"] = buffer_.size() - view["byteOffset"].get<std::size_t>();
    accessors_.push_back({{"bufferView", views_.size() - 1},
                          {"componentType", componentType},
                          {"count", count},
                          {"type", type}});
  }

  void appendPoint(const glm::vec3& p) {
    for (int axis = 0; axis < 3; ++axis) append(buffer_, p[axis]);
  }

  std::size_t addPositions(const std::vector<std::uint32_t>& corners) {
    const std::size_t accessor = beginView(targetVertices);
    glm::vec3 low(std::numeric_limits<float>::infinity());
    glm::vec3 high = -low;
    for (const std::uint32_t corner : corners) {
      const glm::vec3 point = yUp(mesh_.corners_m[corner]);
      low = glm::min(low, point);
      high = glm::max(high, point);
      appendPoint(point);
    }
    endView(typeFloat, corners.size(), "VEC3");
    accessors_.back()["min"] = list(low);
    accessors_.back()["max"] = list(high);
    return accessor;
  }

  std::size_t addColours(const std::vector<std::uint32_t>& corners) {
    const std::size_t accessor = beginView(targetVertices);
    for (const std::uint32_t corner : corners)
      appendPoint(glm::clamp(colourOfExitance_ * mesh_.exitance_lm_m2[corner], 0.0F, 1.0F));
    endView(typeFloat, corners.size(), "VEC3");
    return accessor;
  }

  std::size_t addIlluminances(const std::vector<std::uint32_t>& corners) {
    const std::size_t accessor = beginView(targetVertices);
    for (const std::uint32_t corner : corners) append(buffer_, mesh_.illuminance_lx[corner]);
    endView(typeFloat, corners.size(), "SCALAR");
    return accessor;
  }

  [[nodiscard]] std::string packed(const Json& document) const {
    std::string json = document.dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::size_t chunks = buffer_.empty() ? 1 : 2;
    const std::size_t length = 12 + 8 * chunks + json.size() + buffer_.size();
    if (length > std::numeric_limits<std::uint32_t>::max())
      throw std::length_error("scene.glb would be larger than 4 GB");
    std::string file = "glTF";
    append(file, std::uint32_t{2});
    append(file, static_cast<std::uint32_t>(length));
    append(file, static_cast<std::uint32_t>(json.size()));
    file += "JSON" + json;
    if (buffer_.empty()) return file;
    append(file, static_cast<std::uint32_t>(buffer_.size()));  // a multiple of 4, as all in it is
    file += std::string("BIN\0", 4);
    return file += buffer_;
  }

  const ElementMesh& mesh_;
  float colourOfExitance_;
  std::string buffer_;
  Json views_ = Json::array(), accessors_ = Json::array(), meshes_ = Json::array(), nodes_ = Json::array();
};

}  // namespace

std::string sceneGlb(const ReportInput& input) {
  const ElementMesh& mesh = input.solution.mesh;
  const std::vector<std::string> names = surfaceRowNames(input);
  std::vector<std::vector<std::uint32_t>> elements(input.solution.surfaces.size());
  for (std::uint32_t e = 0; e < mesh.size(); ++e) elements.at(mesh.surfaceRow[e]).push_back(e);
  SceneFile file(mesh);
  for (std::size_t row = 0; row < elements.size(); ++row) {
    const SurfaceValue& surface = input.solution.surfaces[row];
    const CleanModel& model = input.building.model;
    const Json extras = {
        {"room", validUtf8(roomName(input.building, surface.room))},
        {"material", validUtf8(model.materials.at(model.surfaces.at(surface.surface).material).name)}};
    file.addSurface(validUtf8(names.at(row)), extras, elements[row]);
  }
  return file.bytes(input.run.version);
}

}  // namespace clerestory
