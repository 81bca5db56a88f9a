// SPDX-License-Identifier: GPL-3.0-or-later
// The fixed-size cache of links between two shooting steps (paper, section 3.2).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "hierarchy.hpp"

namespace clerestory {

/// What is known of the way from a sender to a receiver: geometry and visibility, no radiosity. All of it is
/// kept as it is here, so that a link computed anew is the same to the bit as one from the cache.
struct Link {
  float formFactor = 0.0F;   ///< mean over the receiver, unoccluded; clusters: an estimate
  std::uint16_t passed = 0;  ///< a bit for each of its rays, 16 at most: it met nothing opaque
  std::uint16_t spread = 0;  ///< (max - min) / mean of the form factor over the receiver, in 1/16384

  static std::uint16_t packSpread(float value) {
    return static_cast<std::uint16_t>(std::min(value, 3.99F) * 16384.0F + 0.5F);
  }
  [[nodiscard]] float spreadOverReceiver() const { return static_cast<float>(spread) / 16384.0F; }
};

/// A link with its ends: 16 bytes.
struct CachedLink {
  NodeIndex receiver;
  NodeIndex sender;
  Link link;
};
static_assert(sizeof(CachedLink) == 16);

/// Links of the last step, the costliest that fit. Reading is free of locks; what a step wants to keep is
/// handed over between steps. Nothing that is computed depends on what the cache holds.
class LinkCache {
 public:
  explicit LinkCache(std::size_t bytes) : capacity_(bytes / sizeof(CachedLink)), counts_(stripes * classes) {}

  /// The links of a receiver, ordered by sender.
  [[nodiscard]] std::span<const CachedLink> ofReceiver(NodeIndex receiver) const {
    if (receiver + std::size_t{1} >= firstOfReceiver_.size()) return {};
    return std::span(links_).subspan(firstOfReceiver_[receiver],
                                     firstOfReceiver_[receiver + 1] - firstOfReceiver_[receiver]);
  }

  /// Counts a link of this step that carries `power`, and tells whether it is worth keeping: by the caching
  /// threshold (ε′ of the paper), while places are left. `key` spreads the counting over threads.
  [[nodiscard]] bool keeps(float power, std::uint64_t key);

  /// Replaces the content by the links of the step that has ended, and predicts the next caching threshold:
  /// light of the next step is taken to be `fade` times that of this one, link by link. `receivers`: one more
  /// than the largest among the links.
  void replace(std::vector<CachedLink> links, std::size_t receivers, float fade);

  [[nodiscard]] std::size_t size() const { return links_.size(); }

 private:
  static constexpr std::size_t stripes = 8;
  static constexpr std::size_t classes = 512;
  /// Eight classes an octave; class 0 holds all below 2^-32.
  static std::size_t classOf(float power);

  std::size_t capacity_;
  std::atomic<std::size_t> reserved_{0};
  std::vector<std::atomic<std::uint64_t>> counts_;  ///< of this step's links, by power
  std::vector<CachedLink> links_;                   ///< by receiver, then sender
  std::vector<std::uint32_t> firstOfReceiver_;
  float threshold_ = 0.0F;
};

}  // namespace clerestory
