// SPDX-License-Identifier: GPL-3.0-or-later
// Reads subdivision cages from a glTF mesh's extras.
#include "gltfcage.hpp"

#include <algorithm>

#include "cage.hpp"

namespace clerestory {
namespace {

constexpr std::size_t kMaxCorners = 1'000'000'000;

std::uint32_t pointAt(const JsonNode& node, std::uint32_t first, std::size_t count) {
  const std::size_t point = node.count();
  if (point >= count) {
    node.fail("point " + std::to_string(point) + " is out of range: there are " + std::to_string(count));
  }
  return first + static_cast<std::uint32_t>(point);
}

float sharpnessAt(const JsonNode& node) {
  const double sharpness = node.number();
  if (sharpness < 0.0) {
    node.fail("a sharpness is 0 or more");
  }
  return static_cast<float>(std::min(sharpness, 10.0));
}

/// An array of `size` elements.
const JsonNode& sized(const JsonNode& node, std::size_t size) {
  if (node.size() != size) {
    node.fail("has to have " + std::to_string(size) + " elements, has " + std::to_string(node.size()));
  }
  return node;
}

void readFaces(const JsonNode& tags, std::uint32_t first, std::size_t count, Cage& cage) {
  const JsonNode sizesNode = tags.at("face_sizes");
  const std::vector<std::uint32_t> sizes = sizesNode.indices(kMaxCorners);
  std::vector<std::uint32_t> points = tags.at("face_points").indices(count);
  for (std::uint32_t& point : points) {
    point += first;
  }
  std::size_t at = 0;
  for (std::size_t f = 0; f < sizes.size(); ++f) {
    if (sizes[f] < 3 || sizes[f] > points.size() - at) {
      sizesNode[f].fail("a face has 3 corners or more, and face_points has to hold them all");
    }
    cage.faces.add(std::span(points).subspan(at, sizes[f]));
    at += sizes[f];
  }
  if (at != points.size() || sizes.empty()) {
    sizesNode.fail("the sizes add up to " + std::to_string(at) + " corners, face_points has " +
                   std::to_string(points.size()));
  }
}

}  // namespace

Cage readGltfCage(const JsonNode& tags, std::uint32_t first, std::size_t count) {
  Cage cage;
  const auto scheme = parseScheme(tags.textOr("scheme", "catmark"));
  if (!scheme) {
    tags.at("scheme").fail("a scheme is catmark, loop or bilinear");
  }
  cage.scheme = *scheme;
  const auto boundary = parseBoundary(tags.textOr("boundary", "edge-and-corner"));
  if (!boundary) {
    tags.at("boundary").fail("a boundary is none, edge-only or edge-and-corner");
  }
  cage.boundary = *boundary;
  readFaces(tags, first, count, cage);
  for (const JsonNode& crease : tags.elements("creases")) {
    sized(crease, 3);
    cage.creases.push_back(
        {pointAt(crease[0], first, count), pointAt(crease[1], first, count), sharpnessAt(crease[2])});
  }
  for (const JsonNode& corner : tags.elements("corners")) {
    sized(corner, 2);
    cage.corners.push_back({pointAt(corner[0], first, count), sharpnessAt(corner[1])});
  }
  if (const auto holes = tags.find("holes")) {
    cage.holes = holes->indices(cage.faces.size());
  }
  return cage;
}

}  // namespace clerestory
