// SPDX-License-Identifier: GPL-3.0-or-later
// The sun's beam: what of it falls on a point, through glass and past what stands in its way, and on
// elements.
#pragma once

#include <vector>

#include "hierarchy.hpp"
#include "world.hpp"

namespace clerestory {

/// Illuminance of a point with unit `normal` by the sun's beam from the middle of its disc, linear Rec.709.
/// Glass on the way counts by its angle, wherever it stands; what it reflects or scatters is left out. [lx]
glm::vec3 sunlightAt(const World& world, const glm::vec3& point, const glm::vec3& normal);

/// The same by its images in panes, for points outdoors. [lx]
glm::vec3 mirroredSunlightAt(const World& world, const glm::vec3& point, const glm::vec3& normal);

/// Luminance of the sun's disc along a unit direction, through glass; black beside the disc. [cd/m²]
glm::vec3 sunDiscLuminance(const World& world, const glm::vec3& from, const glm::vec3& direction);

/// Illuminance by the whole disc: `rays` directions over it, seeded by `key`. [lx]
glm::vec3 sunlightByDisc(const World& world, const glm::vec3& point, const glm::vec3& normal,
                         std::uint32_t rays, std::uint64_t key);

/// Sunlight on the nodes of a tree.
struct Sunlight {
  std::vector<glm::vec3> illuminance_lx;  ///< #nodes; leaves hold their means, linear Rec.709
  std::vector<std::uint8_t> mayReach;     ///< #nodes; 0 where no beam can fall on any point of a leaf

  [[nodiscard]] bool empty() const { return illuminance_lx.empty(); }
};

/// Divides the elements of a closed domain's tree where sun patches end, and lights its leaves. A patch is a
/// pane's polygon thrown along the beam onto the element's plane, exact but for what stands in between, which
/// rays find. In an open domain the tree stays as it is, and rays light its leaves. An element is divided
/// while it may misplace more than `thresholdShare` of the beam's power and its radius is above elementMin_m.
/// Empty without sun.
Sunlight sunlightOn(const World& world, std::int32_t domain, Hierarchy& tree, float thresholdShare,
                    float elementMin_m, std::size_t memoryBytes);

}  // namespace clerestory
