// SPDX-License-Identifier: GPL-3.0-or-later
// Final-gathered pictures: irradiance for every surface in every tile of a few pixels, most of it
// interpolated, then shaded with several rays a pixel.
#include "view.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include <geometry/parallel.hpp>
#include <geometry/sampling.hpp>

#include "camera.hpp"
#include "directfield.hpp"
#include "irradiancecache.hpp"

namespace clerestory {
namespace {

constexpr int tile = 3;  // pixels of a side
// Where the rays of a pixel pass through it.
constexpr std::array<glm::vec2, 4> spots = {
    {{0.375F, 0.125F}, {0.875F, 0.375F}, {0.125F, 0.625F}, {0.625F, 0.875F}}};
constexpr std::size_t furtherSide = 4;  // 16 further spots where the first differ
constexpr float contrastLeast = 1.1F;   // between the first, to look further
constexpr std::size_t spotsMost = spots.size() + furtherSide * furtherSide;
const GatherSettings spotSettings{{96.0F, 2.0F}, 64};  // where no sample is near
constexpr float aslantMost = 0.3F;  // cosine under which a surface's edge is looked at pixel by pixel
constexpr int smoothingSteps = 5;   // each doubles the reach: 62 tiles after five

// Records of reflected light.
constexpr int blockSide = 8;                                       // tiles that look for records together
constexpr float recordReachLeast = 3.0F, recordReachMost = 12.0F;  // in tiles
constexpr float coveredFrom = 0.3F;                                // sum of records' weights
constexpr int recordStride = 16;                                   // tiles between the first

// Direct light.
constexpr int directStride = 4;          // tiles between points that are measured anyway
constexpr std::size_t directsLeast = 3;  // measured around a point, to judge by
constexpr float furtherDirect = 8.0F;    // times as many rays where there is much noise
constexpr float raysOfSure = 2.0F;       // times as many as were asked for: no more were needed
constexpr float unevenMost = 0.02F;      // of all light, between points that another lies between

/// Spots in a lattice that is sheared, so that no two share a row or a column.
glm::vec2 furtherSpot(std::size_t i) {
  constexpr auto side = static_cast<float>(furtherSide);
  const auto column = static_cast<float>(i % furtherSide);
  const auto row = static_cast<float>(i / furtherSide);
  return {(column + (row + 0.5F) / side) / side, (row + (column + 0.5F) / side) / side};
}

/// A visible point whose irradiance is known.
template <int K>
struct Sample {
  glm::vec2 pixel{0.0F};  ///< where it is seen
  float reach_px = tile;  ///< how far from there others count more
  glm::vec3 point{0.0F}, normal{0.0F};
  float distance_m = 0.0F;
  std::int32_t domain = -1;
  Columns<K> reflected_lx;
  Columns<K> unhidden_lx;     ///< direct light were nothing in the way
  Columns<K> share;           ///< of it that arrives
  float deviation_lx = 0.0F;  ///< of direct light
  bool isMeasured = false;    ///< direct light, by rays of its own
  bool seemsSure = false;     ///< that light, after the first of them

  [[nodiscard]] Columns<K> irradiance_lx() const { return share * unhidden_lx + reflected_lx; }
};

template <int K>
class Picture {
 public:
  Picture(const SolvedLight<K>& light, const ViewSettings& view, const PictureSettings& settings)
      : light_(light),
        world_(light.world()),
        camera_(view),
        eye_(world_.local(view.eye_m)),
        settings_(settings),
        columns_((camera_.width() + tile - 1) / tile),
        rows_((camera_.height() + tile - 1) / tile) {}

  LuminanceImage render() {
    domain_ = domainAt(world_, eye_);
    findSamples();
    gatherReflected();
    gatherDirect();
    evenDeviations();
    measureNoisyAgain();
    takeOutliersIn();
    smooth();
    for (const Sample<K>& sample : samples_) irradiance_lx_.push_back(sample.irradiance_lx());
    lookThroughCorners();
    LuminanceImage image{camera_.width(), camera_.height(), {}, {}};
    image.pixels_cd_m2.resize(static_cast<std::size_t>(camera_.width()) *
                              static_cast<std::size_t>(camera_.height()));
    image.illuminance_lx.assign(image.pixels_cd_m2.size(), std::numeric_limits<float>::quiet_NaN());
    forEachIndex(image.pixels_cd_m2.size(), 256, [&](std::size_t i) { shade(i, image); });
    return image;
  }

