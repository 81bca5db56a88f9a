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

/// What is known of the way from a sender to a receiver: geometry and visibility, no radiosity. Visibility
/// and spread are kept in 16 bits, so that a link computed anew is the same to the bit as one from the cache.
struct Link {
  float formFactor = 0.0F;       ///< mean over the receiver, unoccluded; clusters: an estimate
  std::uint16_t visibility = 0;  ///< of 65535
  std::uint16_t spread = 0;      ///< (max - min) / mean of the form factor over the receiver, in 1/16384

  static std::uint16_t packVisibility(float value) {
    return static_cast<std::uint16_t>(value * 65535.0F + 0.5F);
  }
  static std::uint16_t packSpread(float value) {
    return static_cast<std::uint16_t>(std::min(value, 3.99F) * 16384.0F + 0.5F);
  }
  [[nodiscard]] float visible() const { return static_cast<float>(visibility) / 65535.0F; }
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
  explicit LinkCache(std::size_t bytes) : capacity_(bytes / sizeof(CachedLink)) {}

  /// The links of a receiver, ordered by sender.
  [[nodiscard]] std::span<const CachedLink> ofReceiver(NodeIndex receiver) const;

  /// Whether a link that carries `power` is worth keeping (its caching threshold, ε′ of the paper).
  [[nodiscard]] bool wants(float power) const { return power >= threshold_; }
  /// Takes one of the places left in this step; false where none is left.
  [[nodiscard]] bool reserve() {
    return capacity_ > 0 && reserved_.fetch_add(1, std::memory_order_relaxed) < capacity_;
  }

  /// Replaces the content by the links of the step that has ended, and predicts the next caching threshold:
  /// light of the next step is taken to be `fade` times that of this one, link by link. `powers` counts this
  /// step's links by power, see powerClass.
  void replace(std::vector<CachedLink> links, const std::vector<std::uint64_t>& powers, float fade);

  [[nodiscard]] std::size_t size() const { return links_.size(); }

  static constexpr std::size_t powerClasses = 512;
  /// Eight classes an octave; class 0 holds all below 2^-32.
  static std::size_t powerClass(float power);

 private:
  std::size_t capacity_;
  std::atomic<std::size_t> reserved_{0};
  std::vector<CachedLink> links_;  // by receiver, then sender
  float threshold_ = 0.0F;
};

}  // namespace clerestory
