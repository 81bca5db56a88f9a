// SPDX-License-Identifier: GPL-3.0-or-later
// Final-gathered pictures: irradiance on a coarse raster, smoothed along surfaces, then shaded with four rays
// a pixel.
#include "view.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <geometry/parallel.hpp>
#include <geometry/sampling.hpp>

#include "camera.hpp"

namespace clerestory {
namespace {

constexpr int cell = 3;  // pixels of a side of a cell of the coarse raster
// Where the rays of a pixel pass through it.
constexpr std::size_t spotsOfPixel = 4;
constexpr glm::vec2 spots[spotsOfPixel] = {
    {0.375F, 0.125F}, {0.875F, 0.375F}, {0.125F, 0.625F}, {0.625F, 0.875F}};
constexpr int smoothingSteps = 5;  // each doubles the reach: 62 cells after five

GatherSettings shareOf(const GatherSettings& settings, std::size_t count) {
  const float share = 1.0F / static_cast<float>(count);
  return {{share * settings.direct.perFormFactor, share * settings.direct.least},
          settings.rays / static_cast<std::uint32_t>(count)};
}

/// A visible point whose irradiance is known.
template <int K>
struct Cell {
  bool isSurface = false;  ///< false: sky or glass, which is shaded ray by ray
  glm::vec3 point{0.0F}, normal{0.0F};
  float distance_m = 0.0F;
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
        spotSettings_(shareOf(settings, spotsOfPixel / 2)),
        columns_((camera_.width() + cell - 1) / cell),
        rows_((camera_.height() + cell - 1) / cell),
        cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

  LuminanceImage render() {
    domain_ = domainAt(world_, eye_);
    forEachIndex(cells_.size(), 64, [&](std::size_t i) { gatherCell(i); });
    smooth();
    LuminanceImage image{camera_.width(), camera_.height(), {}, {}};
    image.pixels_cd_m2.resize(static_cast<std::size_t>(camera_.width()) *
                              static_cast<std::size_t>(camera_.height()));
    image.illuminance_lx.assign(image.pixels_cd_m2.size(), std::numeric_limits<float>::quiet_NaN());
    forEachIndex(image.pixels_cd_m2.size(), 256, [&](std::size_t i) { shade(i, image); });
    return image;
  }

 private:
  [[nodiscard]] const Cell<K>& cellAt(int column, int row) const {
    return cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(column)];
  }

  void gatherCell(std::size_t i) {
    const auto column = static_cast<float>(i % static_cast<std::size_t>(columns_));
    const auto row = static_cast<float>(i / static_cast<std::size_t>(columns_));
    const auto direction = camera_.direction(cell * (column + 0.5F), cell * (row + 0.5F));
    if (!direction) return;
    const auto hit = world_.rays.nearest(eye_, *direction, RayScene::Barrier::opaqueAndGlass);
    if (!hit || world_.materialOf(hit.piece).glazing) return;
    const std::int32_t domain = world_.building.sideDomain[hit.side()];
    if (domain < 0 || light_.of(domain) == nullptr) return;
    Cell<K>& own = cells_[i];
    own.isSurface = true;
    own.point = eye_ + hit.distance_m * *direction;
    own.normal = world_.normalOf(hit.side());
    own.distance_m = hit.distance_m;
    const Gathered<K> arriving = gather(light_, domain, own.point + rayOffset_m * own.normal, own.normal,
                                        settings_, mixKeys(0x71c, i));
    own.direct_lx = arriving.direct_lx;
    own.reflected_lx = arriving.reflected_lx;
    own.directDeviation_lx = arriving.directDeviation_lx;
    own.reflectedDeviation_lx = arriving.reflectedDeviation_lx;
  }

