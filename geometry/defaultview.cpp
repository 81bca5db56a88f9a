// SPDX-License-Identifier: GPL-3.0-or-later
// Stands at the sensors of a room in turn, looks around level, and keeps where and whither most is seen.
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <geometry/defaultview.hpp>
#include <geometry/rays.hpp>

namespace clerestory {
namespace {

constexpr double eyeHeight_m = 1.6;
constexpr std::size_t headings = 48;      // that are looked to from a place
constexpr std::size_t sideways = 5;       // headings of the picture to either side of its middle
constexpr std::size_t mostPlaces = 200;   // that are tried
constexpr float farthest_m = 12.0F;       // what lies further off makes no picture better
constexpr float closest_m = 0.8F;         // what stands nearer fills the picture
constexpr float windowsWorth = 0.6F;      // of a picture half full of windows, against one without
constexpr double fieldOfView_deg = 55.0;  // 86 degrees across

glm::vec3 directionOf(std::size_t heading) {
  const float angle =
      2.0F * std::numbers::pi_v<float> * static_cast<float>(heading) / static_cast<float>(headings);
  return {std::cos(angle), std::sin(angle), 0.0F};
}

/// The room to look into, or -1.
std::int32_t roomToShow(const Building& building) {
  std::int32_t best = -1;
  double bestWorth = 0.0;
  for (std::size_t r = 0; r < building.rooms.size(); ++r) {
    const Room& room = building.rooms[r];
    if (room.domain < 0 || !building.domains[static_cast<std::size_t>(room.domain)].lit) continue;
    const bool hasWindow =
        std::any_of(building.portals.begin(), building.portals.end(),
                    [&](const Portal& portal) { return portal.room == static_cast<std::int32_t>(r); });
    const double worth = room.floorArea_m2 * (hasWindow ? 1.0 : 1e-3);
    if (worth > bestWorth) {
      bestWorth = worth;
      best = static_cast<std::int32_t>(r);
    }
  }
  return best;
}

std::vector<glm::dvec3> sensorsIn(const Building& building, std::int32_t room) {
  std::vector<glm::dvec3> points;
  for (const SensorGrid& grid : building.grids) {
    if (grid.room == room) points.insert(points.end(), grid.points.begin(), grid.points.end());
  }
  return points;
}

struct Look {
  float worth = 0.0F;
  std::size_t heading = 0;
};

/// The best heading from a place: far walls, and windows among them.
Look bestLook(const CleanModel& model, const RayScene& rays, const glm::vec3& eye) {
  std::array<float, headings> distances_m{};
  std::array<float, headings> glass{};
  for (std::size_t h = 0; h < headings; ++h) {
    const glm::vec3 direction = directionOf(h);
    const auto hit = rays.nearest(eye, direction, RayScene::Barrier::opaqueAndGlass);
    distances_m[h] = std::min(hit.distance_m, farthest_m);
    if (hit && model.materials[model.pieces.material[hit.piece]].glazing) glass[h] = 1.0F;
  }
  Look best;
  for (std::size_t h = 0; h < headings; ++h) {
    float sum_m = 0.0F;
    float windows = 0.0F;
    float least_m = farthest_m;
    for (std::size_t i = 0; i <= 2 * sideways; ++i) {
      const std::size_t at = (h + headings + i - sideways) % headings;
      sum_m += distances_m[at];
      windows += glass[at];
      least_m = std::min(least_m, distances_m[at]);
    }
    if (least_m < closest_m) continue;
    const float share = std::min(2.0F * windows / static_cast<float>(2 * sideways + 1), 1.0F);
    const float worth = sum_m * (1.0F + windowsWorth * share);
    if (worth > best.worth) best = {worth, h};
  }
  return best;
}

glm::dvec3 toCentimetres(const glm::dvec3& point_m) {
  return {std::round(100.0 * point_m.x) / 100.0, std::round(100.0 * point_m.y) / 100.0,
          std::round(100.0 * point_m.z) / 100.0};
}

}  // namespace

std::optional<ViewSettings> defaultView(const Building& building) {
  const std::int32_t shown = roomToShow(building);
  if (shown < 0) return std::nullopt;
  const Room& room = building.rooms[static_cast<std::size_t>(shown)];
  const double eye_m = room.floor_m + std::min(eyeHeight_m, 0.65 * (room.ceiling_m - room.floor_m));
  const std::vector<glm::dvec3> sensors = sensorsIn(building, shown);
  const RayScene rays(building.model, building.innerGlass);

  Look best;
  glm::dvec3 bestEye_m(0.0);
  const std::size_t step = std::max<std::size_t>(1, sensors.size() / mostPlaces);
  for (std::size_t s = 0; s < sensors.size(); s += step) {
    const glm::dvec3 place_m = {sensors[s].x, sensors[s].y, eye_m};
    const glm::vec3 eye(place_m - rays.origin());
    const bool hasCeiling =
        static_cast<bool>(rays.nearest(eye, {0.0F, 0.0F, 1.0F}, RayScene::Barrier::opaqueAndGlass));
    if (!hasCeiling || rays.occluded(glm::vec3(sensors[s] - rays.origin()), eye, RayScene::Barrier::opaque))
      continue;
    const Look look = bestLook(building.model, rays, eye);
    if (look.worth > best.worth) {
      best = look;
      bestEye_m = place_m;
    }
  }
  if (best.worth == 0.0F) return std::nullopt;
  ViewSettings view;
  view.name = room.name;
  view.eye_m = toCentimetres(bestEye_m);
  view.target_m =
      toCentimetres(bestEye_m + 4.0 * glm::dvec3(directionOf(best.heading)) - glm::dvec3(0.0, 0.0, 0.35));
  view.fieldOfView_deg = fieldOfView_deg;
  view.size_px = {960, 540};
  return view;
}

}  // namespace clerestory
