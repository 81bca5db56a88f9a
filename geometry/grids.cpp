// SPDX-License-Identifier: GPL-3.0-or-later
// Sensor grids: points over a room's floor, within an outline, on surfaces, or from a list.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include <geometry/sampling.hpp>

#include "rooms.hpp"

namespace clerestory {
namespace {

/// Sensors of a whole study: some hundred bytes each while it runs, and as many in the table.
constexpr double sensorsMost = 5e6;

struct Rectangle {
  glm::dvec2 low{1e300}, high{-1e300};

  void add(const glm::dvec2& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
};

/// Even-odd test; points on the outline may fall on either side.
bool isWithin(const glm::dvec2& point, const std::vector<glm::dvec2>& outline) {
  bool within = false;
  for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    const glm::dvec2& a = outline[i];
    const glm::dvec2& b = outline[j];
    if ((a.y > point.y) != (b.y > point.y) && point.x < a.x + (b.x - a.x) * (point.y - a.y) / (b.y - a.y)) {
      within = !within;
    }
  }
  return within;
}

double distanceToOutline(const glm::dvec2& point, const std::vector<glm::dvec2>& outline) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    const glm::dvec2 edge = outline[i] - outline[j];
    const double t =
        glm::clamp(glm::dot(point - outline[j], edge) / std::max(glm::dot(edge, edge), 1e-18), 0.0, 1.0);
    least = std::min(least, glm::length(point - outline[j] - t * edge));
  }
  return least;
}

/// Whether `least` of the 16 rays from a point at least end in a domain's air.
bool seesAir(const Building& building, const RayScene& rays, const glm::dvec3& point, std::int32_t domain,
             std::uint32_t least) {
  constexpr std::uint32_t count = 16;
  const Sequence sequence(0xa17);
  const glm::vec3 from(point - rays.origin());
  const bool isOpen = building.domains[static_cast<std::size_t>(domain)].open;
  std::uint32_t inAir = 0;
  for (std::uint32_t i = 0; i < count && inAir < least && inAir + count - i >= least; ++i) {
    const float z = 2.0F * sequence(i, 0) - 1.0F;
    const float angle = 2.0F * std::numbers::pi_v<float> * sequence(i, 1);
    const float radius = std::sqrt(std::max(0.0F, 1.0F - z * z));
    const auto hit = rays.nearest(from, {radius * std::cos(angle), radius * std::sin(angle), z},
                                  RayScene::Barrier::opaqueAndGlass);
    if (hit ? building.sideDomain[hit.side()] == domain : isOpen) ++inAir;
  }
  return inAir >= least;
}

/// A room where all points see its air, else none: each sensor is then lit by the air that it stands in.
std::int32_t roomOfAll(const Building& building, const RayScene& rays, std::int32_t room,
                       const std::vector<glm::dvec3>& points) {
  if (room < 0) return room;
  const std::int32_t domain = building.rooms[static_cast<std::size_t>(room)].domain;
  const bool isIn = std::all_of(points.begin(), points.end(), [&](const glm::dvec3& point) {
    return seesAir(building, rays, point, domain, 1);
  });
  return isIn ? room : -1;
}

/// A piece of a room's floor in plan.
struct FloorPart {
  std::vector<glm::dvec2> outline;
  double height_m;  ///< of its middle
};

std::vector<FloorPart> floorPartsOf(const Building& building, const Room& room) {
  std::vector<FloorPart> parts;
  for (const std::uint32_t piece : room.floorPieces) {
    FloorPart& part = parts.emplace_back();
    const auto corners = building.model.pieces.polygons[piece];
    for (const std::uint32_t corner : corners) {
      const glm::dvec3& point = building.model.pieces.points[corner];
      part.outline.emplace_back(point);
      part.height_m += point.z / static_cast<double>(corners.size());
    }
  }
  return parts;
}

