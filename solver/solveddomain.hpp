// SPDX-License-Identifier: GPL-3.0-or-later
// A domain while it is solved and after: its radiosity, where its light went, what each step took.
#pragma once

#include <chrono>
#include <vector>

#include <solver/solution.hpp>

#include "radiosity.hpp"
#include "transport.hpp"

namespace clerestory {

template <int K>
struct SolvedDomain {
  std::int32_t domain;
  Radiosity<K> radiosity;
  std::vector<IterationStatistics> statistics;
  EnergyBalance balance;
  float threshold_lm = 0.0F;  ///< weighted power that one interaction was allowed to err by
  std::vector<Diagnosis> diagnoses;

  /// Dark as yet but for the sun's beam: what its sides reflect and emit is known.
  SolvedDomain(const World& world, std::int32_t domain, Hierarchy tree,
               const TransportSettings& settings = {});

  /// What leaves send before anything is exchanged: their emission, and the sun's beam as they reflect it.
  /// #nodes
  [[nodiscard]] std::vector<Columns<K>> emission() const;
  /// Power of the emission and of the beam that is not reflected. [lm]
  [[nodiscard]] double firstPower_lm() const;
  /// Gives nodes made since the tree had `before` of them the sunlight of their parents.
  void inheritSunlight(std::size_t before);
  /// What leaves send of the irradiances that they hold. #nodes
  [[nodiscard]] Columns<K> reflected(NodeIndex leaf, const Columns<K>& irradiance_lx) const {
    return radiosity.reflectance[radiosity.tree.treeSide[leaf]] * irradiance_lx;
  }
  /// Mean over their area of what sides reflect, but of the sun's beam, whose place is exact: what a place in
  /// a closed domain receives of that, on average.
  [[nodiscard]] Columns<K> meanReflected_lm_m2() const;
  /// Mean reflectance of all sides, glass as it reflects inwards.
  [[nodiscard]] Columns<K> meanReflectance() const;

  /// Whether a leaf is a clear pane outdoors: what it mirrors of sky and sun has reached its receivers along
  /// the mirrored ray, and is not to be sent out evenly as well.
  [[nodiscard]] bool isMirror(NodeIndex leaf) const;
  /// What a leaf sends of the first step's light in the next one. A clear pane has mirrored some to its
  /// receivers already: outdoors all of it, in a room what came from the patches of sun.
  [[nodiscard]] Columns<K> sentOn(NodeIndex leaf, const Columns<K>& irradiance_lx) const;

  void addStatistics(const Tally& tally, std::size_t cached, float unshotPower_lm, double seconds);
  /// Adds up what was absorbed and what left through glass.
  void closeBalance();

 private:
  const World& world_;
  std::vector<std::uint8_t> mirrorsPatches_;  // #sides of the tree: panes that are portals of this room
};

/// Gives nodes made since the tree had `before` of them the values of their parents.
template <class Value>
void inheritValues(const Hierarchy& tree, std::size_t before, std::vector<Value>& values) {
  values.resize(tree.size());
  for (NodeIndex node = 0; node < tree.size(); ++node) {
    const NodeIndex first = tree.firstChild[node];
    if (first == noNode || first < before) continue;
    values[first] = values[first + 1] = values[node];
  }
}

/// Seconds since it was made.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace clerestory
