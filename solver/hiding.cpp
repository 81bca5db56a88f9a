// SPDX-License-Identifier: GPL-3.0-or-later
// Looks for pieces on the way to a polygon's middle, and whether one of them covers its corners, too.
#include "hiding.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

namespace clerestory {
namespace {

constexpr int piecesMost = 6;  // that are looked at on the way

/// Whether the way between two points passes through a convex piece, off its edges.
bool passesThrough(const glm::vec3& from, const glm::vec3& to, std::span<const glm::vec3> piece,
                   const glm::vec3& normal) {
  const float before_m = glm::dot(from - piece[0], normal);
  const float behind_m = glm::dot(to - piece[0], normal);
  if (before_m * behind_m >= 0.0F) return false;
  const glm::vec3 crossing = from + before_m / (before_m - behind_m) * (to - from);
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const glm::vec3 edge = piece[(i + 1) % piece.size()] - piece[i];
    const float inside_m = glm::dot(glm::cross(normal, edge), crossing - piece[i]) / glm::length(edge);
    if (inside_m < rayOffset_m) return false;
  }
  return true;
}

}  // namespace

// A convex piece that all corners are behind hides what is between them, too.
bool isBehindOnePiece(const World& world, const glm::vec3& from, std::span<const glm::vec3> polygon) {
  glm::vec3 middle(0.0F);
  for (const glm::vec3& corner : polygon) middle += corner / static_cast<float>(polygon.size());
  const float length_m = glm::length(middle - from);
  const glm::vec3 direction = (middle - from) / length_m;
  float passed_m = 0.0F;
  for (int i = 0; i < piecesMost; ++i) {
    const auto hit = world.rays.nearest(from + passed_m * direction, direction, RayScene::Barrier::opaque,
                                        length_m - passed_m - rayOffset_m);
    if (!hit) return false;
    const auto piece = world.polygon(hit.piece);
    const glm::vec3 normal = world.normalOf(2 * hit.piece);
    if (std::ranges::all_of(
            polygon, [&](const glm::vec3& corner) { return passesThrough(from, corner, piece, normal); }))
      return true;
    passed_m += hit.distance_m + rayOffset_m;
  }
  return false;
}

}  // namespace clerestory
