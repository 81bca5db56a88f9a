// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures: light is found at samples, then pixels are shaded with several rays where they need it.
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

#include "viewdirect.hpp"
#include "viewreflected.hpp"
#include "viewsamples.hpp"

namespace clerestory {
namespace {

// Where the rays of a pixel pass through it.
constexpr std::array<glm::vec2, 4> spots = {
    {{0.375F, 0.125F}, {0.875F, 0.375F}, {0.125F, 0.625F}, {0.625F, 0.875F}}};
// Where 16 more pass, if the first differ: a lattice that is sheared, so that no two share a row or a column.
constexpr auto furtherSpots = [] {
  constexpr std::size_t side = 4;
  std::array<glm::vec2, side * side> places{};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto column = static_cast<float>(i % side);
    const auto row = static_cast<float>(i / side);
    places[i] = {(column + (row + 0.5F) / side) / side, (row + (column + 0.5F) / side) / side};
  }
  return places;
}();
constexpr float contrastLeast = 1.1F;                  // between the first, to look further
const GatherSettings spotSettings{{96.0F, 2.0F}, 64};  // where no sample is near

template <int K>
class Picture {
 public:
  Picture(const SolvedLight<K>& light, const ViewSettings& view, const PictureSettings& settings)
      : light_(light),
        world_(light.world()),
        looks_(light, view),
        samples_(world_, looks_),
        domain_(domainAt(world_, looks_.eye())) {
    gatherReflected(light_, settings.rays, samples_);
    gatherDirect(light_, {settings.directRays, settings.deviationMost}, samples_);
    for (const ViewSample<K>& sample : samples_.all)
      lit_.push_back({sample.pixel, 1.0F / sample.reach_px, sample.point, sample.normal,
                      glm::vec3(world_.layout.totalColour(sample.irradiance_lx()))});
    lookThroughCorners();
  }

  [[nodiscard]] LuminanceImage shaded() const {
    LuminanceImage image{looks_.camera().width(), looks_.camera().height(), {}, {}};
    image.pixels_cd_m2.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    image.illuminance_lx.assign(image.pixels_cd_m2.size(), std::numeric_limits<float>::quiet_NaN());
    forEachIndex(image.pixels_cd_m2.size(), 256, [&](std::size_t i) { shade(i, image); });
    return image;
  }

 private:
  /// What it sees, and the illuminance of the surface that it meets.
  struct Seen {
    glm::dvec3 luminance_cd_m2{0.0};
    double illuminance_lx = std::numeric_limits<double>::quiet_NaN();  ///< NaN: no surface
  };

  /// What pixels need of a sample, close together since they ask for it often.
  struct Lit {
    glm::vec2 pixel;
    float perReach;  ///< 1/px
    glm::vec3 point, normal;
    glm::vec3 irradiance_lx;  ///< by all kinds of light, without the sun's beam
  };

  /// Light of a side that no sample is near, gathered for the rays of one pixel.
  struct Spot {
    std::uint32_t side;
    glm::vec3 irradiance_lx;
  };

  /// What a ray through a corner of pixels meets: a lit surface, or none that would do for a whole pixel.
  struct Corner {
    std::uint32_t side = RayScene::Hit::none;
    glm::vec3 beam_lx{0.0F};
  };

  /// The lit side that a ray of view ends on; none for glass, the open, a lamp.
  [[nodiscard]] std::uint32_t sideOf(const Look& look) const {
    return look.isInPicture && looks_.isLit(look.hit) && !lampOf(look) ? look.hit.side()
                                                                       : RayScene::Hit::none;
  }

  [[nodiscard]] Corner cornerOf(const Look& look, std::uint64_t key) const {
    const std::uint32_t side = sideOf(look);
    if (side == RayScene::Hit::none) return {};
    return {side, beamOn(look, key)};
  }

  /// The corners of a pixel.
  [[nodiscard]] std::array<Corner, 4> cornersOf(std::size_t x, std::size_t y) const {
    const std::size_t width = static_cast<std::size_t>(looks_.camera().width()) + 1;
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
    const std::size_t width = static_cast<std::size_t>(looks_.camera().width()) + 1;
    const std::size_t height = static_cast<std::size_t>(looks_.camera().height()) + 1;
    corners_.resize(width * height);
    forEachIndex(height, 1, [&](std::size_t y) {
      const std::vector<Look> looks = looks_.row({0.0F, static_cast<float>(y)}, width);
      for (std::size_t i = y * width, x = 0; x < width; ++i, ++x)
        corners_[i] = cornerOf(looks[x], mixKeys(0x71f, i));
    });
  }

