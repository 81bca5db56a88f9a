// SPDX-License-Identifier: GPL-3.0-or-later
// Builds the trunk of clusters by the surface-area heuristic, and divides elements across their longer
// extent.
#include "hierarchy.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <geometry/parallel.hpp>
#include <geometry/sampling.hpp>

namespace clerestory {
namespace {

struct Box {
  glm::vec3 low{std::numeric_limits<float>::max()};
  glm::vec3 high{-std::numeric_limits<float>::max()};

  void add(const glm::vec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  void add(const Box& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  [[nodiscard]] float halfSurface() const {
    const glm::vec3 d = high - low;
    return d.x * d.y + d.y * d.z + d.z * d.x;
  }
};

float areaOf(std::span<const glm::vec3> polygon) {
  glm::vec3 sum(0.0F);
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    sum += glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  }
  return 0.5F * glm::length(sum);
}

glm::vec3 centroidOf(std::span<const glm::vec3> polygon) {
  glm::vec3 sum(0.0F);
  float total = 0.0F;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const float area = glm::length(glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]));
    sum += area * ((polygon[0] + polygon[i - 1] + polygon[i]) / 3.0F - polygon[0]);
    total += area;
  }
  return total > 0.0F ? polygon[0] + sum / total : polygon[0];
}

void measure(ElementShape& shape) {
  shape.centre = centroidOf(shape.corners);
  shape.radius_m = 0.0F;
  for (const glm::vec3& corner : shape.corners) {
    shape.radius_m = std::max(shape.radius_m, glm::length(corner - shape.centre));
  }
}

struct TrunkNode {
  std::size_t first, last;  // of the order of sides
  NodeIndex firstChild = noNode;
};

/// Parts sides by the surface-area heuristic. They are sorted along each axis once; a cut keeps all three
/// orders in both of its parts. Ties keep the canonical order.
class TrunkBuilder {
 public:
  explicit TrunkBuilder(std::span<const Box> boxes)
      : boxes_(boxes), costAfter_(boxes.size()), isBefore_(boxes.size()), aside_(boxes.size()) {
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<std::uint32_t>& order = sorted_[static_cast<std::size_t>(axis)];
      order.resize(boxes.size());
      std::iota(order.begin(), order.end(), 0U);
      std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const float x = boxes[a].low[axis] + boxes[a].high[axis];
        const float y = boxes[b].low[axis] + boxes[b].high[axis];
        return x != y ? x < y : a < b;
      });
    }
  }

  /// The trunk in breadth-first order, down to single sides.
  std::vector<TrunkNode> build() {
    std::vector<TrunkNode> nodes{{0, boxes_.size()}};
    for (std::size_t node = 0; node < nodes.size(); ++node) {
      const auto [first, last, child] = nodes[node];
      if (last - first < 2) continue;
      const std::size_t cut = part(first, last);
      nodes[node].firstChild = static_cast<NodeIndex>(nodes.size());
      nodes.push_back({first, cut});
      nodes.push_back({cut, last});
    }
    return nodes;
  }

  /// The sides in the order that the built nodes refer to.
  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return sorted_[0]; }

 private:
  struct Cut {
    float cost = std::numeric_limits<float>::infinity();
    std::size_t place = 0;
    std::size_t axis = 0;
  };

  /// Where to part the sides first … last; they are then in this order along every axis.
  std::size_t part(std::size_t first, std::size_t last) {
    Cut best;
    best.place = first + (last - first) / 2;
    for (std::size_t axis = 0; axis < 3; ++axis) lookAlong(axis, first, last, best);
    for (std::size_t i = first; i < last; ++i) isBefore_[sorted_[best.axis][i]] = i < best.place;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axis != best.axis) keepOrder(sorted_[axis], first, last);
    }
    return best.place;
  }

  void lookAlong(std::size_t axis, std::size_t first, std::size_t last, Cut& best) {
    const std::vector<std::uint32_t>& order = sorted_[axis];
    Box box;
    for (std::size_t i = last; i-- > first;) {
      box.add(boxes_[order[i]]);
      costAfter_[i] = box.halfSurface() * static_cast<float>(last - i);
    }
    box = {};
    for (std::size_t i = first + 1; i < last; ++i) {
      box.add(boxes_[order[i - 1]]);
      const float cost = box.halfSurface() * static_cast<float>(i - first) + costAfter_[i];
      if (cost < best.cost) best = {cost, i, axis};
    }
  }

  /// Brings the sides before the cut to the front.
  void keepOrder(std::vector<std::uint32_t>& order, std::size_t first, std::size_t last) {
    std::size_t before = first;
    std::size_t after = 0;
    for (std::size_t i = first; i < last; ++i) {
      if (isBefore_[order[i]] != 0) {
        order[before++] = order[i];
      } else {
        aside_[after++] = order[i];
      }
    }
    std::copy_n(aside_.begin(), after, order.begin() + static_cast<std::ptrdiff_t>(before));
  }

  std::span<const Box> boxes_;
  std::array<std::vector<std::uint32_t>, 3> sorted_;
  std::vector<float> costAfter_;        // by place in an order
  std::vector<std::uint8_t> isBefore_;  // by side
  std::vector<std::uint32_t> aside_;
};

}  // namespace

