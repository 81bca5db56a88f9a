// SPDX-License-Identifier: GPL-3.0-or-later
// The tree of one light domain: clusters over the sides of its pieces, and elements that sides are divided
// into. It knows geometry only; sums of radiosity run beside it in arrays of the same indices.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <geometry/building.hpp>

namespace clerestory {

using NodeIndex = std::uint32_t;
inline constexpr NodeIndex noNode = std::numeric_limits<NodeIndex>::max();

/// The six directions that a cluster's light is kept by, and the share of a vector along each.
inline constexpr glm::vec3 sixDirections[6] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                               {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
inline float alongDirection(const glm::vec3& vector, std::size_t k) {
  return std::max(glm::dot(vector, sixDirections[k]), 0.0F);
}

/// A side of a piece as a tree of elements.
struct TreeSide {
  std::uint32_t side;  ///< of the building: 2 × piece, + 1 for the back
  glm::vec3 normal;    ///< into the domain's air
  NodeIndex root;
};

/// Points that stand for a node wherever its visibility is asked for: laid evenly by area, once.
inline constexpr std::size_t spotsOfNode = 8;
using Spots = std::array<glm::vec3, spotsOfNode>;

/// A convex planar polygon with what the oracle asks of it.
struct ElementShape {
  std::vector<glm::vec3> corners;
  glm::vec3 centre{0.0F};
  float radius_m = 0.0F;  ///< of the sphere about the centre that holds it
  float area_m2 = 0.0F;
  float weight = 0.0F;    ///< what an error on it counts; adds up over children
  std::uint64_t key = 1;  ///< stable: from the piece's place in the canonical order and the path of division
};

/// Where an element is divided: the plane n·x + d, positive on the second child's side. The way down to a
/// leaf reads nothing else, so the children are told here too; noNode: not divided.
struct Split {
  glm::vec4 plane{0.0F};
  NodeIndex firstChild = noNode;

  [[nodiscard]] NodeIndex whichChild(const glm::vec3& point) const {
    return glm::dot(glm::vec3(plane), point) + plane.w > 0.0F ? 1U : 0U;
  }
};

/// Nodes in arrays. The trunk (clusters and the sides' roots) comes first, then elements as they are made, so
/// a child's index is always above its parent's. The two children of a node stand side by side.
class Hierarchy {
 public:
  /// A tree over the given sides; corners are local to `origin`. `weights` (#sides) may be empty: areas.
  Hierarchy(const Pieces& pieces, std::span<const std::uint32_t> sides, const glm::dvec3& origin,
            std::span<const float> weights);

  std::vector<glm::vec3> centre;
  std::vector<float> radius_m;
  std::vector<float> area_m2;
  std::vector<float> weight;
  std::vector<NodeIndex> firstChild;    ///< noNode: none
  std::vector<std::uint32_t> treeSide;  ///< index into sides; clusters: noNode
  std::vector<std::uint64_t> key;
  std::vector<std::uint32_t> firstCorner;  ///< into corners; clusters: bounding box's low and high
  std::vector<std::uint32_t> cornerCount;
  std::vector<Split> split;  ///< of divided elements
  std::vector<glm::vec3> corners;
  std::vector<TreeSide> sides;
  std::vector<Spots> spots;
  /// The leaves that hold the spots, as of the last call of `findSpotLeaves`.
  std::vector<std::array<NodeIndex, spotsOfNode>> spotLeaves;
  /// Of the trunk's nodes: the sides that the spots lie on.
  std::vector<std::array<std::uint32_t, spotsOfNode>> spotSides;
  /// The sides in the trunk's order, in which those of any of its nodes stand together: #sides, their places;
  /// and of the trunk's nodes the first place and the one past the last.
  std::vector<std::uint32_t> placeOfSide;
  std::vector<std::array<std::uint32_t, 2>> places;
  /// Of the trunk's nodes: area seen from +x -x +y -y +z -z were nothing hidden.
  std::vector<std::array<float, 6>> crossSection_m2;

  /// Of the first nodes, those over elements that line a gap: light falls off so steeply along these that
  /// none of it may be received as one mean. May be shorter than the tree.
  std::vector<std::uint8_t> holdsGap;

  [[nodiscard]] std::size_t size() const { return centre.size(); }
  /// Nodes of the trunk: all clusters are among the first so many.
  [[nodiscard]] std::size_t trunkSize() const { return trunkSize_; }
  [[nodiscard]] bool isCluster(NodeIndex node) const { return treeSide[node] == noNode; }
  [[nodiscard]] bool isLeaf(NodeIndex node) const { return firstChild[node] == noNode; }
  [[nodiscard]] std::span<const glm::vec3> polygon(NodeIndex element) const {
    return std::span(corners).subspan(firstCorner[element], cornerCount[element]);
  }
  [[nodiscard]] const glm::vec3& normal(NodeIndex element) const { return sides[treeSide[element]].normal; }
  [[nodiscard]] const glm::vec3& spotNormal(NodeIndex node, std::size_t spot) const {
    return isCluster(node) ? sides[spotSides[node][spot]].normal : normal(node);
  }
  [[nodiscard]] bool isOverGap(NodeIndex node) const { return node < holdsGap.size() && holdsGap[node] != 0; }
  [[nodiscard]] ElementShape shape(NodeIndex element) const;

  /// Gives the leaf `parent` two children and returns the first. Their weights come with them.
  NodeIndex divide(NodeIndex parent, const ElementShape& first, const ElementShape& second,
                   const glm::vec4& plane);

  /// The child of a divided element that holds a point of it.
  [[nodiscard]] NodeIndex childAt(NodeIndex element, const glm::vec3& point) const {
    return firstChild[element] + whichChild(element, point);
  }
  /// 0 for its first child, 1 for its second.
  [[nodiscard]] NodeIndex whichChild(NodeIndex element, const glm::vec3& point) const {
    return split[element].whichChild(point);
  }
  /// Looks up the leaves of all spots; to be called before they are asked for when the tree has grown.
  void findSpotLeaves();
  /// The leaf of a side's tree that holds a point of the side.
  [[nodiscard]] NodeIndex leafAt(NodeIndex sideRoot, const glm::vec3& point) const;

  /// Bytes that any node takes beside its corners.
  static constexpr std::size_t bytesOfNode = sizeof(glm::vec3) + 3 * sizeof(float) + 2 * sizeof(NodeIndex) +
                                             sizeof(std::uint64_t) + 2 * sizeof(std::uint32_t) +
                                             sizeof(Split) + sizeof(Spots) + spotsOfNode * sizeof(NodeIndex);
  /// Bytes that nodes take, without the values that run over them.
  [[nodiscard]] std::size_t bytes() const;

 private:
  NodeIndex addElement(const ElementShape& shape, std::uint32_t treeSide);
  void drawClusterSpots(NodeIndex cluster);
  std::size_t trunkSize_ = 0;
};

/// Points laid evenly over a convex polygon (#≥3), seeded by an element's key.
Spots spotsOn(std::span<const glm::vec3> polygon, std::uint64_t key);

/// How far an element reaches along its longest edge and across it, in its plane.
struct Extents {
  glm::vec3 along, across;  ///< unit vectors
  glm::vec2 alongRange_m, acrossRange_m;

  [[nodiscard]] float along_m() const { return alongRange_m[1] - alongRange_m[0]; }
  [[nodiscard]] float across_m() const { return acrossRange_m[1] - acrossRange_m[0]; }
  [[nodiscard]] float longer_m() const { return std::max(along_m(), across_m()); }
  [[nodiscard]] float shorter_m() const { return std::min(along_m(), across_m()); }
};
Extents extentsOf(std::span<const glm::vec3> polygon, const glm::vec3& normal);

/// The two halves of an element, one of its extents cut in two; their areas and weights add up to its own.
struct Halves {
  ElementShape first, second;
  glm::vec4 plane;
};
enum class Extent : std::uint8_t { longer, shorter };
Halves halve(const ElementShape& element, const glm::vec3& normal, Extent cut = Extent::longer);

}  // namespace clerestory
