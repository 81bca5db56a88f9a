// SPDX-License-Identifier: GPL-3.0-or-later
// E = light from portals and emitters + mean of the exitance that cosine rays meet, iterated.
#include "plain.hpp"

#include <chrono>
#include <cmath>
#include <numbers>

#include <geometry/parallel.hpp>
#include <geometry/sampling.hpp>

namespace clerestory {
namespace {

/// Where a cosine ray ends: a leaf, and the share of its light that inner glass on the way lets through.
struct RayEnd {
  NodeIndex leaf = noNode;
  float transmittance = 1.0F;
};

template <int K>
Radiosity<K> unlit(const World& world, Hierarchy tree) {
  Radiosity<K> radiosity{std::move(tree), {}, {}, {}, {}, {}};
  for (const TreeSide& side : radiosity.tree.sides) {
    const Material& material = world.materialOf(side.side / 2);
    const auto number = static_cast<std::uint32_t>(radiosity.reflectance.size());
    radiosity.reflectance.push_back(world.layout.template property<K>(world.reflectanceOf(side.side / 2)));
    radiosity.exitance_lm_m2.push_back(
        world.layout.template light<K>(world.layout.electricColumn(), material.exitance_lm_m2));
    if (world.layout.strength(radiosity.exitance_lm_m2[number]) > 0.0F) radiosity.emitters.push_back(number);
  }
  return radiosity;
}

void divideEvenly(Hierarchy& tree, float elementSize_m) {
  const float largest_m = elementSize_m * std::numbers::sqrt2_v<float> / 2.0F;
  for (NodeIndex node = 0; node < tree.size(); ++node) {  // grows on the way
    if (tree.isCluster(node) || !tree.isLeaf(node) || tree.radius_m[node] <= largest_m) continue;
    const Halves halves = halve(tree.shape(node), tree.normal(node));
    tree.divide(node, halves.first, halves.second, halves.plane);
  }
}

std::vector<NodeIndex> leavesOf(const Hierarchy& tree) {
  std::vector<NodeIndex> leaves;
  for (NodeIndex node = 0; node < tree.size(); ++node) {
    if (!tree.isCluster(node) && tree.isLeaf(node)) leaves.push_back(node);
  }
  return leaves;
}

/// Light from portals and emitters, the mean over points of each leaf; returns the rays it took.
template <int K>
std::uint64_t receiveDirect(const SolvedLight<K>& light, const SolvedLight<K>& emitting, std::int32_t domain,
                            const Hierarchy& tree, const std::vector<NodeIndex>& leaves,
                            const PlainSettings& settings, std::vector<Columns<K>>& direct_lx) {
  std::vector<std::uint32_t> rays(leaves.size(), 0);
  forEachIndex(leaves.size(), 16, [&](std::size_t i) {
    const NodeIndex leaf = leaves[i];
    const glm::vec3& normal = tree.normal(leaf);
    const Sequence sequence(mixKeys(tree.key[leaf], 0xd1));
    for (std::uint32_t k = 0; k < settings.directPoints; ++k) {
      const glm::vec3 onLeaf =
          settings.directPoints == 1
              ? tree.centre[leaf]
              : pointOnPolygon<glm::vec3>(tree.polygon(leaf), sequence(k, 0), sequence(k, 1));
      const glm::vec3 point = onLeaf + rayOffset_m * normal;
      const std::uint64_t key = mixKeys(tree.key[leaf], k);
      const DirectLight<K> entering = directFromPortals(light, domain, point, normal, settings.direct, key);
      const DirectLight<K> own = directFromEmitters(emitting, domain, point, normal, settings.direct, key);
      direct_lx[leaf] +=
          (1.0F / static_cast<float>(settings.directPoints)) * (entering.illuminance_lx + own.illuminance_lx);
      rays[i] += entering.rays + own.rays;
    }
  });
  std::uint64_t sum = 0;
  for (const std::uint32_t own : rays) sum += own;
  return sum;
}

std::vector<RayEnd> traceRays(const World& world, const Hierarchy& tree, const std::vector<NodeIndex>& leaves,
                              std::uint32_t raysPerElement) {
  std::vector<NodeIndex> rootOfSide(2 * world.pieces().size(), noNode);
  for (const TreeSide& side : tree.sides) rootOfSide[side.side] = side.root;
  std::vector<RayEnd> ends(leaves.size() * raysPerElement);
  forEachIndex(leaves.size(), 16, [&](std::size_t i) {
    const glm::vec3& normal = tree.normal(leaves[i]);
    const auto polygon = tree.polygon(leaves[i]);
    const Sequence sequence(mixKeys(tree.key[leaves[i]], 0x4a));
    for (std::uint32_t ray = 0; ray < raysPerElement; ++ray) {
      const glm::vec3 from =
          pointOnPolygon<glm::vec3>(polygon, sequence(ray, 0), sequence(ray, 1)) + rayOffset_m * normal;
      const glm::vec3 direction = cosineDirection(normal, sequence(ray, 2), sequence(ray, 3));
      const auto hit = world.rays.nearest(from, direction, RayScene::Barrier::opaqueAndGlass);
      if (!hit || rootOfSide[hit.side()] == noNode) continue;
      const glm::vec3 to = from + hit.distance_m * direction;
      ends[i * raysPerElement + ray] = {tree.leafAt(rootOfSide[hit.side()], to),
                                        world.innerTransmittance(from, to)};
    }
  });
  return ends;
}

/// Jacobi iterations on all reflected light, until the area's mean no longer changes.
template <int K>
void iterate(const World& world, Radiosity<K>& radiosity, const std::vector<NodeIndex>& leaves,
             const std::vector<Columns<K>>& direct_lx, const std::vector<RayEnd>& ends,
             const PlainSettings& settings, const AfterIteration<K>& afterIteration) {
  constexpr int iterationsMax = 2000;
  const Hierarchy& tree = radiosity.tree;
  radiosity.irradiance_lx = direct_lx;
  std::vector<Columns<K>> reflected_lm_m2(tree.size());
  for (int iteration = 0; iteration < iterationsMax; ++iteration) {
    if (afterIteration) afterIteration(iteration, radiosity);
    double before = 0.0;
    for (const NodeIndex leaf : leaves) {
      reflected_lm_m2[leaf] = radiosity.reflected(leaf);
      before +=
          static_cast<double>(tree.area_m2[leaf] * world.layout.strength(radiosity.irradiance_lx[leaf]));
    }
    forEachIndex(leaves.size(), 64, [&](std::size_t i) {
      // Rays that end on sides without air are left out: shooting too keeps all light in the domain.
      Columns<K> sum;
      float count = 0.0F;
      for (std::size_t ray = i * settings.raysPerElement; ray < (i + 1) * settings.raysPerElement; ++ray) {
        if (ends[ray].leaf == noNode) continue;
        sum += ends[ray].transmittance * reflected_lm_m2[ends[ray].leaf];
        count += 1.0F;
      }
      radiosity.irradiance_lx[leaves[i]] = direct_lx[leaves[i]];
      if (count > 0.0F) radiosity.irradiance_lx[leaves[i]] += (1.0F / count) * sum;
    });
    double after = 0.0;
    for (const NodeIndex leaf : leaves) {
      after += static_cast<double>(tree.area_m2[leaf] * world.layout.strength(radiosity.irradiance_lx[leaf]));
    }
    if (std::abs(after - before) <= settings.endShare * after) return;
  }
}

}  // namespace

template <int K>
PlainSolution<K> plainRadiosity(const SolvedLight<K>& light, std::int32_t domain, Hierarchy tree,
                                const PlainSettings& settings, const AfterIteration<K>& after) {
  using Clock = std::chrono::steady_clock;
  const World& world = light.world();
  PlainSolution<K> result{unlit<K>(world, std::move(tree))};
  Radiosity<K>& radiosity = result.radiosity;
  SolvedLight<K> emitting(world);  // emitters are whole sides: the undivided tree serves
  if (!radiosity.emitters.empty()) emitting.add(domain, radiosity);
  divideEvenly(radiosity.tree, settings.elementSize_m);
  const std::vector<NodeIndex> leaves = leavesOf(radiosity.tree);

  const auto start = Clock::now();
  std::vector<Columns<K>> direct_lx(radiosity.tree.size());
  result.rays = receiveDirect(light, emitting, domain, radiosity.tree, leaves, settings, direct_lx);
  result.directSeconds = std::chrono::duration<double>(Clock::now() - start).count();

  const std::vector<RayEnd> ends = traceRays(world, radiosity.tree, leaves, settings.raysPerElement);
  iterate(world, radiosity, leaves, direct_lx, ends, settings, after);

  result.elements = leaves.size();
  result.rays += ends.size();
  std::uint64_t leaked = 0;
  for (const RayEnd& end : ends) leaked += end.leaf == noNode ? 1U : 0U;
  result.leakedShare =
      static_cast<double>(leaked) / static_cast<double>(std::max<std::size_t>(ends.size(), 1));
  return result;
}

#define CLERESTORY_INSTANTIATE(K)                                                             \
  template PlainSolution<K> plainRadiosity<K>(const SolvedLight<K>&, std::int32_t, Hierarchy, \
                                              const PlainSettings&, const AfterIteration<K>&);
CLERESTORY_STUDY_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
