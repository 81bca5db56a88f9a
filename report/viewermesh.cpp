// SPDX-License-Identifier: GPL-3.0-or-later
// Packs elements: differences of neighbouring values, low and high bytes apart, which deflate takes well.
#include "viewermesh.hpp"

#include <glm/common.hpp>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "metrics.hpp"

namespace clerestory {
namespace {

/// 0 for no light, else 1 … 16383 in even steps of the logarithm from 2^-14 to 2^26: 0.17 % apart.
std::uint16_t lightCode(double value) {
  if (!(value > 0.0)) return 0;
  return static_cast<std::uint16_t>(
      std::lround(std::clamp((std::log2(value) + 14.0) / 40.0, 0.0, 1.0) * 16382.0) + 1);
}

template <class Value>
void appendShorts(std::string& bytes, std::size_t count, const Value& value) {
  const std::size_t start = bytes.size();
  bytes.resize(start + 2 * count);
  std::uint16_t before = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint16_t now = value(i);
    const auto difference = static_cast<std::uint16_t>(now - before);
    bytes[start + i] = static_cast<char>(difference & 0xffU);
    bytes[start + count + i] = static_cast<char>(difference >> 8U);
    before = now;
  }
}

template <class Value>
void appendOctets(std::string& bytes, std::size_t count, const Value& value) {
  std::uint8_t before = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t now = value(i);
    bytes.push_back(static_cast<char>(static_cast<std::uint8_t>(now - before)));
    before = now;
  }
}

std::string deflated(const std::string& bytes) {
  uLongf length = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(length, '\0');
  const int result =
      compress2(reinterpret_cast<Bytef*>(packed.data()), &length,
                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()), 6);
  if (result != Z_OK) throw std::bad_alloc();  // the only failure with a buffer of that size
  packed.resize(length);
  return packed;
}

}  // namespace

PackedMesh packMesh(const ElementMesh& mesh) {
  glm::vec3 low(std::numeric_limits<float>::infinity());
  glm::vec3 high = -low;
  for (const glm::vec3& corner : mesh.corners_m) {
    low = glm::min(low, corner);
    high = glm::max(high, corner);
  }
  const glm::dvec3 size(high - low);
  PackedMesh packed;
  packed.low_m = mesh.origin_m + glm::dvec3(low);
  packed.size_m = size;
  packed.step_m = std::max({size.x, size.y, size.z, 1e-6}) / 65535.0;

  const std::size_t elements = mesh.size();
  const std::size_t corners = mesh.corners_m.size();
  std::string bytes;
  bytes.reserve(6 * elements + 13 * corners);
  appendShorts(bytes, elements, [&](std::size_t e) {
    return static_cast<std::uint16_t>(mesh.firstCorner[e + 1] - mesh.firstCorner[e]);
  });
  appendShorts(bytes, elements,
               [&](std::size_t e) { return static_cast<std::uint16_t>(mesh.surfaceRow[e] & 0xffffU); });
  appendShorts(bytes, elements,
               [&](std::size_t e) { return static_cast<std::uint16_t>(mesh.surfaceRow[e] >> 16U); });
  for (int axis = 0; axis < 3; ++axis) {
    appendShorts(bytes, corners, [&](std::size_t c) {
      const double along_m = static_cast<double>(mesh.corners_m[c][axis] - low[axis]);
      return static_cast<std::uint16_t>(std::clamp(std::lround(along_m / packed.step_m), 0L, 65535L));
    });
  }
  appendShorts(bytes, corners,
               [&](std::size_t c) { return lightCode(static_cast<double>(mesh.illuminance_lx[c])); });
  appendShorts(bytes, corners,
               [&](std::size_t c) { return lightCode(luminousY(glm::dvec3(mesh.exitance_lm_m2[c]))); });
  for (int channel = 0; channel < 3; ++channel) {
    appendOctets(bytes, corners, [&](std::size_t c) {
      const glm::vec3& exitance = mesh.exitance_lm_m2[c];
      const double y = luminousY(glm::dvec3(exitance));
      // A pure blue is 14 times its own luminance: tints beyond 4 are cut.
      const double tint = y > 0.0 ? static_cast<double>(exitance[channel]) / y : 1.0;
      return static_cast<std::uint8_t>(std::lround(std::clamp(tint / 4.0, 0.0, 1.0) * 255.0));
    });
  }
  packed.bytes = deflated(bytes);
  return packed;
}

}  // namespace clerestory
