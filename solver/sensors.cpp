// SPDX-License-Identifier: GPL-3.0-or-later
// Sensors: receivers without area, lit directly by quadrature and by a final gather of reflected light.
#include "sensors.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>

#include <geometry/parallel.hpp>
#include <geometry/sampling.hpp>

namespace clerestory {
namespace {

constexpr std::uint32_t samplesMost = 65536;  // of a polygon or the hemisphere
constexpr int roundsMost = 8;                 // of twice as many
constexpr std::uint32_t raysOfDisc = 32;      // to the sun's disc, from a sensor
constexpr double evenErrorMost = 0.25;        // of what is reflected at a sensor
constexpr float missedBetween = 1.0F;         // samples: of one sample's share of the light

/// How sure light is when more samples are decided on. What all samples have missed, the reveal at the edge
/// of what a pane shows, is not in their deviation: a few that see the sky alone would seem sure, and too
/// bright. Nor is it where few have met what is in the way of a bright part: `unhidden_lx` of it could be.
template <int K>
float doubtOf(const ColumnLayout& layout, const DirectLight<K>& own, float unhidden_lx = 0.0F) {
  const float missed_lx = missedBetween * std::max(layout.strength(own.illuminance_lx), unhidden_lx) /
                          static_cast<float>(std::max(own.rays, 1U));
  return std::hypot(own.deviation_lx, missed_lx);
}

}  // namespace

template <int K>
std::optional<Columns<K>> luminanceAlong(const SolvedLight<K>& light, std::int32_t domain,
                                         const glm::vec3& from, const glm::vec3& direction, LightAsked what) {
  return luminanceAlong(light, domain, from, direction, what,
                        light.world().rays.nearest(from, direction, RayScene::Barrier::opaqueAndGlass));
}

template <int K>
std::optional<Columns<K>> luminanceAlong(const SolvedLight<K>& light, std::int32_t domain,
                                         const glm::vec3& fromIn, const glm::vec3& directionIn,
                                         LightAsked what, RayScene::Hit hit) {
  const World& world = light.world();
  const bool withDirect = what == LightAsked::all;
  Columns<K> sum;
  float weight = 1.0F;
  glm::vec3 from = fromIn;
  glm::vec3 direction = directionIn;
  for (int depth = 0; depth < mirrorDepth; ++depth) {
    if (depth > 0) hit = world.rays.nearest(from, direction, RayScene::Barrier::opaqueAndGlass);
    if (!hit) {
      // Only an open domain sees the sky without glass; in a closed one this is a leak.
      if (!world.building.domains[static_cast<std::size_t>(domain)].open) return std::nullopt;
      return sum +
             weight * world.innerTransmittance(from, from + 1e4F * direction) * light.skyLuminance(direction);
    }
    const glm::vec3 point = from + hit.distance_m * direction;
    weight *= world.innerTransmittance(from, point);
    if (!world.materialOf(hit.piece).glazing) {
      if (!light.isSolved(hit)) return std::nullopt;
      if (what == LightAsked::reflectedEvenly && depth == 0 && light.isInBrightPart(hit, point)) return sum;
      return sum + weight * std::numbers::inv_pi_v<float> * light.exitance(hit, point, withDirect);
    }
    const Glass& glass = world.glassOf(hit.piece);
    const glm::vec3 normal = world.normalOf(hit.side());
    const float cosine = std::abs(glm::dot(direction, normal));
    if (withDirect) sum += weight * light.paneLuminance(hit.piece, point, direction);
    if (world.materialOf(hit.piece).diffusing) {
      return sum + weight * std::numbers::inv_pi_v<float> * light.exitance(hit, point, false);
    }
    weight *= glass.reflectance(cosine);
    direction = glm::reflect(direction, normal);
    from = point + rayOffset_m * normal;
  }
  return sum;
}

namespace {

/// Light at a point from all that is neither portal, emitter nor bright part, by cosine rays.
template <int K>
class HemisphereLight {
 public:
  HemisphereLight(const SolvedLight<K>& light, std::int32_t domain, const glm::vec3& point,
                  const glm::vec3& normal, std::uint64_t key)
      : light_(light),
        isOpen_(light.world().building.domains[static_cast<std::size_t>(domain)].open),
        domain_(domain),
        point_(point),
        normal_(normal),
        sequence_(key) {}

  [[nodiscard]] std::uint32_t size() const { return samples_.size(); }

