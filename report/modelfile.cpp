// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of one object and material, written as OBJ with MTL or as GLB.
#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numbers>

#include <report/modelfile.hpp>

#include "folder.hpp"
#include "numbers.hpp"

namespace clerestory {
namespace {

static_assert(std::endian::native == std::endian::little, "GLB is little-endian");

using Json = nlohmann::ordered_json;

constexpr double markerRadius_m = 0.05;
constexpr const char* markerPrefix = "diagnosis ";

/// Polygons of one object in one material, with points of their own.
struct Part {
  std::string object;
  std::uint32_t material = 0;
  std::vector<glm::dvec3> points;
  PolygonList polygons;
};

struct Parts {
  std::vector<Material> materials;
  std::vector<Part> parts;
};

void addPieces(const Pieces& pieces, const std::vector<Surface>& surfaces, std::vector<Part>& parts) {
  const std::size_t first = parts.size();
  for (const Surface& surface : surfaces) parts.push_back({surface.name, surface.material, {}, {}});
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> numberOf;  // by surface and point
  std::vector<std::uint32_t> corners;
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    Part& part = parts[first + pieces.surface[piece]];
    corners.clear();
    for (const std::uint32_t point : pieces.polygons[piece]) {
      const auto [found, isNew] = numberOf.try_emplace({pieces.surface[piece], point},
                                                       static_cast<std::uint32_t>(part.points.size()));
      if (isNew) part.points.push_back(pieces.points[point]);
      corners.push_back(found->second);
    }
    if (pieces.isDrawnForBack[piece]) std::reverse(corners.begin(), corners.end());
    part.polygons.add(corners);
  }
}

void addMarker(const glm::dvec3& place_m, Part& part) {
  const auto first = static_cast<std::uint32_t>(part.points.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      glm::dvec3 tip = place_m;
      tip[axis] += sign * markerRadius_m;
      part.points.push_back(tip);
    }
  }
  for (std::uint32_t octant = 0; octant < 8; ++octant) {
    std::array<std::uint32_t, 3> corners{first + (octant & 1U), first + 2 + (octant >> 1U & 1U),
                                         first + 4 + (octant >> 2U)};
    if (std::popcount(octant) % 2 == 1) std::swap(corners[1], corners[2]);
    part.polygons.add(corners);
  }
}

/// Colours that follow each other lie far apart on the circle of hues.
glm::dvec3 colourOf(std::size_t number) {
  const double hue = static_cast<double>(number) * std::numbers::phi;
  const auto channel = [&](double shift) {
    const double turn = hue + shift - std::floor(hue + shift);
    return 0.85 * glm::clamp(std::abs(6.0 * turn - 3.0) - 1.0, 0.0, 1.0) + 0.02;
  };
  return {channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0)};
}

void addMarks(std::span<const Mark> marks, Parts& result) {
  std::map<std::string, std::uint32_t> materialOf;  // by code
  for (const Mark& mark : marks) materialOf.try_emplace(mark.code, 0U);
  for (auto& [code, material] : materialOf) {
    material = static_cast<std::uint32_t>(result.materials.size());
    Material& marker = result.materials.emplace_back();
    marker.name = markerPrefix + code;
    marker.reflectance =
        colourOf(static_cast<std::size_t>(std::distance(materialOf.begin(), materialOf.find(code))));
  }
  std::map<std::pair<std::string, std::string>, std::size_t> partOf;  // by code and object
  for (const Mark& mark : marks) {
    const auto [found, isNew] = partOf.try_emplace({mark.code, mark.object}, result.parts.size());
    if (isNew) {
      const std::string object = mark.object.empty() ? "" : " " + mark.object;
      result.parts.push_back({markerPrefix + mark.code + object, materialOf.at(mark.code), {}, {}});
    }
    addMarker(mark.place_m, result.parts[found->second]);
  }
}

Parts partsOf(const CleanModel& model, std::span<const Mark> marks) {
  Parts result{model.materials, {}};
  addPieces(model.pieces, model.surfaces, result.parts);
  addMarks(marks, result);
  std::erase_if(result.parts, [](const Part& part) { return part.polygons.size() == 0; });
  return result;
}

std::string words(const glm::dvec3& v) {
  return ' ' + shortestDouble(v.x) + ' ' + shortestDouble(v.y) + ' ' + shortestDouble(v.z);
}

