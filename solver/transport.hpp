// SPDX-License-Identifier: GPL-3.0-or-later
// HR(ε, B) of the paper: one transport of a radiosity through a domain, by TRANSPORT-LIGHT from the root's
// self link and PUSH-PULL. Shooting and gathering differ in what they hand to it.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <solver/solution.hpp>

#include "entering.hpp"
#include "interaction.hpp"

namespace clerestory {

/// What becomes of links between two transports.
enum class Links {
  madeAnew,  ///< each transport begins at the root's self link; what the cache holds is only not computed
             ///< again
  stored     ///< the cache holds all of them; each transport begins at those of the last
};

template <int K>
class Transport {
 public:
  /// `radiosity.tree` grows by the elements that transports ask for.
  Transport(const SolvedLight<K>& light, std::int32_t domain, Radiosity<K>& radiosity,
            const TransportSettings& settings, LinkCache& cache, Links links);

  /// Sends the radiosity that `leaves` (#nodes; leaves alone count) hold, and with it the light from outside
  /// and of luminaires if `withOutside`. Afterwards received() is what it has brought to each leaf.
  void send(const std::vector<Columns<K>>& leaves, bool withOutside);

  /// Irradiance of each node; leaves hold all of what they got. #nodes
  [[nodiscard]] const std::vector<Received<K>>& received() const { return received_; }
  /// Puts the links of the last `send` in the cache, for a next one whose light is `fade` times as strong.
  void handOverLinks(float fade);

  /// Power of what leaves hold, summed over the domain. [lm]
  [[nodiscard]] Columns<K> powerOf(const std::vector<Columns<K>>& perNode) const;
  /// Power of the light that enters from outside, an estimate in open domains, and that of luminaires. [lm]
  [[nodiscard]] Columns<K> enteringPower_lm() const;
  /// Power of the domain's luminaires. [lm]
  [[nodiscard]] Columns<K> lampPower_lm() const { return entering_.lampFlux_lm(); }
  /// Power that the last `send` brought in through portals, as its receivers add it up. [lm]
  [[nodiscard]] const Columns<K>& enteredPower_lm() const { return entered_lm_; }
  /// Sets what one interaction may err by, from the light that the domain starts with. [lm]
  void setFirstLight(float firstLight_lm);
  /// Sets it for what is sent from now on. [lm]
  void setThreshold(float threshold_lm) { interactions_.threshold_lm = coarser_ * threshold_lm; }
  [[nodiscard]] float threshold_lm() const { return interactions_.threshold_lm; }

  /// Of the last `send`.
  [[nodiscard]] Tally tally() const;
  /// Share of all power sent so far that the links missed or overdid, before that was mended.
  [[nodiscard]] double unscaledDefect() const { return sent_lm_ > 0.0 ? missed_lm_ / sent_lm_ : 0.0; }

  /// Bytes that light takes beside a tree while it is solved.
  [[nodiscard]] static std::size_t valueBytes(const Hierarchy& tree);

  std::vector<Diagnosis> diagnoses;

 private:
  /// Two children that a receiver's task has made in this step; they enter the tree when the step is over.
  struct Grown {
    bool parentIsGrown;
    std::uint32_t parent;  ///< node, or 2 × number in the task's list + which child
    Halves halves;
    Spots spots[2];
    Received<K> received[2];
  };
  /// What one task (a trunk node as receiver) brings back.
  struct Work {
    std::vector<std::unique_ptr<Grown>> grown;
    std::vector<CachedLink> kept;
    std::vector<std::pair<std::uint32_t, CachedLink>> keptByGrown;  ///< receiver: number of the grown child
    Tally tally;
  };

  void transportLight(const std::vector<Sender>& senders);
  /// By the threshold, or by the least of its multiples whose elements find room in memory.
  void transportWithinMemory(const std::vector<Sender>& senders);
  /// Bytes that the tree may grow by.
  [[nodiscard]] std::size_t roomBytes() const;
  [[nodiscard]] bool isOverfull() const { return grownBytes_.load(std::memory_order_relaxed) > room_; }
  void stopGrowth();
  void receive(const Receiver& receiver, std::vector<Sender> senders, Work& work);
  std::vector<Sender> settle(const Receiver& receiver, std::vector<Sender> senders, Incoming<K>& incoming,
                             Work& work);
  void descend(const Receiver& receiver, std::vector<Sender> senders, Work& work);
  void keep(const Receiver& receiver, const Candidate<K>& candidate, Work& work);

  void mergeGrown();
  void pushPull();
  void pull(const std::vector<Columns<K>>& leaves);
  void mend(const Columns<K>& sent_lm, const Columns<K>& entering_lm, const Columns<K>& lamps_lm);
  void closeViews();
  void evenViews();
  [[nodiscard]] Columns<K> receivedPower() const;
  /// `of` gives a leaf's value.
  template <class Value>
  [[nodiscard]] Columns<K> powerOfLeaves(Value&& of) const;

  const World& world_;
  bool isOpen_;
  TransportSettings settings_;
  LinkCache& cache_;
  Hierarchy& tree_;
  Links links_;

  Unshot<K> unshot_;
  std::vector<Received<K>> received_;                // #nodes
  std::vector<SixReceived<K>> receivedByDirection_;  // #trunk
  std::vector<Work> work_;                           // #trunk
  EnteringLight<K> entering_;
  Interactions<K> interactions_;
  Columns<K> entered_lm_;
  float coarser_ = 1.0F;                    // than the threshold asked for
  std::size_t room_ = 0;                    // bytes that a step may grow by
  std::atomic<std::size_t> grownBytes_{0};  // in this step
  double sent_lm_ = 0.0, missed_lm_ = 0.0;
};

}  // namespace clerestory