/// Height of the floor at a place in plan, the highest where several lie there; none beside it.
std::optional<double> floorAt(const std::vector<FloorPart>& parts, const glm::dvec2& plan) {
  std::optional<double> height_m;
  for (const FloorPart& part : parts) {
    if (height_m.value_or(-1e300) < part.height_m && isWithin(plan, part.outline)) height_m = part.height_m;
  }
  return height_m;
}

/// Throws InputError where a grid would bring a study above its number of sensors.
void expectRoomFor(const Building& building, const std::string& grid, double sensors) {
  for (const SensorGrid& other : building.grids) sensors += static_cast<double>(other.points.size());
  if (sensors <= sensorsMost) return;
  char count[32];
  std::snprintf(count, sizeof count, "%.3g", 1e-6 * sensors);
  throw InputError("the grid \"" + grid + "\" would make " + count +
                   " million sensors of the study, which may have 5 million: make its spacing larger or its "
                   "outline smaller");
}

/// The centred points of the rectangle around a grid: n = floor(length / spacing) of them each way.
std::vector<glm::dvec2> pointsOf(const Building& building, const GridSettings& settings,
                                 const Rectangle& area) {
  const double spacing_m = settings.spacing_m;
  const glm::dvec2 size = area.high - area.low;
  const glm::dvec2 count = glm::max(glm::floor(size / spacing_m + 1e-6), glm::dvec2(1.0));
  expectRoomFor(building, settings.name, count.x * count.y);
  const glm::dvec2 first = area.low + 0.5 * (size - (count - 1.0) * spacing_m);
  std::vector<glm::dvec2> points;
  for (double row = 0; row < count.y; ++row) {
    for (double column = 0; column < count.x; ++column)
      points.push_back(first + spacing_m * glm::dvec2(column, row));
  }
  return points;
}

/// The room whose floor lies below a point in plan, the nearest one below it where there are several.
std::int32_t roomBelow(const Building& building, const glm::dvec2& point, double below_m) {
  std::int32_t found = -1;
  for (std::size_t i = 0; i < building.rooms.size(); ++i) {
    const Room& room = building.rooms[i];
    if (room.floor_m > below_m) continue;
    if (found >= 0 && room.floor_m <= building.rooms[static_cast<std::size_t>(found)].floor_m) continue;
    if (floorAt(floorPartsOf(building, room), point)) found = static_cast<std::int32_t>(i);
  }
  return found;
}

SensorGrid gridOverRoom(const Building& building, const GridSettings& settings, std::int32_t roomIndex,
                        const RayScene& rays) {
  const Room& room = building.rooms[static_cast<std::size_t>(roomIndex)];
  SensorGrid grid{settings.name, roomIndex, {}, {}, settings.spacing_m};
  const std::vector<FloorPart> floor = floorPartsOf(building, room);
  Rectangle bounds;
  for (const FloorPart& part : floor) {
    for (const glm::dvec2& corner : part.outline) bounds.add(corner);
  }
  bounds.low += settings.inset_m;
  bounds.high -= settings.inset_m;
  if (bounds.low.x >= bounds.high.x || bounds.low.y >= bounds.high.y) return grid;
  for (const glm::dvec2& plan : pointsOf(building, settings, bounds)) {
    const std::optional<double> floor_m = floorAt(floor, plan);
    if (!floor_m) continue;
    const glm::dvec3 point(plan, *floor_m + settings.height_m);
    if (isInAir(building, rays, point, room.domain)) grid.points.push_back(point);
  }
  grid.normals.assign(grid.points.size(), {0, 0, 1});
  return grid;
}

