// SPDX-License-Identifier: GPL-3.0-or-later
// What the interactions of a step read and hand on: settings, the light sent and received, and verdicts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "columns.hpp"

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

inline constexpr float linearDeviation = 0.29F;  ///< 1 / sqrt(12): rms of a linear ramp, of its whole rise
/// Of what rays bring together, in thresholds of an interaction: noise averages over elements. Calibrated
/// with the oracle on the furnished office (docs/validation.md).
inline constexpr float rayNoise = 2.0F;

/// Answers of the oracle.
enum class Verdict { nothing, accept, weak, refineSender, refineReceiver };

/// An end of an interaction that sends: a node of the tree, the open sky, a portal of the domain, or a
/// luminaire.
using Sender = std::uint32_t;
inline constexpr Sender firstPortal = 0x80000000U;
inline constexpr Sender firstLamp = 0xc0000000U;
inline constexpr Sender openSky = 0xfffffffeU;

}  // namespace clerestory
