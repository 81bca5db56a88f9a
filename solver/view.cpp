// SPDX-License-Identifier: GPL-3.0-or-later
// Final-gathered pictures: irradiance once for every surface in every tile of a few pixels, smoothed along
// surfaces, then shaded with several rays a pixel.
#include "view.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include <geometry/parallel.hpp>
#include <geometry/sampling.hpp>

#include "camera.hpp"

namespace clerestory {
namespace {

constexpr int tile = 3;  // pixels of a side
// Where the rays of a pixel pass through it.
constexpr std::array<glm::vec2, 4> spots = {
    {{0.375F, 0.125F}, {0.875F, 0.375F}, {0.125F, 0.625F}, {0.625F, 0.875F}}};
constexpr std::size_t furtherSide = 4;  // 16 further spots where the first differ
constexpr float contrastLeast = 1.1F;   // between the first, to look further
constexpr std::size_t spotsMost = spots.size() + furtherSide * furtherSide;
constexpr float aslantMost = 0.3F;     // cosine under which a surface's edge is looked at pixel by pixel
constexpr float noiseMost = 0.05F;     // of direct light, in what a surface gets, before it is gathered again
constexpr float furtherDirect = 8.0F;  // times as many samples then
constexpr int smoothingSteps = 5;      // each doubles the reach: 62 tiles after five

/// Spots in a lattice that is sheared, so that no two share a row or a column.
glm::vec2 furtherSpot(std::size_t i) {
  constexpr auto side = static_cast<float>(furtherSide);
  const auto column = static_cast<float>(i % furtherSide);
  const auto row = static_cast<float>(i / furtherSide);
  return {(column + (row + 0.5F) / side) / side, (row + (column + 0.5F) / side) / side};
}

GatherSettings shareOf(const GatherSettings& settings, std::size_t count) {
  const float share = 1.0F / static_cast<float>(count);
  return {{share * settings.direct.perFormFactor, share * settings.direct.least},
          settings.rays / static_cast<std::uint32_t>(count)};
}

/// A visible point whose irradiance is known.
template <int K>
struct Sample {
  glm::vec2 pixel{0.0F};  ///< where it is seen
  float reach_px = tile;  ///< how far from there others count more
  glm::vec3 point{0.0F}, normal{0.0F};
  float distance_m = 0.0F;
  std::int32_t domain = -1;
  Columns<K> direct_lx, reflected_lx;
  float directDeviation_lx = 0.0F, reflectedDeviation_lx = 0.0F;
};

template <int K>
class Picture {
 public:
  Picture(const SolvedLight<K>& light, const ViewSettings& view, const GatherSettings& settings)
      : light_(light),
        world_(light.world()),
        camera_(view),
        eye_(world_.local(view.eye_m)),
        settings_(settings),
        spotSettings_(shareOf(settings, spots.size() / 2)),
        columns_((camera_.width() + tile - 1) / tile),
        rows_((camera_.height() + tile - 1) / tile) {}

  LuminanceImage render() {
    domain_ = domainAt(world_, eye_);
    findSamples();
    forEachIndex(samples_.size(), 64, [&](std::size_t i) { gatherSample(i); });
    evenDeviations();
    gatherNoisyAgain();
    takeOutliersIn();
    smooth();
    LuminanceImage image{camera_.width(), camera_.height(), {}, {}};
    image.pixels_cd_m2.resize(static_cast<std::size_t>(camera_.width()) *
                              static_cast<std::size_t>(camera_.height()));
    image.illuminance_lx.assign(image.pixels_cd_m2.size(), std::numeric_limits<float>::quiet_NaN());
    forEachIndex(image.pixels_cd_m2.size(), 256, [&](std::size_t i) { shade(i, image); });
    return image;
  }

 private:
  [[nodiscard]] std::span<const Sample<K>> samplesIn(int column, int row) const {
    const std::size_t at =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    return std::span(samples_).subspan(first_[at], first_[at + 1] - first_[at]);
  }

  /// Whether two points lie on one surface, or on facets that stand for a curved one.
  static bool isOneSurface(const Sample<K>& a, const Sample<K>& b) {
    return a.domain == b.domain && glm::dot(a.normal, b.normal) > 0.95F &&
           std::abs(glm::dot(a.point - b.point, a.normal)) < 0.004F * a.distance_m;
  }

