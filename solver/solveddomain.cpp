// SPDX-License-Identifier: GPL-3.0-or-later
// Sets a domain up for its solve, and sums up afterwards.
#include "solveddomain.hpp"

#include <algorithm>

namespace clerestory {

template <int K>
SolvedDomain<K>::SolvedDomain(const World& world, std::int32_t domainIn, Hierarchy tree,
                              const TransportSettings& settings)
    : domain(domainIn), radiosity{std::move(tree), {}, {}, {}, {}, {}, {}}, world_(world) {
  radiosity.sunlight = sunlightOn(world, domain, radiosity.tree, settings.epsilon, settings.elementMin_m,
                                  settings.memoryBytes);
  radiosity.irradiance_lx.resize(radiosity.tree.size());
  for (const TreeSide& side : radiosity.tree.sides) {
    const Material& material = world.materialOf(side.side / 2);
    radiosity.reflectance.push_back(world.layout.template property<K>(world.reflectanceOf(side.side / 2)));
    radiosity.exitance_lm_m2.push_back(
        world.layout.template light<K>(world.layout.electricColumn(), material.exitance_lm_m2));
    if (world.layout.strength(radiosity.exitance_lm_m2.back()) > 0.0F) {
      radiosity.emitters.push_back(static_cast<std::uint32_t>(radiosity.exitance_lm_m2.size() - 1));
    }
  }
  mirrorsPatches_.resize(radiosity.tree.sides.size());
  const bool isOpen = world.building.domains[static_cast<std::size_t>(domain)].open;
  for (std::size_t i = 0; i < mirrorsPatches_.size() && world.sun && !isOpen; ++i) {
    const std::uint32_t piece = radiosity.tree.sides[i].side / 2;
    const bool isPortal = std::ranges::any_of(world.building.portals, [&](const Portal& portal) {
      return portal.piece == piece && portal.inside == domain;
    });
    mirrorsPatches_[i] = world.isMirror(piece) && isPortal ? 1 : 0;
  }
  balance.domain = domain;
}

template <int K>
std::vector<Columns<K>> SolvedDomain<K>::emission() const {
  const Hierarchy& tree = radiosity.tree;
  std::vector<Columns<K>> emission(tree.size());
  for (NodeIndex node = 0; node < tree.size(); ++node) {
    if (tree.isCluster(node)) continue;
    const std::uint32_t side = tree.treeSide[node];
    emission[node] = radiosity.exitance_lm_m2[side];
    if (!isMirror(node))
      emission[node] += radiosity.reflectance[side] * radiosity.sunlightOf(world_.layout, node);
  }
  return emission;
}

template <int K>
bool SolvedDomain<K>::isMirror(NodeIndex leaf) const {
  const Hierarchy& tree = radiosity.tree;
  return world_.building.domains[static_cast<std::size_t>(domain)].open &&
         world_.isMirror(tree.sides[tree.treeSide[leaf]].side / 2);
}

template <int K>
Columns<K> SolvedDomain<K>::sentOn(NodeIndex leaf, const Columns<K>& irradiance_lx) const {
  if (isMirror(leaf)) return {};
  const Columns<K> all = reflected(leaf, irradiance_lx);
  if (mirrorsPatches_[radiosity.tree.treeSide[leaf]] == 0) return all;
  const int sun = world_.layout.sunColumn();
  return all - world_.layout.template light<K>(sun, world_.layout.colourOf(all, sun));
}

template <int K>
double SolvedDomain<K>::firstPower_lm() const {
  const Hierarchy& tree = radiosity.tree;
  double power_lm = 0.0;
  for (NodeIndex node = 0; node < tree.size(); ++node) {
    if (!tree.isLeaf(node) || tree.isCluster(node)) continue;
    const Columns<K> light =
        radiosity.exitance_lm_m2[tree.treeSide[node]] + radiosity.sunlightOf(world_.layout, node);
    power_lm += static_cast<double>(tree.area_m2[node]) * luminanceOf(world_.layout.totalColour(light));
  }
  return power_lm;
}

template <int K>
void SolvedDomain<K>::inheritSunlight(std::size_t before) {
  if (radiosity.sunlight.empty()) return;
  inheritValues(radiosity.tree, before, radiosity.sunlight.illuminance_lx);
  inheritValues(radiosity.tree, before, radiosity.sunlight.mayReach);
}

template <int K>
Columns<K> SolvedDomain<K>::meanReflected_lm_m2() const {
  const Hierarchy& tree = radiosity.tree;
  Columns<K> sum_lm;
  float area_m2 = 0.0F;
  for (NodeIndex node = 0; node < tree.size(); ++node) {
    if (tree.isCluster(node) || !tree.isLeaf(node)) continue;
    sum_lm += tree.area_m2[node] * reflected(node, radiosity.irradiance_lx[node]);
    area_m2 += tree.area_m2[node];
  }
  return (1.0F / area_m2) * sum_lm;
}

template <int K>
Columns<K> SolvedDomain<K>::meanReflectance() const {
  Columns<K> sum;
  float area_m2 = 0.0F;
  for (std::size_t side = 0; side < radiosity.tree.sides.size(); ++side) {
    const float own_m2 = radiosity.tree.area_m2[radiosity.tree.sides[side].root];
    sum += own_m2 * radiosity.reflectance[side];
    area_m2 += own_m2;
  }
  return (1.0F / area_m2) * sum;
}

template <int K>
void SolvedDomain<K>::addStatistics(const Tally& tally, std::size_t cached, float unshotPower_lm,
                                    double seconds) {
  IterationStatistics row;
  row.domain = domain;
  row.iteration = static_cast<int>(statistics.size()) + 1;
  row.linksRequired = tally.links;
  row.linksCached = cached;
  row.linksReused = tally.reused;
  row.visibilityTests = tally.rays;
  row.unshotPower_lm = static_cast<double>(unshotPower_lm);
  row.seconds = seconds;
  for (NodeIndex node = 0; node < radiosity.tree.size(); ++node)
    row.elements += radiosity.tree.isLeaf(node) ? 1U : 0U;
  statistics.push_back(row);
}

template <int K>
void SolvedDomain<K>::closeBalance() {
  const Hierarchy& tree = radiosity.tree;
  for (NodeIndex node = 0; node < tree.size(); ++node) {
    if (!tree.isLeaf(node)) continue;
    const Columns<K> irradiance_lx =
        radiosity.irradiance_lx[node] + radiosity.sunlightOf(world_.layout, node);
    const Columns<K> absorbed = irradiance_lx - reflected(node, irradiance_lx);
    const double power_lm =
        static_cast<double>(tree.area_m2[node]) * luminanceOf(world_.layout.totalColour(absorbed));
    const bool isGlass = world_.materialOf(tree.sides[tree.treeSide[node]].side / 2).glazing;
    (isGlass ? balance.escaped_lm : balance.absorbed_lm) += power_lm;
  }
}

#define CLERESTORY_INSTANTIATE(K) template struct SolvedDomain<K>;
CLERESTORY_TRANSPORT_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
