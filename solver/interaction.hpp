// SPDX-License-Identifier: GPL-3.0-or-later
// One interaction of a shooting step: the oracle, form factor and visibility of a link, and the light it
// moves.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exchange.hpp"
#include "linkcache.hpp"
#include "radiosity.hpp"
#include "receiver.hpp"

namespace clerestory {

/// A link that the oracle has not refused on sight; its visibility is to be asked for, or known.
template <int K>
struct Candidate {
  NodeIndex sender = noNode;
  Link link;
  bool isKnown = false;  ///< from the cache
  float visible = 0.0F;  ///< share of the way that is open, by the kernel
  Columns<K> lit;        ///< share of the sender's light that comes through, by kernel and radiosity
  /// What an element's two children get of the light, of its mean: of a receiver half in shadow one may have
  /// all.
  std::array<Columns<K>, 2> onChild;
  std::array<float, 2> viewOnChild{};  ///< likewise of its view
  bool differs = false;                ///< whether they differ
};

/// The senders that a receiver has left to rays. None holds another.
struct WeakSenders {
  std::vector<NodeIndex> nodes;
  float power_lm = 0.0F;      ///< that they could send together, were nothing in their way
  float variance_lm2 = 0.0F;  ///< of one ray that stands for all of them
};

/// The rays of many links to one receiver, cast together; kept by a task between receivers.
struct RayBatch {
  std::vector<RayScene::Segment> segments;
  std::vector<float> kernel, seen;
  std::vector<std::uint8_t> spot;  ///< of the sender, where a ray ends
  std::vector<std::uint8_t> blocked;
  std::vector<std::uint32_t> firstRay;  ///< #candidates + 1

  void clear() {
    segments.clear();
    kernel.clear();
    spot.clear();
    firstRay.clear();
  }
};

/// Interactions within one tree. Reads the tree and its unshot light, writes nothing but what it is handed.
template <int K>
class Interactions {
 public:
  /// `exitance_lm_m2` (#sides of the tree): of what shines by itself. Before a step in which the tree is
  /// larger than it was, its `findSpotLeaves` is to be called.
  Interactions(const World& world, const Hierarchy& tree, const Unshot<K>& unshot,
               std::span<const Columns<K>> exitance_lm_m2, const TransportSettings& settings);

  /// lm that one interaction may err by, or move.
  float threshold_lm = 0.0F;
  /// From where on it counts what the rays of a link have missed: by the first step's threshold, not by the
  /// lower ones of a bright room's many steps.
  float missedThreshold_lm = 0.0F;
  /// Whether receivers may be divided further.
  bool mayGrow = true;
  /// Whether a sender that is dark as yet gets links too, for a step in which it is not.
  bool linksDark = false;

  [[nodiscard]] bool canDivide(const Receiver& receiver) const;

  /// ORACLE of the paper's TRANSPORT-LIGHT on what is known of two nodes beforehand.
  [[nodiscard]] Verdict judgeOnSight(const Receiver& receiver, NodeIndex sender) const;
  /// A link without its visibility.
  [[nodiscard]] Link measureLink(const Receiver& receiver, NodeIndex sender) const;
  /// Fills what is seen of the candidates, and their links' rays where they are not known.
  void castRays(const Receiver& receiver, std::span<Candidate<K>> candidates, RayBatch& batch,
                Tally& tally) const;
  /// ORACLE on what the rays have told.
  Verdict judgeSeen(const Receiver& receiver, const Candidate<K>& candidate, Tally& tally) const;
  /// Adds the light that an accepted link brings.
  void add(Incoming<K>& incoming, const Receiver& receiver, const Candidate<K>& candidate) const;
  /// Power that a link moves, or could were nothing in its way. [lm]
  [[nodiscard]] float powerOf(const Receiver& receiver, const Candidate<K>& candidate) const {
    return unshot_.strength[candidate.sender] * candidate.link.formFactor * receiver.weight;
  }

