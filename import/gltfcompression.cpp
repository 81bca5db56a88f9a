// SPDX-License-Identifier: GPL-3.0-or-later
// Decodes compressed parts of a glTF. What the decoders must not be given is refused before they see it.
#include "gltfcompression.hpp"

#include <draco/compression/decode.h>
#include <meshoptimizer.h>

#include <array>
#include <cmath>
#include <exception>
#include <memory>

namespace clerestory {
namespace {

/// The codecs store two bits at least for 16 bytes of attributes, a byte for a triangle, a byte for an index.
constexpr std::size_t kMaxMeshoptRatio = 64;
/// Draco's fewest bits for a triangle are about one, and it announces its counts before their data.
constexpr std::size_t kMaxDracoTrianglesPerByte = 16;

struct MeshoptView {
  std::size_t count = 0;
  std::size_t stride = 0;
  std::string mode;
  std::string filter;
};

MeshoptView meshoptView(const JsonNode& extension, std::size_t byteCount) {
  MeshoptView view{extension.at("count").count(), extension.at("byteStride").count(),
                   extension.at("mode").text(), extension.textOr("filter", "NONE")};
  const bool isAttributes = view.mode == "ATTRIBUTES";
  if (!isAttributes && view.mode != "TRIANGLES" && view.mode != "INDICES") {
    extension.at("mode").fail("is none of ATTRIBUTES, TRIANGLES, INDICES");
  }
  const bool strideFits = isAttributes ? view.stride > 0 && view.stride <= 256 && view.stride % 4 == 0
                                       : view.stride == 2 || view.stride == 4;
  if (!strideFits) {
    extension.at("byteStride").fail(std::to_string(view.stride) + " does not fit its mode");
  }
  if (view.mode == "TRIANGLES" && view.count % 3 != 0) {
    extension.at("count").fail(std::to_string(view.count) + " indices are no whole triangles");
  }
  if (view.count > kMaxMeshoptRatio * (byteCount + 64) / view.stride) {
    extension.at("count").fail("announces more than its " + std::to_string(byteCount) +
                               " compressed bytes can hold");
  }
  const bool filterFits =
      view.filter == "NONE" || (isAttributes && view.filter == "EXPONENTIAL") ||
      (isAttributes && view.filter == "QUATERNION" && view.stride == 8) ||
      (isAttributes && view.filter == "OCTAHEDRAL" && (view.stride == 4 || view.stride == 8));
  if (!filterFits) {
    extension.at("filter").fail("does not fit its mode and byteStride");
  }
  return view;
}

std::array<double, 3> attributeValue(const draco::PointAttribute& attribute, draco::PointIndex point,
                                     const JsonNode& extension) {
  std::array<float, 3> value{};
  if (!attribute.ConvertValue<float>(attribute.mapped_index(point), 3, value.data()) ||
      !std::isfinite(value[0]) || !std::isfinite(value[1]) || !std::isfinite(value[2])) {
    extension.fail("the Draco mesh has a position or a texture coordinate that is no finite number");
  }
  return {static_cast<double>(value[0]), static_cast<double>(value[1]), static_cast<double>(value[2])};
}

const draco::PointAttribute& attributeOf(const draco::Mesh& mesh, const JsonNode& node, int components) {
  const std::size_t id = node.count();
  const draco::PointAttribute* attribute =
      id <= UINT32_MAX ? mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id)) : nullptr;
  if (attribute == nullptr || attribute->num_components() < components) {
    node.fail("the Draco mesh has no attribute " + std::to_string(id) + " of " + std::to_string(components) +
              " components");
  }
  return *attribute;
}

std::unique_ptr<draco::Mesh> dracoMesh(const JsonNode& extension, std::string_view bytes) {
  try {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) {
      extension.fail("the Draco mesh does not decode: " + decoded.status().error_msg_string());
    }
    return std::move(decoded).value();
  } catch (const std::bad_alloc&) {  // counts are believed before their data is read
    extension.fail("the Draco mesh announces more than its " + std::to_string(bytes.size()) +
                   " bytes can hold");
  }
}

}  // namespace

std::string decodeMeshopt(const JsonNode& extension, std::string_view bytes) {
  const MeshoptView view = meshoptView(extension, bytes.size());
  std::string decoded(view.count * view.stride, '\0');
  const auto* source = reinterpret_cast<const unsigned char*>(bytes.data());
  const int error =
      view.mode == "ATTRIBUTES"
          ? meshopt_decodeVertexBuffer(decoded.data(), view.count, view.stride, source, bytes.size())
      : view.mode == "TRIANGLES"
          ? meshopt_decodeIndexBuffer(decoded.data(), view.count, view.stride, source, bytes.size())
          : meshopt_decodeIndexSequence(decoded.data(), view.count, view.stride, source, bytes.size());
  if (error != 0) {
    extension.fail("the compressed data does not decode; export the model again");
  }
  if (view.filter == "EXPONENTIAL") {
    meshopt_decodeFilterExp(decoded.data(), view.count, view.stride);
  } else if (view.filter == "QUATERNION") {
    meshopt_decodeFilterQuat(decoded.data(), view.count, view.stride);
  } else if (view.filter == "OCTAHEDRAL") {
    meshopt_decodeFilterOct(decoded.data(), view.count, view.stride);
  }
  return decoded;
}

DracoMesh decodeDraco(const JsonNode& extension, std::string_view bytes,
                      std::optional<std::size_t> coordinateSet) {
  const std::unique_ptr<draco::Mesh> mesh = dracoMesh(extension, bytes);
  if (mesh->num_faces() > kMaxDracoTrianglesPerByte * bytes.size() ||
      mesh->num_points() > kMaxDracoTrianglesPerByte * bytes.size()) {
    extension.fail("the Draco mesh has more triangles than its bytes can hold");
  }
  const JsonNode attributes = extension.at("attributes");
  const draco::PointAttribute& positions = attributeOf(*mesh, attributes.at("POSITION"), 3);
  DracoMesh result;
  for (draco::PointIndex point(0); point < mesh->num_points(); ++point) {
    const auto value = attributeValue(positions, point, extension);
    result.positions.emplace_back(value[0], value[1], value[2]);
  }
  const auto set =
      coordinateSet ? attributes.find(("TEXCOORD_" + std::to_string(*coordinateSet)).c_str()) : std::nullopt;
  if (set) {
    const draco::PointAttribute& coordinates = attributeOf(*mesh, *set, 2);
    for (draco::PointIndex point(0); point < mesh->num_points(); ++point) {
      const auto value = attributeValue(coordinates, point, extension);
      result.coordinates.emplace_back(value[0], value[1]);
    }
  }
  for (draco::FaceIndex face(0); face < mesh->num_faces(); ++face) {
    for (const draco::PointIndex& corner : mesh->face(face)) {
      if (corner.value() >= mesh->num_points()) {
        extension.fail("a face of the Draco mesh has a corner that is no point of it");
      }
      result.corners.push_back(corner.value());
    }
  }
  return result;
}

}  // namespace clerestory