  /// Of each surface that is seen in a tile, the point nearest to the middle of what is seen of it. Of one
  /// that is seen aslant and ends there, as a window's head, light may be another in each pixel: all points.
  [[nodiscard]] std::vector<Sample<K>> samplesOfTile(std::size_t i) const {
    const auto left = static_cast<float>(tile * static_cast<int>(i % static_cast<std::size_t>(columns_)));
    const auto top = static_cast<float>(tile * static_cast<int>(i / static_cast<std::size_t>(columns_)));
    std::vector<std::vector<Sample<K>>> surfaces;
    for (int p = 0; p < tile * tile; ++p) {
      const glm::vec2 pixel = {left + static_cast<float>(p % tile) + 0.5F,
                               top + static_cast<float>(p / tile) + 0.5F};
      const std::optional<Sample<K>> sample = sampleAt(pixel);
      if (!sample) continue;
      const auto same = std::find_if(surfaces.begin(), surfaces.end(), [&](const auto& surface) {
        return isOneSurface(surface.front(), *sample);
      });
      (same == surfaces.end() ? surfaces.emplace_back() : *same).push_back(*sample);
    }
    std::vector<Sample<K>> samples;
    for (std::vector<Sample<K>>& surface : surfaces) {
      const glm::vec3 view = glm::normalize(surface.front().point - eye_);
      const bool isWhole = surface.size() == static_cast<std::size_t>(tile * tile);
      if (!isWhole && std::abs(glm::dot(view, surface.front().normal)) < aslantMost) {
        for (Sample<K>& sample : surface) {
          sample.reach_px = 1.0F;
          samples.push_back(sample);
        }
        continue;
      }
      glm::vec2 sum(0.0F);
      for (const Sample<K>& sample : surface) sum += sample.pixel;
      const glm::vec2 middle = sum / static_cast<float>(surface.size());
      samples.push_back(
          *std::min_element(surface.begin(), surface.end(), [&](const Sample<K>& a, const Sample<K>& b) {
            return glm::distance(a.pixel, middle) < glm::distance(b.pixel, middle);
          }));
    }
    return samples;
  }

  /// The surface that is seen through a place of the picture, before any light is known.
  [[nodiscard]] std::optional<Sample<K>> sampleAt(const glm::vec2& pixel) const {
    const auto direction = camera_.direction(pixel.x, pixel.y);
    if (!direction) return std::nullopt;
    const auto hit = world_.rays.nearest(eye_, *direction, RayScene::Barrier::opaqueAndGlass);
    if (!hit || world_.materialOf(hit.piece).glazing) return std::nullopt;
    const std::int32_t domain = world_.building.sideDomain[hit.side()];
    if (domain < 0 || light_.of(domain) == nullptr) return std::nullopt;
    Sample<K> sample;
    sample.pixel = pixel;
    sample.point = eye_ + hit.distance_m * *direction;
    sample.normal = world_.normalOf(hit.side());
    sample.distance_m = hit.distance_m;
    sample.domain = domain;
    return sample;
  }

  void findSamples() {
    const std::size_t tiles = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    std::vector<std::vector<Sample<K>>> found(tiles);
    forEachIndex(tiles, 64, [&](std::size_t i) { found[i] = samplesOfTile(i); });
    first_.assign(1, 0);
    for (std::vector<Sample<K>>& some : found) {
      samples_.insert(samples_.end(), some.begin(), some.end());
      first_.push_back(samples_.size());
      some = {};
    }
  }

  void gatherSample(std::size_t i) {
    Sample<K>& own = samples_[i];
    const Gathered<K> arriving = gather(light_, own.domain, own.point + rayOffset_m * own.normal, own.normal,
                                        settings_, mixKeys(0x71c, i));
    own.direct_lx = arriving.direct_lx;
    own.reflected_lx = arriving.reflected_lx;
    own.directDeviation_lx = arriving.directDeviation_lx;
    own.reflectedDeviation_lx = arriving.reflectedDeviation_lx;
  }