  void shade(std::size_t pixel, LuminanceImage& image) const {
    const std::size_t width = static_cast<std::size_t>(looks_.camera().width());
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
    std::vector<Spot> spotsMet;
    const auto add = [&](const Look& look) {
      sides.push_back(sideOf(look));
      const Seen seen = seenAlong(look, mixKeys(key, looked++), spotsMet);
      sum += seen.luminance_cd_m2;
      const double luminance = luminanceOf(seen.luminance_cd_m2);
      darkest = std::min(darkest, luminance);
      brightest = std::max(brightest, luminance);
      if (std::isnan(seen.illuminance_lx)) return;
      lit_lx += seen.illuminance_lx;
      ++surfaces;
    };
    const auto addAt = [&](std::span<const glm::vec2> places) {
      std::array<glm::vec2, furtherSpots.size()> at;
      std::array<Look, furtherSpots.size()> looks;
      for (std::size_t i = 0; i < places.size(); ++i) at[i] = corner + places[i];
      looks_.through(std::span(at).first(places.size()), looks);
      for (std::size_t i = 0; i < places.size(); ++i) add(looks[i]);
    };
    addAt(spots);
    if (brightest > contrastLeast * darkest || !showAllOfCorners(sides, pixel % width, pixel / width))
      addAt(furtherSpots);
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
    const Look look = looks_.atMiddle(static_cast<int>(x), static_cast<int>(y));
    if (!isAlike(cornerOf(look, key))) return std::nullopt;
    const glm::vec3 normal = world_.normalOf(look.hit.side());
    const auto irradiance = irradianceAt(look.at.x, look.at.y, looks_.pointOf(look), normal,
                                         look.hit.distance_m, std::abs(glm::dot(normal, look.direction)));
    if (!irradiance) return std::nullopt;
    return surfaceSeen(look.hit, *irradiance, corner.beam_lx);
  }

  /// The sun's beam where a ray of view ends. [lx]
  [[nodiscard]] glm::vec3 beamOn(const Look& look, std::uint64_t key) const {
    if (!world_.sun) return glm::vec3(0.0F);
    return sunlight(world_.building.sideDomain[look.hit.side()], looks_.pointOf(look),
                    world_.normalOf(look.hit.side()), key);
  }

  // A millimetre, since an opening often lies in the surface that it is fixed to.
  [[nodiscard]] std::optional<glm::dvec3> lampOf(const Look& look) const {
    return lampLuminance(world_, looks_.eye(), look.direction, look.hit.distance_m + 1e-3F);
  }

  /// As the columns of a solve have it: of grey surfaces, all channels are one.
  [[nodiscard]] glm::dvec3 inColumns(const glm::dvec3& colour) const {
    return world_.layout.grey ? glm::dvec3(luminanceOf(colour)) : colour;
  }

  /// Every kind of light is reflected alike, so their sum tells what is seen of a surface.
  [[nodiscard]] Seen surfaceSeen(const RayScene::Hit& hit, const glm::vec3& irradiance_lx,
                                 const glm::vec3& beam_lx) const {
    const glm::dvec3 all_lx = glm::dvec3(irradiance_lx) + inColumns(glm::dvec3(beam_lx));
    glm::dvec3 exitance_lm_m2 = inColumns(world_.reflectanceOf(hit.piece)) * all_lx;
    if (world_.layout.electric) exitance_lm_m2 += inColumns(world_.materialOf(hit.piece).exitance_lm_m2);
    return {std::numbers::inv_pi * exitance_lm_m2, luminanceOf(all_lx)};
  }

  [[nodiscard]] Seen seenAlong(const Look& look, std::uint64_t key, std::vector<Spot>& spotsMet) const {
    if (!look.isInPicture) return {};
    if (const auto lamp = lampOf(look)) return {*lamp};
    if (!looks_.isLit(look.hit)) return {openSeen(look)};
    const glm::vec3 point = looks_.pointOf(look);
    const glm::vec3 normal = world_.normalOf(look.hit.side());
    std::optional<glm::vec3> irradiance = irradianceAt(
        look.at.x, look.at.y, point, normal, look.hit.distance_m, std::abs(glm::dot(normal, look.direction)));
    if (!irradiance) irradiance = irradianceOfSpot(look.hit.side(), point, normal, key, spotsMet);
    return surfaceSeen(look.hit, *irradiance, beamOn(look, key));
  }

