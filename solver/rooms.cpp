// SPDX-License-Identifier: GPL-3.0-or-later
// Looks out from the middle of each pane: for the sky that it sees, and for the sun through a day.
#include "rooms.hpp"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

#include <solver/daylight.hpp>

namespace clerestory {
namespace {

constexpr int looksOfSky = 360;  // over the half circle that a pane could see
constexpr int stepsOfHour = 12;
constexpr float beyond_m = 1e4F;

/// A pane as it looks out.
struct Outlook {
  glm::vec3 from, outward;
  double area_m2, transmittance;

  [[nodiscard]] bool sees(const World& world, const glm::vec3& direction) const {
    return glm::dot(direction, outward) > 0.0F &&
           !world.rays.meetsAny(from, direction, RayScene::Barrier::opaqueAndGlass, beyond_m);
  }
};

std::vector<Outlook> outlooksOf(const World& world, std::int32_t domain) {
  std::vector<Outlook> outlooks;
  for (const Portal& portal : world.building.portals) {
    if (portal.inside != domain) continue;
    const auto polygon = world.polygon(portal.piece);
    const glm::vec3 outward = world.normalOf(2 * portal.piece + (portal.frontIsInside ? 1U : 0U));
    glm::vec3 centre(0.0F);
    for (const glm::vec3& corner : polygon) centre += corner / static_cast<float>(polygon.size());
    outlooks.push_back({centre + rayOffset_m * outward, outward, world.pieces().area_m2[portal.piece],
                        world.glassOf(portal.piece).hemisphericalTransmittance() *
                            static_cast<double>(world.portalFactor(portal.piece))});
  }
  return outlooks;
}

/// Angle of visible sky in the upright plane square to a pane. [degrees]
double skyAngle_deg(const World& world, const Outlook& outlook) {
  const glm::vec3 level(outlook.outward.x, outlook.outward.y, 0.0F);
  const float length = glm::length(level);
  const glm::vec3 ahead = length > 1e-3F ? level / length : glm::vec3(0.0F, -1.0F, 0.0F);
  int seen = 0;
  for (int i = 0; i < looksOfSky; ++i) {
    const double angle = glm::radians(180.0 * (i + 0.5) / looksOfSky);
    seen += outlook.sees(world, static_cast<float>(std::cos(angle)) * ahead +
                                    glm::vec3(0.0F, 0.0F, static_cast<float>(std::sin(angle))))
                ? 1
                : 0;
  }
  return 180.0 * seen / looksOfSky;
}

double averageDaylightFactor_pct(const World& world, std::int32_t domain,
                                 const std::vector<Outlook>& outlooks) {
  double area_m2 = 0.0;
  double reflecting_m2 = 0.0;
  for (std::uint32_t side = 0; side < world.building.sideDomain.size(); ++side) {
    if (world.building.sideDomain[side] != domain || world.building.innerGlass[side / 2]) continue;
    area_m2 += world.pieces().area_m2[side / 2];
    reflecting_m2 += world.pieces().area_m2[side / 2] * luminanceOf(world.reflectanceOf(side / 2));
  }
  if (!(area_m2 > 0.0)) return 0.0;
  const double reflectance = reflecting_m2 / area_m2;
  double sum = 0.0;
  for (const Outlook& outlook : outlooks)
    sum += outlook.area_m2 * outlook.transmittance * skyAngle_deg(world, outlook);
  return sum / (area_m2 * (1.0 - reflectance * reflectance));
}

/// Directions to the sun on 21 March of the study's year, in steps of a stepsOfHour-th of an hour.
std::vector<glm::vec3> sunsOfEquinox(const Study& study) {
  ClockTime time;
  if (study.sky.time) time.year = study.sky.time->year;
  std::vector<glm::vec3> suns;
  for (int step = 0; step < 24 * stepsOfHour; ++step) {
    time.hour_h = (step + 0.5) / stepsOfHour;
    const glm::dvec2 sun_deg = sunPosition_deg(time, study.site);
    if (sun_deg.x > 0.0) suns.emplace_back(directionFromAngles(sun_deg.x, sun_deg.y, study.site.north_deg));
  }
  return suns;
}

}  // namespace

std::vector<RoomValue> measureRooms(const World& world, const Study& study) {
  const std::vector<glm::vec3> suns = sunsOfEquinox(study);
  std::vector<RoomValue> rooms;
  for (const Room& room : world.building.rooms) {
    RoomValue value;
    if (!world.building.domains[static_cast<std::size_t>(room.domain)].open) {
      const std::vector<Outlook> outlooks = outlooksOf(world, room.domain);
      value.averageDaylightFactor_pct = averageDaylightFactor_pct(world, room.domain, outlooks);
      for (const Outlook& outlook : outlooks) {
        const auto steps = std::count_if(suns.begin(), suns.end(),
                                         [&](const glm::vec3& sun) { return outlook.sees(world, sun); });
        value.sunlight_h = std::max(value.sunlight_h, static_cast<double>(steps) / stepsOfHour);
      }
    }
    rooms.push_back(value);
  }
  return rooms;
}

}  // namespace clerestory
