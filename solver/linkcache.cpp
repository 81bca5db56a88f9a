// SPDX-License-Identifier: GPL-3.0-or-later
// Keeps the costliest links of a step for the next one.
#include "linkcache.hpp"

#include <algorithm>
#include <cmath>

namespace clerestory {

std::size_t LinkCache::classOf(float power) {
  if (!(power > 0x1p-32F)) return 0;
  const float octave = (std::log2(power) + 32.0F) * 8.0F;
  return std::min(static_cast<std::size_t>(octave), classes - 1);
}

bool LinkCache::keeps(float power, std::uint64_t key) {
  counts_[(key % stripes) * classes + classOf(power)].fetch_add(1, std::memory_order_relaxed);
  if (power < threshold_ || reserved_.load(std::memory_order_relaxed) >= capacity_) return false;
  return reserved_.fetch_add(1, std::memory_order_relaxed) < capacity_;
}

void LinkCache::replace(std::vector<CachedLink> links, std::size_t receivers, float fade) {
  // By receiver in one pass of counting, and the few of each by sender.
  firstOfReceiver_.assign(receivers + 1, 0);
  for (const CachedLink& link : links) ++firstOfReceiver_[link.receiver + 1];
  for (std::size_t i = 0; i < receivers; ++i) firstOfReceiver_[i + 1] += firstOfReceiver_[i];
  std::vector<std::uint32_t> next(firstOfReceiver_.begin(), firstOfReceiver_.end() - 1);
  links_.resize(links.size());
  for (const CachedLink& link : links) links_[next[link.receiver]++] = link;
  for (std::size_t i = 0; i < receivers; ++i) {
    std::sort(links_.begin() + firstOfReceiver_[i], links_.begin() + firstOfReceiver_[i + 1],
              [](const CachedLink& a, const CachedLink& b) { return a.sender < b.sender; });
  }
  reserved_.store(0, std::memory_order_relaxed);

  // The lowest power above which the links of this step would have fitted, faded to the next step's light.
  std::uint64_t above = 0;
  std::size_t lowest = classes;
  while (lowest > 0) {
    std::uint64_t own = 0;
    for (std::size_t stripe = 0; stripe < stripes; ++stripe) own += counts_[stripe * classes + lowest - 1];
    if (above + own > capacity_) break;
    above += own;
    --lowest;
  }
  threshold_ = lowest == 0 ? 0.0F : fade * std::exp2(static_cast<float>(lowest) / 8.0F - 32.0F);
  for (std::atomic<std::uint64_t>& count : counts_) count.store(0, std::memory_order_relaxed);
}

}  // namespace clerestory