  /// An à-trous filter along surfaces. Direct light keeps its edges, the shadows, where it changes by more
  /// than its noise; reflected light has none that are sharp and is held only against large steps.
  void smooth() {
    std::vector<Cell<K>> smoothed = cells_;
    for (int step = 0; step < smoothingSteps; ++step) {
      forEachIndex(cells_.size(), 256, [&](std::size_t i) {
        if (!cells_[i].isSurface) return;
        const int column = static_cast<int>(i % static_cast<std::size_t>(columns_));
        const int row = static_cast<int>(i / static_cast<std::size_t>(columns_));
        smoothCell(column, row, 1 << step, smoothed[i]);
      });
      std::swap(cells_, smoothed);
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

  void smoothCell(int column, int row, int reach, Cell<K>& result) const {
    constexpr float kernel[3] = {0.375F, 0.25F, 0.0625F};
    const Cell<K>& own = cellAt(column, row);
    const float ownDirect_lx = world_.layout.strength(own.direct_lx);
    const float ownReflected_lx = world_.layout.strength(own.reflected_lx);
    Mean direct;
    Mean reflected;
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) {
        const int x = column + dx * reach;
        const int y = row + dy * reach;
        if (x < 0 || y < 0 || x >= columns_ || y >= rows_) continue;
        const Cell<K>& other = cellAt(x, y);
        const float facing = glm::dot(own.normal, other.normal);
        if (!other.isSurface || facing < 0.9F) continue;
        const float offPlane =
            std::abs(glm::dot(other.point - own.point, own.normal)) / (0.004F * own.distance_m);
        const float along =
            kernel[std::abs(dx)] * kernel[std::abs(dy)] * std::exp(-offPlane - 32.0F * (1.0F - facing));
        const float directStep = std::abs(world_.layout.strength(other.direct_lx) - ownDirect_lx) /
                                 (3.0F * (own.directDeviation_lx + other.directDeviation_lx) + 1e-6F);
        direct.add(along * std::exp(-directStep * directStep), other.direct_lx, other.directDeviation_lx);
        const float reflectedStep = std::abs(world_.layout.strength(other.reflected_lx) - ownReflected_lx) /
                                    (6.0F * (own.reflectedDeviation_lx + other.reflectedDeviation_lx) +
                                     0.1F * ownReflected_lx + 1e-6F);
        reflected.add(along * std::exp(-reflectedStep * reflectedStep), other.reflected_lx,
                      other.reflectedDeviation_lx);
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
    for (std::size_t i = 0; i < spotsOfPixel; ++i) {
      const Seen seen = seenAt(x + spots[i].x, y + spots[i].y, mixKeys(0x71d, spotsOfPixel * pixel + i));
      sum += seen.luminance_cd_m2;
      if (std::isnan(seen.illuminance_lx)) continue;
      lit_lx += seen.illuminance_lx;
      ++surfaces;
    }
    image.pixels_cd_m2[pixel] = glm::vec3(sum / static_cast<double>(spotsOfPixel));
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
      return {world_.layout.totalColour(
          luminanceAlong(light_, domain_, eye_, direction, true).value_or(Columns<K>{}))};
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

  /// Whether a surface goes on for another cell `towards` where its cells lie from a point at its edge, and
  /// light hardly changes on the way: then it is the same at the edge.
  [[nodiscard]] bool isEvenBeyond(int column, int row, const glm::vec3& point, const glm::vec3& normal,
                                  const glm::vec3& towards, float distance_m) const {
    constexpr float changeMost = 0.15F;
    const glm::vec3 view = (point - eye_) / distance_m;
    const float seenAcross = glm::length(towards - glm::dot(towards, view) * view);
    const float spacing_m = distance_m * cell * camera_.pixelAngle() / std::max(seenAcross, 0.02F);
    const Cell<K>* near = nullptr;
    const Cell<K>* far = nullptr;
    float nearest_m = std::numeric_limits<float>::infinity();
    float farthest_m = -nearest_m;
    for (int y = std::max(row - 2, 0); y <= std::min(row + 2, rows_ - 1); ++y) {
      for (int x = std::max(column - 2, 0); x <= std::min(column + 2, columns_ - 1); ++x) {
        const Cell<K>& other = cellAt(x, y);
        const bool isSame = other.isSurface && glm::dot(other.normal, normal) > 0.98F &&
                            std::abs(glm::dot(other.point - point, normal)) < 0.002F * distance_m;
        if (!isSame) continue;
        const float along_m = glm::dot(other.point - point, towards);
        if (along_m < nearest_m) {
          nearest_m = along_m;
          near = &other;
        }
        if (along_m > farthest_m) {
          farthest_m = along_m;
          far = &other;
        }
      }
    }
    if (near == nullptr || farthest_m - nearest_m < 0.7F * spacing_m) return false;
    const float here_lx = world_.layout.strength(near->direct_lx + near->reflected_lx);
    const float there_lx = world_.layout.strength(far->direct_lx + far->reflected_lx);
    return std::abs(there_lx - here_lx) < changeMost * here_lx;
  }

  /// Irradiance between the cells near a picture point that lie on the same surface, if they lie about it. A
  /// surface that is seen aslant and narrow, as a window's head, often has all of them before the point or
  /// all behind it, where light may be another. Cells lie further apart on a surface seen `aslant`, the
  /// cosine.
  [[nodiscard]] std::optional<Columns<K>> irradianceAt(float x, float y, const glm::vec3& point,
                                                       const glm::vec3& normal, float distance_m,
                                                       float aslant) const {
    const float cell_m = distance_m * cell * camera_.pixelAngle();  // where it is seen squarely
    const float step_m = cell_m / std::max(aslant, 0.02F);
    const float farthest_m = std::max(0.05F * distance_m, std::min(2.0F * step_m, 0.3F * distance_m));
    const int column = static_cast<int>(x) / cell;
    const int row = static_cast<int>(y) / cell;
    Columns<K> sum;
    glm::vec3 offset(0.0F);
    float weights = 0.0F;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (column + dx < 0 || row + dy < 0 || column + dx >= columns_ || row + dy >= rows_) continue;
        const Cell<K>& other = cellAt(column + dx, row + dy);
        if (!other.isSurface || glm::dot(other.normal, normal) < 0.7F) continue;
        const float offPlane = std::abs(glm::dot(other.point - point, normal)) / (0.01F * distance_m);
        if (glm::length(other.point - point) > farthest_m) continue;
        const float tent =
            std::max(1.5F - std::abs(x / cell - static_cast<float>(column + dx) - 0.5F), 0.01F) *
            std::max(1.5F - std::abs(y / cell - static_cast<float>(row + dy) - 0.5F), 0.01F);
        const float weight = tent * std::exp(-4.0F * (offPlane + 1.0F - glm::dot(other.normal, normal)));
        sum += weight * (other.direct_lx + other.reflected_lx);
        offset += weight * (other.point - point);
        weights += weight;
      }
    }
    if (weights < 1e-4F) return std::nullopt;
    if (glm::length(offset) > weights * std::max(cell_m, 0.25F * step_m) &&
        !isEvenBeyond(column, row, point, normal, glm::normalize(offset), distance_m)) {
      return std::nullopt;
    }
    return (1.0F / weights) * sum;
  }

  const SolvedLight<K>& light_;
  const World& world_;
  Camera camera_;
  glm::vec3 eye_;
  GatherSettings settings_, spotSettings_;  // of a cell, of a spot of a pixel
  int columns_, rows_;
  std::vector<Cell<K>> cells_;
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
