// SPDX-License-Identifier: GPL-3.0-or-later
// Looks for the surfaces in the tiles of a picture.
#include "viewsamples.hpp"

#include <glm/geometric.hpp>

namespace clerestory {
namespace {

constexpr float aslantMost = 0.3F;  // cosine under which a surface's edge is looked at pixel by pixel

}  // namespace

template <int K>
ViewSamples<K>::ViewSamples(const World& world, const Looks<K>& looks)
    : world_(world),
      looks_(looks),
      columns_((looks.camera().width() + tileSide_px - 1) / tileSide_px),
      rows_((looks.camera().height() + tileSide_px - 1) / tileSide_px) {
  const std::size_t tiles = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  std::vector<std::vector<ViewSample<K>>> found(tiles);
  forEachIndex(tiles, 64, [&](std::size_t tile) { found[tile] = ofTile(tile); });
  first_.assign(1, 0);
  for (std::vector<ViewSample<K>>& some : found) {
    all.insert(all.end(), some.begin(), some.end());
    first_.push_back(all.size());
    some = {};
  }
}

// Of each surface that is seen in a tile, the point nearest to the middle of what is seen of it. Of one that
// is seen aslant and ends there, as a window's head, light may be another in each pixel: all points.
template <int K>
std::vector<ViewSample<K>> ViewSamples<K>::ofTile(std::size_t tile) const {
  std::vector<std::vector<ViewSample<K>>> surfaces;
  for (int p = 0; p < tileSide_px * tileSide_px; ++p) {
    const std::optional<ViewSample<K>> sample =
        atPixel(tileSide_px * columnOf(tile) + p % tileSide_px, tileSide_px * rowOf(tile) + p / tileSide_px);
    if (!sample) continue;
    const auto same = std::find_if(surfaces.begin(), surfaces.end(), [&](const auto& surface) {
      return isOneSurface(surface.front(), *sample);
    });
    (same == surfaces.end() ? surfaces.emplace_back() : *same).push_back(*sample);
  }
  std::vector<ViewSample<K>> samples;
  for (std::vector<ViewSample<K>>& surface : surfaces) {
    const glm::vec3 view = glm::normalize(surface.front().point - looks_.eye());
    const bool isWhole = surface.size() == static_cast<std::size_t>(tileSide_px * tileSide_px);
    if (!isWhole && std::abs(glm::dot(view, surface.front().normal)) < aslantMost) {
      for (ViewSample<K>& sample : surface) {
        sample.reach_px = 1.0F;
        samples.push_back(sample);
      }
      continue;
    }
    glm::vec2 sum(0.0F);
    for (const ViewSample<K>& sample : surface) sum += sample.pixel;
    const glm::vec2 middle = sum / static_cast<float>(surface.size());
    samples.push_back(*std::min_element(surface.begin(), surface.end(), [&](const auto& a, const auto& b) {
      return glm::distance(a.pixel, middle) < glm::distance(b.pixel, middle);
    }));
  }
  return samples;
}

/// The surface that is seen in the middle of a pixel, before any light is known.
template <int K>
std::optional<ViewSample<K>> ViewSamples<K>::atPixel(int x, int y) const {
  if (x >= looks_.camera().width() || y >= looks_.camera().height()) return std::nullopt;
  const Look look = looks_.atMiddle(x, y);
  if (!looks_.isLit(look.hit)) return std::nullopt;
  ViewSample<K> sample;
  sample.pixel = look.at;
  sample.point = looks_.pointOf(look);
  sample.normal = world_.normalOf(look.hit.side());
  sample.distance_m = look.hit.distance_m;
  sample.domain = world_.building.sideDomain[look.hit.side()];
  return sample;
}

#define CLERESTORY_INSTANTIATE(K) template class ViewSamples<K>;
CLERESTORY_STUDY_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
