// SPDX-License-Identifier: GPL-3.0-or-later
// Casts rays of view.
#include "looks.hpp"

#include <algorithm>
#include <array>

#include <geometry/parallel.hpp>

namespace clerestory {

template <int K>
Looks<K>::Looks(const SolvedLight<K>& light, const ViewSettings& view)
    : light_(light), world_(light.world()), camera_(view), eye_(world_.local(view.eye_m)) {
  const auto width = static_cast<std::size_t>(camera_.width());
  middles_.resize(width * static_cast<std::size_t>(camera_.height()));
  forEachIndex(static_cast<std::size_t>(camera_.height()), 1, [&](std::size_t y) {
    const std::vector<Look> looks = row({0.5F, static_cast<float>(y) + 0.5F}, width);
    for (std::size_t x = 0; x < width; ++x) middles_[y * width + x] = looks[x].hit;
  });
}

template <int K>
std::vector<Look> Looks<K>::row(const glm::vec2& first, std::size_t count) const {
  std::vector<glm::vec2> at(count, first);
  for (std::size_t i = 0; i < count; ++i) at[i].x += static_cast<float>(i);
  std::vector<Look> looks(count);
  through(at, looks);
  return looks;
}

template <int K>
void Looks<K>::through(std::span<const glm::vec2> at, std::span<Look> looks) const {
  constexpr std::size_t together = 64;
  std::array<RayScene::Ray, together> rays;
  std::array<RayScene::Hit, together> hits;
  for (std::size_t first = 0; first < at.size(); first += together) {
    const std::span<Look> some = looks.subspan(first, std::min(together, at.size() - first));
    std::size_t count = 0;
    for (std::size_t i = 0; i < some.size(); ++i) {
      const auto direction = camera_.direction(at[first + i].x, at[first + i].y);
      some[i] = {at[first + i], direction.value_or(glm::vec3(0.0F)), direction.has_value(), {}};
      if (direction) rays[count++] = {eye_, *direction};
    }
    world_.rays.nearest(std::span(rays).first(count), RayScene::Barrier::opaqueAndGlass, hits);
    const RayScene::Hit* next = hits.data();
    for (Look& look : some) {
      if (look.isInPicture) look.hit = *next++;
    }
  }
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
