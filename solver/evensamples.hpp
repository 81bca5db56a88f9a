// SPDX-License-Identifier: GPL-3.0-or-later
// Means over even samples of a square that can be carried on, with what the samples themselves tell of the
// error.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "columns.hpp"

namespace clerestory {

/// A sample's place in the square, its weight and the strongest kind of light that it saw.
struct EvenSample {
  float u, v, weight, strength;
};

/// Variance of the weighted mean of even samples, from what differs within cells that hold two samples each
/// on average: the sequence is even, so what differs between cells is no error.
float varianceWithinCells(std::span<const EvenSample> samples, float mean, float weights);

/// The weighted mean of light over the points of a Sequence's first two dimensions.
template <int K>
class EvenSamples {
 public:
  /// A sample that sees nothing that counts (below a horizon, in a crack) has the weight 0.
  void add(float u, float v, float weight, const Columns<K>& light, float strength) {
    samples_.push_back({u, v, weight, strength});
    sum_ += weight * light;
    weights_ += weight;
    strengths_ += weight * strength;
  }

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(samples_.size()); }
  [[nodiscard]] Columns<K> mean() const { return weights_ > 0.0F ? (1.0F / weights_) * sum_ : Columns<K>{}; }
  [[nodiscard]] float strength() const { return weights_ > 0.0F ? strengths_ / weights_ : 0.0F; }
  /// Of the mean's strength.
  [[nodiscard]] float variance() const {
    return weights_ > 0.0F ? varianceWithinCells(samples_, strength(), weights_) : 0.0F;
  }

 private:
  std::vector<EvenSample> samples_;
  Columns<K> sum_;
  float weights_ = 0.0F, strengths_ = 0.0F;
};

}  // namespace clerestory
