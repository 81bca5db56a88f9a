// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses where direct light is measured, and filters what was measured along surfaces.
#include "viewdirect.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <limits>
#include <map>

#include <geometry/sampling.hpp>

#include "directfield.hpp"

namespace clerestory {
namespace {

constexpr int directStride = 4;           // tiles between points that are measured anyway
constexpr std::size_t directsLeast = 3;   // measured around a point, to judge by
constexpr float furtherDirect = 8.0F;     // times as many rays where there is much noise
constexpr float raysOfSure = 2.0F;        // times as many as were asked for: no more were needed
constexpr float unevenMost = 0.02F;       // of all light, between points that another lies between
constexpr float noiseMost = 3.0F;         // deviations that light may be off without being an outlier
constexpr float deviationOfGrain = 0.5F;  // of what one ray brings by chance: it meets the thing or not
constexpr float apartMost = 8.0F;         // above it a weight of e^-apart is next to nothing
constexpr int smoothingSteps = 4;         // each doubles the reach: 30 tiles after four

template <int K>
class DirectGather {
 public:
  DirectGather(const SolvedLight<K>& light, const DirectMeasure& measure, ViewSamples<K>& samples)
      : layout_(light.world().layout), settings_(measure), samples_(samples) {
    firstFormFactor_.assign(1, 0);
    for (const ViewSample<K>& sample : samples_.all) {
      const auto field = fields_.try_emplace(sample.domain, light, sample.domain).first;
      firstFormFactor_.push_back(firstFormFactor_.back() + field->second.shiners());
    }
    formFactors_.resize(firstFormFactor_.back());
    forEachIndex(samples_.all.size(), 64, [&](std::size_t s) {
      ViewSample<K>& own = samples_.all[s];
      own.unhidden_lx =
          fields_.at(own.domain).unhidden(own.point + rayOffset_m * own.normal, own.normal, formFactorsOf(s));
    });
  }

  /// Measures in a coarse lattice of tiles and in finer ones where light is uneven or its shadows begin;
  /// elsewhere the share that arrives lies between.
  void measureUneven() {
    for (int stride = directStride; stride > 0; stride /= 2) {
      const std::vector<std::size_t> needed =
          samples_.inLattice(stride, [&](std::size_t tile, std::size_t s) {
            const ViewSample<K>& own = samples_.all[s];
            return !own.isMeasured && (stride == directStride || !liesBetween(tile, own, stride));
          });
      forEachIndex(needed.size(), 64, [&](std::size_t i) { measure(needed[i], settings_.rays); });
    }
    samples_.forEach([&](std::size_t tile, std::size_t s) {
      if (!samples_.all[s].isMeasured) interpolate(tile, samples_.all[s]);
    });
  }

  /// What a sample's own rays tell of its noise is noise itself, and nothing where they happen to agree: the
  /// mean variance of the samples around it is taken instead.
  void evenDeviations() {
    samples_.changeAll([&](ViewSample<K>& result, std::size_t tile, std::size_t s) {
      float variance = 0.0F;
      float count = 0.0F;
      samples_.onSurface(samples_.all[s], tile, 1, 1, [&](const ViewSample<K>& other) {
        variance += other.deviation_lx * other.deviation_lx;
        count += 1.0F;
      });
      result.deviation_lx = std::sqrt(variance / count);
    });
  }

  /// Measures again with more rays where samples around tell of noise that a sample's own few rays may have
  /// missed altogether, as a bright sliver at the edge of what a pane shows.
  void measureNoisyAgain() {
    forEachIndex(samples_.all.size(), 64, [&](std::size_t s) {
      ViewSample<K>& own = samples_.all[s];
      const float allowed_lx = settings_.deviationMost * layout_.strength(own.irradiance_lx());
      if (own.seemsSure && own.deviation_lx > allowed_lx) measure(s, furtherDirect * settings_.rays);
    });
  }

  /// A sample that is darker or brighter than all around it is a point in a seam, or noise: it is taken into
  /// their range. What is drawn as a line, as a shadow's edge is, has its like beside it.
  void takeOutliersIn() {
    constexpr int fewest = 5;
    samples_.changeAll([&](ViewSample<K>& result, std::size_t tile, std::size_t s) {
      const ViewSample<K>& own = samples_.all[s];
      float low_lx = std::numeric_limits<float>::infinity();
      float high_lx = 0.0F;
      int others = 0;
      samples_.onSurface(own, tile, 1, 1, [&](const ViewSample<K>& other) {
        if (&other == &own) return;
        const float lx = layout_.strength(other.share * own.unhidden_lx);
        low_lx = std::min(low_lx, lx);
        high_lx = std::max(high_lx, lx);
        ++others;
      });
      const float own_lx = layout_.strength(result.share * result.unhidden_lx);
      low_lx = std::max(low_lx - noiseMost * own.deviation_lx, 0.0F);
      high_lx += noiseMost * own.deviation_lx;
      if (others < fewest || own_lx <= 0.0F || (own_lx >= low_lx && own_lx <= high_lx)) return;
      result.share = (std::clamp(own_lx, low_lx, high_lx) / own_lx) * result.share;
    });
  }