  /// Calls `visit` for each sample on the surface of sample `s` in its tile and those around, itself too.
  template <class Visit>
  void aroundSample(std::size_t tileIndex, std::size_t s, const Visit& visit) const {
    const int column = static_cast<int>(tileIndex % static_cast<std::size_t>(columns_));
    const int row = static_cast<int>(tileIndex / static_cast<std::size_t>(columns_));
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows_ - 1); ++y) {
      for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns_ - 1); ++x) {
        for (const Sample<K>& other : samplesIn(x, y)) {
          if (isOneSurface(samples_[s], other)) visit(other);
        }
      }
    }
  }

  /// Makes each sample anew from those around it on its surface: `change(result, tile, sample's number)`.
  template <class Change>
  void changeAll(const Change& change) {
    std::vector<Sample<K>> changed = samples_;
    forEachIndex(first_.size() - 1, 256, [&](std::size_t i) {
      for (std::size_t s = first_[i]; s < first_[i + 1]; ++s) change(changed[s], i, s);
    });
    std::swap(samples_, changed);
  }

  /// What a sample's own rays tell of its noise is noise itself, and nothing where they happen to agree: the
  /// mean variance of the samples around it is taken instead.
  void evenDeviations() {
    changeAll([&](Sample<K>& result, std::size_t tileIndex, std::size_t s) {
      float direct = 0.0F;
      float reflected = 0.0F;
      float count = 0.0F;
      aroundSample(tileIndex, s, [&](const Sample<K>& other) {
        direct += other.directDeviation_lx * other.directDeviation_lx;
        reflected += other.reflectedDeviation_lx * other.reflectedDeviation_lx;
        count += 1.0F;
      });
      result.directDeviation_lx = std::sqrt(direct / count);
      result.reflectedDeviation_lx = std::sqrt(reflected / count);
    });
  }

  /// A sample that is darker or brighter than all around it is a point in a seam, or noise: it is taken into
  /// their range. What is drawn as a line, as a shadow's edge is, has its like beside it.
  void takeOutliersIn() {
    constexpr int fewest = 5;
    changeAll([&](Sample<K>& result, std::size_t tileIndex, std::size_t s) {
      float low_lx = std::numeric_limits<float>::infinity();
      float high_lx = 0.0F;
      int others = 0;
      aroundSample(tileIndex, s, [&](const Sample<K>& other) {
        if (&other == &samples_[s]) return;
        const float lx = world_.layout.strength(other.direct_lx);
        low_lx = std::min(low_lx, lx);
        high_lx = std::max(high_lx, lx);
        ++others;
      });
      const float own_lx = world_.layout.strength(result.direct_lx);
      if (others < fewest || own_lx <= 0.0F || (own_lx >= low_lx && own_lx <= high_lx)) return;
      result.direct_lx = (std::clamp(own_lx, low_lx, high_lx) / own_lx) * result.direct_lx;
    });
  }

  /// Gathers direct light again with more samples where its noise would show.
  void gatherNoisyAgain() {
    GatherSettings more = settings_;
    more.direct.perFormFactor *= furtherDirect;
    more.direct.least *= furtherDirect;
    more.rays = 1;
    forEachIndex(samples_.size(), 64, [&](std::size_t i) {
      Sample<K>& own = samples_[i];
      const float whole_lx = world_.layout.strength(own.direct_lx + own.reflected_lx);
      if (own.directDeviation_lx < noiseMost * whole_lx) return;
      const Gathered<K> again = gather(light_, own.domain, own.point + rayOffset_m * own.normal, own.normal,
                                       more, mixKeys(0x71e, i));
      own.direct_lx = (1.0F / (1.0F + furtherDirect)) * (own.direct_lx + furtherDirect * again.direct_lx);
      own.directDeviation_lx /= std::sqrt(1.0F + furtherDirect);
    });
  }

  /// An à-trous filter along surfaces. Direct light keeps its edges, the shadows, where it changes by more
  /// than its noise; reflected light has none that are sharp and is held only against large steps.
  void smooth() {
    std::vector<Sample<K>> smoothed = samples_;
    for (int step = 0; step < smoothingSteps; ++step) {
      forEachIndex(first_.size() - 1, 256, [&](std::size_t i) {
        const int column = static_cast<int>(i % static_cast<std::size_t>(columns_));
        const int row = static_cast<int>(i / static_cast<std::size_t>(columns_));
        for (std::size_t s = first_[i]; s < first_[i + 1]; ++s)
          smoothSample(samples_[s], column, row, 1 << step, smoothed[s]);
      });
      std::swap(samples_, smoothed);
    }
  }

  /// A weighted mean of one part of the light, and its noise.
  struct Mean {
    Columns<K> sum;
    float weights = 0.0F, variance = 0.0F;

    void add(float weight, const Columns<K>& light_lx, float deviation_lx) {
      sum += weight * light_lx;
      weights += weight;
      variance += weight * weight * deviation_lx * deviation_lx;
    }
  };

  void smoothSample(const Sample<K>& own, int column, int row, int reach, Sample<K>& result) const {
    constexpr float kernel[3] = {0.375F, 0.25F, 0.0625F};
    const float ownDirect_lx = world_.layout.strength(own.direct_lx);
    const float ownReflected_lx = world_.layout.strength(own.reflected_lx);
    Mean direct;
    Mean reflected;
    const auto add = [&](const Sample<K>& other, float share) {
      const float facing = glm::dot(own.normal, other.normal);
      if (facing < 0.9F) return;
      const float offPlane =
          std::abs(glm::dot(other.point - own.point, own.normal)) / (0.004F * own.distance_m);
      const float along = share * std::exp(-offPlane - 32.0F * (1.0F - facing));
      const float directStep = std::abs(world_.layout.strength(other.direct_lx) - ownDirect_lx) /
                               (3.0F * (own.directDeviation_lx + other.directDeviation_lx) + 1e-6F);
      direct.add(along * std::exp(-directStep * directStep), other.direct_lx, other.directDeviation_lx);
      const float reflectedStep =
          std::abs(world_.layout.strength(other.reflected_lx) - ownReflected_lx) /
          (6.0F * (own.reflectedDeviation_lx + other.reflectedDeviation_lx) + 0.1F * ownReflected_lx + 1e-6F);
      reflected.add(along * std::exp(-reflectedStep * reflectedStep), other.reflected_lx,
                    other.reflectedDeviation_lx);
    };
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) {
        const int x = column + dx * reach;
        const int y = row + dy * reach;
        if (x < 0 || y < 0 || x >= columns_ || y >= rows_) continue;
        for (const Sample<K>& other : samplesIn(x, y))
          add(other, kernel[std::abs(dx)] * kernel[std::abs(dy)]);
      }
    }
    result = own;
    result.direct_lx = (1.0F / direct.weights) * direct.sum;
    result.directDeviation_lx = std::sqrt(direct.variance) / direct.weights;
    result.reflected_lx = (1.0F / reflected.weights) * reflected.sum;
    result.reflectedDeviation_lx = std::sqrt(reflected.variance) / reflected.weights;
  }

  void shade(std::size_t pixel, LuminanceImage& image) const {
    const auto x = static_cast<float>(pixel % static_cast<std::size_t>(camera_.width()));
    const auto y = static_cast<float>(pixel / static_cast<std::size_t>(camera_.width()));
    glm::dvec3 sum(0.0);
    double lit_lx = 0.0;
    int surfaces = 0;
    std::size_t looked = 0;
    double darkest = std::numeric_limits<double>::infinity();
    double brightest = 0.0;
    const auto look = [&](const glm::vec2& spot) {
      const Seen seen = seenAt(x + spot.x, y + spot.y, mixKeys(0x71d, spotsMost * pixel + looked++));
      sum += seen.luminance_cd_m2;
      const double luminance = luminanceOf(seen.luminance_cd_m2);
      darkest = std::min(darkest, luminance);
      brightest = std::max(brightest, luminance);
      if (std::isnan(seen.illuminance_lx)) return;
      lit_lx += seen.illuminance_lx;
      ++surfaces;
    };
    for (const glm::vec2& spot : spots) look(spot);
    if (brightest > contrastLeast * darkest) {
      for (std::size_t i = 0; i < furtherSide * furtherSide; ++i) look(furtherSpot(i));
    }
    image.pixels_cd_m2[pixel] = glm::vec3(sum / static_cast<double>(looked));
    if (surfaces > 0) image.illuminance_lx[pixel] = static_cast<float>(lit_lx / surfaces);
  }

  /// What a ray of a pixel sees, and the illuminance of the surface that it meets.
  struct Seen {
    glm::dvec3 luminance_cd_m2{0.0};
    double illuminance_lx = std::numeric_limits<double>::quiet_NaN();  ///< NaN: no surface
  };

  [[nodiscard]] Seen seenAt(float x, float y, std::uint64_t key) const {
    const auto looked = camera_.direction(x, y);
    if (!looked) return {};
    const glm::vec3 direction = *looked;
    const auto hit = world_.rays.nearest(eye_, direction, RayScene::Barrier::opaqueAndGlass);
    // A millimetre, since an opening often lies in the surface that it is fixed to.
    const auto lamp = lampLuminance(world_, eye_, direction, hit.distance_m + 1e-3F);
    if (lamp) return {*lamp};
    const std::int32_t domain = hit ? world_.building.sideDomain[hit.side()] : -1;
    const bool isSolved = domain >= 0 && light_.of(domain) != nullptr;
    if (!hit || world_.materialOf(hit.piece).glazing || !isSolved) {
      if (domain_ < 0) return {};
      Columns<K> seen = luminanceAlong(light_, domain_, eye_, direction, true).value_or(Columns<K>{});
      if (hit || world_.building.domains[static_cast<std::size_t>(domain_)].open)
        seen += world_.layout.template light<K>(world_.layout.sunColumn(),
                                                glm::dvec3(sunDiscLuminance(world_, eye_, direction)));
      return {world_.layout.totalColour(seen)};
    }
    const glm::vec3 point = eye_ + hit.distance_m * direction;
    const glm::vec3 normal = world_.normalOf(hit.side());
    const float aslant = std::abs(glm::dot(normal, direction));
    std::optional<Columns<K>> irradiance = irradianceAt(x, y, point, normal, hit.distance_m, aslant);
    if (!irradiance) {
      const Gathered<K> arriving =
          gather(light_, domain, point + rayOffset_m * normal, normal, spotSettings_, key);
      irradiance = arriving.direct_lx + arriving.reflected_lx;
    }
    *irradiance += world_.layout.template light<K>(world_.layout.sunColumn(),
                                                   glm::dvec3(sunlight(domain, point, normal, key)));
    const Columns<K> exitance =
        world_.layout.template property<K>(world_.reflectanceOf(hit.piece)) * *irradiance +
        world_.layout.template light<K>(world_.layout.electricColumn(),
                                        world_.materialOf(hit.piece).exitance_lm_m2);
    return {std::numbers::inv_pi * world_.layout.totalColour(exitance),
            luminanceOf(world_.layout.totalColour(*irradiance))};
  }

  /// The beam on a surface. Rounding puts some points at the edge of a ceiling or a wall outside, where
  /// nothing stands before the sun: a closed domain has sun through its panes only.
  [[nodiscard]] glm::vec3 sunlight(std::int32_t domain, const glm::vec3& point, const glm::vec3& normal,
                                   std::uint64_t key) const {
    const glm::vec3 start = point + rayOffset_m * normal;
    const glm::vec3 beam_lx = sunlightByDisc(world_, start, normal, 1, key);
    if (beam_lx == glm::vec3(0.0F) || world_.building.domains[static_cast<std::size_t>(domain)].open)
      return beam_lx;
    const bool isInside =
        static_cast<bool>(world_.rays.nearest(start, world_.sun->towards, RayScene::Barrier::opaqueAndGlass));
    return isInside ? beam_lx : glm::vec3(0.0F);
  }

  /// Irradiance between the samples near a place of the picture that lie on the same surface. They lie
  /// further apart on a surface seen `aslant`, the cosine.
  [[nodiscard]] std::optional<Columns<K>> irradianceAt(float x, float y, const glm::vec3& point,
                                                       const glm::vec3& normal, float distance_m,
                                                       float aslant) const {
    const float tile_m = distance_m * tile * camera_.pixelAngle();  // where it is seen squarely
    const float step_m = tile_m / std::max(aslant, 0.02F);
    const float farthest_m = std::max(0.05F * distance_m, std::min(2.0F * step_m, 0.3F * distance_m));
    const int column = static_cast<int>(x) / tile;
    const int row = static_cast<int>(y) / tile;
    Columns<K> sum;
    float weights = 0.0F;
    for (int ny = std::max(row - 1, 0); ny <= std::min(row + 1, rows_ - 1); ++ny) {
      for (int nx = std::max(column - 1, 0); nx <= std::min(column + 1, columns_ - 1); ++nx) {
        for (const Sample<K>& other : samplesIn(nx, ny)) {
          const float facing = glm::dot(other.normal, normal);
          if (facing < 0.7F || glm::distance(other.point, point) > farthest_m) continue;
          const float offPlane = std::abs(glm::dot(other.point - point, normal)) / (0.01F * distance_m);
          // Nothing at a tile's distance, so that no edges of tiles show.
          const float tent = std::max(1.0F - std::abs(x - other.pixel.x) / other.reach_px, 0.01F) *
                             std::max(1.0F - std::abs(y - other.pixel.y) / other.reach_px, 0.01F);
          const float weight = tent * std::exp(-4.0F * (offPlane + 1.0F - facing));
          sum += weight * (other.direct_lx + other.reflected_lx);
          weights += weight;
        }
      }
    }
    if (weights < 1e-4F) return std::nullopt;
    return (1.0F / weights) * sum;
  }

  const SolvedLight<K>& light_;
  const World& world_;
  Camera camera_;
  glm::vec3 eye_;
  GatherSettings settings_, spotSettings_;  // of a sample, of a spot of a pixel
  int columns_, rows_;
  std::vector<Sample<K>> samples_;  // by tiles
  std::vector<std::size_t> first_;  // of a tile, and one past the last
  std::int32_t domain_ = -1;
};

}  // namespace

template <int K>
LuminanceImage renderView(const SolvedLight<K>& light, const ViewSettings& view,
                          const GatherSettings& settings) {
  return Picture<K>(light, view, settings).render();
}

#define CLERESTORY_INSTANTIATE(K) \
  template LuminanceImage renderView<K>(const SolvedLight<K>&, const ViewSettings&, const GatherSettings&);
CLERESTORY_STUDY_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
