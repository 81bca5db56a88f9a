// SPDX-License-Identifier: GPL-3.0-or-later
// Shooting hierarchical radiosity in one domain: the algorithm of the paper's section 3.1, step by step.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <solver/solution.hpp>

#include "interaction.hpp"

namespace clerestory {

/// Legend, as in the paper: sum is the irradiance received so far (the paper's B without its emission, before
/// the surface's reflectance), unshot is the radiosity that has not been sent yet, next is what this step
/// received.
template <int K>
class Shooting {
 public:
  Shooting(const SolvedLight<K>& light, std::int32_t domain, Hierarchy tree,
           const TransportSettings& settings, LinkCache& cache);

  /// SHOOTING-HR of the paper: steps until the rest can be exchanged by the root's self link alone.
  void run();

  /// The solved domain; the object is spent.
  Radiosity<K> takeRadiosity();

  std::vector<IterationStatistics> statistics;
  EnergyBalance balance;
  std::vector<Diagnosis> diagnoses;

 private:
  /// Two children that a receiver's task has made in this step; they enter the tree when the step is over.
  struct Grown {
    bool parentIsGrown;
    std::uint32_t parent;  ///< node, or 2 × number in the task's list + which child
    Halves halves;
    Received<K> next[2];
  };
  /// What one task (a trunk node as receiver) brings back.
  struct Work {
    std::vector<Grown> grown;
    std::vector<CachedLink> kept;
    std::vector<std::pair<std::uint32_t, CachedLink>> keptByGrown;  ///< receiver: number of the grown child
    std::vector<std::uint64_t> powers;
    Tally tally;
  };

  void transportLight();
  void receiveCluster(NodeIndex receiver, std::vector<NodeIndex> senders);
  void receiveElement(const Element& receiver, std::vector<NodeIndex> senders, Work& work);
  void receiveChildren(const Element& receiver, std::vector<NodeIndex> senders, Work& work);
  void keep(const Element& receiver, NodeIndex sender, const Link& link, Work& work);

  void mergeGrown();
  void pushPull();
  void pullUnshot();
  [[nodiscard]] Columns<K> receivedPower() const;
  void addDefect(const Columns<K>& shot_lm);
  void closeViews();
  void scaleToShotPower(const Columns<K>& shot_lm);
  void finishWithRootLink();
  [[nodiscard]] Columns<K> powerOf(const std::vector<Columns<K>>& perNode) const;
  [[nodiscard]] Columns<K> meanReflectance() const;
  void closeStatistics(int step, double seconds);

  const World& world_;
  std::int32_t domain_;
  bool isOpen_;
  TransportSettings settings_;
  LinkCache& cache_;
  Radiosity<K> radiosity_;
  Hierarchy& tree_;

  std::vector<Columns<K>>& sum_;  // irradiance, leaves
  Unshot<K> unshot_;
  std::vector<Received<K>> next_;                // #nodes
  std::vector<SixReceived<K>> nextByDirection_;  // #trunk
  std::vector<Work> work_;                       // #trunk
  Interactions<K> interactions_;
  bool lightEnters_ = false;  ///< by portals or from the open sky, in the first step
  bool firstStep_ = true;
  double shotSoFar_lm_ = 0.0, missedSoFar_lm_ = 0.0;
};

}  // namespace clerestory
