// SPDX-License-Identifier: GPL-3.0-or-later
// TRANSPORT-LIGHT and PUSH-PULL (Stamminger et al., section 3.1), and the energy balance of a step.
#include "transport.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

#include <geometry/parallel.hpp>

namespace clerestory {
namespace {

/// Of a node: what it sends and has received here, the sum and what is unshot where the steps are driven.
template <int K>
constexpr std::size_t valueBytesOfNode = 3 * sizeof(Columns<K>) + 3 * sizeof(float) + sizeof(Received<K>);

/// What an element takes once it is in the tree.
template <int K>
std::size_t bytesOf(const ElementShape& element) {
  return Hierarchy::bytesOfNode + element.corners.size() * sizeof(glm::vec3) + valueBytesOfNode<K>;
}

}  // namespace

template <int K>
Transport<K>::Transport(const SolvedLight<K>& light, std::int32_t domain, Radiosity<K>& radiosity,
                        const TransportSettings& settings, LinkCache& cache, Links links)
    : world_(light.world()),
      isOpen_(world_.building.domains[static_cast<std::size_t>(domain)].open),
      settings_(settings),
      cache_(cache),
      tree_(radiosity.tree),
      links_(links),
      entering_(light, domain, tree_, settings_, links == Links::madeAnew),
      interactions_(world_, tree_, unshot_, radiosity.exitance_lm_m2, settings_) {
  interactions_.linksDark = links == Links::stored;
  received_.resize(tree_.size());
  unshot_.resize(tree_.size());
  unshot_.byDirection_lm.resize(tree_.trunkSize());
  receivedByDirection_.resize(tree_.trunkSize());
  work_.resize(tree_.trunkSize());
}

template <int K>
Columns<K> Transport<K>::enteringPower_lm() const {
  if (!isOpen_) return entering_.portalFlux_lm() + entering_.lampFlux_lm();
  return entering_.lampFlux_lm() +
         world_.layout.template light<K>(
             world_.layout.skyColumn(),
             glm::dvec3(0.5 * world_.sky.horizontalIlluminance_lx() * static_cast<double>(tree_.area_m2[0])));
}

template <int K>
void Transport<K>::setFirstLight(float firstLight_lm) {
  interactions_.threshold_lm =
      settings_.epsilon * firstLight_lm * std::max(tree_.weight[0], 1e-20F) / tree_.area_m2[0];
  constexpr float missed =
      2.0F;  // at 1 bright rooms take 2 % more rays, a corridor behind doors is 1 % brighter
  interactions_.missedThreshold_lm = missed * interactions_.threshold_lm;
}

template <int K>
void Transport<K>::send(const std::vector<Columns<K>>& leaves, bool withOutside) {
  pull(leaves);
  tree_.findSpotLeaves();
  const bool enters = withOutside && !isOpen_;
  const Columns<K> entering_lm = enters ? entering_.portalFlux_lm() : Columns<K>{};
  const Columns<K> lamps_lm = enters ? entering_.lampFlux_lm() : Columns<K>{};
  std::vector<Sender> senders;
  if (links_ == Links::madeAnew || cache_.size() == 0) senders.push_back(0);
  if (withOutside) {
    const std::vector<Sender> outside = entering_.senders();
    senders.insert(senders.end(), outside.begin(), outside.end());
  }
  transportWithinMemory(senders);
  mergeGrown();
  pushPull();
  mend(powerOf(unshot_.radiosity_lm_m2), entering_lm, lamps_lm);
}

template <int K>
std::size_t Transport<K>::roomBytes() const {
  const std::size_t used = tree_.bytes() + valueBytes(tree_);
  return used < settings_.memoryBytes ? settings_.memoryBytes - used : 0;
}

template <int K>
void Transport<K>::stopGrowth() {
  interactions_.mayGrow = false;
  diagnoses.push_back(
      {"S301",
       "the memory allowed is used up: no further elements are made, the solution is complete at "
       "the accuracy reached; allow more with --memory",
       ""});
}

// Whether a step asks for more than there is room for does not depend on the order of its tasks. It is given
// up as soon as it does and taken again by a coarser threshold, so all of the domain is as fine as the rest,
// and elements that are not fine are not linked as if they were.
template <int K>
void Transport<K>::transportWithinMemory(const std::vector<Sender>& senders) {
  constexpr float coarser = 4.0F;  // half as accurate
  constexpr float coarsest = 1e9F;
  room_ = roomBytes();
  if (interactions_.mayGrow && room_ == 0) stopGrowth();
  transportLight(senders);
  if (!isOverfull()) return;
  while (isOverfull() && coarser_ < coarsest) {
    coarser_ *= coarser;
    interactions_.threshold_lm *= coarser;
    interactions_.missedThreshold_lm *= coarser;
    transportLight(senders);
  }
  stopGrowth();
  if (isOverfull()) transportLight(senders);
}

template <int K>
void Transport<K>::transportLight(const std::vector<Sender>& senders) {
  grownBytes_ = 0;
  for (Work& work : work_) work = {};
  std::fill(received_.begin(), received_.end(), Received<K>{});
  std::fill(receivedByDirection_.begin(), receivedByDirection_.end(), SixReceived<K>{});
  receive(receiverOf(tree_, 0), senders, work_[0]);
}

// The paper's TRANSPORT-LIGHT(p, q), turned about the receiver: all senders that the levels above have left
// to p are settled at p or handed on to p's children, so a task writes to its own receiver alone and needs no
// lock.
template <int K>
void Transport<K>::receive(const Receiver& receiver, std::vector<Sender> senders, Work& work) {
  if (isOverfull()) return;
  Incoming<K> incoming;
  if (receiver.isCluster()) incoming.six = &receivedByDirection_[receiver.node];
  std::vector<Sender> down = settle(receiver, std::move(senders), incoming, work);
  const bool hasChildren = receiver.node != noNode && !tree_.isLeaf(receiver.node);
  if (receiver.node != noNode) {
    received_[receiver.node] += incoming.own;
    if (hasChildren && !receiver.isCluster()) {
      for (NodeIndex child = 0; child < 2; ++child)
        received_[tree_.firstChild[receiver.node] + child] = incoming.ofChildren[child];
    }
  } else {
    work.grown[receiver.grown / 2]->received[receiver.grown % 2] = incoming.own;
  }
  if (!down.empty() || (links_ == Links::stored && hasChildren)) descend(receiver, std::move(down), work);
}

// Wave by wave, so that the rays of many links are cast together. Returns the senders that are left to the
// receiver's children.
template <int K>
std::vector<Sender> Transport<K>::settle(const Receiver& receiver, std::vector<Sender> senders,
                                         Incoming<K>& incoming, Work& work) {
  const auto cached =
      receiver.node != noNode ? cache_.ofReceiver(receiver.node) : std::span<const CachedLink>();
  if (links_ == Links::stored) {
    for (const CachedLink& stored : cached) senders.push_back(stored.sender);
  }
  std::vector<Sender> down;
  std::vector<Sender> next;
  WeakSenders weak;
  std::vector<Candidate<K>> candidates;
  RayBatch batch;
  const auto decide = [&](Verdict verdict, Sender sender) {
    if (verdict == Verdict::refineReceiver) down.push_back(sender);
    if (verdict == Verdict::weak) interactions_.addWeak(weak, receiver, sender);
    if (verdict == Verdict::refineSender) {
      next.push_back(tree_.firstChild[sender]);
      next.push_back(tree_.firstChild[sender] + 1);
    }
  };
  while (!senders.empty()) {
    next.clear();
    candidates.clear();
    const bool byRays = interactions_.leavesToRays(receiver, senders, weak);
    for (const Sender sender : senders) {
      if (byRays && sender < firstPortal) continue;
      if (sender >= firstPortal) {
        const Verdict verdict = entering_.receive(
            receiver, sender, {interactions_.threshold_lm, interactions_.canDivide(receiver)}, incoming,
            work.tally);
        work.tally.links += verdict == Verdict::accept ? 1U : 0U;
        decide(verdict, sender);
        continue;
      }
      const Verdict verdict = interactions_.judgeOnSight(receiver, sender);
      if (verdict != Verdict::accept) {
        decide(verdict, sender);
        continue;
      }
      const auto found = std::lower_bound(cached.begin(), cached.end(), sender,
                                          [](const CachedLink& a, NodeIndex b) { return a.sender < b; });
      const bool isKnown = found != cached.end() && found->sender == sender;
      Candidate<K>& candidate = candidates.emplace_back();
      candidate.sender = sender;
      candidate.isKnown = isKnown;
      candidate.link = isKnown ? found->link : interactions_.measureLink(receiver, sender);
      work.tally.reused += isKnown ? 1U : 0U;
    }
    interactions_.castRays(receiver, candidates, batch, work.tally);
    for (const Candidate<K>& candidate : candidates) {
      const Verdict verdict = interactions_.judgeSeen(receiver, candidate, work.tally);
      if (verdict != Verdict::accept) {
        decide(verdict, candidate.sender);
        continue;
      }
      ++work.tally.links;
      interactions_.add(incoming, receiver, candidate);
      keep(receiver, candidate, work);
    }
    std::swap(senders, next);
  }
  if (!interactions_.takesWeak(receiver, weak)) {
    down.insert(down.end(), weak.nodes.begin(), weak.nodes.end());
  } else if (!weak.nodes.empty()) {
    ++work.tally.links;
    interactions_.receiveWeak(receiver, weak, incoming, work.tally);
  }
  if (down.empty() && links_ == Links::madeAnew)
    interactions_.receiveMirrored(receiver, incoming, work.tally);
  return down;
}

template <int K>
void Transport<K>::descend(const Receiver& receiver, std::vector<Sender> senders, Work& work) {
  if (receiver.isCluster()) {
    const NodeIndex first = tree_.firstChild[receiver.node];
    const auto own = [&](NodeIndex child) { receive(receiverOf(tree_, child), senders, work_[child]); };
    inParallel([&] { own(first); }, [&] { own(first + 1); });
    return;
  }
  if (receiver.node != noNode && !tree_.isLeaf(receiver.node)) {
    const NodeIndex first = tree_.firstChild[receiver.node];
    receive(receiverOf(tree_, first), senders, work);
    receive(receiverOf(tree_, first + 1), std::move(senders), work);
    return;
  }
  const auto number = static_cast<std::uint32_t>(work.grown.size());
  const bool parentIsGrown = receiver.node == noNode;
  const ElementShape shape{{receiver.corners.begin(), receiver.corners.end()},
                           receiver.centre,
                           receiver.radius_m,
                           receiver.area_m2,
                           receiver.weight,
                           receiver.key};
  work.grown.push_back(std::make_unique<Grown>(Grown{
      parentIsGrown, parentIsGrown ? receiver.grown : receiver.node, halve(shape, receiver.normal), {}, {}}));
  Grown& grown = *work.grown.back();
  grownBytes_ += bytesOf<K>(grown.halves.first) + bytesOf<K>(grown.halves.second);
  const auto child = [&](const ElementShape& half, std::uint32_t which) {
    grown.spots[which] = spotsOn(half.corners, half.key);
    return Receiver{
        noNode,      2 * number + which, receiver.treeSide, half.corners, &grown.spots[which], nullptr,
        half.centre, receiver.normal,    half.radius_m,     half.area_m2, half.weight,         half.key};
  };
  receive(child(grown.halves.first, 0), senders, work);
  receive(child(grown.halves.second, 1), std::move(senders), work);
}

template <int K>
void Transport<K>::keep(const Receiver& receiver, const Candidate<K>& candidate, Work& work) {
  if (!cache_.keeps(interactions_.powerOf(receiver, candidate), receiver.key)) return;
  if (receiver.node != noNode) {
    work.kept.push_back({receiver.node, candidate.sender, candidate.link});
  } else {
    work.keptByGrown.push_back({receiver.grown, {0, candidate.sender, candidate.link}});
  }
}

template <int K>
void Transport<K>::mergeGrown() {
  const std::size_t before = tree_.size();
  for (Work& work : work_) {
    std::vector<NodeIndex> first(work.grown.size());
    for (std::size_t i = 0; i < work.grown.size(); ++i) {
      const Grown& grown = *work.grown[i];
      const NodeIndex parent = grown.parentIsGrown ? first[grown.parent / 2] + grown.parent % 2
                                                   : static_cast<NodeIndex>(grown.parent);
      first[i] = tree_.divide(parent, grown.halves.first, grown.halves.second, grown.halves.plane);
      for (const Received<K>& received : grown.received) {
        received_.push_back(received);
        unshot_.radiosity_lm_m2.push_back(unshot_.radiosity_lm_m2[parent]);
      }
    }
    for (auto& [grown, cached] : work.keptByGrown) {
      cached.receiver = first[grown / 2] + grown % 2;
      work.kept.push_back(cached);
    }
    work.grown.clear();
    work.keptByGrown.clear();
  }
  if (tree_.size() == before) return;
  unshot_.resize(tree_.size());
}

// PUSH-PULL of the paper on what this step received: irradiance goes down to the leaves.
template <int K>
void Transport<K>::pushPull() {
  for (NodeIndex node = 0; node < tree_.size(); ++node) {
    if (tree_.isLeaf(node)) continue;
    for (NodeIndex child = tree_.firstChild[node]; child < tree_.firstChild[node] + 2; ++child) {
      received_[child] += received_[node];
      if (!tree_.isCluster(node)) continue;
      for (std::size_t k = 0; k < 6; ++k) {
        const Received<K>& from = receivedByDirection_[node][k];
        if (tree_.isCluster(child)) {
          receivedByDirection_[child][k] += from;
        } else {
          received_[child] += alongDirection(tree_.normal(child), k) * from;
        }
      }
    }
  }
}

// The pull half: means over children, sums by direction for clusters, and the one scalar the oracle looks at.
template <int K>
void Transport<K>::pull(const std::vector<Columns<K>>& leaves) {
  for (NodeIndex node = static_cast<NodeIndex>(tree_.size()); node-- > 0;) {
    if (tree_.isLeaf(node)) {
      unshot_.radiosity_lm_m2[node] = leaves[node];
      unshot_.strength[node] = unshot_.lowest[node] = unshot_.highest[node] =
          world_.layout.strength(leaves[node]);
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
template <class Value>
Columns<K> Transport<K>::powerOfLeaves(Value&& of) const {
  std::array<double, K> sum{};
  for (NodeIndex node = 0; node < tree_.size(); ++node) {
    if (!tree_.isLeaf(node)) continue;
    const Columns<K>& value = of(node);
    for (int c = 0; c < K; ++c) {
      sum[static_cast<std::size_t>(c)] +=
          static_cast<double>(tree_.area_m2[node]) * static_cast<double>(value[c]);
    }
  }
  Columns<K> power;
  for (int c = 0; c < K; ++c) power[c] = static_cast<float>(sum[static_cast<std::size_t>(c)]);
  return power;
}

template <int K>
Columns<K> Transport<K>::powerOf(const std::vector<Columns<K>>& perNode) const {
  return powerOfLeaves([&](NodeIndex node) -> const Columns<K>& { return perNode[node]; });
}

template <int K>
Columns<K> Transport<K>::receivedPower() const {
  return powerOfLeaves([&](NodeIndex node) -> const Columns<K>& { return received_[node].irradiance_lx; });
}

// Of a trunk's node its light by direction too.
template <int K>
std::size_t Transport<K>::valueBytes(const Hierarchy& tree) {
  return tree.size() * valueBytesOfNode<K> + tree.trunkSize() * (sizeof(Six<K>) + sizeof(SixReceived<K>));
}

// In a closed domain all power sent is received. Sampled visibility misses that by some tenths of a per cent,
// which a bright room's hundred reflections would add up. Light from outside has only one step to be missed
// in, and its receivers know it better than the rays through the panes do: it stays as it was received. Of
// luminaires the lumens are known.
template <int K>
void Transport<K>::mend(const Columns<K>& sent_lm, const Columns<K>& entering_lm,
                        const Columns<K>& lamps_lm) {
  closeViews();
  entered_lm_ = {};
  if (isOpen_) return;
  const Columns<K> power_lm = receivedPower();
  const double expected_lm = static_cast<double>(world_.layout.strength(sent_lm + entering_lm + lamps_lm));
  missed_lm_ += std::abs(expected_lm - static_cast<double>(world_.layout.strength(power_lm)));
  sent_lm_ += expected_lm;
  Columns<K> factor;
  for (int c = 0; c < K; ++c) {
    const bool enters = entering_lm[c] > 0.0F;
    if (enters) entered_lm_[c] = std::max(power_lm[c] - sent_lm[c] - lamps_lm[c], 0.0F);
    const bool keeps = enters || world_.rays.hasInnerGlass() || !(power_lm[c] > 0.0F);
    factor[c] = keeps ? 1.0F : std::clamp((sent_lm[c] + lamps_lm[c]) / power_lm[c], 0.5F, 2.0F);
  }
  for (Received<K>& received : received_) received.irradiance_lx *= factor;
}

// In a closed domain where everything sends, a leaf's view is 1, and elsewhere at most 1. What its links make
// of it tells their common error: those kept at a parent err alike for a leaf in a corner. Dividing takes it
// out.
template <int K>
void Transport<K>::closeViews() {
  if (isOpen_ || world_.rays.hasInnerGlass() || !(unshot_.lowest[0] > 0.0F)) {
    evenViews();
    return;
  }
  for (NodeIndex node = 0; node < tree_.size(); ++node) {
    Received<K>& received = received_[node];
    if (tree_.isLeaf(node) && received.view > 0.0F) received = (1.0F / received.view) * received;
  }
}

// Where some senders are dark a view below 1 may be right; one above 1 is not, and what is too much there is
// missing elsewhere on the same side: a leaf has more than its share of what a parent's link brought. It is
// missing where views fall short by little; one that falls far short is rightly dark, as in a gap.
template <int K>
void Transport<K>::evenViews() {
  struct Side {
    Columns<K> excess_lm, room_lm;
  };
  constexpr float viewLeast = 0.6F;
  std::vector<Side> sides(tree_.sides.size());
  const auto whole = [](const Received<K>& received) {
    return received.view < viewLeast ? received : (1.0F / received.view) * received;
  };
  for (NodeIndex node = 0; node < tree_.size(); ++node) {
    const Received<K>& received = received_[node];
    if (!tree_.isLeaf(node) || received.view <= 0.0F) continue;
    Side& side = sides[tree_.treeSide[node]];
    const Columns<K> change_lm =
        tree_.area_m2[node] * (whole(received).irradiance_lx - received.irradiance_lx);
    (received.view > 1.0F ? side.excess_lm : side.room_lm) += change_lm;
  }
  for (NodeIndex node = 0; node < tree_.size(); ++node) {
    Received<K>& received = received_[node];
    if (!tree_.isLeaf(node) || received.view <= 0.0F) continue;
    const Side& side = sides[tree_.treeSide[node]];
    const Columns<K> change_lx = whole(received).irradiance_lx - received.irradiance_lx;
    for (int c = 0; c < K; ++c) {
      const float moved_lm = std::min(-side.excess_lm[c], side.room_lm[c]);
      const float offered_lm = received.view > 1.0F ? -side.excess_lm[c] : side.room_lm[c];
      if (offered_lm > 0.0F) received.irradiance_lx[c] += moved_lm / offered_lm * change_lx[c];
    }
  }
}

template <int K>
Tally Transport<K>::tally() const {
  Tally sum;
  for (const Work& work : work_) {
    sum.links += work.tally.links;
    sum.reused += work.tally.reused;
    sum.rays += work.tally.rays;
  }
  return sum;
}

template <int K>
void Transport<K>::handOverLinks(float fade) {
  std::vector<CachedLink> kept;
  for (Work& work : work_) {
    kept.insert(kept.end(), work.kept.begin(), work.kept.end());
    work.kept = {};
  }
  cache_.replace(std::move(kept), tree_.size(), fade);
}

#define CLERESTORY_INSTANTIATE(K) template class Transport<K>;
CLERESTORY_TRANSPORT_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