 private:
  /// What a ray of view meets.
  struct Look {
    glm::vec2 at{0.0F};  ///< in the picture
    glm::vec3 direction{0.0F};
    bool isInPicture = false;  ///< a fisheye has corners that are not
    RayScene::Hit hit;
  };
  /// What it sees, and the illuminance of the surface that it meets.
  struct Seen {
    glm::dvec3 luminance_cd_m2{0.0};
    double illuminance_lx = std::numeric_limits<double>::quiet_NaN();  ///< NaN: no surface
  };

  [[nodiscard]] std::size_t tileAt(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] int columnOf(std::size_t tileIndex) const {
    return static_cast<int>(tileIndex % static_cast<std::size_t>(columns_));
  }
  [[nodiscard]] int rowOf(std::size_t tileIndex) const {
    return static_cast<int>(tileIndex / static_cast<std::size_t>(columns_));
  }
  [[nodiscard]] std::span<const Sample<K>> samplesIn(int column, int row) const {
    const std::size_t at = tileAt(column, row);
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
    std::vector<std::vector<Sample<K>>> surfaces;
    for (int p = 0; p < tile * tile; ++p) {
      const std::optional<Sample<K>> sample =
          sampleAt(tile * columnOf(i) + p % tile, tile * rowOf(i) + p / tile);
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

  /// The surface that is seen in the middle of a pixel, before any light is known.
  [[nodiscard]] std::optional<Sample<K>> sampleAt(int x, int y) const {
    if (x >= camera_.width() || y >= camera_.height()) return std::nullopt;
    const Look look = lookAtMiddle(x, y);
    if (!isLit(look.hit)) return std::nullopt;
    Sample<K> sample;
    sample.pixel = look.at;
    sample.point = pointOf(look);
    sample.normal = world_.normalOf(look.hit.side());
    sample.distance_m = look.hit.distance_m;
    sample.domain = world_.building.sideDomain[look.hit.side()];
    return sample;
  }

  void lookAtMiddles() {
    middles_.resize(static_cast<std::size_t>(camera_.width()) * static_cast<std::size_t>(camera_.height()));
    forEachIndex(middles_.size(), 256, [&](std::size_t pixel) {
      const auto width = static_cast<std::size_t>(camera_.width());
      middles_[pixel] =
          lookThrough({static_cast<float>(pixel % width) + 0.5F, static_cast<float>(pixel / width) + 0.5F})
              .hit;
    });
  }

  [[nodiscard]] Look lookAtMiddle(int x, int y) const {
    const glm::vec2 at(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
    const auto direction = camera_.direction(at.x, at.y);
    if (!direction) return {at, {}, false, {}};
    return {at, *direction, true,
            middles_[static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width()) +
                     static_cast<std::size_t>(x)]};
  }

  void findSamples() {
    lookAtMiddles();
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

  /// Extent of a tile where a sample lies, as if all of it were seen at the same cosine. [m]
  [[nodiscard]] float tile_m(const Sample<K>& sample) const {
    return sample.distance_m * tile * camera_.pixelAngle() / std::sqrt(std::max(aslantOf(sample), 0.1F));
  }
  /// Cosine at which a sample is seen.
  [[nodiscard]] float aslantOf(const Sample<K>& sample) const {
    return std::abs(glm::dot(sample.normal, sample.point - eye_)) / sample.distance_m;
  }
  /// How far a record that is gathered at a sample may hold. Where samples are pixels, it is a few of them.
  [[nodiscard]] RecordReach reachOf(const Sample<K>& sample) const {
    const float own_m =
        sample.reach_px < tile ? sample.distance_m * camera_.pixelAngle() : recordReachLeast * tile_m(sample);
    return {own_m, std::max(own_m, recordReachMost * tile_m(sample))};
  }

  /// Tiles that look for records of reflected light together.
  struct Block {
    glm::vec3 centre{0.0F};  ///< of a sphere that holds their samples
    float radius_m = 0.0F;
    std::vector<std::uint32_t> records;  ///< that may hold somewhere in it
  };

  [[nodiscard]] const Block& blockOf(std::size_t tileIndex) const {
    return blocks_[static_cast<std::size_t>(rowOf(tileIndex) / blockSide) *
                       static_cast<std::size_t>(blockColumns_) +
                   static_cast<std::size_t>(columnOf(tileIndex) / blockSide)];
  }

  /// Calls visit(tile, sample's number) for the samples of a block.
  template <class Visit>
  void inBlock(std::size_t block, const Visit& visit) const {
    const int left = blockSide * static_cast<int>(block % static_cast<std::size_t>(blockColumns_));
    const int top = blockSide * static_cast<int>(block / static_cast<std::size_t>(blockColumns_));
    for (int row = top; row < std::min(top + blockSide, rows_); ++row) {
      for (int column = left; column < std::min(left + blockSide, columns_); ++column) {
        const std::size_t at = tileAt(column, row);
        for (std::size_t s = first_[at]; s < first_[at + 1]; ++s) visit(at, s);
      }
    }
  }

  void makeBlocks() {
    blockColumns_ = (columns_ + blockSide - 1) / blockSide;
    blocks_.resize(static_cast<std::size_t>(blockColumns_) *
                   static_cast<std::size_t>((rows_ + blockSide - 1) / blockSide));
    forEachIndex(blocks_.size(), 16, [&](std::size_t b) {
      Block& block = blocks_[b];
      glm::vec3 low(std::numeric_limits<float>::infinity());
      glm::vec3 high(-std::numeric_limits<float>::infinity());
      inBlock(b, [&](std::size_t, std::size_t s) {
        low = glm::min(low, samples_[s].point);
        high = glm::max(high, samples_[s].point);
      });
      block.radius_m = low.x <= high.x ? 0.5F * glm::distance(low, high) : -1.0F;
      block.centre = 0.5F * (low + high);
    });
  }

  [[nodiscard]] float coverage(std::size_t tileIndex, const Sample<K>& sample) const {
    float weights = 0.0F;
    for (const std::uint32_t r : blockOf(tileIndex).records)
      weights += records_[r].weightAt(sample.domain, sample.point, sample.normal);
    return weights;
  }

  /// Gathers records at samples that those so far do not cover, in finer and finer lattices of tiles; then
  /// all samples have their reflected light from records.
  void gatherReflected() {
    makeBlocks();
    for (int stride = recordStride; stride > 0; stride /= 2) {
      std::vector<std::uint8_t> isNeeded(samples_.size(), 0);
      forEachIndex(first_.size() - 1, 256, [&](std::size_t i) {
        if (columnOf(i) % stride != 0 || rowOf(i) % stride != 0) return;
        for (std::size_t s = first_[i]; s < first_[i + 1]; ++s)
          isNeeded[s] = coverage(i, samples_[s]) < coveredFrom ? 1 : 0;
      });
      std::vector<std::size_t> needed;
      for (std::size_t s = 0; s < samples_.size(); ++s) {
        if (isNeeded[s] != 0) needed.push_back(s);
      }
      addRecords(needed);
    }
    forEachIndex(first_.size() - 1, 64, [&](std::size_t i) {
      for (std::size_t s = first_[i]; s < first_[i + 1]; ++s) interpolateReflected(i, samples_[s]);
    });
  }

  void addRecords(const std::vector<std::size_t>& places) {
    const std::size_t before = records_.size();
    records_.resize(before + places.size());
    forEachIndex(places.size(), 16, [&](std::size_t i) {
      const Sample<K>& sample = samples_[places[i]];
      records_[before + i] = irradianceRecord(light_, sample.domain, sample.point, sample.normal,
                                              reachOf(sample), settings_.rays, mixKeys(0x71c, places[i]));
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

  void interpolateReflected(std::size_t tileIndex, Sample<K>& sample) const {
    IrradianceFit<K> fit(sample.normal);
    for (const std::uint32_t r : blockOf(tileIndex).records) {
      const IrradianceRecord<K>& record = records_[r];
      const float weight = record.weightAt(sample.domain, sample.point, sample.normal);
      if (weight > 0.0F) fit.add(weight, record.point - sample.point, record.radius_m, record.irradiance_lx);
    }
    sample.reflected_lx = fit.value();
  }

  /// Measures direct light in a coarse lattice of tiles and in finer ones where it is uneven or its shadows
  /// begin; elsewhere the share that arrives lies between.
  void gatherDirect() {
    for (const Sample<K>& sample : samples_) {
      if (!fields_.contains(sample.domain)) fields_.try_emplace(sample.domain, light_, sample.domain);
    }
    forEachIndex(samples_.size(), 64, [&](std::size_t s) {
      Sample<K>& own = samples_[s];
      own.unhidden_lx = fields_.at(own.domain).unhidden(own.point + rayOffset_m * own.normal, own.normal);
    });
    for (int stride = directStride; stride > 0; stride /= 2) {
      std::vector<std::size_t> needed;
      std::vector<std::uint8_t> isNeeded(samples_.size(), 0);
      forEachIndex(first_.size() - 1, 256, [&](std::size_t i) {
        if (columnOf(i) % stride != 0 || rowOf(i) % stride != 0) return;
        for (std::size_t s = first_[i]; s < first_[i + 1]; ++s)
          isNeeded[s] =
              !samples_[s].isMeasured && (stride == directStride || !liesBetween(i, s, stride)) ? 1 : 0;
      });
      for (std::size_t s = 0; s < samples_.size(); ++s) {
        if (isNeeded[s] != 0) needed.push_back(s);
      }
      forEachIndex(needed.size(), 64, [&](std::size_t i) { measureDirect(needed[i], settings_.directRays); });
    }
    forEachIndex(first_.size() - 1, 256, [&](std::size_t i) {
      for (std::size_t s = first_[i]; s < first_[i + 1]; ++s) {
        if (!samples_[s].isMeasured) interpolateDirect(i, samples_[s]);
      }
    });
  }

  void measureDirect(std::size_t s, float rays) {
    Sample<K>& own = samples_[s];
    const DirectLight<K> direct =
        fields_.at(own.domain)
            .light(own.point + rayOffset_m * own.normal, own.normal, rays, settings_.deviationMost,
                   world_.layout.strength(own.reflected_lx), mixKeys(0x71e, s));
    for (int c = 0; c < K; ++c)
      own.share[c] = own.unhidden_lx[c] > 0.0F ? direct.illuminance_lx[c] / own.unhidden_lx[c] : 0.0F;
    own.deviation_lx = direct.deviation_lx;
    own.isMeasured = true;
    own.seemsSure = static_cast<float>(direct.rays) < raysOfSure * rays;
  }

  /// Calls `visit` for each sample on the surface of `own` in the tiles of a lattice around it.
  template <class Visit>
  void onSurface(const Sample<K>& own, int column, int row, int reach, int stride, const Visit& visit) const {
    const auto firstFrom = [&](int at) { return std::max((at + stride - 1) / stride * stride, 0); };
    for (int y = firstFrom(std::max(row - reach, 0)); y <= std::min(row + reach, rows_ - 1); y += stride) {
      for (int x = firstFrom(std::max(column - reach, 0)); x <= std::min(column + reach, columns_ - 1);
           x += stride) {
        for (const Sample<K>& other : samplesIn(x, y)) {
          if (isOneSurface(own, other)) visit(other);
        }
      }
    }
  }

  /// Whether the direct light of a sample can be told from those measured around it in the lattice of twice
  /// the `stride`: they agree, and nothing touches its surface there, from where a shadow might begin.
  [[nodiscard]] bool liesBetween(std::size_t tileIndex, std::size_t s, int stride) const {
    const Sample<K>& own = samples_[s];
    if (own.reach_px < tile || (stride == 1 && isAtContact(tileIndex, own))) return false;
    for (const int reach : {2 * stride, 4 * stride}) {
      Columns<K> low;
      Columns<K> high;
      float deviation_lx = 0.0F;
      std::size_t count = 0;
      onSurface(own, columnOf(tileIndex), rowOf(tileIndex), reach, 2 * stride, [&](const Sample<K>& other) {
        if (!other.isMeasured) return;
        for (int c = 0; c < K; ++c) {
          low[c] = count > 0 ? std::min(low[c], other.share[c]) : other.share[c];
          high[c] = count > 0 ? std::max(high[c], other.share[c]) : other.share[c];
        }
        deviation_lx = std::max(deviation_lx, other.deviation_lx);
        ++count;
      });
      if (count < directsLeast) continue;
      const float all_lx = world_.layout.strength(high * own.unhidden_lx + own.reflected_lx);
      return world_.layout.strength((high - low) * own.unhidden_lx) <=
             unevenMost * all_lx + 2.0F * deviation_lx;
    }
    return false;
  }

  [[nodiscard]] bool isAtContact(std::size_t tileIndex, const Sample<K>& own) const {
    const float near_m = 2.0F * tile_m(own);
    const int column = columnOf(tileIndex);
    const int row = rowOf(tileIndex);
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows_ - 1); ++y) {
      for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns_ - 1); ++x) {
        for (const Sample<K>& other : samplesIn(x, y)) {
          if (glm::distance(own.point, other.point) < near_m && !isOneSurface(own, other)) return true;
        }
      }
    }
    return false;
  }

  void interpolateDirect(std::size_t tileIndex, Sample<K>& own) const {
    for (int reach = 2; reach <= 4 * directStride; reach *= 2) {
      Columns<K> sum;
      float weights = 0.0F;
      float variance = 0.0F;
      const float reach_px = static_cast<float>(tile * (reach + 1));
      onSurface(own, columnOf(tileIndex), rowOf(tileIndex), reach, 1, [&](const Sample<K>& other) {
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
      float variance = 0.0F;
      float count = 0.0F;
      aroundSample(tileIndex, s, [&](const Sample<K>& other) {
        variance += other.deviation_lx * other.deviation_lx;
        count += 1.0F;
      });
      result.deviation_lx = std::sqrt(variance / count);
    });
  }

  /// Measures direct light again with more rays where samples around tell of noise that a sample's own few
  /// rays may have missed altogether, as a bright sliver at the edge of what a pane shows.
  void measureNoisyAgain() {
    forEachIndex(samples_.size(), 64, [&](std::size_t s) {
      Sample<K>& own = samples_[s];
      const float allowed_lx = settings_.deviationMost * world_.layout.strength(own.irradiance_lx());
      if (own.seemsSure && own.deviation_lx > allowed_lx)
        measureDirect(s, furtherDirect * settings_.directRays);
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
        const float lx = world_.layout.strength(other.share * samples_[s].unhidden_lx);
        low_lx = std::min(low_lx, lx);
        high_lx = std::max(high_lx, lx);
        ++others;
      });
      const float own_lx = world_.layout.strength(result.share * result.unhidden_lx);
      if (others < fewest || own_lx <= 0.0F || (own_lx >= low_lx && own_lx <= high_lx)) return;
      result.share = (std::clamp(own_lx, low_lx, high_lx) / own_lx) * result.share;
    });
  }

  /// An à-trous filter along surfaces. Shadows keep their edges, where light changes by more than its noise.
  void smooth() {
    std::vector<Sample<K>> smoothed = samples_;
    for (int step = 0; step < smoothingSteps; ++step) {
      forEachIndex(first_.size() - 1, 256, [&](std::size_t i) {
        for (std::size_t s = first_[i]; s < first_[i + 1]; ++s)
          smoothSample(samples_[s], columnOf(i), rowOf(i), 1 << step, smoothed[s]);
      });
      std::swap(samples_, smoothed);
    }
  }

  void smoothSample(const Sample<K>& own, int column, int row, int reach, Sample<K>& result) const {
    constexpr float kernel[3] = {0.375F, 0.25F, 0.0625F};
    result = own;
    if (own.deviation_lx <= 0.0F) return;
    const Columns<K> ownDirect_lx = own.share * own.unhidden_lx;
    Columns<K> sum;
    float weights = 0.0F;
    float variance = 0.0F;
    const auto add = [&](const Sample<K>& other, float nearness) {
      const float facing = glm::dot(own.normal, other.normal);
      if (facing < 0.9F || other.domain != own.domain) return;
      const float offPlane =
          std::abs(glm::dot(other.point - own.point, own.normal)) / (0.004F * own.distance_m);
      if (offPlane > 4.0F) return;
      Columns<K> direct_lx = other.share * other.unhidden_lx;
      Columns<K> apart = direct_lx - ownDirect_lx;
      for (int c = 0; c < K; ++c) apart[c] = std::abs(apart[c]);
      const float step =
          world_.layout.strength(apart) / (3.0F * (own.deviation_lx + other.deviation_lx) + 1e-6F);
      const float weight = nearness * std::exp(-offPlane - 32.0F * (1.0F - facing) - step * step);
      sum += weight * direct_lx;
      weights += weight;
      variance += weight * weight * other.deviation_lx * other.deviation_lx;
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
    for (int c = 0; c < K; ++c)
      result.share[c] = own.unhidden_lx[c] > 0.0F ? sum[c] / (weights * own.unhidden_lx[c]) : 0.0F;
    result.deviation_lx = std::sqrt(variance) / weights;
  }

  /// What a ray through a corner of pixels meets: a lit surface, or none that would do for a whole pixel.
  struct Corner {
    std::uint32_t side = RayScene::Hit::none;
    glm::vec3 beam_lx{0.0F};
  };

  [[nodiscard]] Look lookThrough(const glm::vec2& at) const {
    const auto direction = camera_.direction(at.x, at.y);
    if (!direction) return {at, {}, false, {}};
    return {at, *direction, true, world_.rays.nearest(eye_, *direction, RayScene::Barrier::opaqueAndGlass)};
  }

  /// The lit side that a ray of view ends on; none for glass, the open, a lamp.
  [[nodiscard]] std::uint32_t sideOf(const Look& look) const {
    return look.isInPicture && isLit(look.hit) && !lampOf(look) ? look.hit.side() : RayScene::Hit::none;
  }

  [[nodiscard]] Corner cornerOf(const Look& look, std::uint64_t key) const {
    const std::uint32_t side = sideOf(look);
    if (side == RayScene::Hit::none) return {};
    return {side, beamOn(look, key)};
  }

  /// The corners of a pixel.
  [[nodiscard]] std::array<Corner, 4> cornersOf(std::size_t x, std::size_t y) const {
    const std::size_t width = static_cast<std::size_t>(camera_.width()) + 1;
    const std::size_t above = y * width + x;
    return {corners_[above], corners_[above + 1], corners_[above + width], corners_[above + width + 1]};
  }

  /// Whether the rays of a pixel have met all that its corners show.
  [[nodiscard]] bool showAllOfCorners(const std::vector<std::uint32_t>& sides, std::size_t x,
                                      std::size_t y) const {
    const std::array<Corner, 4> corners = cornersOf(x, y);
    return std::all_of(corners.begin(), corners.end(), [&](const Corner& corner) {
      return std::find(sides.begin(), sides.end(), corner.side) != sides.end();
    });
  }

  /// Rays through the corners of all pixels, each shared by four.
  void lookThroughCorners() {
    const std::size_t width = static_cast<std::size_t>(camera_.width()) + 1;
    corners_.resize(width * (static_cast<std::size_t>(camera_.height()) + 1));
    forEachIndex(corners_.size(), 256, [&](std::size_t i) {
      const glm::vec2 at(static_cast<float>(i % width), static_cast<float>(i / width));
      corners_[i] = cornerOf(lookThrough(at), mixKeys(0x71f, i));
    });
  }

  void shade(std::size_t pixel, LuminanceImage& image) const {
    const std::size_t width = static_cast<std::size_t>(camera_.width());
    const glm::vec2 corner(static_cast<float>(pixel % width), static_cast<float>(pixel / width));
    const std::uint64_t key = mixKeys(0x71d, pixel);
    if (const auto seen = seenOnOnePiece(pixel % width, pixel / width, key)) {
      image.pixels_cd_m2[pixel] = glm::vec3(seen->luminance_cd_m2);
      image.illuminance_lx[pixel] = static_cast<float>(seen->illuminance_lx);
      return;
    }
    glm::dvec3 sum(0.0);
    double lit_lx = 0.0;
    int surfaces = 0;
    std::size_t looked = 0;
    double darkest = std::numeric_limits<double>::infinity();
    double brightest = 0.0;
    std::vector<std::uint32_t> sides;
    const auto add = [&](const glm::vec2& spot) {
      const Look look = lookThrough(corner + spot);
      sides.push_back(sideOf(look));
      const Seen seen = seenAlong(look, mixKeys(key, looked++));
      sum += seen.luminance_cd_m2;
      const double luminance = luminanceOf(seen.luminance_cd_m2);
      darkest = std::min(darkest, luminance);
      brightest = std::max(brightest, luminance);
      if (std::isnan(seen.illuminance_lx)) return;
      lit_lx += seen.illuminance_lx;
      ++surfaces;
    };
    for (const glm::vec2& spot : spots) add(spot);
    if (brightest > contrastLeast * darkest || !showAllOfCorners(sides, pixel % width, pixel / width)) {
      for (std::size_t i = 0; i < furtherSide * furtherSide; ++i) add(furtherSpot(i));
    }
    image.pixels_cd_m2[pixel] = glm::vec3(sum / static_cast<double>(looked));
    if (surfaces > 0) image.illuminance_lx[pixel] = static_cast<float>(lit_lx / surfaces);
  }

  /// A pixel whose corners and middle show one side under one beam: its middle tells the light of all.
  [[nodiscard]] std::optional<Seen> seenOnOnePiece(std::size_t x, std::size_t y, std::uint64_t key) const {
    const std::array<Corner, 4> corners = cornersOf(x, y);
    const Corner& corner = corners[0];
    const auto isAlike = [&](const Corner& other) {
      return other.side == corner.side && other.beam_lx == corner.beam_lx;
    };
    if (corner.side == RayScene::Hit::none || !std::all_of(corners.begin(), corners.end(), isAlike))
      return std::nullopt;
    const Look look = lookAtMiddle(static_cast<int>(x), static_cast<int>(y));
    if (!isAlike(cornerOf(look, key))) return std::nullopt;
    const glm::vec3 normal = world_.normalOf(look.hit.side());
    const auto irradiance = irradianceAt(look.at.x, look.at.y, pointOf(look), normal, look.hit.distance_m,
                                         std::abs(glm::dot(normal, look.direction)));
    if (!irradiance) return std::nullopt;
    return surfaceSeen(look.hit, *irradiance, corner.beam_lx);
  }

  /// The sun's beam where a ray of view ends. [lx]
  [[nodiscard]] glm::vec3 beamOn(const Look& look, std::uint64_t key) const {
    if (!world_.sun) return glm::vec3(0.0F);
    return sunlight(world_.building.sideDomain[look.hit.side()], pointOf(look),
                    world_.normalOf(look.hit.side()), key);
  }

  [[nodiscard]] glm::vec3 pointOf(const Look& look) const {
    return eye_ + look.hit.distance_m * look.direction;
  }

  // A millimetre, since an opening often lies in the surface that it is fixed to.
  [[nodiscard]] std::optional<glm::dvec3> lampOf(const Look& look) const {
    return lampLuminance(world_, eye_, look.direction, look.hit.distance_m + 1e-3F);
  }

  /// Whether a ray ends on a surface whose light is known.
  [[nodiscard]] bool isLit(const RayScene::Hit& hit) const {
    if (!hit || world_.materialOf(hit.piece).glazing) return false;
    const std::int32_t domain = world_.building.sideDomain[hit.side()];
    return domain >= 0 && light_.of(domain) != nullptr;
  }

  [[nodiscard]] Seen surfaceSeen(const RayScene::Hit& hit, Columns<K> irradiance,
                                 const glm::vec3& beam_lx) const {
    irradiance += world_.layout.template light<K>(world_.layout.sunColumn(), glm::dvec3(beam_lx));
    const Columns<K> exitance =
        world_.layout.template property<K>(world_.reflectanceOf(hit.piece)) * irradiance +
        world_.layout.template light<K>(world_.layout.electricColumn(),
                                        world_.materialOf(hit.piece).exitance_lm_m2);
    return {std::numbers::inv_pi * world_.layout.totalColour(exitance),
            luminanceOf(world_.layout.totalColour(irradiance))};
  }

  [[nodiscard]] Seen seenAlong(const Look& look, std::uint64_t key) const {
    if (!look.isInPicture) return {};
    if (const auto lamp = lampOf(look)) return {*lamp};
    if (!isLit(look.hit)) return {openSeen(look)};
    const std::int32_t domain = world_.building.sideDomain[look.hit.side()];
    const glm::vec3 point = pointOf(look);
    const glm::vec3 normal = world_.normalOf(look.hit.side());
    std::optional<Columns<K>> irradiance = irradianceAt(
        look.at.x, look.at.y, point, normal, look.hit.distance_m, std::abs(glm::dot(normal, look.direction)));
    if (!irradiance) irradiance = irradianceOfSpot(domain, point, normal, key);
    return surfaceSeen(look.hit, *irradiance, beamOn(look, key));
  }

  /// What is seen of glass, and beyond it or where there is nothing.
  [[nodiscard]] glm::dvec3 openSeen(const Look& look) const {
    if (domain_ < 0) return {};
    Columns<K> seen =
        luminanceAlong(light_, domain_, eye_, look.direction, LightAsked::all).value_or(Columns<K>{});
    if (look.hit || world_.building.domains[static_cast<std::size_t>(domain_)].open)
      seen += world_.layout.template light<K>(world_.layout.sunColumn(),
                                              glm::dvec3(sunDiscLuminance(world_, eye_, look.direction)));
    return world_.layout.totalColour(seen);
  }

  /// Light of a point that no sample is near, for one ray of a pixel.
  [[nodiscard]] Columns<K> irradianceOfSpot(std::int32_t domain, const glm::vec3& point,
                                            const glm::vec3& normal, std::uint64_t key) const {
    const Gathered<K> arriving =
        gather(light_, domain, point + rayOffset_m * normal, normal, spotSettings, key);
    return arriving.direct_lx + arriving.reflected_lx;
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
          const float apart = offPlane + 1.0F - facing;
          const float weight = apart > 1e-4F ? tent * std::exp(-4.0F * apart) : tent;
          sum += weight * irradiance_lx_[static_cast<std::size_t>(&other - samples_.data())];
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
  PictureSettings settings_;
  int columns_, rows_;
  std::vector<Sample<K>> samples_;         // by tiles
  std::vector<std::size_t> first_;         // of a tile, and one past the last
  std::vector<Columns<K>> irradiance_lx_;  // #samples
  std::vector<RayScene::Hit> middles_;     // #pixels
  std::vector<Corner> corners_;            // of pixels, one more in both directions
  int blockColumns_ = 0;
  std::vector<Block> blocks_;
  std::vector<IrradianceRecord<K>> records_;
  std::map<std::int32_t, DirectField<K>> fields_;  // by domain
  std::int32_t domain_ = -1;
};

}  // namespace

PictureSettings picturesFor(double accuracy) {
  const double finer = 0.05 / accuracy;  // 1 at the standard accuracy
  return {static_cast<std::uint32_t>(std::clamp(1024.0 * finer, 256.0, 4096.0)),
          static_cast<float>(96.0 * finer), static_cast<float>(std::clamp(0.6 * accuracy, 0.01, 0.06))};
}

template <int K>
LuminanceImage renderView(const SolvedLight<K>& light, const ViewSettings& view,
                          const PictureSettings& settings) {
  return Picture<K>(light, view, settings).render();
}

#define CLERESTORY_INSTANTIATE(K) \
  template LuminanceImage renderView<K>(const SolvedLight<K>&, const ViewSettings&, const PictureSettings&);
CLERESTORY_STUDY_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
