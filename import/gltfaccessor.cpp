// SPDX-License-Identifier: GPL-3.0-or-later
// Reads glTF's accessors: counts, offsets and sizes are compared with the bytes that are there before any is
// read.
#include <cmath>
#include <cstring>

#include "gltfdocument.hpp"

namespace clerestory {
namespace {

constexpr std::size_t kByte = 5121;
constexpr std::size_t kShort = 5123;
constexpr std::size_t kInt = 5125;
constexpr std::size_t kFloat = 5126;
constexpr std::size_t kMaxZeros = 1'000'000;  // elements that no byte stands for

std::size_t componentSize(std::size_t type, const JsonNode& accessor) {
  switch (type) {
    case 5120:
    case kByte:
      return 1;
    case 5122:
    case kShort:
      return 2;
    case kInt:
    case kFloat:
      return 4;
    default:
      accessor.fail("componentType " + std::to_string(type) + " is not one of glTF's");
  }
}

template <typename Value>
Value load(const char* data) {
  Value value;
  std::memcpy(&value, data, sizeof(value));
  return value;
}

std::uint32_t loadUnsigned(const char* data, std::size_t type) {
  switch (type) {
    case kByte:
      return load<std::uint8_t>(data);
    case kShort:
      return load<std::uint16_t>(data);
    default:
      return load<std::uint32_t>(data);
  }
}

glm::dvec3 loadPoint(const char* data, const JsonNode& accessor, std::size_t index) {
  const glm::dvec3 point(load<float>(data), load<float>(data + 4), load<float>(data + 8));
  if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z)) {
    accessor.fail("position " + std::to_string(index) + " is not finite");
  }
  return point;
}

bool isUnsigned(std::size_t type) {
  return type == kByte || type == kShort || type == kInt;
}

}  // namespace

JsonNode GltfDocument::accessorNode(std::size_t index) const {
  const JsonNode accessors = root().at("accessors");
  if (index >= accessors.size()) {
    accessors.fail("there is no accessor " + std::to_string(index));
  }
  return accessors[index];
}

/// The bytes of the buffer view that `user` names, and its stride (0: packed).
std::string_view GltfDocument::view(const JsonNode& user, std::size_t& stride) const {
  const auto index = user.index("bufferView", countOf("bufferViews"), "bufferView");
  if (!index) {
    user.fail("\"bufferView\" is missing");
  }
  const JsonNode node = root().at("bufferViews")[*index];
  const auto buffer = node.index("buffer", buffers_.size(), "buffer");
  if (!buffer) {
    node.fail("\"buffer\" is missing");
  }
  const std::string_view bytes = buffers_[*buffer];
  const std::size_t offset = node.countOr("byteOffset", 0);
  const std::size_t length = node.at("byteLength").count();
  if (offset > bytes.size() || length > bytes.size() - offset) {
    node.fail("reaches beyond the end of its buffer: offset " + std::to_string(offset) + " and length " +
              std::to_string(length) + " of " + std::to_string(bytes.size()) + " bytes");
  }
  stride = node.countOr("byteStride", 0);
  return bytes.substr(offset, length);
}

GltfDocument::Elements GltfDocument::elements(const JsonNode& accessor, std::size_t count,
                                              std::size_t componentType, std::size_t components) const {
  const std::size_t size = componentSize(componentType, accessor) * components;
  std::size_t stride = 0;
  const std::string_view bytes = view(accessor, stride);
  if (stride != 0 && stride < size) {
    accessor.fail("its elements of " + std::to_string(size) + " bytes overlap: byteStride is " +
                  std::to_string(stride));
  }
  stride = stride == 0 ? size : stride;
  const std::size_t offset = accessor.countOr("byteOffset", 0);
  const std::size_t room = offset <= bytes.size() ? bytes.size() - offset : 0;
  if (count > 0 && (room < size || count - 1 > (room - size) / stride)) {
    accessor.fail("reaches beyond the end of its bufferView: " + std::to_string(count) +
                  " elements from byte " + std::to_string(offset) + " of " + std::to_string(bytes.size()));
  }
  return {bytes.data() + (count > 0 ? offset : 0), count, stride, componentType};
}

GltfDocument::Elements GltfDocument::accessorElements(const JsonNode& accessor, const char* type,
                                                      std::size_t components) const {
  if (accessor.at("type").text() != type) {
    accessor.fail(std::string("its type has to be ") + type);
  }
  const std::size_t count = accessor.at("count").count();
  const std::size_t componentType = accessor.at("componentType").count();
  if (accessor.find("bufferView")) {
    return elements(accessor, count, componentType, components);
  }
  if (!accessor.find("sparse")) {
    accessor.fail("has no bufferView; compressed geometry is not read, export without compression");
  }
  if (count > kMaxZeros) {
    accessor.fail("has no bufferView for its " + std::to_string(count) + " elements");
  }
  return {nullptr, count, 0, componentType};
}

std::vector<glm::dvec3> GltfDocument::positions(std::size_t index) const {
  const JsonNode accessor = accessorNode(index);
  const Elements values = accessorElements(accessor, "VEC3", 3);
  if (values.componentType != kFloat) {
    accessor.fail("positions have to be float; export without quantisation");
  }
  std::vector<glm::dvec3> points(values.count, glm::dvec3(0.0));
  for (std::size_t i = 0; i < values.count && values.data != nullptr; ++i) {
    points[i] = loadPoint(values.data + i * values.stride, accessor, i);
  }
  applySparse(accessor, points);
  return points;
}

/// Sparse accessors: some elements stand elsewhere.
void GltfDocument::applySparse(const JsonNode& accessor, std::vector<glm::dvec3>& points) const {
  const auto sparse = accessor.find("sparse");
  if (!sparse) {
    return;
  }
  const std::size_t count = sparse->at("count").count();
  const JsonNode places = sparse->at("indices");
  const JsonNode values = sparse->at("values");
  const std::size_t type = places.at("componentType").count();
  if (!isUnsigned(type)) {
    places.fail("indices have to be unsigned");
  }
  const Elements at = elements(places, count, type, 1);
  const Elements to = elements(values, count, kFloat, 3);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = loadUnsigned(at.data + i * at.stride, type);
    if (place >= points.size()) {
      places.fail("element " + std::to_string(place) + " is out of range: there are " +
                  std::to_string(points.size()));
    }
    points[place] = loadPoint(to.data + i * to.stride, values, i);
  }
}

std::vector<std::uint32_t> GltfDocument::indices(std::size_t index) const {
  const JsonNode accessor = accessorNode(index);
  if (accessor.find("sparse")) {
    accessor.fail("sparse indices are not read");
  }
  const Elements values = accessorElements(accessor, "SCALAR", 1);
  if (!isUnsigned(values.componentType)) {
    accessor.fail("indices have to be unsigned bytes, shorts or ints");
  }
  std::vector<std::uint32_t> indices(values.count);
  for (std::size_t i = 0; i < values.count; ++i) {
    indices[i] = loadUnsigned(values.data + i * values.stride, values.componentType);
  }
  return indices;
}

}  // namespace clerestory