std::string mtlText(const std::vector<Material>& materials) {
  std::string text = "# Kd is reflectance and Tf transmittance, linear; Ke is luminance in cd/m2\n";
  for (const Material& material : materials) {
    text += "\nnewmtl " + material.name + "\nKd" +
            words(material.glazing ? glm::dvec3(0.5, 0.7, 0.8) : material.reflectance) + '\n';
    if (material.exitance_lm_m2 != glm::dvec3(0.0))
      text += "Ke" + words(material.exitance_lm_m2 / std::numbers::pi) + '\n';
    text += material.glazing ? "d 0.3\n" : "d 1\n";
    if (material.glazing && !material.transmittanceIsAssumed)
      text += "Tf" + words(material.transmittance) + '\n';
  }
  return text;
}

std::string objText(const Parts& model, const std::string& library) {
  std::string text = "# Metres, z up\nmtllib " + library + '\n';
  std::size_t before = 1;
  for (const Part& part : model.parts) {
    text += "o " + part.object + "\nusemtl " + model.materials[part.material].name + '\n';
    for (const glm::dvec3& point : part.points) text += 'v' + words(point) + '\n';
    for (std::size_t polygon = 0; polygon < part.polygons.size(); ++polygon) {
      text += 'f';
      for (const std::uint32_t corner : part.polygons[polygon]) text += ' ' + std::to_string(before + corner);
      text += '\n';
    }
    before += part.points.size();
  }
  return text;
}

