// SPDX-License-Identifier: GPL-3.0-or-later
// SHOOTING-HR: each step sends what is unshot, and ends with the root's self link (Stamminger et al.,
// section 3.1).
//
// Legend, as in the paper: sum is what was received so far (irradiance here, where the paper sums radiosity),
// unshot is the radiosity that has not been sent yet, next is what a step has brought.
#include "shooting.hpp"

#include <algorithm>
#include <array>

namespace clerestory {
namespace {

constexpr float stepsTogether = 6.0F;  // that may err by a whole threshold each
constexpr float fadeLeast = 0.01F;     // of a step against the one before, for what is asked of interactions

// The last interaction is the root's self link: the rest of the series in closed form, E = M / (1 -
// reflectance) with M the mean unshot exitance; in an open domain only the share that does not escape comes
// back each time.
template <int K>
Columns<K> evenRest(const Domain& domain, const Columns<K>& unshotPower_lm, const SolvedDomain<K>& solved) {
  const auto stays =
      static_cast<float>(1.0 - (domain.open ? domain.escape_m2 / std::max(domain.area_m2, 1e-9) : 0.0));
  const Columns<K> mean = (1.0F / solved.radiosity.tree.area_m2[0]) * unshotPower_lm;
  const Columns<K> reflectance = solved.meanReflectance();
  Columns<K> rest;
  for (int c = 0; c < K; ++c) rest[c] = stays * mean[c] / std::max(1.0F - stays * reflectance[c], 1e-6F);
  return rest;
}

// An even rest would light a room behind a door like the one before it. In a closed domain it is spread as
// the last step's light was, in such strength that all that is unshot is absorbed.
template <int K>
void finishWithRootLink(const Domain& domain, const Columns<K>& unshotPower_lm,
                        const std::vector<Received<K>>& last, SolvedDomain<K>& solved) {
  const Hierarchy& tree = solved.radiosity.tree;
  const Columns<K> even = evenRest(domain, unshotPower_lm, solved);
  // What has come from outside in the only step has a pattern of its own.
  const bool hasPattern = !domain.open && solved.statistics.size() > 1;
  std::array<double, K> absorbed_lm{};
  for (NodeIndex node = 0; hasPattern && node < tree.size(); ++node) {
    if (!tree.isLeaf(node)) continue;
    const Columns<K> absorbed = last[node].irradiance_lx - solved.reflected(node, last[node].irradiance_lx);
    for (int c = 0; c < K; ++c)
      absorbed_lm[static_cast<std::size_t>(c)] += static_cast<double>(tree.area_m2[node] * absorbed[c]);
  }
  for (NodeIndex node = 0; node < tree.size(); ++node) {
    if (!tree.isLeaf(node)) continue;
    for (int c = 0; c < K; ++c) {
      const auto whole_lm = static_cast<float>(absorbed_lm[static_cast<std::size_t>(c)]);
      solved.radiosity.irradiance_lx[node][c] +=
          whole_lm > 0.0F ? unshotPower_lm[c] / whole_lm * last[node].irradiance_lx[c] : even[c];
    }
  }
  Tally tally;
  tally.links = 1;
  solved.addStatistics(tally, 0, 0.0F, 0.0);
}

/// Light on leaves by what errors on them count.
template <int K>
double weighted(const ColumnLayout& layout, const Hierarchy& tree, const std::vector<Columns<K>>& light) {
  double sum = 0.0;
  for (NodeIndex node = 0; node < tree.size(); ++node) {
    if (tree.isLeaf(node)) sum += static_cast<double>(tree.weight[node] * layout.strength(light[node]));
  }
  return sum;
}

}  // namespace

template <int K>
SolvedDomain<K> shootingHR(const SolvedLight<K>& light, std::int32_t domain, Hierarchy treeIn,
                           const TransportSettings& settings, LinkCache& cache) {
  const World& world = light.world();
  SolvedDomain<K> solved(world, domain, std::move(treeIn), settings);
  const Hierarchy& tree = solved.radiosity.tree;
  const bool isOpen = world.building.domains[static_cast<std::size_t>(domain)].open;
  Transport<K> transport(light, domain, solved.radiosity, settings, cache, Links::madeAnew);

  // Line 2 of the listing: what is unshot at first is the emission, and sunlight as it is reflected where it
  // falls. (Its line 1 should read B <- E; here the
  // sum holds irradiance, and emission is added where exitance is asked for.)
  std::vector<Columns<K>>& sum = solved.radiosity.irradiance_lx;
  std::vector<Columns<K>> unshot = solved.emission();
  Columns<K> unshotPower_lm = transport.powerOf(unshot);
  const Columns<K> entering_lm = transport.enteringPower_lm();
  float before_lm = world.layout.strength(unshotPower_lm) + world.layout.strength(entering_lm);
  const double first_lm = solved.firstPower_lm();
  if (!(before_lm > 0.0F)) return solved;
  transport.setFirstLight(before_lm);
  solved.threshold_lm = transport.threshold_lm();

  for (int step = 1; step <= settings.stepsMax; ++step) {
    const Stopwatch watch;
    const std::size_t nodesBefore = tree.size();
    const std::size_t cached = cache.size();
    transport.send(unshot, step == 1);
    if (step == 1)
      solved.balance.emitted_lm =
          first_lm +
          luminanceOf(world.layout.totalColour(transport.lampPower_lm() + transport.enteredPower_lm()));
    inheritValues(tree, nodesBefore, sum);
    solved.inheritSunlight(nodesBefore);
    unshot.resize(tree.size());
    for (NodeIndex node = 0; node < tree.size(); ++node) {
      if (!tree.isLeaf(node)) continue;
      const Columns<K>& next = transport.received()[node].irradiance_lx;
      sum[node] += next;
      unshot[node] = step == 1 ? solved.sentOn(node, next) : solved.reflected(node, next);
      if (step > 1) continue;
      // What was mirrored is its receivers' already, among what entered.
      const Columns<K> mirrored = solved.reflected(node, next) - unshot[node];
      solved.balance.emitted_lm -=
          static_cast<double>(tree.area_m2[node]) * luminanceOf(world.layout.totalColour(mirrored));
    }
    unshotPower_lm = transport.powerOf(unshot);
    const float after_lm = world.layout.strength(unshotPower_lm);
    const float share = std::min(after_lm / before_lm, 1.0F);
    transport.handOverLinks(share);
    // Each of the 1 / (1 - share) steps to come errs like the next one. Where a room is bright they are many,
    // and what they err by together is much beside the little that is absorbed.
    transport.setThreshold(solved.threshold_lm *
                           std::min(1.0F, stepsTogether * std::max(1.0F - share, fadeLeast)));
    before_lm = std::max(after_lm, 1e-30F);
    solved.addStatistics(transport.tally(), cached, after_lm, watch.seconds());

    const bool isRootLinkAlone = transport.tally().links <= 1;
    const float sum_lm = world.layout.strength(transport.powerOf(sum));
    bool isLittle = after_lm <= static_cast<float>(settings.endShare) * sum_lm;
    // What is looked at outdoors may lie deep in a gap, whose light is little beside all that there is.
    if (isOpen && isLittle)
      isLittle =
          weighted(world.layout, tree, unshot) <= settings.endShare * weighted(world.layout, tree, sum);
    if (isRootLinkAlone || isLittle) break;
  }
  finishWithRootLink(world.building.domains[static_cast<std::size_t>(domain)], unshotPower_lm,
                     transport.received(), solved);
  cache.replace({}, 0, 1.0F);
  solved.balance.unscaledDefect = transport.unscaledDefect();
  solved.closeBalance();
  solved.diagnoses = transport.diagnoses;
  return solved;
}

#define CLERESTORY_INSTANTIATE(K)                                                     \
  template SolvedDomain<K> shootingHR(const SolvedLight<K>&, std::int32_t, Hierarchy, \
                                      const TransportSettings&, LinkCache&);
CLERESTORY_TRANSPORT_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
