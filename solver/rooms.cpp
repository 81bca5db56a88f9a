// SPDX-License-Identifier: GPL-3.0-or-later
// Looks out through each pane: for the sky that it sees, and for the sun through a day.
#include "rooms.hpp"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include <solver/daylight.hpp>

namespace clerestory {
namespace {

constexpr int looksOfSky = 360;  // over the half circle that a pane could see
constexpr int stepsOfHour = 12;
constexpr float beyond_m = 1e4F;
constexpr float aboveFloor_m = 1.2F, aboveSill_m = 0.3F;  // of the reference point for sunlight
constexpr float revealMost_m = 0.6F, revealStep_m = 0.02F;
constexpr float besidePane_m = 0.15F;  // how far its reveal may stand from a pane, with a frame between

/// A pane as it looks out.
struct Outlook {
  std::uint32_t piece;
  glm::vec3 centre, outward;
  double area_m2, transmittance;
};

std::vector<Outlook> outlooksOf(const World& world, std::int32_t room) {
  std::vector<Outlook> outlooks;
  for (const Portal& portal : world.building.portals) {
    if (portal.room != room) continue;
    const auto polygon = world.polygon(portal.piece);
    const glm::vec3 outward = world.normalOf(2 * portal.piece + (portal.frontIsInside ? 1U : 0U));
    glm::vec3 centre(0.0F);
    for (const glm::vec3& corner : polygon) centre += corner / static_cast<float>(polygon.size());
    outlooks.push_back({portal.piece, centre, outward, world.pieces().area_m2[portal.piece],
                        world.glassOf(portal.piece).hemisphericalTransmittance() *
                            static_cast<double>(world.portalFactor(portal.piece))});
  }
  return outlooks;
}

/// The level direction that a pane looks along; nothing for one that lies flat.
std::optional<glm::vec3> levelAhead(const Outlook& outlook) {
  const glm::vec3 level(outlook.outward.x, outlook.outward.y, 0.0F);
  const float length = glm::length(level);
  if (length < 1e-3F) return std::nullopt;
  return level / length;
}

/// Angle of visible sky in the upright plane square to a pane. [degrees]
double skyAngle_deg(const World& world, const Outlook& outlook) {
  const glm::vec3 ahead = levelAhead(outlook).value_or(glm::vec3(0.0F, -1.0F, 0.0F));
  const glm::vec3 from = outlook.centre + rayOffset_m * outlook.outward;
  int seen = 0;
  for (int i = 0; i < looksOfSky; ++i) {
    const double angle = glm::radians(180.0 * (i + 0.5) / looksOfSky);
    const glm::vec3 direction = static_cast<float>(std::cos(angle)) * ahead +
                                glm::vec3(0.0F, 0.0F, static_cast<float>(std::sin(angle)));
    if (glm::dot(direction, outlook.outward) > 0.0F &&
        !world.rays.meetsAny(from, direction, RayScene::Barrier::opaqueAndGlass, beyond_m))
      ++seen;
  }
  return 180.0 * seen / looksOfSky;
}

double averageDaylightFactor_pct(const World& world, std::int32_t room,
                                 const std::vector<Outlook>& outlooks) {
  double area_m2 = 0.0;
  double reflecting_m2 = 0.0;
  for (std::uint32_t side = 0; side < world.building.sideRoom.size(); ++side) {
    if (world.building.sideRoom[side] != room || world.building.innerGlass[side / 2]) continue;
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

/// The stretch of an upright polygon at a height, along a level direction; nothing where it does not reach.
std::optional<glm::vec3> middleAtHeight(std::span<const glm::vec3> polygon, float height) {
  glm::vec3 sum(0.0F);
  float count = 0.0F;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::vec3& from = polygon[i];
    const glm::vec3& to = polygon[(i + 1) % polygon.size()];
    if ((from.z > height) == (to.z > height)) continue;
    sum += from + (height - from.z) / (to.z - from.z) * (to - from);
    count += 1.0F;
  }
  if (count < 1.0F) return std::nullopt;
  return sum / count;
}

/// How far the reveal reaches into the room from a point of the pane: as long as something stands close by
/// the pane on both sides. [m]
float revealDepth_m(const World& world, const Outlook& outlook, const glm::vec3& onPane,
                    const glm::vec3& ahead) {
  const glm::vec3 along(-ahead.y, ahead.x, 0.0F);
  float half_m = 0.0F;
  for (const glm::vec3& corner : world.polygon(outlook.piece))
    half_m = std::max(half_m, std::abs(glm::dot(corner - onPane, along)));
  const float reach_m = half_m + besidePane_m;
  float depth_m = 0.0F;
  while (depth_m < revealMost_m) {
    const glm::vec3 from = onPane - (depth_m + revealStep_m) * ahead;
    const bool isBetween = world.rays.meetsAny(from, along, RayScene::Barrier::opaque, reach_m) &&
                           world.rays.meetsAny(from, -along, RayScene::Barrier::opaque, reach_m);
    if (!isBetween) break;
    depth_m += revealStep_m;
  }
  return depth_m;
}

/// EN 17037's reference point: in the middle of the opening's width, 1.2 m above the floor and 0.3 m above
/// the sill at least, where the reveal ends. A pane that does not reach up there, or that lies rather flat,
/// has it in its middle.
glm::vec3 referencePoint(const World& world, const Room& room, const Outlook& outlook) {
  const auto ahead = levelAhead(outlook);
  if (!ahead || outlook.outward.z > 0.7F) return outlook.centre - rayOffset_m * outlook.outward;
  const auto polygon = world.polygon(outlook.piece);
  float sill = outlook.centre.z;
  for (const glm::vec3& corner : polygon) sill = std::min(sill, corner.z);
  const float floor = world.local({0.0, 0.0, room.floor_m}).z;
  const float height = std::max(floor + aboveFloor_m, sill + aboveSill_m);
  const glm::vec3 onPane = middleAtHeight(polygon, height).value_or(outlook.centre);
  return onPane - (revealDepth_m(world, outlook, onPane, *ahead) + rayOffset_m) * *ahead;
}

/// Directions to the sun on the study's date, in steps of a stepsOfHour-th of an hour, from the altitude that
/// counts.
std::vector<glm::vec3> sunsOfDay(const Study& study) {
  ClockTime time = study.sunlight.date;
  std::vector<glm::vec3> suns;
  for (int step = 0; step < 24 * stepsOfHour; ++step) {
    time.hour_h = (step + 0.5) / stepsOfHour;
    const glm::dvec2 sun_deg = sunPosition_deg(time, study.site);
    if (sun_deg.x > study.sunlight.leastAltitude_deg)
      suns.emplace_back(directionFromAngles(sun_deg.x, sun_deg.y, study.site.north_deg));
  }
  return suns;
}

/// How long one of the suns is seen through a pane. [h]
double sunlight_h(const World& world, const Room& room, const Outlook& outlook,
                  const std::vector<glm::vec3>& suns) {
  const glm::vec3 from = referencePoint(world, room, outlook);
  const auto steps = std::count_if(suns.begin(), suns.end(), [&](const glm::vec3& sun) {
    return glm::dot(sun, outlook.outward) > 0.0F &&
           !world.rays.meetsAny(from, sun, RayScene::Barrier::opaque, beyond_m);
  });
  return static_cast<double>(steps) / stepsOfHour;
}

}  // namespace

std::vector<RoomValue> measureRooms(const World& world, const Study& study) {
  const std::vector<glm::vec3> suns = sunsOfDay(study);
  std::vector<RoomValue> values;
  for (std::size_t i = 0; i < world.building.rooms.size(); ++i) {
    const Room& room = world.building.rooms[i];
    RoomValue value;
    if (!world.building.domains[static_cast<std::size_t>(room.domain)].open) {
      const auto number = static_cast<std::int32_t>(i);
      const std::vector<Outlook> outlooks = outlooksOf(world, number);
      value.averageDaylightFactor_pct = averageDaylightFactor_pct(world, number, outlooks);
      for (const Outlook& outlook : outlooks)
        value.sunlight_h = std::max(value.sunlight_h, sunlight_h(world, room, outlook, suns));
    }
    values.push_back(value);
  }
  return values;
}

}  // namespace clerestory