Json gltfMaterial(const Material& material, bool& transmits) {
  const auto rgb = [](const glm::dvec3& v, double alpha) { return Json{v.r, v.g, v.b, alpha}; };
  Json json = {{"name", material.name}, {"doubleSided", true}};
  Json& base = json["pbrMetallicRoughness"];
  base = {{"metallicFactor", 0.0}, {"roughnessFactor", 1.0}};
  if (!material.glazing) {
    base["baseColorFactor"] = rgb(material.reflectance, 1.0);
  } else if (material.transmittanceIsAssumed) {
    base["baseColorFactor"] = rgb({0.5, 0.7, 0.8}, 0.3);
    json["alphaMode"] = "BLEND";
  } else {
    base["baseColorFactor"] = rgb(material.transmittance, 1.0);
    json["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1.0;
    transmits = true;
  }
  return json;
}

/// Emission with the strength that brings its factor to 1 at most.
void addEmission(const Material& material, Json& json, bool& emits) {
  const glm::dvec3 luminance = material.exitance_lm_m2 / std::numbers::pi;
  const double strength = std::max({luminance.r, luminance.g, luminance.b});
  if (strength <= 0.0) return;
  const glm::dvec3 factor = luminance / strength;
  json["emissiveFactor"] = {factor.r, factor.g, factor.b};
  json["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
  emits = true;
}

template <class Value>
void append(std::string& bytes, const Value& value) {
  std::array<char, sizeof(Value)> raw;
  std::memcpy(raw.data(), &value, sizeof(Value));
  bytes.append(raw.data(), raw.size());
}

/// A GLB on its way: one buffer, a view and an accessor for each array in it.
class Glb {
 public:
  Glb(const Parts& model, const glm::dvec3& origin_m) {
    json_["asset"] = {{"version", "2.0"}, {"generator", "Clerestory"}};
    json_["scene"] = 0;
    json_["scenes"] = {{{"nodes", {0}}}};
    // Floats are fine near the origin only, so what is far away is moved by its node, which is in decimals.
    json_["nodes"] = {{{"name", "model"}, {"translation", {origin_m.x, origin_m.z, -origin_m.y}}}};
    addMaterials(model.materials);
    std::map<std::string, std::size_t> meshOf;
    for (const Part& part : model.parts) {
      const auto [found, isNew] = meshOf.try_emplace(part.object, meshOf.size());
      if (isNew) {
        const std::size_t node = json_["nodes"].size();
        json_["nodes"][0]["children"].push_back(node);
        json_["nodes"].push_back({{"name", part.object}, {"mesh", found->second}});
        json_["meshes"].push_back({{"name", part.object}, {"primitives", Json::array()}});
      }
      Json drawn = primitive(part, origin_m);  // adds to json_, which moves what it holds
      json_["meshes"][found->second]["primitives"].push_back(std::move(drawn));
    }
  }

  [[nodiscard]] std::string bytes() {
    json_["buffers"] = {{{"byteLength", binary_.size()}}};
    std::string text = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
    text.append((4 - text.size() % 4) % 4, ' ');
    const std::size_t total = 12 + 8 + text.size() + 8 + binary_.size();
    if (total > std::numeric_limits<std::uint32_t>::max())
      throw MachineError("the repaired model is too large for a GLB; write an .obj");
    std::string result = "glTF";
    append(result, std::uint32_t{2});
    append(result, static_cast<std::uint32_t>(total));
    append(result, static_cast<std::uint32_t>(text.size()));
    result += "JSON" + text;
    append(result, static_cast<std::uint32_t>(binary_.size()));
    result += std::string("BIN\0", 4) + binary_;
    return result;
  }

 private:
  void addMaterials(const std::vector<Material>& materials) {
    bool transmits = false;
    bool emits = false;
    for (const Material& material : materials) {
      Json json = gltfMaterial(material, transmits);
      addEmission(material, json, emits);
      json_["materials"].push_back(std::move(json));
    }
    if (transmits) json_["extensionsUsed"].push_back("KHR_materials_transmission");
    if (emits) json_["extensionsUsed"].push_back("KHR_materials_emissive_strength");
  }

  Json primitive(const Part& part, const glm::dvec3& origin_m) {
    constexpr int kArrayBuffer = 34962;
    constexpr int kElementArrayBuffer = 34963;
    constexpr int kFloat = 5126;
    constexpr int kUnsignedInt = 5125;
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(std::numeric_limits<float>::lowest());
    const std::size_t points = beginView(kArrayBuffer);
    for (const glm::dvec3& point : part.points) {
      const glm::dvec3 local = point - origin_m;
      const glm::vec3 turned(local.x, local.z, -local.y);
      low = glm::min(low, turned);
      high = glm::max(high, turned);
      for (int i = 0; i < 3; ++i) append(binary_, turned[i]);
    }
    const std::size_t pointsView = endView(points);
    json_["accessors"].push_back({{"bufferView", pointsView},
                                  {"componentType", kFloat},
                                  {"count", part.points.size()},
                                  {"type", "VEC3"},
                                  {"min", {low.x, low.y, low.z}},
                                  {"max", {high.x, high.y, high.z}}});
    const std::size_t triangles = beginView(kElementArrayBuffer);
    std::size_t count = 0;
    for (std::size_t polygon = 0; polygon < part.polygons.size(); ++polygon) {
      const auto corners = part.polygons[polygon];
      for (std::size_t i = 2; i < corners.size(); ++i, count += 3) {
        for (const std::uint32_t corner : {corners[0], corners[i - 1], corners[i]}) append(binary_, corner);
      }
    }
    const std::size_t trianglesView = endView(triangles);
    json_["accessors"].push_back({{"bufferView", trianglesView},
                                  {"componentType", kUnsignedInt},
                                  {"count", count},
                                  {"type", "SCALAR"}});
    return {{"attributes", {{"POSITION", json_["accessors"].size() - 2}}},
            {"indices", json_["accessors"].size() - 1},
            {"material", part.material}};
  }

  std::size_t beginView(int target) {
    json_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary_.size()}, {"target", target}});
    return json_["bufferViews"].size() - 1;
  }
  std::size_t endView(std::size_t view) {
    Json& json = json_["bufferViews"][view];
    json["byteLength"] = binary_.size() - json["byteOffset"].get<std::size_t>();
    return view;
  }

  Json json_;
  std::string binary_;
};

std::string endingOf(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); });
  return ending;
}

}  // namespace

bool isModelFile(const std::filesystem::path& file) {
  const std::string ending = endingOf(file);
  return ending == ".glb" || ending == ".obj";
}

void writeModel(const std::filesystem::path& file, const CleanModel& model, std::span<const Mark> marks) {
  const Parts parts = partsOf(model, marks);
  if (endingOf(file) == ".glb") {
    const std::vector<glm::dvec3>& points = model.pieces.points;
    writeFile(file, Glb(parts, points.empty() ? glm::dvec3(0.0) : glm::round(points[0])).bytes());
    return;
  }
  std::filesystem::path library = file;
  library.replace_extension(".mtl");
  writeFile(file, objText(parts, library.filename().string()));
  writeFile(library, mtlText(parts.materials));
}

}  // namespace clerestory
