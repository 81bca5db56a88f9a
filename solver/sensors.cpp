// SPDX-License-Identifier: GPL-3.0-or-later
// Sensors: receivers without area, lit directly by quadrature and by a final gather of reflected light.
#include "sensors.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include <geometry/parallel.hpp>
#include <geometry/sampling.hpp>

namespace clerestory {
namespace {

constexpr int mirrorDepth = 4;  // panes that a ray is followed by reflection
constexpr std::uint32_t batches = 16;
constexpr std::uint32_t raysOfDisc = 32;  // to the sun's disc, from a sensor

/// Standard deviation of the mean of what batches sum up, of `counts` values each.
float deviationOfMean(const std::array<float, batches>& sums, const std::array<float, batches>& counts) {
  std::array<float, batches> means{};
  float mean = 0.0F;
  for (std::size_t i = 0; i < batches; ++i) {
    means[i] = sums[i] / std::max(counts[i], 1.0F);
    mean += means[i] / static_cast<float>(batches);
  }
  float variance = 0.0F;
  for (const float own : means) variance += (own - mean) * (own - mean);
  return std::sqrt(variance / static_cast<float>(batches * (batches - 1)));
}

}  // namespace

template <int K>
std::optional<Columns<K>> luminanceAlong(const SolvedLight<K>& light, std::int32_t domain,
                                         const glm::vec3& fromIn, const glm::vec3& directionIn,
                                         bool withDirect) {
  const World& world = light.world();
  Columns<K> sum;
  float weight = 1.0F;
  glm::vec3 from = fromIn;
  glm::vec3 direction = directionIn;
  for (int depth = 0; depth < mirrorDepth; ++depth) {
    const auto hit = world.rays.nearest(from, direction, RayScene::Barrier::opaqueAndGlass);
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

template <int K>
Gathered<K> gather(const SolvedLight<K>& light, std::int32_t domain, const glm::vec3& point,
                   const glm::vec3& normal, const GatherSettings& settings, std::uint64_t key) {
  const World& world = light.world();
  Gathered<K> result;
  const DirectLight<K> fromPortals =
      directFromPortals(light, domain, point, normal, settings.direct, mixKeys(key, 1));
  const DirectLight<K> fromEmitters =
      directFromEmitters(light, domain, point, normal, settings.direct, mixKeys(key, 2));
  const DirectLight<K> fromLamps =
      directFromLamps<K>(world, domain, point, normal, settings.direct, mixKeys(key, 4));
  result.direct_lx = fromPortals.illuminance_lx + fromEmitters.illuminance_lx + fromLamps.illuminance_lx;

  const bool isOpen = world.building.domains[static_cast<std::size_t>(domain)].open;
  const Sequence sequence(mixKeys(key, 3));
  // Rays that end on no air's side (a crack between two books) are left out, as shooting leaves them out.
  Columns<K> sky_cd_m2, reflected_cd_m2;
  std::array<float, batches> strengths{};
  std::array<float, batches> counts{};
  for (std::uint32_t i = 0; i < settings.rays; ++i) {
    const glm::vec3 direction = cosineDirection(normal, sequence(i, 0), sequence(i, 1));
    const bool meetsSky = isOpen && !world.rays.nearest(point, direction, RayScene::Barrier::opaqueAndGlass);
    const auto seen = luminanceAlong(light, domain, point, direction, false);
    if (!seen) continue;
    (meetsSky ? sky_cd_m2 : reflected_cd_m2) += *seen;
    strengths[i % batches] += world.layout.strength(*seen);
    counts[i % batches] += 1.0F;
  }
  const float count = std::accumulate(counts.begin(), counts.end(), 0.0F);
  if (count > 0.0F) {
    const float scale = std::numbers::pi_v<float> / count;
    result.direct_lx += scale * sky_cd_m2;
    result.reflected_lx = scale * reflected_cd_m2;
    result.reflectedDeviation_lx = std::numbers::pi_v<float> * deviationOfMean(strengths, counts);
  }
  result.directDeviation_lx =
      std::hypot(fromPortals.deviation_lx, fromEmitters.deviation_lx, fromLamps.deviation_lx);
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
GridValues senseGrid(const SolvedLight<K>& light, const SensorGrid& grid, const GatherSettings& settings,
                     double solverError) {
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
    const Gathered<K> arriving = gather(light, domain, point, normal, settings, mixKeys(0x5e5, i));
    const ColumnLayout& layout = world.layout;
    const Columns<K> sun = layout.template light<K>(
        layout.sunColumn(), glm::dvec3(sunlightByDisc(world, point, normal, raysOfDisc, mixKeys(0x5e6, i))));
    const Columns<K> all = arriving.direct_lx + sun + arriving.reflected_lx;
    value.direct_lx = luminanceOf(layout.totalColour(arriving.direct_lx + sun));
    value.reflected_lx = luminanceOf(layout.totalColour(arriving.reflected_lx));
    value.sky_lx = luminanceOf(layout.colourOf(all, layout.skyColumn()));
    value.sun_lx = luminanceOf(layout.colourOf(all, layout.sunColumn()));
    value.electric_lx = luminanceOf(layout.colourOf(all, layout.electricColumn()));
    value.illuminance_lx = value.direct_lx + value.reflected_lx;
    value.error_lx =
        2.0 * static_cast<double>(std::hypot(arriving.directDeviation_lx, arriving.reflectedDeviation_lx)) +
        solverError * value.reflected_lx;
  });
  return values;
}

#define CLERESTORY_INSTANTIATE(K)                                                                         \
  template std::optional<Columns<K>> luminanceAlong<K>(const SolvedLight<K>&, std::int32_t,               \
                                                       const glm::vec3&, const glm::vec3&, bool);         \
  template Gathered<K> gather<K>(const SolvedLight<K>&, std::int32_t, const glm::vec3&, const glm::vec3&, \
                                 const GatherSettings&, std::uint64_t);                                   \
  template GridValues senseGrid<K>(const SolvedLight<K>&, const SensorGrid&, const GatherSettings&, double);
CLERESTORY_STUDY_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