  /// Adds a sender that is too weak for a link of its own.
  void addWeak(WeakSenders& weak, const Receiver& receiver, NodeIndex sender) const;
  /// Whether a receiver may take what weak senders bring as one mean.
  [[nodiscard]] bool takesWeak(const Receiver& receiver, const WeakSenders& weak) const;
  /// Adds `senders` to the weak ones and says so, if rays for all of them are cheaper than to look for links.
  [[nodiscard]] bool leavesToRays(const Receiver& receiver, std::span<const Sender> senders,
                                  WeakSenders& weak) const;
  /// Adds what the weak senders bring.
  void receiveWeak(const Receiver& receiver, const WeakSenders& weak, Incoming<K>& incoming,
                   Tally& tally) const;
  /// Adds what an element outdoors sees in panes.
  void receiveMirrored(const Receiver& receiver, Incoming<K>& incoming, Tally& tally) const;

 private:
  /// What the oracle sees of a sender.
  struct Sight {
    float strength;  ///< unshot light, strongest kind [lm/m²]
    float distance_m;
    float bound;  ///< of the form factor
  };

  [[nodiscard]] bool isBehind(NodeIndex node, const glm::vec3& onPlane, const glm::vec3& normal) const;
  [[nodiscard]] bool isBehind(const Receiver& receiver, const glm::vec3& onPlane,
                              const glm::vec3& normal) const;
  [[nodiscard]] Sight look(const Receiver& receiver, NodeIndex sender) const;
  [[nodiscard]] Verdict refineLarger(const Receiver& receiver, NodeIndex sender) const;
  [[nodiscard]] Verdict judgePower(const Receiver& receiver, NodeIndex sender, const Sight& seen) const;
  [[nodiscard]] Verdict judgeCluster(const Receiver& receiver, NodeIndex sender, const Sight& seen) const;
  [[nodiscard]] Verdict judgeElement(const Receiver& receiver, NodeIndex sender, const Sight& seen) const;
  bool isOtherwise(const Receiver& receiver, const Candidate<K>& candidate, Tally& tally) const;
  [[nodiscard]] Verdict judgeVisible(const Receiver& receiver, const Candidate<K>& candidate, float visible,
                                     float allowed_lm) const;
  void measureNear(const Receiver& receiver, NodeIndex sender, float apart, Link& link) const;
  [[nodiscard]] std::uint32_t raysOf(const Receiver& receiver, const Candidate<K>& candidate) const;
  void layRays(const Receiver& receiver, const Candidate<K>& candidate, RayBatch& batch) const;
  void weighRays(const Receiver& receiver, Candidate<K>& candidate, const RayBatch& batch, std::size_t first,
                 std::size_t last) const;
  void shareLight(const Receiver& receiver, Candidate<K>& candidate, const RayBatch& batch, std::size_t first,
                  std::size_t last) const;
  [[nodiscard]] float uneven(NodeIndex sender) const;
  /// What is too weak for a link of its own comes by rays, but where links are to be stored or counted.
  [[nodiscard]] bool usesRays() const { return settings_.oracle == Oracle::error && !linksDark; }

  /// For the noise that rays may have, by the variance of one.
  [[nodiscard]] float raysNeeded(float variance_lm2) const;

  void addToElement(Received<K>& next, const Receiver& receiver, const Candidate<K>& candidate) const;
  [[nodiscard]] Columns<K> unevenLight(const Receiver& receiver, NodeIndex sender, float formFactor) const;
  void addToCluster(SixReceived<K>& next, const Receiver& receiver, const Candidate<K>& candidate) const;
  [[nodiscard]] float heldSquare(NodeIndex sender, float distance_m, float receiverRadius_m) const;
  [[nodiscard]] Received<K> sentAlong(NodeIndex cluster, const glm::vec3& direction) const;
  [[nodiscard]] float isotropicShare(NodeIndex sender, float receiverRadius_m) const;

  const World& world_;
  const Hierarchy& tree_;
  const Unshot<K>& unshot_;
  const TransportSettings& settings_;
  float totalWeight_;
  std::vector<float> brilliance_;          // #sides of the tree, 1 or more for what shines by itself
  bool seesPanes_ = false;                 // outdoors, where they mirror
  std::vector<std::uint32_t> treeSideOf_;  // #sides of the building; noNode: another domain's
};

}  // namespace clerestory
