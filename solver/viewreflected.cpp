// SPDX-License-Identifier: GPL-3.0-or-later
// Finds where records are wanting, and for each sample those that hold there.
#include "viewreflected.hpp"

#include <glm/geometric.hpp>

#include <limits>

#include <geometry/sampling.hpp>

#include "irradiancecache.hpp"

namespace clerestory {
namespace {

constexpr int blockSide = 8;                                       // tiles that look for records together
constexpr float recordReachLeast = 3.0F, recordReachMost = 12.0F;  // in tiles
constexpr float coveredFrom = 0.3F;                                // sum of records' weights
constexpr int recordStride = 16;                                   // tiles between the first

/// The records of a picture, kept by blocks of tiles.
template <int K>
class Records {
 public:
  explicit Records(const ViewSamples<K>& samples) : samples_(samples) { makeBlocks(); }

  /// Gathers one at each of these samples.
  void add(const SolvedLight<K>& light, std::uint32_t raysMost, const std::vector<std::size_t>& places) {
    const std::size_t before = records_.size();
    records_.resize(before + places.size());
    forEachIndex(places.size(), 16, [&](std::size_t i) {
      const ViewSample<K>& sample = samples_.all[places[i]];
      records_[before + i] = irradianceRecord(light, sample.domain, sample.point, sample.normal,
                                              reachOf(sample), raysMost, mixKeys(0x71c, places[i]));
    });
    forEachIndex(blocks_.size(), 16, [&](std::size_t b) {
      Block& block = blocks_[b];
      if (block.radius_m < 0.0F) return;
      for (std::size_t r = before; r < records_.size(); ++r) {
        const float reach_m = block.radius_m + records_[r].radius_m;
        const glm::vec3 way = records_[r].point - block.centre;
        if (glm::dot(way, way) < reach_m * reach_m) block.records.push_back(static_cast<std::uint32_t>(r));
      }
    });
  }

  [[nodiscard]] bool cover(std::size_t tile, const ViewSample<K>& sample) const {
    float weights = 0.0F;
    for (const std::uint32_t r : blockOf(tile).records) {
      weights += records_[r].weightAt(sample.domain, sample.point, sample.normal);
      if (weights >= coveredFrom) return true;
    }
    return false;
  }

  /// Reflected light of a sample that they cover. [lx]
  [[nodiscard]] Columns<K> at(std::size_t tile, const ViewSample<K>& sample) const {
    IrradianceFit<K> fit(sample.normal);
    for (const std::uint32_t r : blockOf(tile).records) {
      const IrradianceRecord<K>& record = records_[r];
      const float weight = record.weightAt(sample.domain, sample.point, sample.normal);
      if (weight > 0.0F) fit.add(weight, record.point - sample.point, record.radius_m, record.irradiance_lx);
    }
    return fit.value();
  }

 private:
  /// Tiles that look for records together.
  struct Block {
    glm::vec3 centre{0.0F};              ///< of a sphere that holds their samples
    float radius_m = -1.0F;              ///< negative without any
    std::vector<std::uint32_t> records;  ///< that may hold somewhere in it
  };

  [[nodiscard]] std::size_t blockAt(std::size_t tile) const {
    const auto columns = static_cast<std::size_t>((samples_.columns() + blockSide - 1) / blockSide);
    return static_cast<std::size_t>(samples_.rowOf(tile) / blockSide) * columns +
           static_cast<std::size_t>(samples_.columnOf(tile) / blockSide);
  }
  [[nodiscard]] const Block& blockOf(std::size_t tile) const { return blocks_[blockAt(tile)]; }

  void makeBlocks() {
    if (samples_.tiles() == 0) return;
    blocks_.resize(blockAt(samples_.tiles() - 1) + 1);
    std::vector<glm::vec3> low(blocks_.size(), glm::vec3(std::numeric_limits<float>::infinity()));
    std::vector<glm::vec3> high(blocks_.size(), glm::vec3(-std::numeric_limits<float>::infinity()));
    for (std::size_t tile = 0; tile < samples_.tiles(); ++tile) {
      const std::size_t b = blockAt(tile);
      for (const ViewSample<K>& sample : samples_.in(samples_.columnOf(tile), samples_.rowOf(tile))) {
        low[b] = glm::min(low[b], sample.point);
        high[b] = glm::max(high[b], sample.point);
      }
    }
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      if (low[b].x > high[b].x) continue;
      blocks_[b].radius_m = 0.5F * glm::distance(low[b], high[b]);
      blocks_[b].centre = 0.5F * (low[b] + high[b]);
    }
  }

  /// How far a record that is gathered at a sample may hold. Where samples are pixels, it is two of them.
  [[nodiscard]] RecordReach reachOf(const ViewSample<K>& sample) const {
    const float tile_m = samples_.tile_m(sample);
    const float least_m = sample.isOfPixel() ? 2.0F * samples_.pixel_m(sample) : recordReachLeast * tile_m;
    return {least_m, std::max(least_m, recordReachMost * tile_m)};
  }

  const ViewSamples<K>& samples_;
  std::vector<Block> blocks_;
  std::vector<IrradianceRecord<K>> records_;
};

}  // namespace

template <int K>
void gatherReflected(const SolvedLight<K>& light, std::uint32_t raysMost, ViewSamples<K>& samples) {
  Records<K> records(samples);
  const auto addWhere = [&](int stride, const auto& isAsked) {
    records.add(light, raysMost, samples.inLattice(stride, [&](std::size_t tile, std::size_t s) {
      return isAsked(samples.all[s]) && !records.cover(tile, samples.all[s]);
    }));
  };
  // Of samples that are pixels, those in the middles of tiles take part; then every other one, and the rest.
  const auto place = [](const ViewSample<K>& sample) { return glm::ivec2(sample.pixel); };
  for (int stride = recordStride; stride > 0; stride /= 2) {
    addWhere(stride, [&](const ViewSample<K>& sample) {
      return !sample.isOfPixel() ||
             (place(sample).x % tileSide_px == 1 && place(sample).y % tileSide_px == 1);
    });
  }
  addWhere(1, [&](const ViewSample<K>& sample) { return (place(sample).x + place(sample).y) % 2 == 0; });
  addWhere(1, [&](const ViewSample<K>&) { return true; });
  samples.forEach([&](std::size_t tile, std::size_t s) {
    samples.all[s].reflected_lx = records.at(tile, samples.all[s]);
  });
}

#define CLERESTORY_INSTANTIATE(K) \
  template void gatherReflected<K>(const SolvedLight<K>&, std::uint32_t, ViewSamples<K>&);
CLERESTORY_STUDY_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
