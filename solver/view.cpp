// SPDX-License-Identifier: GPL-3.0-or-later
// Final-gathered pictures: irradiance on a coarse raster, smoothed along surfaces, then shaded with four rays
// a pixel.
#include "view.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <geometry/parallel.hpp>
#include <geometry/sampling.hpp>

namespace clerestory {
namespace {

constexpr int cell = 3;  // pixels of a side of a cell of the coarse raster
// Where the rays of a pixel pass through it.
constexpr std::size_t spotsOfPixel = 4;
constexpr glm::vec2 spots[spotsOfPixel] = {
    {0.375F, 0.125F}, {0.875F, 0.375F}, {0.125F, 0.625F}, {0.625F, 0.875F}};
constexpr int smoothingSteps = 5;  // each doubles the reach: 62 cells after five

struct Camera {
  glm::vec3 eye, forward, right, up;
  float halfHeight;
  int width, height;

  /// Width of a cell of the coarse raster where it is seen squarely, of the distance.
  [[nodiscard]] float cellAngle() const { return cell * 2.0F * halfHeight / static_cast<float>(height); }

  [[nodiscard]] glm::vec3 ray(float x, float y) const {
    const float scale = 2.0F * halfHeight / static_cast<float>(height);
    return glm::normalize(forward + (x - 0.5F * static_cast<float>(width)) * scale * right -
                          (y - 0.5F * static_cast<float>(height)) * scale * up);
  }
};

Camera cameraOf(const World& world, const ViewSettings& view) {
  Camera camera{};
  camera.eye = world.local(view.eye_m);
  camera.forward = glm::normalize(glm::vec3(view.target_m - view.eye_m));
  camera.right = glm::normalize(glm::cross(camera.forward, glm::vec3(view.up)));
  camera.up = glm::cross(camera.right, camera.forward);
  camera.halfHeight = static_cast<float>(std::tan(0.5 * view.fieldOfView_deg * std::numbers::pi / 180.0));
  camera.width = view.size_px[0];
  camera.height = view.size_px[1];
  return camera;
}

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
        camera_(cameraOf(world_, view)),
        settings_(settings),
        spotSettings_(shareOf(settings, spotsOfPixel)),
        columns_((camera_.width + cell - 1) / cell),
        rows_((camera_.height + cell - 1) / cell),
        cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

  LuminanceImage render() {
    domain_ = domainAt(world_, camera_.eye);
    forEachIndex(cells_.size(), 64, [&](std::size_t i) { gatherCell(i); });
    smooth();
    LuminanceImage image{camera_.width, camera_.height, {}};
    image.pixels_cd_m2.resize(static_cast<std::size_t>(camera_.width) *
                              static_cast<std::size_t>(camera_.height));
    forEachIndex(image.pixels_cd_m2.size(), 256, [&](std::size_t i) { image.pixels_cd_m2[i] = shade(i); });
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
    const glm::vec3 direction = camera_.ray(cell * (column + 0.5F), cell * (row + 0.5F));
    const auto hit = world_.rays.nearest(camera_.eye, direction, RayScene::Barrier::opaqueAndGlass);
    if (!hit || world_.materialOf(hit.piece).glazing) return;
    const std::int32_t domain = world_.building.sideDomain[hit.side()];
    if (domain < 0 || light_.of(domain) == nullptr) return;
    Cell<K>& own = cells_[i];
    own.isSurface = true;
    own.point = camera_.eye + hit.distance_m * direction;
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

  [[nodiscard]] glm::vec3 shade(std::size_t pixel) const {
    const auto x = static_cast<float>(pixel % static_cast<std::size_t>(camera_.width));
    const auto y = static_cast<float>(pixel / static_cast<std::size_t>(camera_.width));
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < spotsOfPixel; ++i)
      sum += luminanceAt(x + spots[i].x, y + spots[i].y, mixKeys(0x71d, spotsOfPixel * pixel + i));
    return glm::vec3(sum / static_cast<double>(spotsOfPixel));
  }

  [[nodiscard]] glm::dvec3 luminanceAt(float x, float y, std::uint64_t key) const {
    const glm::vec3 direction = camera_.ray(x, y);
    const auto hit = world_.rays.nearest(camera_.eye, direction, RayScene::Barrier::opaqueAndGlass);
    // A millimetre, since an opening often lies in the surface that it is fixed to.
    const auto lamp = lampLuminance(world_, camera_.eye, direction, hit.distance_m + 1e-3F);
    if (lamp) return *lamp;
    const std::int32_t domain = hit ? world_.building.sideDomain[hit.side()] : -1;
    const bool isSolved = domain >= 0 && light_.of(domain) != nullptr;
    if (!hit || world_.materialOf(hit.piece).glazing || !isSolved) {
      if (domain_ < 0) return glm::dvec3(0.0);
      return world_.layout.totalColour(
          luminanceAlong(light_, domain_, camera_.eye, direction, true).value_or(Columns<K>{}));
    }
    const glm::vec3 point = camera_.eye + hit.distance_m * direction;
    const glm::vec3 normal = world_.normalOf(hit.side());
    std::optional<Columns<K>> irradiance = irradianceAt(x, y, point, normal, hit.distance_m);
    if (!irradiance) {
      const Gathered<K> arriving =
          gather(light_, domain, point + rayOffset_m * normal, normal, spotSettings_, key);
      irradiance = arriving.direct_lx + arriving.reflected_lx;
    }
    *irradiance += world_.layout.template light<K>(
        world_.layout.sunColumn(),
        glm::dvec3(sunlightByDisc(world_, point + rayOffset_m * normal, normal, 1, key)));
    const Columns<K> exitance =
        world_.layout.template property<K>(world_.reflectanceOf(hit.piece)) * *irradiance +
        world_.layout.template light<K>(world_.layout.electricColumn(),
                                        world_.materialOf(hit.piece).exitance_lm_m2);
    return std::numbers::inv_pi * world_.layout.totalColour(exitance);
  }

  /// Irradiance between the cells near a picture point that lie on the same surface, if they lie about it. A
  /// surface that is seen aslant and narrow, as a window's head, often has all of them before the point or
  /// all behind it, where light may be another.
  [[nodiscard]] std::optional<Columns<K>> irradianceAt(float x, float y, const glm::vec3& point,
                                                       const glm::vec3& normal, float distance_m) const {
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
        const float away = glm::length(other.point - point) / (0.05F * distance_m);
        if (away > 1.0F) continue;
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
    if (glm::length(offset) > weights * distance_m * camera_.cellAngle()) return std::nullopt;
    return (1.0F / weights) * sum;
  }

  const SolvedLight<K>& light_;
  const World& world_;
  Camera camera_;
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
