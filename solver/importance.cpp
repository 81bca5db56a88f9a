// SPDX-License-Identifier: GPL-3.0-or-later
// Random walks from the sensors and eyes of a domain.
#include "importance.hpp"

#include <cmath>
#include <numbers>

#include <geometry/sampling.hpp>

#include "sensors.hpp"

namespace clerestory {
namespace {

constexpr std::uint32_t walksOfKind = 8192;  // of sensors, and of eyes
constexpr std::uint32_t reflectionsMost = 32;
constexpr double shareOfArea = 0.1;  // of all weight
// Measured by bench_importance (docs/validation.md): 0.04 and 0.29 pay, 0.51 and more do not.
constexpr double askedMost = 0.4;

/// What walks have met, of the building's sides.
struct Met {
  std::vector<double> reflected, hits;  ///< #sides
};

/// Follows one walk and adds what it meets.
void walk(const World& world, std::int32_t domain, glm::vec3 from, glm::vec3 direction, std::uint64_t key,
          Met& met) {
  for (std::uint32_t i = 0; i < reflectionsMost; ++i) {
    const auto hit = world.rays.nearest(from, direction, RayScene::Barrier::opaqueAndGlass);
    if (!hit || world.building.sideDomain[hit.side()] != domain) return;
    const double reflectance = luminanceOf(world.reflectanceOf(hit.side() / 2));
    met.reflected[hit.side()] += reflectance;
    met.hits[hit.side()] += 1.0;
    const Sequence sequence(mixKeys(key, i));
    if (static_cast<double>(sequence(0, 2)) >= reflectance) return;
    const glm::vec3 normal = world.normalOf(hit.side());
    from += hit.distance_m * direction + rayOffset_m * normal;
    direction = cosineDirection(normal, sequence(0, 0), sequence(0, 1));
  }
}

void walkFromSensors(const World& world, std::int32_t domain, Met& met) {
  struct Sensor {
    glm::vec3 point, normal;
  };
  std::vector<Sensor> sensors;
  for (const SensorGrid& grid : world.building.grids) {
    const bool isElsewhere =
        grid.room >= 0 && world.building.rooms[static_cast<std::size_t>(grid.room)].domain != domain;
    for (std::size_t i = 0; i < grid.points.size() && !isElsewhere; ++i) {
      const glm::vec3 point = world.local(grid.points[i]);
      if (grid.room >= 0 || domainAt(world, point) == domain)
        sensors.push_back({point, glm::vec3(grid.normals[i])});
    }
  }
  if (sensors.empty()) return;
  const Sequence sequence(0x1327);
  for (std::uint32_t i = 0; i < walksOfKind; ++i) {
    const Sensor& sensor = sensors[std::size_t{i} * sensors.size() / walksOfKind];
    const glm::vec3 direction = cosineDirection(sensor.normal, sequence(i, 0), sequence(i, 1));
    walk(world, domain, sensor.point, direction, mixKeys(0x5e45, i), met);
  }
}

void walkFromEyes(const World& world, const Study& study, std::int32_t domain, Met& met) {
  std::vector<glm::vec3> eyes;
  for (const ViewSettings& view : study.views) {
    const glm::vec3 eye = world.local(view.eye_m);
    if (domainAt(world, eye) == domain) eyes.push_back(eye);
  }
  if (eyes.empty()) return;
  const Sequence sequence(0xe7e5);
  for (std::uint32_t i = 0; i < walksOfKind; ++i) {
    const float z = 2.0F * sequence(i, 0) - 1.0F;
    const float angle = 2.0F * std::numbers::pi_v<float> * sequence(i, 1);
    const float radius = std::sqrt(std::max(0.0F, 1.0F - z * z));
    walk(world, domain, eyes[i % eyes.size()], {radius * std::cos(angle), radius * std::sin(angle), z},
         mixKeys(0xe7e, i), met);
  }
}

}  // namespace

std::vector<float> importanceOf(const World& world, const Study& study, std::int32_t domain,
                                std::span<const std::uint32_t> sides) {
  Met met;
  met.reflected.resize(2 * world.pieces().size());
  met.hits.resize(2 * world.pieces().size());
  walkFromSensors(world, domain, met);
  walkFromEyes(world, study, domain, met);

  double area_m2 = 0.0;
  double total = 0.0;
  double squares = 0.0;  // of importance by area, summed over area
  for (const std::uint32_t side : sides) {
    const double own_m2 = world.pieces().area_m2[side / 2];
    area_m2 += own_m2;
    total += met.reflected[side];
    // hits (hits - 1): the noise of a few hits on a small side would count as importance of its own.
    if (met.hits[side] > 1.0)
      squares += met.reflected[side] * met.reflected[side] * (1.0 - 1.0 / met.hits[side]) / own_m2;
  }
  // The share of the area that matters: 1 where all of it matters alike.
  if (!(squares > 0.0) || total * total / (area_m2 * squares) > askedMost) return {};
  std::vector<float> weights;
  for (const std::uint32_t side : sides) {
    const double asked_m2 = met.reflected[side] / total * area_m2;
    const double own_m2 = world.pieces().area_m2[side / 2];
    weights.push_back(static_cast<float>((1.0 - shareOfArea) * asked_m2 + shareOfArea * own_m2));
  }
  return weights;
}

}  // namespace clerestory