SensorGrid gridWithinOutline(const Building& building, const GridSettings& settings, const RayScene& rays) {
  Rectangle bounds;
  for (const glm::dvec2& corner : settings.polygon_m) bounds.add(corner);
  SensorGrid grid{settings.name, -1, {}, {}, settings.spacing_m};
  grid.room = roomBelow(building, 0.5 * (bounds.low + bounds.high), std::numeric_limits<double>::infinity());
  const double floor_m = grid.room < 0 ? 0.0 : building.rooms[static_cast<std::size_t>(grid.room)].floor_m;
  for (const glm::dvec2& plan : pointsOf(building, settings, bounds)) {
    if (!isWithin(plan, settings.polygon_m)) continue;
    if (settings.inset_m > 0.0 && distanceToOutline(plan, settings.polygon_m) < settings.inset_m) continue;
    grid.points.emplace_back(plan, floor_m + settings.height_m);
  }
  grid.room = roomOfAll(building, rays, grid.room, grid.points);
  grid.normals.assign(grid.points.size(), {0, 0, 1});
  return grid;
}

/// A plane with axes: the first level, the second upwards; on a level plane they are +x and ±y.
struct SurfacePlane {
  glm::dvec3 origin, along, up, normal;

  SurfacePlane(const glm::dvec3& point, const glm::dvec3& facing) : origin(point), normal(facing) {
    const glm::dvec3 level(-facing.y, facing.x, 0.0);
    along = glm::length(level) > 1e-3 ? glm::normalize(level) : glm::dvec3(1.0, 0.0, 0.0);
    up = glm::cross(normal, along);
  }
  [[nodiscard]] glm::dvec2 flat(const glm::dvec3& point) const {
    return {glm::dot(point - origin, along), glm::dot(point - origin, up)};
  }
  [[nodiscard]] glm::dvec3 at(const glm::dvec2& point, double height_m) const {
    return origin + point.x * along + point.y * up + height_m * normal;
  }
};

/// Sides of one planar polygon in one room.
using FaceKey = std::tuple<std::int32_t, std::uint32_t, std::uint32_t>;  // room, polygon, side of it
using Faces = std::map<FaceKey, std::vector<std::uint32_t>>;             // pieces

/// The faces of the surfaces that a grid names: those in rooms, or outdoors where none is in a room.
Faces facesOf(const Building& building, const std::string& glob) {
  const Pieces& pieces = building.model.pieces;
  Faces faces;
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
    const std::uint32_t piece = side / 2;
    if (building.sideDomain[side] < 0) continue;
    if (!globMatches(glob, building.model.surfaces[pieces.surface[piece]].name)) continue;
    faces[{building.sideRoom[side], pieces.polygon[piece], side % 2}].push_back(piece);
  }
  if (!faces.empty() && std::get<0>(faces.rbegin()->first) >= 0)
    std::erase_if(faces, [](const auto& face) { return std::get<0>(face.first) < 0; });
  return faces;
}

void addPointsOnFace(const Building& building, const GridSettings& settings, const RayScene& rays,
                     const FaceKey& key, const std::vector<std::uint32_t>& faces, SensorGrid& grid) {
  constexpr double offLeast_m = 0.001;
  const Pieces& pieces = building.model.pieces;
  const std::uint32_t parity = std::get<2>(key);
  const auto corner = [&](std::uint32_t index) { return pieces.points[index]; };
  const glm::dvec3 normal = parity == 0 ? pieces.normal[faces.front()] : -pieces.normal[faces.front()];
  const SurfacePlane plane(corner(pieces.polygons[faces.front()][0]), normal);
  const std::int32_t domain = building.sideDomain[2 * faces.front() + parity];
  std::vector<std::vector<glm::dvec2>> outlines;
  Rectangle bounds;
  for (const std::uint32_t piece : faces) {
    std::vector<glm::dvec2>& outline = outlines.emplace_back();
    for (const std::uint32_t index : pieces.polygons[piece]) {
      outline.push_back(plane.flat(corner(index)));
      bounds.add(outline.back());
    }
  }
  bounds.low += settings.inset_m;
  bounds.high -= settings.inset_m;
  if (bounds.low.x >= bounds.high.x || bounds.low.y >= bounds.high.y) return;
  for (const glm::dvec2& flat : pointsOf(building, settings, bounds)) {
    const bool isOn = std::any_of(outlines.begin(), outlines.end(),
                                  [&](const auto& outline) { return isWithin(flat, outline); });
    const glm::dvec3 point = plane.at(flat, std::max(settings.height_m, offLeast_m));
    if (!isOn || !isInAir(building, rays, point, domain)) continue;
    grid.points.push_back(point);
    grid.normals.push_back(normal);
  }
}

