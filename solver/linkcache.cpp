// SPDX-License-Identifier: GPL-3.0-or-later
// Keeps the costliest links of a step for the next one.
#include "linkcache.hpp"

#include <algorithm>
#include <cmath>

namespace clerestory {

std::span<const CachedLink> LinkCache::ofReceiver(NodeIndex receiver) const {
  const auto [first, last] =
      std::equal_range(links_.begin(), links_.end(), CachedLink{receiver, 0, {}},
                       [](const CachedLink& a, const CachedLink& b) { return a.receiver < b.receiver; });
  return {first, last};
}

std::size_t LinkCache::powerClass(float power) {
  if (!(power > 0x1p-32F)) return 0;
  const float octave = (std::log2(power) + 32.0F) * 8.0F;
  return std::min(static_cast<std::size_t>(octave), powerClasses - 1);
}

void LinkCache::replace(std::vector<CachedLink> links, const std::vector<std::uint64_t>& powers, float fade) {
  std::sort(links.begin(), links.end(), [](const CachedLink& a, const CachedLink& b) {
    return a.receiver != b.receiver ? a.receiver < b.receiver : a.sender < b.sender;
  });
  links_ = std::move(links);
  reserved_.store(0, std::memory_order_relaxed);

  // The lowest power above which the links of this step would have fitted, faded to the next step's light.
  std::uint64_t above = 0;
  std::size_t lowest = powerClasses;
  while (lowest > 0 && above + powers[lowest - 1] <= capacity_) above += powers[--lowest];
  threshold_ = lowest == 0 ? 0.0F : fade * std::exp2(static_cast<float>(lowest) / 8.0F - 32.0F);
}

}  // namespace clerestory