  /// Where a bright strip comes into view, it is chance whether one of a sample's rays meets it. A sample of
  /// which none did knows nothing of that, and is told by those around it.
  void addGrain() {
    samples_.changeAll([&](ViewSample<K>& result, std::size_t tile, std::size_t s) {
      float grain_lx = 0.0F;
      samples_.onSurface(samples_.all[s], tile, 1, 1,
                         [&](const ViewSample<K>& other) { grain_lx = std::max(grain_lx, other.grain_lx); });
      result.deviation_lx = std::hypot(result.deviation_lx, deviationOfGrain * grain_lx);
    });
  }

  /// An à-trous filter along surfaces. Shadows keep their edges, where light changes by more than its noise.
  void smooth() {
    std::vector<Lit> lit(samples_.all.size());
    std::vector<Lit> smoothed(lit.size());
    for (std::size_t s = 0; s < lit.size(); ++s) {
      const ViewSample<K>& own = samples_.all[s];
      lit[s] = litBy(own, own.deviation_lx, own.share * own.unhidden_lx);
    }
    for (int step = 0; step < smoothingSteps; ++step) {
      samples_.forEach([&](std::size_t tile, std::size_t s) {
        const float thickness_m = 0.004F * samples_.all[s].distance_m;
        smoothed[s] =
            lit[s].deviation_lx > 0.0F ? smoothedAt(lit, lit[s], thickness_m, tile, 1 << step) : lit[s];
      });
      std::swap(lit, smoothed);
    }
    for (std::size_t s = 0; s < lit.size(); ++s) {
      ViewSample<K>& own = samples_.all[s];
      for (int c = 0; c < K; ++c)
        own.share[c] = own.unhidden_lx[c] > 0.0F ? lit[s].direct_lx[c] / own.unhidden_lx[c] : 0.0F;
    }
  }

 private:
  /// What smoothing looks at of a sample.
  struct Lit {
    glm::vec3 point, normal;
    std::int32_t domain;
    float deviation_lx;
    Columns<K> direct_lx;
    glm::vec3 kinds_lx;  ///< illuminance by each kind of light, of which one tells how far two are apart
  };

  /// A sample, or what smoothing has made of it.
  [[nodiscard]] Lit litBy(const auto& of, float deviation_lx, const Columns<K>& direct_lx) const {
    const auto kind = [&](int column) {
      return static_cast<float>(luminanceOf(layout_.colourOf(direct_lx, column)));
    };
    return {of.point,
            of.normal,
            of.domain,
            deviation_lx,
            direct_lx,
            glm::vec3(kind(layout_.skyColumn()), kind(layout_.sunColumn()), kind(layout_.electricColumn()))};
  }

  [[nodiscard]] std::span<float> formFactorsOf(std::size_t s) {
    return std::span(formFactors_)
        .subspan(firstFormFactor_[s], firstFormFactor_[s + 1] - firstFormFactor_[s]);
  }

  void measure(std::size_t s, float rays) {
    ViewSample<K>& own = samples_.all[s];
    const auto [direct, grain_lx] =
        fields_.at(own.domain)
            .light(own.point + rayOffset_m * own.normal, own.normal, formFactorsOf(s), rays,
                   settings_.deviationMost, layout_.strength(own.reflected_lx), mixKeys(0x71e, s));
    for (int c = 0; c < K; ++c)
      own.share[c] = own.unhidden_lx[c] > 0.0F ? direct.illuminance_lx[c] / own.unhidden_lx[c] : 0.0F;
    own.deviation_lx = direct.deviation_lx;
    own.grain_lx = grain_lx;
    own.isMeasured = true;
    own.seemsSure = static_cast<float>(direct.rays) < raysOfSure * rays;
  }

  /// Whether the direct light of a sample can be told from those measured around it in the lattice of twice
  /// the `stride`: they agree, and nothing touches its surface there, from where a shadow might begin.
  [[nodiscard]] bool liesBetween(std::size_t tile, const ViewSample<K>& own, int stride) const {
    if (own.isOfPixel() || (stride == 1 && isAtContact(tile, own))) return false;
    for (const int reach : {2 * stride, 4 * stride}) {
      Columns<K> low;
      Columns<K> high;
      float deviation_lx = 0.0F;
      std::size_t count = 0;
      samples_.onSurface(own, tile, reach, 2 * stride, [&](const ViewSample<K>& other) {
        if (!other.isMeasured) return;
        for (int c = 0; c < K; ++c) {
          low[c] = count > 0 ? std::min(low[c], other.share[c]) : other.share[c];
          high[c] = count > 0 ? std::max(high[c], other.share[c]) : other.share[c];
        }
        deviation_lx = std::max(deviation_lx, other.deviation_lx);
        ++count;
      });
      if (count < directsLeast) continue;
      const float all_lx = layout_.strength(high * own.unhidden_lx + own.reflected_lx);
      return layout_.strength((high - low) * own.unhidden_lx) <= unevenMost * all_lx + 2.0F * deviation_lx;
    }
    return false;
  }

