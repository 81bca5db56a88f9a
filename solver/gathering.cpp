// SPDX-License-Identifier: GPL-3.0-or-later
// Jacobi steps that gather all light anew by stored links (Stamminger et al., sections 2.4 and 4.2).
#include "gathering.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace clerestory {

template <int K>
SolvedDomain<K> gatheringHR(const SolvedLight<K>& light, std::int32_t domain, Hierarchy treeIn,
                            const TransportSettings& settings) {
  const World& world = light.world();
  SolvedDomain<K> solved(world, domain, std::move(treeIn), settings);
  const Hierarchy& tree = solved.radiosity.tree;
  LinkCache links(std::numeric_limits<std::uint32_t>::max() * sizeof(CachedLink));
  Transport<K> transport(light, domain, solved.radiosity, settings, links, Links::stored);

  std::vector<Columns<K>> sent = solved.emission();
  const Columns<K> emitted_lm = transport.powerOf(sent);
  const Columns<K> entering_lm = transport.enteringPower_lm();
  const float first_lm = world.layout.strength(emitted_lm) + world.layout.strength(entering_lm);
  if (!(first_lm > 0.0F)) return solved;
  transport.setFirstLight(first_lm);
  solved.threshold_lm = transport.threshold_lm();

  // Light from outside is emission's like: it arrives once, and every step adds it again.
  std::vector<Columns<K>>& irradiance_lx = solved.radiosity.irradiance_lx;
  std::vector<Columns<K>> entered_lx;
  const Stopwatch firstWatch;
  const double firstPower_lm = solved.firstPower_lm();
  const std::size_t nodesAtFirst = tree.size();
  transport.send(std::vector<Columns<K>>(tree.size()), true);
  solved.inheritSunlight(nodesAtFirst);
  solved.balance.emitted_lm =
      firstPower_lm +
      luminanceOf(world.layout.totalColour(transport.lampPower_lm() + transport.enteredPower_lm()));
  for (const Received<K>& received : transport.received()) entered_lx.push_back(received.irradiance_lx);
  transport.handOverLinks(1.0F);
  solved.addStatistics(transport.tally(), 0, world.layout.strength(entering_lm), firstWatch.seconds());
  irradiance_lx = entered_lx;

  float before_lm = 0.0F;
  for (int step = 1; step <= settings.stepsMax; ++step) {
    const Stopwatch watch;
    sent = solved.emission();
    for (NodeIndex node = 0; node < tree.size(); ++node) {
      if (tree.isLeaf(node)) sent[node] += solved.reflected(node, irradiance_lx[node]);
    }
    const std::size_t nodesBefore = tree.size();
    const std::size_t stored = links.size();
    transport.send(sent, false);
    transport.handOverLinks(1.0F);
    inheritValues(tree, nodesBefore, entered_lx);
    solved.inheritSunlight(nodesBefore);
    irradiance_lx.resize(tree.size());
    for (NodeIndex node = 0; node < tree.size(); ++node)
      irradiance_lx[node] = entered_lx[node] + transport.received()[node].irradiance_lx;
    const float power_lm = world.layout.strength(transport.powerOf(irradiance_lx));
    solved.addStatistics(transport.tally(), stored, std::abs(power_lm - before_lm), watch.seconds());
    if (std::abs(power_lm - before_lm) <= static_cast<float>(settings.endShare) * power_lm) break;
    before_lm = power_lm;
  }
  solved.balance.unscaledDefect = transport.unscaledDefect();
  solved.closeBalance();
  solved.diagnoses = transport.diagnoses;
  return solved;
}

#define CLERESTORY_INSTANTIATE(K)                                                      \
  template SolvedDomain<K> gatheringHR(const SolvedLight<K>&, std::int32_t, Hierarchy, \
                                       const TransportSettings&);
CLERESTORY_STUDY_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