Hierarchy::Hierarchy(const Pieces& pieces, std::span<const std::uint32_t> sidesIn, const glm::dvec3& origin,
                     std::span<const float> weights) {
  const std::size_t count = sidesIn.size();
  std::vector<ElementShape> shapes(count);
  std::vector<Box> boxes(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t piece = sidesIn[i] / 2;
    const bool back = sidesIn[i] % 2 == 1;
    ElementShape& shape = shapes[i];
    for (const std::uint32_t corner : pieces.polygons[piece]) {
      shape.corners.emplace_back(pieces.points[corner] - origin);
      boxes[i].add(shape.corners.back());
    }
    if (back) std::reverse(shape.corners.begin(), shape.corners.end());
    shape.area_m2 = static_cast<float>(pieces.area_m2[piece]);
    shape.weight = weights.empty() ? shape.area_m2 : weights[i];
    shape.key = (std::uint64_t{sidesIn[i]} + 1U) << 32U | 1U;
    measure(shape);
    sides.push_back({sidesIn[i], glm::vec3(back ? -pieces.normal[piece] : pieces.normal[piece]), noNode});
  }

  TrunkBuilder builder(boxes);
  const std::vector<TrunkNode> trunk = builder.build();
  const std::vector<std::uint32_t>& order = builder.order();

  placeOfSide.resize(count);
  for (std::uint32_t place = 0; place < count; ++place) placeOfSide[order[place]] = place;
  for (const TrunkNode& node : trunk) {
    places.push_back({static_cast<std::uint32_t>(node.first), static_cast<std::uint32_t>(node.last)});
    const bool isSide = node.firstChild == noNode;
    if (isSide) {
      const std::uint32_t own = order[node.first];
      sides[own].root = addElement(shapes[own], own);
      continue;
    }
    Box box;
    float area = 0.0F;
    float weightSum = 0.0F;
    for (std::size_t s = node.first; s < node.last; ++s) {
      box.add(boxes[order[s]]);
      area += shapes[order[s]].area_m2;
      weightSum += shapes[order[s]].weight;
    }
    firstCorner.push_back(static_cast<std::uint32_t>(corners.size()));
    cornerCount.push_back(2);
    corners.push_back(box.low);
    corners.push_back(box.high);
    key.push_back(mixKey(size()) | std::uint64_t{1} << 63U);
    centre.push_back(0.5F * (box.low + box.high));
    radius_m.push_back(0.5F * glm::length(box.high - box.low));
    area_m2.push_back(area);
    weight.push_back(weightSum);
    firstChild.push_back(node.firstChild);
    treeSide.push_back(noNode);
    split.emplace_back();
    spots.emplace_back();
  }
  trunkSize_ = size();
  spotSides.resize(trunkSize_);
  crossSection_m2.resize(trunkSize_);
  for (NodeIndex node = static_cast<NodeIndex>(trunkSize_); node-- > 0;) {
    if (isCluster(node)) {
      drawClusterSpots(node);
    } else {
      spotSides[node].fill(treeSide[node]);
    }
    for (std::size_t k = 0; k < 6; ++k) {
      const NodeIndex child = firstChild[node];
      crossSection_m2[node][k] = treeSide[node] == noNode
                                     ? crossSection_m2[child][k] + crossSection_m2[child + 1][k]
                                     : area_m2[node] * alongDirection(sides[treeSide[node]].normal, k);
    }
  }
}