  [[nodiscard]] bool isAtContact(std::size_t tile, const ViewSample<K>& own) const {
    const float near_m = 2.0F * samples_.tile_m(own);
    const int column = samples_.columnOf(tile);
    const int row = samples_.rowOf(tile);
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, samples_.rows() - 1); ++y) {
      for (int x = std::max(column - 1, 0); x <= std::min(column + 1, samples_.columns() - 1); ++x) {
        for (const ViewSample<K>& other : samples_.in(x, y)) {
          if (glm::distance(own.point, other.point) < near_m && !isOneSurface(own, other)) return true;
        }
      }
    }
    return false;
  }

  void interpolate(std::size_t tile, ViewSample<K>& own) const {
    for (int reach = 2; reach <= 4 * directStride; reach *= 2) {
      Columns<K> sum;
      float weights = 0.0F;
      float variance = 0.0F;
      const float reach_px = static_cast<float>(tileSide_px * (reach + 1));
      samples_.onSurface(own, tile, reach, 1, [&](const ViewSample<K>& other) {
        if (!other.isMeasured) return;
        const float weight = std::max(1.0F - std::abs(own.pixel.x - other.pixel.x) / reach_px, 0.01F) *
                             std::max(1.0F - std::abs(own.pixel.y - other.pixel.y) / reach_px, 0.01F);
        sum += weight * other.share;
        weights += weight;
        variance += weight * other.deviation_lx * other.deviation_lx;
      });
      if (weights <= 0.0F) continue;
      own.share = (1.0F / weights) * sum;
      own.deviation_lx = std::sqrt(variance / weights);
      return;
    }
  }

  /// `thickness_m`: how far off its plane a surface still is the same.
  [[nodiscard]] Lit smoothedAt(const std::vector<Lit>& lit, const Lit& own, float thickness_m,
                               std::size_t tile, int reach) const {
    constexpr float kernel[3] = {0.375F, 0.25F, 0.0625F};
    Columns<K> sum;
    float weights = 0.0F;
    float variance = 0.0F;
    const auto add = [&](const Lit& other, float nearness) {
      const float facing = glm::dot(own.normal, other.normal);
      if (facing < 0.9F || other.domain != own.domain) return;
      const float offPlane = std::abs(glm::dot(other.point - own.point, own.normal)) / thickness_m;
      if (offPlane > 4.0F) return;
      const glm::vec3 apart_lx = glm::abs(other.kinds_lx - own.kinds_lx);
      const float step = std::max({apart_lx.x, apart_lx.y, apart_lx.z}) /
                         (3.0F * (own.deviation_lx + other.deviation_lx) + 1e-6F);
      const float apart = offPlane + 32.0F * (1.0F - facing) + step * step;
      if (apart > apartMost) return;
      const float weight = nearness * std::exp(-apart);
      sum += weight * other.direct_lx;
      weights += weight;
      variance += weight * weight * other.deviation_lx * other.deviation_lx;
    };
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) {
        const int x = samples_.columnOf(tile) + dx * reach;
        const int y = samples_.rowOf(tile) + dy * reach;
        if (x < 0 || y < 0 || x >= samples_.columns() || y >= samples_.rows()) continue;
        const std::size_t there = samples_.tileAt(x, y);
        for (std::size_t s = samples_.firstOf(there); s < samples_.firstOf(there + 1); ++s)
          add(lit[s], kernel[std::abs(dx)] * kernel[std::abs(dy)]);
      }
    }
    return litBy(own, std::sqrt(variance) / weights, (1.0F / weights) * sum);
  }

  const ColumnLayout& layout_;
  DirectMeasure settings_;
  ViewSamples<K>& samples_;
  std::map<std::int32_t, DirectField<K>> fields_;  // by domain
  std::vector<float> formFactors_;                 // of each sample, to all that shines in its domain
  std::vector<std::size_t> firstFormFactor_;       // of a sample, and one past the last
};

}  // namespace

template <int K>
void gatherDirect(const SolvedLight<K>& light, const DirectMeasure& measure, ViewSamples<K>& samples) {
  DirectGather<K> gather(light, measure, samples);
  gather.measureUneven();
  gather.evenDeviations();
  gather.measureNoisyAgain();
  gather.takeOutliersIn();
  gather.addGrain();
  gather.smooth();
}

#define CLERESTORY_INSTANTIATE(K) \
  template void gatherDirect<K>(const SolvedLight<K>&, const DirectMeasure&, ViewSamples<K>&);
CLERESTORY_STUDY_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
