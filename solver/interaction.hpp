// SPDX-License-Identifier: GPL-3.0-or-later
// One interaction of a shooting step: the oracle, form factor and visibility of a link, and the light it
// moves.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "linkcache.hpp"
#include "portals.hpp"
#include "radiosity.hpp"
#include "receiver.hpp"

namespace clerestory {

/// What decides whether an interaction is fine enough.
enum class Oracle {
  error,            ///< an estimate of the error that it causes
  transportedPower  ///< a bound on the power that it moves, as in the paper's section 4.1
};

/// What decides how finely light is transported.
struct TransportSettings {
  Oracle oracle = Oracle::error;
  float epsilon = 2e-6F;                ///< share of the domain's first light that one interaction may err by
  float elementMin_m = 0.06F;           ///< elements of a smaller radius are not divided
  std::uint32_t portalFluxRays = 4096;  ///< of each pane, for the power that enters
  std::uint32_t skyRays = 256;          ///< of an element that sees the sky without glass
  double endShare = 1e-3;  ///< unshot light, as a share of the mean irradiance, that ends the steps
  int stepsMax = 200;
  std::size_t memoryBytes = std::size_t{4} << 30;
};

/// What an asked accuracy sets, calibrated on the reference scenes (docs/validation.md).
TransportSettings transportFor(double accuracy);

/// A cluster's light by direction.
template <int K>
using Six = std::array<Columns<K>, 6>;

/// What a receiver got in a step: light, and the share of its view that this light came from. The view is
/// what the same links would bring from senders of radiosity 1; exact links would fill it to 1 in a closed
/// domain.
template <int K>
struct Received {
  Columns<K> irradiance_lx;
  float view = 0.0F;

  Received& operator+=(const Received& other) {
    irradiance_lx += other.irradiance_lx;
    view += other.view;
    return *this;
  }
  friend Received operator*(float factor, const Received& received) {
    return {factor * received.irradiance_lx, factor * received.view};
  }
};
template <int K>
using SixReceived = std::array<Received<K>, 6>;

/// What a receiver collects: an element in `own`, a cluster by direction too, at the place that it is given.
template <int K>
struct Incoming {
  Received<K> own;
  std::array<Received<K>, 2> ofChildren;  ///< an element's, where it has them: what they do not share
  SixReceived<K>* six = nullptr;
};

/// The radiosity that a step sends, pulled up to the root, and the scalars that the oracle looks at.
template <int K>
struct Unshot {
  std::vector<Columns<K>> radiosity_lm_m2;       ///< #nodes: means
  std::vector<Six<K>> byDirection_lm;            ///< #trunk: power times cosine, of clusters
  std::vector<float> strength, lowest, highest;  ///< #nodes: of the strongest kind of light [lm/m²]

  void resize(std::size_t nodes) {
    radiosity_lm_m2.resize(nodes);
    strength.resize(nodes);
    lowest.resize(nodes);
    highest.resize(nodes);
  }
};

/// What a task has done, for the statistics.
struct Tally {
  std::uint64_t links = 0, reused = 0, rays = 0;
};

/// Answers of the oracle.
enum class Verdict { nothing, accept, weak, refineSender, refineReceiver };

/// An end of an interaction that sends: a node of the tree, the open sky, a portal of the domain, or a
/// luminaire.
using Sender = std::uint32_t;
inline constexpr Sender firstPortal = 0x80000000U;
inline constexpr Sender firstLamp = 0xc0000000U;
inline constexpr Sender openSky = 0xfffffffeU;

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
  Interactions(const SolvedLight<K>& light, std::int32_t domain, const Hierarchy& tree,
               const Unshot<K>& unshot, const TransportSettings& settings);

  /// lm that one interaction may err by, or move.
  float threshold_lm = 0.0F;
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
  [[nodiscard]] Verdict judgeSeen(const Receiver& receiver, const Candidate<K>& candidate) const;
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
  void receiveWeak(const Receiver& receiver, WeakSenders& weak, Incoming<K>& incoming, Tally& tally) const;

  /// Light from a portal, a luminaire or the open sky: judged, and on `accept` added at once.
  Verdict receiveFromOutside(const Receiver& receiver, Sender sender, Incoming<K>& incoming,
                             Tally& tally) const;

  /// Portals of the domain or the open sky, and luminaires.
  [[nodiscard]] std::vector<Sender> sendersOutside() const;
  /// Light that enters by the portals. [lm]
  [[nodiscard]] Columns<K> portalFlux_lm() const;
  /// Light of the domain's luminaires. [lm]
  [[nodiscard]] Columns<K> lampFlux_lm() const;

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
  void measureNear(const Receiver& receiver, NodeIndex sender, float apart, Link& link) const;
  [[nodiscard]] std::uint32_t raysOf(const Receiver& receiver, const Link& link) const;
  void layRays(const Receiver& receiver, const Candidate<K>& candidate, RayBatch& batch) const;
  void weighRays(const Receiver& receiver, Candidate<K>& candidate, const RayBatch& batch, std::size_t first,
                 std::size_t last) const;
  void shareLight(const Receiver& receiver, Candidate<K>& candidate, const RayBatch& batch, std::size_t first,
                  std::size_t last) const;
  [[nodiscard]] const Columns<K>& radiosityAt(NodeIndex sender, std::size_t spot) const;
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

  Verdict receiveFromSky(const Receiver& receiver, Incoming<K>& incoming, Tally& tally) const;
  Verdict receiveFromPortal(const Receiver& receiver, const PortalSender<K>& portal, Incoming<K>& incoming,
                            Tally& tally) const;

  Verdict receiveFromLamp(const Receiver& receiver, std::uint32_t lamp, Incoming<K>& incoming,
                          Tally& tally) const;

  const SolvedLight<K>& light_;
  const World& world_;
  const Hierarchy& tree_;
  const Unshot<K>& unshot_;
  const TransportSettings& settings_;
  std::int32_t domain_;
  bool isOpen_;
  float totalWeight_;
  std::vector<PortalSender<K>> portals_;
  std::vector<std::uint32_t> treeSideOf_;  // #sides of the building; noNode: another domain's
};

}  // namespace clerestory