// Drawn from the spots of both children by area, at even steps through the list of them.
void Hierarchy::drawClusterSpots(NodeIndex cluster) {
  const NodeIndex first = firstChild[cluster];
  const float step = 1.0F / static_cast<float>(spotsOfNode);
  const float firstShare = area_m2[first] / std::max(area_m2[cluster], 1e-30F);
  const float start = Sequence(key[cluster])(0, 0);
  for (std::size_t s = 0; s < spotsOfNode; ++s) {
    const float place = (static_cast<float>(s) + start) * step;
    const bool fromSecond = place >= firstShare;
    const float within =
        fromSecond ? (place - firstShare) / std::max(1.0F - firstShare, 1e-7F) : place / firstShare;
    const auto spot =
        std::min(static_cast<std::size_t>(within * static_cast<float>(spotsOfNode)), spotsOfNode - 1);
    const NodeIndex child = first + (fromSecond ? 1U : 0U);
    spots[cluster][s] = spots[child][spot];
    spotSides[cluster][s] = spotSides[child][spot];
  }
}

NodeIndex Hierarchy::addElement(const ElementShape& shape, std::uint32_t treeSideIndex) {
  const auto node = static_cast<NodeIndex>(size());
  centre.push_back(shape.centre);
  radius_m.push_back(shape.radius_m);
  area_m2.push_back(shape.area_m2);
  weight.push_back(shape.weight);
  firstChild.push_back(noNode);
  treeSide.push_back(treeSideIndex);
  key.push_back(shape.key);
  firstCorner.push_back(static_cast<std::uint32_t>(corners.size()));
  cornerCount.push_back(static_cast<std::uint32_t>(shape.corners.size()));
  corners.insert(corners.end(), shape.corners.begin(), shape.corners.end());
  split.emplace_back();
  spots.push_back(spotsOn(shape.corners, shape.key));
  return node;
}

ElementShape Hierarchy::shape(NodeIndex element) const {
  const auto own = polygon(element);
  return {{own.begin(), own.end()}, centre[element], radius_m[element],
          area_m2[element],         weight[element], key[element]};
}

NodeIndex Hierarchy::divide(NodeIndex parent, const ElementShape& first, const ElementShape& second,
                            const glm::vec4& plane) {
  const NodeIndex child = addElement(first, treeSide[parent]);
  addElement(second, treeSide[parent]);
  firstChild[parent] = child;
  split[parent] = {plane, child};
  return child;
}

NodeIndex Hierarchy::leafAt(NodeIndex node, const glm::vec3& point) const {
  for (const Split* own = &split[node]; own->firstChild != noNode; own = &split[node])
    node = own->firstChild + own->whichChild(point);
  return node;
}

// A look starts from the leaf that was found last, which may have been divided since.
void Hierarchy::findSpotLeaves() {
  if (spotLeaves.size() == size()) return;  // nothing was divided since
  spotLeaves.reserve(size());
  while (spotLeaves.size() < size()) {
    const auto node = static_cast<NodeIndex>(spotLeaves.size());
    std::array<NodeIndex, spotsOfNode>& leaves = spotLeaves.emplace_back();
    leaves.fill(node);
    if (!isCluster(node)) continue;
    for (std::size_t s = 0; s < spotsOfNode; ++s) leaves[s] = sides[spotSides[node][s]].root;
  }
  constexpr std::size_t together = 1024;
  forEachIndex(size(), together, [&](std::size_t node) {
    if (firstChild[node] == noNode) return;
    for (std::size_t s = 0; s < spotsOfNode; ++s)
      spotLeaves[node][s] = leafAt(spotLeaves[node][s], spots[node][s]);
  });
}

