// SPDX-License-Identifier: GPL-3.0-or-later
// Casts rays of view.
#include "looks.hpp"

#include <geometry/parallel.hpp>

namespace clerestory {

template <int K>
Looks<K>::Looks(const SolvedLight<K>& light, const ViewSettings& view)
    : light_(light), world_(light.world()), camera_(view), eye_(world_.local(view.eye_m)) {
  const auto width = static_cast<std::size_t>(camera_.width());
  middles_.resize(width * static_cast<std::size_t>(camera_.height()));
  forEachIndex(middles_.size(), 256, [&](std::size_t pixel) {
    middles_[pixel] =
        through({static_cast<float>(pixel % width) + 0.5F, static_cast<float>(pixel / width) + 0.5F}).hit;
  });
}

template <int K>
Look Looks<K>::through(const glm::vec2& at) const {
  const auto direction = camera_.direction(at.x, at.y);
  if (!direction) return {at, {}, false, {}};
  return {at, *direction, true, world_.rays.nearest(eye_, *direction, RayScene::Barrier::opaqueAndGlass)};
}

template <int K>
Look Looks<K>::atMiddle(int x, int y) const {
  const glm::vec2 at(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
  const auto direction = camera_.direction(at.x, at.y);
  if (!direction) return {at, {}, false, {}};
  return {at, *direction, true,
          middles_[static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width()) +
                   static_cast<std::size_t>(x)]};
}

template <int K>
bool Looks<K>::isLit(const RayScene::Hit& hit) const {
  if (!hit || world_.materialOf(hit.piece).glazing) return false;
  const std::int32_t domain = world_.building.sideDomain[hit.side()];
  return domain >= 0 && light_.of(domain) != nullptr;
}

#define CLERESTORY_INSTANTIATE(K) template class Looks<K>;
CLERESTORY_STUDY_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
