// SPDX-License-Identifier: GPL-3.0-or-later
// One interaction of a shooting step: the oracle, form factor and visibility of a link, and the light it
// moves.
#pragma once

#include <glm/geometric.hpp>

#include <array>
#include <cstdint>
#include <vector>

#include "direct.hpp"
#include "linkcache.hpp"
#include "radiosity.hpp"

namespace clerestory {

/// What decides how finely light is transported.
struct TransportSettings {
  float epsilon = 2e-6F;                ///< share of the domain's first light that one interaction may err by
  float elementMin_m = 0.06F;           ///< elements of a smaller radius are not divided
  DirectSamples direct{60.0F, 3.0F};    ///< of each portal, at each point of an element that is asked
  std::uint32_t portalFluxRays = 4096;  ///< of each pane, for the power that enters
  std::uint32_t skyRays = 256;          ///< of an element that sees the sky without glass
  double endShare = 1e-3;  ///< unshot light, as a share of the mean irradiance, that ends the steps
  int stepsMax = 200;
  std::size_t memoryBytes = std::size_t{4} << 30;
};

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

/// The unshot light of a tree's nodes, pulled up to its root, and the scalars that the oracle looks at.
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

/// An element as a receiver: a node of the tree or one grown in this step.
struct Element {
  ElementShape shape;
  NodeIndex node = noNode;
  std::uint32_t grown = noNode;
  std::uint32_t treeSide;
};

/// What a task has done, for the statistics.
struct Tally {
  std::uint64_t links = 0, reused = 0, rays = 0;
};

/// ORACLE of the paper's TRANSPORT-LIGHT, and what it answers about.
enum class Verdict { nothing, accept, refineSender, refineReceiver };

/// Interactions within one tree. Reads the tree and its unshot light, writes nothing but what it is handed.
template <int K>
class Interactions {
 public:
  /// Ends of an interaction that send and are no nodes: all portals, or the open sky.
  static constexpr NodeIndex portals = noNode - 1;
  static constexpr NodeIndex openSky = noNode - 2;

  Interactions(const SolvedLight<K>& light, std::int32_t domain, const Hierarchy& tree,
               const Unshot<K>& unshot, const TransportSettings& settings);

  /// lm that one interaction may err by.
  float threshold_lm = 0.0F;
  /// Whether receivers may be divided further.
  bool mayGrow = true;

  /// Judges an interaction; on `accept`, `link` is what is known of it.
  Verdict oracleForCluster(NodeIndex receiver, NodeIndex sender, Link& link, Tally& tally) const;
  Verdict oracleForElement(const Element& receiver, NodeIndex sender, std::span<const CachedLink> cached,
                           Link& link, Tally& tally) const;

  /// Adds the light that an accepted link brings to a receiver.
  void addToElement(Received<K>& next, const Element& receiver, NodeIndex sender, const Link& link) const;
  void addToCluster(SixReceived<K>& next, NodeIndex receiver, NodeIndex sender, const Link& link) const;

  /// Light from the portals or the open sky: judged, and on `accept` added at once.
  Verdict receiveFromOutside(const Element& receiver, NodeIndex sender, Columns<K>& next, Tally& tally) const;

  /// Light that enters by the portals, by many directions over each pane. [lm]
  [[nodiscard]] Columns<K> portalFlux() const;

 private:
  /// What the oracle sees of a sender.
  struct Sight {
    float strength;  ///< unshot light, strongest kind [lm/m²]
    float distance_m;
    float bound;  ///< of the form factor
  };
  struct Spot {
    glm::vec3 point, normal;
  };

  [[nodiscard]] bool isBehind(NodeIndex node, const glm::vec3& onPlane, const glm::vec3& normal) const;
  [[nodiscard]] bool canDivide(const Element& receiver) const;
  [[nodiscard]] Sight look(const glm::vec3& centre, float radius_m, NodeIndex sender) const;
  [[nodiscard]] Link elementLink(const Element& receiver, NodeIndex sender, Tally& tally) const;
  [[nodiscard]] float sampledVisibility(std::uint64_t key, std::uint32_t count, NodeIndex receiverNode,
                                        const Element* receiver, NodeIndex sender, Tally& tally) const;
  [[nodiscard]] Spot spotOn(NodeIndex node, float u, float v, float choice) const;
  [[nodiscard]] float heldSquare(NodeIndex sender, float distance_m, float receiverRadius_m) const;
  [[nodiscard]] Received<K> sentAlong(NodeIndex cluster, const glm::vec3& direction) const;
  [[nodiscard]] float isotropicShare(NodeIndex sender, float receiverRadius_m) const;
  Verdict receiveFromSky(const Element& receiver, Columns<K>& next, Tally& tally) const;
  Verdict receiveFromPortals(const Element& receiver, Columns<K>& next, Tally& tally) const;

  const SolvedLight<K>& light_;
  const World& world_;
  std::int32_t domain_;
  const Hierarchy& tree_;
  const Unshot<K>& unshot_;
  const TransportSettings& settings_;
  float totalWeight_;
};

}  // namespace clerestory