std::size_t Hierarchy::bytes() const {
  return size() * bytesOfNode +
         trunkSize_ * (sizeof(spotSides[0]) + sizeof(crossSection_m2[0]) + sizeof(places[0])) +
         placeOfSide.size() * sizeof(placeOfSide[0]) + corners.size() * sizeof(glm::vec3);
}

Spots spotsOn(std::span<const glm::vec3> polygon, std::uint64_t key) {
  const auto doubleArea = [&](std::size_t i) {
    return glm::length(glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]));
  };
  float total = 0.0F;
  for (std::size_t i = 2; i < polygon.size(); ++i) total += doubleArea(i);
  Spots spots;
  const Sequence sequence(key);
  for (std::uint32_t s = 0; s < spotsOfNode; ++s) {
    float target = sequence(s, 0) * total;
    std::size_t corner = 2;
    float share = doubleArea(2);
    while (corner + 1 < polygon.size() && target >= share) {
      target -= share;
      share = doubleArea(++corner);
    }
    const float a = share > 0.0F ? std::sqrt(std::min(target / share, 1.0F)) : 0.0F;
    const float b = sequence(s, 1) * a;
    spots[s] = polygon[0] + (a - b) * (polygon[corner - 1] - polygon[0]) + b * (polygon[corner] - polygon[0]);
  }
  return spots;
}

Extents extentsOf(std::span<const glm::vec3> polygon, const glm::vec3& normal) {
  Extents extents{};
  float longest = 0.0F;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const glm::vec3 edge = polygon[i] - polygon[j];
    const float length = glm::length(edge);
    if (length > longest * 1.0001F) {  // nearly equal edges: the first, whatever the rounding
      longest = length;
      extents.along = edge / length;
    }
  }
  extents.across = glm::cross(normal, extents.along);
  const auto rangeOn = [&](const glm::vec3& axis) {
    glm::vec2 range(std::numeric_limits<float>::max(), -std::numeric_limits<float>::max());
    for (const glm::vec3& corner : polygon) {
      range[0] = std::min(range[0], glm::dot(corner, axis));
      range[1] = std::max(range[1], glm::dot(corner, axis));
    }
    return range;
  };
  extents.alongRange_m = rangeOn(extents.along);
  extents.acrossRange_m = rangeOn(extents.across);
  return extents;
}

Halves halve(const ElementShape& element, const glm::vec3& normal, Extent cut) {
  const auto& corners = element.corners;
  const Extents extents = extentsOf(corners, normal);
  const bool cutAlong = (extents.along_m() >= extents.across_m()) == (cut == Extent::longer);
  const glm::vec3& axis = cutAlong ? extents.along : extents.across;
  const glm::vec2& range = cutAlong ? extents.alongRange_m : extents.acrossRange_m;
  const float middle = 0.5F * (range[0] + range[1]);

  Halves halves;
  halves.plane = glm::vec4(axis, -middle);
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const float a = glm::dot(corners[j], axis) - middle;
    const float b = glm::dot(corners[i], axis) - middle;
    if (a * b < 0.0F) {
      const glm::vec3 cut = corners[j] + a / (a - b) * (corners[i] - corners[j]);
      halves.first.corners.push_back(cut);
      halves.second.corners.push_back(cut);
    }
    if (b <= 0.0F) halves.first.corners.push_back(corners[i]);
    if (b >= 0.0F) halves.second.corners.push_back(corners[i]);
  }
  measure(halves.first);
  measure(halves.second);
  const float share = areaOf(halves.first.corners) /
                      std::max(areaOf(halves.first.corners) + areaOf(halves.second.corners), 1e-30F);
  halves.first.area_m2 = share * element.area_m2;
  halves.second.area_m2 = element.area_m2 - halves.first.area_m2;
  halves.first.weight = share * element.weight;
  halves.second.weight = element.weight - halves.first.weight;
  // Below 31 divisions the path is kept bit by bit; deeper ones are far below any element's least size.
  halves.first.key = (element.key & 0xffffffff00000000U) | ((element.key << 1U) & 0xffffffffU);
  halves.second.key = halves.first.key | 1U;
  return halves;
}

}  // namespace clerestory