  /// Carries the rays on to `count` in all. Those that end on no air's side (a crack between two books) are
  /// left out, as shooting leaves them out.
  void sampleTo(std::uint32_t count) {
    const World& world = light_.world();
    for (std::uint32_t i = size(); i < count; ++i) {
      const float u = sequence_(i, 0);
      const float v = sequence_(i, 1);
      const glm::vec3 direction = cosineDirection(normal_, u, v);
      const auto seen = luminanceAlong(light_, domain_, point_, direction, LightAsked::reflectedEvenly);
      if (!seen) {
        samples_.add(u, v, 0.0F, {}, 0.0F);
        continue;
      }
      counted_ += 1.0F;
      samples_.add(u, v, 1.0F, *seen, world.layout.strength(*seen));
      if (isOpen_ && !world.rays.nearest(point_, direction, RayScene::Barrier::opaqueAndGlass)) sky_ += *seen;
    }
    seen_ = {std::numbers::pi_v<float> * samples_.mean(),
             std::numbers::pi_v<float> * std::sqrt(samples_.variance()), size()};
  }

  [[nodiscard]] const DirectLight<K>& light() const { return seen_; }
  /// The part of it that comes straight from the sky.
  [[nodiscard]] Columns<K> sky_lx() const {
    return counted_ > 0.0F ? (std::numbers::pi_v<float> / counted_) * sky_ : Columns<K>{};
  }