/// A grid for each room that the surfaces lie in.
std::vector<SensorGrid> gridsOnSurfaces(const Building& building, const GridSettings& settings,
                                        const RayScene& rays) {
  const Faces faces = facesOf(building, *settings.surface);
  if (faces.empty()) {
    throw InputError("the grid \"" + settings.name +
                     "\" matches no surface that light reaches (asked for: \"" + *settings.surface +
                     "\"); surfaces.csv of a report lists them");
  }
  std::vector<SensorGrid> grids;
  for (const auto& [key, pieces] : faces) {
    if (grids.empty() || grids.back().room != std::get<0>(key))
      grids.push_back({settings.name, std::get<0>(key), {}, {}, settings.spacing_m});
    addPointsOnFace(building, settings, rays, key, pieces, grids.back());
  }
  return grids;
}

SensorGrid gridOfPoints(const Building& building, const GridSettings& settings, const RayScene& rays) {
  expectRoomFor(building, settings.name, static_cast<double>(settings.points.size()));
  SensorGrid grid{settings.name, -1, {}, {}, settings.spacing_m};
  for (const auto& row : settings.points) {
    grid.points.emplace_back(row[0], row[1], row[2]);
    grid.normals.push_back(glm::normalize(glm::dvec3(row[3], row[4], row[5])));
  }
  if (!grid.points.empty()) {
    grid.room = roomOfAll(building, rays, roomBelow(building, grid.points.front(), grid.points.front().z),
                          grid.points);
  }
  return grid;
}

void addGrid(Building& building, SensorGrid grid) {
  if (grid.points.empty()) {
    throw InputError("the grid \"" + grid.name +
                     "\" has no sensor: make its spacing or inset smaller, or check its outline and height");
  }
  building.grids.push_back(std::move(grid));
}

}  // namespace

bool isInAir(const Building& building, const RayScene& rays, const glm::dvec3& point, std::int32_t domain) {
  return seesAir(building, rays, point, domain, 12);
}

void layGrids(Building& building, const Study& study, const RayScene& rays) {
  for (const GridSettings& settings : study.grids) {
    if (!settings.points.empty()) {
      addGrid(building, gridOfPoints(building, settings, rays));
      continue;
    }
    if (!settings.polygon_m.empty()) {
      addGrid(building, gridWithinOutline(building, settings, rays));
      continue;
    }
    if (settings.surface) {
      std::vector<SensorGrid> grids = gridsOnSurfaces(building, settings, rays);
      for (SensorGrid& grid : grids) {
        if (grids.size() > 1) grid.name += " " + building.rooms.at(static_cast<std::size_t>(grid.room)).name;
        addGrid(building, std::move(grid));
      }
      continue;
    }
    std::vector<std::int32_t> matching;
    for (std::size_t i = 0; i < building.rooms.size(); ++i) {
      if (globMatches(settings.room.value_or("*"), building.rooms[i].name)) {
        matching.push_back(static_cast<std::int32_t>(i));
      }
    }
    if (matching.empty()) {
      throw InputError("the grid \"" + settings.name + "\" matches none of the " +
                       std::to_string(building.rooms.size()) + " rooms found in the model (asked for: \"" +
                       settings.room.value_or("*") + "\"); `clerestory inspect` lists them");
    }
    for (const std::int32_t room : matching) {
      SensorGrid grid = gridOverRoom(building, settings, room, rays);
      if (matching.size() > 1) {
        grid.name += " " + building.rooms[static_cast<std::size_t>(room)].name;
        if (grid.points.empty()) continue;  // a closet too small for the spacing
      }
      addGrid(building, std::move(grid));
    }
  }
}

}  // namespace clerestory
