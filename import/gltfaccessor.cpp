// SPDX-License-Identifier: GPL-3.0-or-later
// Reads glTF's accessors: counts, offsets and sizes are compared with the bytes that are there before any is
// read.
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "gltfdocument.hpp"

namespace clerestory {
namespace {

enum ComponentType : std::size_t {
  kSignedByte = 5120,
  kByte = 5121,
  kSignedShort = 5122,
  kShort = 5123,
  kInt = 5125,
  kFloat = 5126
};
constexpr std::size_t kMaxZeros = 1'000'000;  // elements that no byte stands for

std::size_t componentSize(std::size_t type, const JsonNode& accessor) {
  switch (type) {
    case kSignedByte:
    case kByte:
      return 1;
    case kSignedShort:
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

/// An integer, or the fraction of its type's largest value that it stands for (glTF 2.0, 3.6.2.2).
template <typename Value>
double loadInteger(const char* data, bool normalized) {
  const auto value = static_cast<double>(load<Value>(data));
  return normalized ? std::max(value / static_cast<double>(std::numeric_limits<Value>::max()), -1.0) : value;
}

/// The shortest decimal that rounds to the float: what was drawn before it was written in 32 bits, so that
/// an OBJ of the same model gives the same points.
double decimalOf(float value) {
  std::array<char, 32> text;
  const auto written = std::to_chars(text.data(), text.data() + text.size(), value);
  double decimal = static_cast<double>(value);
  std::from_chars(text.data(), written.ptr, decimal);
  return decimal;
}

double loadNumber(const char* data, std::size_t type, bool normalized) {
  switch (type) {
    case kSignedByte:
      return loadInteger<std::int8_t>(data, normalized);
    case kByte:
      return loadInteger<std::uint8_t>(data, normalized);
    case kSignedShort:
      return loadInteger<std::int16_t>(data, normalized);
    case kShort:
      return loadInteger<std::uint16_t>(data, normalized);
    case kInt:
      return loadInteger<std::uint32_t>(data, normalized);
    default:
      return decimalOf(load<float>(data));
  }
}

std::uint32_t loadIndex(const char* data, std::size_t type) {
  switch (type) {
    case kByte:
      return load<std::uint8_t>(data);
    case kShort:
      return load<std::uint16_t>(data);
    default:
      return load<std::uint32_t>(data);
  }
}

void checkIsIndex(std::size_t type, const JsonNode& node) {
  if (type != kByte && type != kShort && type != kInt) {
    node.fail("indices have to be unsigned bytes, shorts or ints");
  }
}

}  // namespace

JsonNode GltfDocument::accessorNode(std::size_t index) const {
  const JsonNode accessors = root().at("accessors");
  if (index >= accessors.size()) {
    accessors.fail("there is no accessor " + std::to_string(index));
  }
  return accessors[index];
}

std::string_view GltfDocument::viewBytes(const JsonNode& user) const {
  std::size_t stride = 0;
  return view(user, stride);
}

/// The bytes of the buffer view that `user` names, and its stride (0: packed).
std::string_view GltfDocument::view(const JsonNode& user, std::size_t& stride) const {
  const auto index = user.index("bufferView", countOf("bufferViews"), "bufferView");
  if (!index) {
    user.fail("\"bufferView\" is missing");
  }
  const JsonNode node = root().at("bufferViews")[*index];
  stride = node.countOr("byteStride", 0);
  const auto decoded = decodedViews_.find(*index);
  return decoded != decodedViews_.end() ? std::string_view(decoded->second) : bufferBytes(node);
}

/// What lies from byteOffset on, byteLength long, in the buffer that `node` names.
std::string_view GltfDocument::bufferBytes(const JsonNode& node) const {
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
  if (count > kMaxZeros) {
    accessor.fail("has no bufferView for its " + std::to_string(count) + " elements");
  }
  static_cast<void>(componentSize(componentType, accessor));
  return {nullptr, count, 0, componentType};
}

/// Calls `replace(place, data)` for each element of a sparse accessor that stands elsewhere.
template <typename Replace>
void GltfDocument::forEachSparse(const JsonNode& accessor, const Elements& whole, std::size_t components,
                                 const Replace& replace) const {
  const auto sparse = accessor.find("sparse");
  if (!sparse) {
    return;
  }
  const std::size_t count = sparse->at("count").count();
  const JsonNode places = sparse->at("indices");
  const std::size_t type = places.at("componentType").count();
  checkIsIndex(type, places);
  const Elements at = elements(places, count, type, 1);
  const Elements to = elements(sparse->at("values"), count, whole.componentType, components);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = loadIndex(at.data + i * at.stride, type);
    if (place >= whole.count) {
      places.fail("element " + std::to_string(place) + " is out of range: there are " +
                  std::to_string(whole.count));
    }
    replace(place, to.data + i * to.stride);
  }
}

std::vector<double> GltfDocument::numbers(std::size_t index, const char* type, std::size_t components) const {
  const JsonNode accessor = accessorNode(index);
  const Elements whole = accessorElements(accessor, type, components);
  const auto normalizedNode = accessor.find("normalized");
  const bool normalized = normalizedNode && normalizedNode->isTrue();
  const std::size_t size = componentSize(whole.componentType, accessor);
  std::vector<double> values(whole.count * components, 0.0);
  const auto read = [&](std::size_t element, const char* data) {
    for (std::size_t c = 0; c < components; ++c) {
      const double value = loadNumber(data + c * size, whole.componentType, normalized);
      if (!std::isfinite(value)) {
        accessor.fail("element " + std::to_string(element) + " is not finite");
      }
      values[element * components + c] = value;
    }
  };
  for (std::size_t i = 0; i < whole.count && whole.data != nullptr; ++i) {
    read(i, whole.data + i * whole.stride);
  }
  forEachSparse(accessor, whole, components, read);
  return values;
}

std::vector<glm::dvec3> GltfDocument::positions(std::size_t index) const {
  const std::vector<double> values = numbers(index, "VEC3", 3);
  std::vector<glm::dvec3> points(values.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  }
  return points;
}

std::vector<std::uint32_t> GltfDocument::indices(std::size_t index) const {
  const JsonNode accessor = accessorNode(index);
  const Elements whole = accessorElements(accessor, "SCALAR", 1);
  checkIsIndex(whole.componentType, accessor);
  std::vector<std::uint32_t> indices(whole.count, 0);
  for (std::size_t i = 0; i < whole.count && whole.data != nullptr; ++i) {
    indices[i] = loadIndex(whole.data + i * whole.stride, whole.componentType);
  }
  forEachSparse(accessor, whole, 1, [&](std::size_t place, const char* data) {
    indices[place] = loadIndex(data, whole.componentType);
  });
  return indices;
}

}  // namespace clerestory