 private:
  const SolvedLight<K>& light_;
  bool isOpen_;
  std::int32_t domain_;
  glm::vec3 point_, normal_;
  Sequence sequence_;
  EvenSamples<K> samples_;
  DirectLight<K> seen_;  // by these
  Columns<K> sky_;
  float counted_ = 0.0F;
};

}  // namespace

// What contributes more than its share of the error allowed is sampled twice as often, until all is within.
template <int K>
Gathered<K> gather(const SolvedLight<K>& light, std::int32_t domain, const glm::vec3& point,
                   const glm::vec3& normal, const GatherSettings& settings, std::uint64_t key,
                   float known_lx) {
  const ColumnLayout& layout = light.world().layout;
  std::vector<PolygonLight<K>> polygons = portalsAt(light, domain, point, normal, mixKeys(key, 1));
  std::vector<PolygonLight<K>> emitters = emittersAt(light, domain, point, normal, mixKeys(key, 2));
  std::move(emitters.begin(), emitters.end(), std::back_inserter(polygons));
  std::vector<PolygonLight<K>> bright = brightPartsAt(light, domain, point, normal, mixKeys(key, 5));
  HemisphereLight<K> hemisphere(light, domain, point, normal, mixKeys(key, 3));

  const DirectLight<K> fromLamps =
      directFromLamps<K>(light.world(), domain, point, normal, settings.direct, mixKeys(key, 4));
  DirectLight<K> fromPolygons = lightOf<K>(polygons, settings.direct);
  DirectLight<K> fromBright = lightOf<K>(bright, settings.direct);
  hemisphere.sampleTo(settings.rays);
  DirectLight<K> evenly = hemisphere.light();

  const float parts = static_cast<float>(polygons.size() + bright.size()) + 1.0F;
  for (int round = 0; round < roundsMost; ++round) {
    const float all_lx = known_lx + layout.strength(fromPolygons.illuminance_lx + fromLamps.illuminance_lx +
                                                    fromBright.illuminance_lx + evenly.illuminance_lx);
    const float allowed_lx = settings.deviationMost * all_lx;
    float doubt_lx = doubtOf(layout, evenly);
    for (const auto* own : {&polygons, &bright}) {
      for (const PolygonLight<K>& polygon : *own)
        doubt_lx = std::hypot(doubt_lx, doubtOf(layout, polygon.light(), polygon.unhidden_lx()));
    }
    if (!(doubt_lx > allowed_lx)) break;
    const auto carryOn = [&](auto& part, float unhidden_lx) {
      const float own_lx = doubtOf(layout, part.light(), unhidden_lx);
      if (own_lx * std::sqrt(parts) > allowed_lx && part.size() < samplesMost) part.sampleTo(2 * part.size());
      return part.light();
    };
    fromPolygons = {};
    for (PolygonLight<K>& polygon : polygons) fromPolygons += carryOn(polygon, polygon.unhidden_lx());
    fromBright = {};
    for (PolygonLight<K>& polygon : bright) fromBright += carryOn(polygon, polygon.unhidden_lx());
    evenly = carryOn(hemisphere, 0.0F);
  }

  Gathered<K> result;
  result.direct_lx = fromPolygons.illuminance_lx + fromLamps.illuminance_lx + hemisphere.sky_lx();
  result.reflected_lx = fromBright.illuminance_lx + evenly.illuminance_lx - hemisphere.sky_lx();
  result.directDeviation_lx = std::hypot(fromPolygons.deviation_lx, fromLamps.deviation_lx);
  result.reflectedDeviation_lx = std::hypot(fromBright.deviation_lx, evenly.deviation_lx);
  return result;
}

std::int32_t domainAt(const World& world, const glm::vec3& point) {
  constexpr std::uint32_t count = 16;
  const Sequence sequence(0xd0a);
  std::map<std::int32_t, int> votes;
  for (std::uint32_t i = 0; i < count; ++i) {
    const float z = 2.0F * sequence(i, 0) - 1.0F;
    const float angle = 2.0F * std::numbers::pi_v<float> * sequence(i, 1);
    const float radius = std::sqrt(std::max(0.0F, 1.0F - z * z));
    const auto hit = world.rays.nearest(point, {radius * std::cos(angle), radius * std::sin(angle), z},
                                        RayScene::Barrier::opaqueAndGlass);
    if (hit) {
      ++votes[world.building.sideDomain[hit.side()]];
    } else if (!world.building.domains.empty() && world.building.domains[0].open) {
      ++votes[0];
    }
  }
  std::int32_t best = -1;
  int most = 0;
  for (const auto& [domain, number] : votes) {
    if (number > most) {
      most = number;
      best = domain;
    }
  }
  return best;
}

template <int K>
GridValues senseGrid(const SolvedLight<K>& light, const SensorGrid& grid, const GatherSettings& settings) {
  const World& world = light.world();
  GridValues values;
  values.sensors.resize(grid.points.size());
  forEachIndex(grid.points.size(), 4, [&](std::size_t i) {
    const glm::vec3 point = world.local(grid.points[i]);
    const glm::vec3 normal(grid.normals[i]);
    const std::int32_t domain = grid.room >= 0
                                    ? world.building.rooms[static_cast<std::size_t>(grid.room)].domain
                                    : domainAt(world, point);
    SensorValue& value = values.sensors[i];
    if (domain < 0 || light.of(domain) == nullptr) return;
    const ColumnLayout& layout = world.layout;
    const Columns<K> sun = layout.template light<K>(
        layout.sunColumn(), glm::dvec3(sunlightByDisc(world, point, normal, raysOfDisc, mixKeys(0x5e6, i))));
    const Gathered<K> arriving =
        gather(light, domain, point, normal, settings, mixKeys(0x5e5, i), layout.strength(sun));
    const Columns<K> all = arriving.direct_lx + sun + arriving.reflected_lx;
    value.direct_lx = luminanceOf(layout.totalColour(arriving.direct_lx + sun));
    value.reflected_lx = luminanceOf(layout.totalColour(arriving.reflected_lx));
    value.sky_lx = luminanceOf(layout.colourOf(all, layout.skyColumn()));
    value.sun_lx = luminanceOf(layout.colourOf(all, layout.sunColumn()));
    value.electric_lx = luminanceOf(layout.colourOf(all, layout.electricColumn()));
    value.illuminance_lx = value.direct_lx + value.reflected_lx;
    const double sampling_lx =
        2.0 * static_cast<double>(std::hypot(arriving.directDeviation_lx, arriving.reflectedDeviation_lx));
    const SolverError& solver = light.of(domain)->solverError;
    const double gaps_lx =
        light.showsGaps() ? std::hypot(solver.gaps * value.illuminance_lx, solver.sunInGaps * value.sun_lx)
                          : 0.0;
    const double even_lx = std::min(solver.even_lx, evenErrorMost * value.reflected_lx);
    value.error_lx =
        std::hypot(std::hypot(sampling_lx, gaps_lx), solver.reflected * value.reflected_lx, even_lx);
  });
  return values;
}

#define CLERESTORY_INSTANTIATE(K)                                                                          \
  template std::optional<Columns<K>> luminanceAlong<K>(const SolvedLight<K>&, std::int32_t,                \
                                                       const glm::vec3&, const glm::vec3&, LightAsked);    \
  template std::optional<Columns<K>> luminanceAlong<K>(                                                    \
      const SolvedLight<K>&, std::int32_t, const glm::vec3&, const glm::vec3&, LightAsked, RayScene::Hit); \
  template Gathered<K> gather<K>(const SolvedLight<K>&, std::int32_t, const glm::vec3&, const glm::vec3&,  \
                                 const GatherSettings&, std::uint64_t, float);                             \
  template GridValues senseGrid<K>(const SolvedLight<K>&, const SensorGrid&, const GatherSettings&);
CLERESTORY_STUDY_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
