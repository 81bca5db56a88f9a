// SPDX-License-Identifier: GPL-3.0-or-later
// A scene written as a modeller exports it to glTF: triangles, floats, y up, a node for each object.
#pragma once

#include <algorithm>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <import/scene.hpp>

#include "soup.hpp"
#include "triangulate.hpp"

namespace clerestory::drawn {

/// Triangles of a face, also of a concave one or a keyhole, wound as it is; a fan where its outline crosses
/// itself.
inline std::vector<std::uint32_t> trianglesOf(const Scene& scene, std::span<const std::uint32_t> face) {
  const glm::dvec3 vector = doubleAreaVector(scene.points, face);
  std::vector<std::uint32_t> triangles;
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    triangles.insert(triangles.end(), {a, b, c});
  };
  if (face.size() > 3 && glm::length(vector) > 0.0) {
    const PlaneFrame frame(glm::normalize(vector), scene.points[face[0]]);
    std::vector<std::uint32_t> corners;  // once each, though a keyhole's bridge is walked twice
    std::vector<glm::dvec2> flat;
    std::vector<std::uint32_t> loop;
    for (const std::uint32_t corner : face) {
      const auto same = std::ranges::find_if(
          corners, [&](std::uint32_t other) { return scene.points[other] == scene.points[corner]; });
      loop.push_back(static_cast<std::uint32_t>(same - corners.begin()));
      if (same != corners.end()) continue;
      corners.push_back(corner);
      flat.push_back(frame.project(scene.points[corner]));
    }
    std::vector<PlaneEdge> edges;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      if (loop[i] != loop[(i + 1) % loop.size()]) edges.push_back({loop[i], loop[(i + 1) % loop.size()], 1});
    }
    for (const auto& triangle : triangulate(flat, edges).triangles) {
      if (triangle.winding % 2 == 0) continue;
      add(corners[triangle.corner[0]], corners[triangle.corner[1]], corners[triangle.corner[2]]);
    }
  }
  if (triangles.empty()) {
    for (std::size_t i = 2; i < face.size(); ++i) add(face[0], face[i - 1], face[i]);
  }
  return triangles;
}

/// The bytes of a GLB with the scene's faces, materials and names.
inline std::string glbOf(const Scene& scene) {
  std::string binary;
  std::string views;
  std::string accessors;
  std::string meshes;
  std::string nodes;
  std::string materials;
  std::size_t count = 0;
  const auto append = [&](const auto& value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    binary.append(raw, sizeof value);
  };
  const auto comma = [](std::string& list) { list += list.empty() ? "" : ","; };
  const auto addArray = [&](std::size_t begin, const std::string& kind, std::size_t elements) {
    comma(views);
    comma(accessors);
    views += "{\"buffer\":0,\"byteOffset\":" + std::to_string(begin) +
             ",\"byteLength\":" + std::to_string(binary.size() - begin) + "}";
    accessors += "{\"bufferView\":" + std::to_string(count) + ",\"count\":" + std::to_string(elements) + "," +
                 kind + "}";
    return std::to_string(count++);
  };
  for (const Material& material : scene.materials) {
    comma(materials);
    const auto& colour = material.reflectance;
    materials += "{\"name\":\"" + material.name + "\",\"pbrMetallicRoughness\":{\"metallicFactor\":0," +
                 "\"baseColorFactor\":[" + std::to_string(colour.r) + "," + std::to_string(colour.g) + "," +
                 std::to_string(colour.b) + (material.glazing ? ",0.3]},\"alphaMode\":\"BLEND\"}" : ",1]}}");
  }
  std::map<std::uint32_t, std::map<std::uint32_t, std::vector<std::uint32_t>>> corners;  // object, material
  for (std::size_t face = 0; face < scene.faces.size(); ++face) {
    const auto triangles = trianglesOf(scene, scene.faces[face]);
    auto& list = corners[scene.faceObject[face]][scene.faceMaterial[face]];
    list.insert(list.end(), triangles.begin(), triangles.end());
  }
  std::string children;
  for (const auto& [object, byMaterial] : corners) {
    std::string primitives;
    for (const auto& [material, list] : byMaterial) {
      const std::size_t points = binary.size();
      std::map<std::uint32_t, std::uint32_t> numberOf;
      std::vector<std::uint32_t> indices;
      for (const std::uint32_t corner : list) {
        const auto [found, isNew] = numberOf.try_emplace(corner, static_cast<std::uint32_t>(numberOf.size()));
        indices.push_back(found->second);
        if (!isNew) continue;
        const glm::dvec3& point = scene.points[corner];
        for (const double value : {point.x, point.z, -point.y}) append(static_cast<float>(value));
      }
      const std::string position =
          addArray(points, "\"componentType\":5126,\"type\":\"VEC3\"", numberOf.size());
      const std::size_t begin = binary.size();
      for (const std::uint32_t index : indices) append(index);
      const std::string triangles =
          addArray(begin, "\"componentType\":5125,\"type\":\"SCALAR\"", indices.size());
      comma(primitives);
      primitives += "{\"attributes\":{\"POSITION\":" + position + "},\"indices\":" + triangles +
                    ",\"material\":" + std::to_string(material) + "}";
    }
    comma(meshes);
    comma(nodes);
    comma(children);
    const std::string name = "\"name\":\"" + scene.objects[object] + "\"";
    const std::string number = std::to_string(std::count(children.begin(), children.end(), ','));  // so far
    nodes += "{" + name + ",\"mesh\":" + number + "}";
    meshes += "{" + name + ",\"primitives\":[" + primitives + "]}";
    children += number;
  }
  std::string text = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + children +
                     "]}],\"nodes\":[" + nodes + "],\"meshes\":[" + meshes + "],\"materials\":[" + materials +
                     "],\"accessors\":[" + accessors + "],\"bufferViews\":[" + views +
                     "],\"buffers\":[{\"byteLength\":" + std::to_string(binary.size()) + "}]}";
  text.append((4 - text.size() % 4) % 4, ' ');
  std::string bytes = std::exchange(binary, {});
  const std::size_t total = 12 + 8 + text.size() + 8 + bytes.size();
  for (const std::size_t word : {std::size_t{0x46546c67}, std::size_t{2}, total, text.size()})
    append(static_cast<std::uint32_t>(word));
  const std::string head = std::exchange(binary, {});
  append(static_cast<std::uint32_t>(bytes.size()));
  return head + "JSON" + text + binary + std::string("BIN\0", 4) + bytes;
}

}  // namespace clerestory::drawn
