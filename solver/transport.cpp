// SPDX-License-Identifier: GPL-3.0-or-later
// SHOOTING-HR: transport from the root's self link, push-pull, Jacobi update (Stamminger et al.,
// section 3.1).
#include "transport.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include <geometry/parallel.hpp>
#include <geometry/sampling.hpp>

namespace clerestory {
template <int K>
Shooting<K>::Shooting(const SolvedLight<K>& light, std::int32_t domain, Hierarchy tree,
                      const TransportSettings& settings, LinkCache& cache)
    : world_(light.world()),
      domain_(domain),
      isOpen_(world_.building.domains[static_cast<std::size_t>(domain)].open),
      settings_(settings),
      cache_(cache),
      radiosity_{std::move(tree), {}, {}, {}, {}},
      tree_(radiosity_.tree),
      sum_(radiosity_.irradiance_lx),
      interactions_(light, domain, tree_, unshot_, settings_) {
  for (const TreeSide& side : tree_.sides) {
    const Material& material = world_.materialOf(side.side / 2);
    radiosity_.reflectance.push_back(world_.layout.template property<K>(world_.reflectanceOf(side.side / 2)));
    radiosity_.exitance_lm_m2.push_back(
        world_.layout.template light<K>(world_.layout.electricColumn(), material.exitance_lm_m2));
    if (world_.layout.strength(radiosity_.exitance_lm_m2.back()) > 0.0F) {
      radiosity_.emitters.push_back(static_cast<std::uint32_t>(radiosity_.exitance_lm_m2.size() - 1));
    }
  }
  sum_.resize(tree_.size());
  next_.resize(tree_.size());
  unshot_.resize(tree_.size());
  unshot_.byDirection_lm.resize(tree_.trunkSize());
  nextByDirection_.resize(tree_.trunkSize());
  work_.resize(tree_.trunkSize());
  balance.domain = domain;
  lightEnters_ = world_.layout.sky &&
                 (isOpen_ || std::any_of(world_.building.portals.begin(), world_.building.portals.end(),
                                         [&](const Portal& portal) { return portal.inside == domain; }));
}

template <int K>
void Shooting<K>::run() {
  using Clock = std::chrono::steady_clock;
  // Line 2 of the paper's listing: what is unshot at first is the emission. (Its line 1 should read B <- E;
  // here the sum holds irradiance, and emission is added where exitance is asked for.)
  for (NodeIndex node = 0; node < tree_.size(); ++node) {
    if (!tree_.isCluster(node) && tree_.isLeaf(node))
      unshot_.radiosity_lm_m2[node] = radiosity_.exitance_lm_m2[tree_.treeSide[node]];
  }
  pullUnshot();

  const Columns<K> emitted = powerOf(unshot_.radiosity_lm_m2);
  const Columns<K> entering = isOpen_ ? Columns<K>{} : interactions_.portalFlux();
  float firstLight = world_.layout.strength(emitted) + world_.layout.strength(entering);
  if (isOpen_)
    firstLight += 0.5F * static_cast<float>(world_.sky.horizontalIlluminance_lx()) * tree_.area_m2[0];
  interactions_.threshold_lm =
      settings_.epsilon * firstLight * std::max(tree_.weight[0], 1e-20F) / tree_.area_m2[0];
  balance.emitted_lm = luminanceOf(world_.layout.totalColour(emitted + entering));
  if (!(firstLight > 0.0F)) return;

  Columns<K> shot = emitted + entering;
  for (int step = 1; step <= settings_.stepsMax; ++step) {
    const auto start = Clock::now();
    transportLight();
    mergeGrown();
    pushPull();
    addDefect(shot);
    closeViews();
    if (!isOpen_ && !world_.rays.hasInnerGlass()) scaleToShotPower(shot);
    for (NodeIndex node = 0; node < tree_.size(); ++node) {
      if (!tree_.isLeaf(node)) continue;
      sum_[node] += next_[node].irradiance_lx;
      unshot_.radiosity_lm_m2[node] =
          radiosity_.reflectance[tree_.treeSide[node]] * next_[node].irradiance_lx;
    }
    pullUnshot();
    const Columns<K> before = shot;
    shot = powerOf(unshot_.radiosity_lm_m2);
    closeStatistics(step, std::chrono::duration<double>(Clock::now() - start).count());

    std::vector<CachedLink> kept;
    std::vector<std::uint64_t> powers(LinkCache::powerClasses, 0);
    for (Work& work : work_) {
      kept.insert(kept.end(), work.kept.begin(), work.kept.end());
      for (std::size_t i = 0; i < work.powers.size(); ++i) powers[i] += work.powers[i];
    }
    const float fade = world_.layout.strength(shot) / std::max(world_.layout.strength(before), 1e-30F);
    cache_.replace(std::move(kept), powers, std::min(fade, 1.0F));
    firstStep_ = false;

    const float unshotMean = world_.layout.strength(shot);
    const float sumMean = world_.layout.strength(powerOf(sum_));
    if (unshotMean <= static_cast<float>(settings_.endShare) * sumMean) break;
  }
  finishWithRootLink();
  cache_.replace({}, std::vector<std::uint64_t>(LinkCache::powerClasses, 0), 1.0F);

  for (NodeIndex node = 0; node < tree_.size(); ++node) {
    if (!tree_.isLeaf(node)) continue;
    const std::uint32_t side = tree_.treeSide[node];
    Columns<K> absorbed = sum_[node];
    absorbed = absorbed - radiosity_.reflectance[side] * sum_[node];
    const double power =
        static_cast<double>(tree_.area_m2[node]) * luminanceOf(world_.layout.totalColour(absorbed));
    const bool isGlass = world_.materialOf(tree_.sides[side].side / 2).glazing;
    (isGlass ? balance.escaped_lm : balance.absorbed_lm) += power;
  }
}

template <int K>
void Shooting<K>::transportLight() {
  for (Work& work : work_) work = {};
  std::fill(next_.begin(), next_.end(), Received<K>{});
  std::fill(nextByDirection_.begin(), nextByDirection_.end(), SixReceived<K>{});
  std::vector<NodeIndex> senders{0};
  if (firstStep_ && lightEnters_) {
    senders.push_back(isOpen_ ? Interactions<K>::openSky : Interactions<K>::portals);
  }
  if (tree_.isCluster(0)) {
    receiveCluster(0, std::move(senders));
  } else {
    receiveElement({tree_.shape(0), 0, noNode, tree_.treeSide[0]}, std::move(senders), work_[0]);
  }
}

// The paper's TRANSPORT-LIGHT(p, q), turned about the receiver: all senders that the levels above have left
// to p are settled at p or handed on to p's children, so a task writes to its own receiver alone and needs no
// lock.
template <int K>
void Shooting<K>::receiveCluster(NodeIndex receiver, std::vector<NodeIndex> senders) {
  Work& work = work_[receiver];
  std::vector<NodeIndex> down;
  SixReceived<K>& next = nextByDirection_[receiver];
  while (!senders.empty()) {
    const NodeIndex sender = senders.back();
    senders.pop_back();
    if (sender == Interactions<K>::portals || sender == Interactions<K>::openSky) {
      down.push_back(sender);
      continue;
    }
    Link link;
    switch (interactions_.oracleForCluster(receiver, sender, link, work.tally)) {
      case Verdict::nothing:
        break;
      case Verdict::accept:
        ++work.tally.links;
        interactions_.addToCluster(next, receiver, sender, link);
        break;
      case Verdict::refineSender:
        senders.push_back(tree_.firstChild[sender] + 1);
        senders.push_back(tree_.firstChild[sender]);
        break;
      case Verdict::refineReceiver:
        down.push_back(sender);
        break;
    }
  }
  if (down.empty()) return;
  std::reverse(down.begin(), down.end());
  const NodeIndex first = tree_.firstChild[receiver];
  const auto descend = [&](NodeIndex child) {
    if (tree_.isCluster(child)) {
      receiveCluster(child, down);
    } else {
      receiveElement({tree_.shape(child), child, noNode, tree_.treeSide[child]}, down, work_[child]);
    }
  };
  inParallel([&] { descend(first); }, [&] { descend(first + 1); });
}

template <int K>
void Shooting<K>::receiveElement(const Element& receiver, std::vector<NodeIndex> senders, Work& work) {
  const auto cached =
      receiver.node != noNode ? cache_.ofReceiver(receiver.node) : std::span<const CachedLink>();
  std::vector<NodeIndex> down;
  Received<K> next;
  while (!senders.empty()) {
    const NodeIndex sender = senders.back();
    senders.pop_back();
    const bool fromOutside = sender == Interactions<K>::portals || sender == Interactions<K>::openSky;
    Link link;
    const Verdict verdict =
        fromOutside ? interactions_.receiveFromOutside(receiver, sender, next.irradiance_lx, work.tally)
                    : interactions_.oracleForElement(receiver, sender, cached, link, work.tally);
    switch (verdict) {
      case Verdict::nothing:
        break;
      case Verdict::accept:
        ++work.tally.links;
        if (fromOutside) break;
        interactions_.addToElement(next, receiver, sender, link);
        keep(receiver, sender, link, work);
        break;
      case Verdict::refineSender:
        senders.push_back(tree_.firstChild[sender] + 1);
        senders.push_back(tree_.firstChild[sender]);
        break;
      case Verdict::refineReceiver:
        down.push_back(sender);
        break;
    }
  }
  if (receiver.node != noNode) {
    next_[receiver.node] = next;
  } else {
    work.grown[receiver.grown / 2].next[receiver.grown % 2] = next;
  }
  if (down.empty()) return;
  std::reverse(down.begin(), down.end());
  receiveChildren(receiver, std::move(down), work);
}

template <int K>
void Shooting<K>::receiveChildren(const Element& receiver, std::vector<NodeIndex> senders, Work& work) {
  if (receiver.node != noNode && !tree_.isLeaf(receiver.node)) {
    const NodeIndex first = tree_.firstChild[receiver.node];
    receiveElement({tree_.shape(first), first, noNode, receiver.treeSide}, senders, work);
    receiveElement({tree_.shape(first + 1), first + 1, noNode, receiver.treeSide}, std::move(senders), work);
    return;
  }
  const auto number = static_cast<std::uint32_t>(work.grown.size());
  const bool parentIsGrown = receiver.node == noNode;
  Halves halves = halve(receiver.shape, tree_.sides[receiver.treeSide].normal);
  const Element first{halves.first, noNode, 2 * number, receiver.treeSide};
  const Element second{halves.second, noNode, 2 * number + 1, receiver.treeSide};
  work.grown.push_back(
      {parentIsGrown, parentIsGrown ? receiver.grown : receiver.node, std::move(halves), {}});
  receiveElement(first, senders, work);
  receiveElement(second, std::move(senders), work);
}

template <int K>
void Shooting<K>::keep(const Element& receiver, NodeIndex sender, const Link& link, Work& work) {
  const float power = unshot_.strength[sender] * link.formFactor * receiver.shape.weight;
  work.powers.resize(LinkCache::powerClasses);
  ++work.powers[LinkCache::powerClass(power)];
  if (!cache_.wants(power) || !cache_.reserve()) return;
  if (receiver.node != noNode) {
    work.kept.push_back({receiver.node, sender, link});
  } else {
    work.keptByGrown.push_back({receiver.grown, {0, sender, link}});
  }
}

template <int K>
void Shooting<K>::mergeGrown() {
  const NodeIndex before = static_cast<NodeIndex>(tree_.size());
  for (Work& work : work_) {
    std::vector<NodeIndex> first(work.grown.size());
    for (std::size_t i = 0; i < work.grown.size(); ++i) {
      const Grown& grown = work.grown[i];
      const NodeIndex parent = grown.parentIsGrown ? first[grown.parent / 2] + grown.parent % 2
                                                   : static_cast<NodeIndex>(grown.parent);
      first[i] = tree_.divide(parent, grown.halves.first, grown.halves.second, grown.halves.plane);
      for (int child = 0; child < 2; ++child) {
        next_.push_back(grown.next[child]);
        sum_.push_back(sum_[parent]);
        unshot_.radiosity_lm_m2.push_back(unshot_.radiosity_lm_m2[parent]);
      }
    }
    for (auto& [grown, cached] : work.keptByGrown) {
      cached.receiver = first[grown / 2] + grown % 2;
      work.kept.push_back(cached);
    }
    work.grown.clear();
  }
  if (tree_.size() == before) return;
  unshot_.resize(tree_.size());
  const std::size_t valueBytes = tree_.size() * (3 * sizeof(Columns<K>) + 3 * sizeof(float));
  if (interactions_.mayGrow && tree_.bytes() + valueBytes > settings_.memoryBytes) {
    interactions_.mayGrow = false;
    diagnoses.push_back(
        {"S301",
         "the memory allowed is used up: no further elements are made, the solution is complete at "
         "the accuracy reached; allow more with --memory",
         ""});
  }
}

// PUSH-PULL of the paper on what this step received: irradiance goes down to the leaves.
template <int K>
void Shooting<K>::pushPull() {
  for (NodeIndex node = 0; node < tree_.size(); ++node) {
    if (tree_.isLeaf(node)) continue;
    for (NodeIndex child = tree_.firstChild[node]; child < tree_.firstChild[node] + 2; ++child) {
      if (!tree_.isCluster(node)) {
        next_[child] += next_[node];
        continue;
      }
      for (std::size_t k = 0; k < 6; ++k) {
        const Received<K>& from = nextByDirection_[node][k];
        if (tree_.isCluster(child)) {
          nextByDirection_[child][k] += from;
        } else {
          next_[child] += alongDirection(tree_.normal(child), k) * from;
        }
      }
    }
  }
}

// The pull half: means over children, sums by direction for clusters, and the one scalar the oracle looks at.
template <int K>
void Shooting<K>::pullUnshot() {
  for (NodeIndex node = static_cast<NodeIndex>(tree_.size()); node-- > 0;) {
    if (tree_.isLeaf(node)) {
      unshot_.strength[node] = unshot_.lowest[node] = unshot_.highest[node] =
          world_.layout.strength(unshot_.radiosity_lm_m2[node]);
      continue;
    }
    const NodeIndex first = tree_.firstChild[node];
    unshot_.radiosity_lm_m2[node] =
        (1.0F / tree_.area_m2[node]) * (tree_.area_m2[first] * unshot_.radiosity_lm_m2[first] +
                                        tree_.area_m2[first + 1] * unshot_.radiosity_lm_m2[first + 1]);
    unshot_.strength[node] = world_.layout.strength(unshot_.radiosity_lm_m2[node]);
    unshot_.lowest[node] = std::min(unshot_.lowest[first], unshot_.lowest[first + 1]);
    unshot_.highest[node] = std::max(unshot_.highest[first], unshot_.highest[first + 1]);
    if (!tree_.isCluster(node)) continue;
    Six<K>& six = unshot_.byDirection_lm[node];
    six = {};
    for (NodeIndex child = first; child < first + 2; ++child) {
      for (std::size_t k = 0; k < 6; ++k) {
        six[k] += tree_.isCluster(child) ? unshot_.byDirection_lm[child][k]
                                         : (tree_.area_m2[child] * alongDirection(tree_.normal(child), k)) *
                                               unshot_.radiosity_lm_m2[child];
      }
    }
  }
}

template <int K>
Columns<K> Shooting<K>::powerOf(const std::vector<Columns<K>>& perNode) const {
  std::array<double, K> sum{};
  for (NodeIndex node = 0; node < tree_.size(); ++node) {
    if (!tree_.isLeaf(node)) continue;
    for (int c = 0; c < K; ++c) {
      sum[static_cast<std::size_t>(c)] +=
          static_cast<double>(tree_.area_m2[node]) * static_cast<double>(perNode[node][c]);
    }
  }
  Columns<K> power;
  for (int c = 0; c < K; ++c) power[c] = static_cast<float>(sum[static_cast<std::size_t>(c)]);
  return power;
}

template <int K>
Columns<K> Shooting<K>::receivedPower() const {
  std::vector<Columns<K>> irradiance_lx;
  for (const Received<K>& next : next_) irradiance_lx.push_back(next.irradiance_lx);
  return powerOf(irradiance_lx);
}

// How far the links of all steps are from moving what was shot, before anything mends it.
template <int K>
void Shooting<K>::addDefect(const Columns<K>& shot_lm) {
  if (isOpen_) return;
  const double shot = static_cast<double>(world_.layout.strength(shot_lm));
  shotSoFar_lm_ += shot;
  missedSoFar_lm_ += std::abs(shot - static_cast<double>(world_.layout.strength(receivedPower())));
  balance.unscaledDefect = missedSoFar_lm_ / shotSoFar_lm_;
}

// No receiver's view is larger than 1, and in a closed domain where everything sends it is 1. What a leaf's
// links make of it tells their common error, which dividing takes out: links kept at a parent err alike for a
// leaf in a corner. (The first step's light through portals comes by no link and is left as it is.)
template <int K>
void Shooting<K>::closeViews() {
  if (firstStep_ && lightEnters_) return;
  const bool allSend = !isOpen_ && !world_.rays.hasInnerGlass() && unshot_.lowest[0] > 0.0F;
  for (NodeIndex node = 0; node < tree_.size(); ++node) {
    Received<K>& next = next_[node];
    if (!tree_.isLeaf(node) || next.view <= 0.0F) continue;
    if (allSend || next.view > 1.0F) next = (1.0F / next.view) * next;
  }
}

// In a closed domain all power shot is received. Sampled visibility misses that by some tenths of a per cent,
// which a bright room's hundred reflections would add up.
template <int K>
void Shooting<K>::scaleToShotPower(const Columns<K>& shot_lm) {
  const Columns<K> received = receivedPower();
  Columns<K> factor;
  for (int c = 0; c < K; ++c) {
    factor[c] = received[c] > 0.0F ? std::clamp(shot_lm[c] / received[c], 0.5F, 2.0F) : 1.0F;
  }
  for (Received<K>& next : next_) next.irradiance_lx *= factor;
}

template <int K>
Columns<K> Shooting<K>::meanReflectance() const {
  Columns<K> sum;
  float area = 0.0F;
  for (std::size_t side = 0; side < tree_.sides.size(); ++side) {
    const float own = tree_.area_m2[tree_.sides[side].root];
    sum += own * radiosity_.reflectance[side];
    area += own;
  }
  return (1.0F / area) * sum;
}

// The last interaction is the root's self link: the rest of the series in closed form, E = M / (1 -
// reflectance) with M the mean unshot exitance; in an open domain only the share that does not escape comes
// back each time.
template <int K>
void Shooting<K>::finishWithRootLink() {
  const Domain& domain = world_.building.domains[static_cast<std::size_t>(domain_)];
  const auto stays =
      static_cast<float>(1.0 - (isOpen_ ? domain.escape_m2 / std::max(domain.area_m2, 1e-9) : 0.0));
  const Columns<K> mean = (1.0F / tree_.area_m2[0]) * powerOf(unshot_.radiosity_lm_m2);
  const Columns<K> reflectance = meanReflectance();
  Columns<K> ambient;
  for (int c = 0; c < K; ++c) ambient[c] = stays * mean[c] / std::max(1.0F - stays * reflectance[c], 1e-6F);
  for (NodeIndex node = 0; node < tree_.size(); ++node) {
    if (tree_.isLeaf(node)) sum_[node] += ambient;
  }
  IterationStatistics last;
  last.domain = domain_;
  last.iteration = static_cast<int>(statistics.size()) + 1;
  last.linksRequired = 1;
  last.elements = statistics.empty() ? 0 : statistics.back().elements;
  statistics.push_back(last);
}

template <int K>
void Shooting<K>::closeStatistics(int step, double seconds) {
  IterationStatistics row;
  row.domain = domain_;
  row.iteration = step;
  for (const Work& work : work_) {
    row.linksRequired += work.tally.links;
    row.linksReused += work.tally.reused;
    row.visibilityTests += work.tally.rays;
  }
  row.linksCached = cache_.size();
  row.unshotPower_lm = static_cast<double>(world_.layout.strength(powerOf(unshot_.radiosity_lm_m2)));
  for (NodeIndex node = 0; node < tree_.size(); ++node) row.elements += tree_.isLeaf(node) ? 1U : 0U;
  row.seconds = seconds;
  statistics.push_back(row);
}

template <int K>
Radiosity<K> Shooting<K>::takeRadiosity() {
  return std::move(radiosity_);
}

template class Shooting<1>;
template class Shooting<2>;
template class Shooting<4>;
template class Shooting<8>;

}  // namespace clerestory