  /// What is seen of glass, and beyond it or where there is nothing.
  [[nodiscard]] glm::dvec3 openSeen(const Look& look) const {
    if (domain_ < 0) return {};
    Columns<K> seen = luminanceAlong(light_, domain_, looks_.eye(), look.direction, LightAsked::all, look.hit)
                          .value_or(Columns<K>{});
    if (look.hit || world_.building.domains[static_cast<std::size_t>(domain_)].open)
      seen += world_.layout.template light<K>(
          world_.layout.sunColumn(), glm::dvec3(sunDiscLuminance(world_, looks_.eye(), look.direction)));
    return world_.layout.totalColour(seen);
  }

  /// Light of a point that no sample is near: that of the first such point of its side in the pixel.
  [[nodiscard]] glm::vec3 irradianceOfSpot(std::uint32_t side, const glm::vec3& point,
                                           const glm::vec3& normal, std::uint64_t key,
                                           std::vector<Spot>& spotsMet) const {
    const auto known = std::ranges::find(spotsMet, side, &Spot::side);
    if (known != spotsMet.end()) return known->irradiance_lx;
    const Gathered<K> arriving = gather(light_, world_.building.sideDomain[side],
                                        point + rayOffset_m * normal, normal, spotSettings, key);
    const Columns<K> all_lx = arriving.direct_lx + arriving.reflected_lx;
    return spotsMet.emplace_back(side, glm::vec3(world_.layout.totalColour(all_lx))).irradiance_lx;
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
  [[nodiscard]] std::optional<glm::vec3> irradianceAt(float x, float y, const glm::vec3& point,
                                                      const glm::vec3& normal, float distance_m,
                                                      float aslant) const {
    const float tile_m =
        distance_m * tileSide_px * looks_.camera().pixelAngle();  // where it is seen squarely
    const float step_m = tile_m / std::max(aslant, 0.02F);
    const float farthest_m = std::max(0.05F * distance_m, std::min(2.0F * step_m, 0.3F * distance_m));
    const float perThickness = 1.0F / (0.01F * distance_m);
    const int column = static_cast<int>(x) / tileSide_px;
    const int row = static_cast<int>(y) / tileSide_px;
    glm::vec3 sum(0.0F);
    float weights = 0.0F;
    const auto add = [&](const Lit& other) {
      const float facing = glm::dot(other.normal, normal);
      const glm::vec3 way = other.point - point;
      if (facing < 0.7F || glm::dot(way, way) > farthest_m * farthest_m) return;
      // Nothing at a tile's distance, so that no edges of tiles show.
      const float tent = std::max(1.0F - std::abs(x - other.pixel.x) * other.perReach, 0.01F) *
                         std::max(1.0F - std::abs(y - other.pixel.y) * other.perReach, 0.01F);
      const float apart = std::abs(glm::dot(way, normal)) * perThickness + 1.0F - facing;
      const float weight = apart > 1e-4F ? tent * std::exp(-4.0F * apart) : tent;
      sum += weight * other.irradiance_lx;
      weights += weight;
    };
    const int first = std::max(column - 1, 0);
    const int last = std::min(column + 1, samples_.columns() - 1);
    for (int ny = std::max(row - 1, 0); ny <= std::min(row + 1, samples_.rows() - 1); ++ny) {
      const std::size_t end = samples_.firstOf(samples_.tileAt(last, ny) + 1);
      for (std::size_t s = samples_.firstOf(samples_.tileAt(first, ny)); s < end; ++s) add(lit_[s]);
    }
    if (weights < 1e-4F) return std::nullopt;
    return (1.0F / weights) * sum;
  }

  const SolvedLight<K>& light_;
  const World& world_;
  Looks<K> looks_;
  ViewSamples<K> samples_;
  std::vector<Lit> lit_;         // #samples
  std::vector<Corner> corners_;  // of pixels, one more in both directions
  std::int32_t domain_;          // that the eye is in
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
  return Picture<K>(light, view, settings).shaded();
}

#define CLERESTORY_INSTANTIATE(K) \
  template LuminanceImage renderView<K>(const SolvedLight<K>&, const ViewSettings&, const PictureSettings&);
CLERESTORY_STUDY_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
