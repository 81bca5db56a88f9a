// SPDX-License-Identifier: GPL-3.0-or-later
// Spreads intensities over openings and casts rays to them.
#include "lamps.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <geometry/sampling.hpp>
#include <solver/formfactor.hpp>

#include "hierarchy.hpp"
#include "world.hpp"

namespace clerestory {
namespace {

constexpr float smallest_m = 0.01F;      // openings of a smaller extent are points; a line is as thick
constexpr int halvings = 6;              // of a face
constexpr float nearApart = 0.25F;       // radius / distance above which a part is halved
constexpr float farApart = 0.03F;        // below which the opening counts as a point: 0.1 % at most
constexpr float leastProjected = 1e-4F;  // of all area: what is seen more edge-on than that sends nothing
constexpr std::size_t sides = 12;        // of a round opening

/// A regular polygon of the same area as the circle of radius 1, in its plane.
std::vector<glm::vec2> roundOutline() {
  const double turn = 2.0 * std::numbers::pi / sides;
  const double radius = std::sqrt(turn / std::sin(turn));
  std::vector<glm::vec2> outline;
  for (std::size_t i = 0; i < sides; ++i) {
    const double angle = turn * (static_cast<double>(i) + 0.5);
    outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return outline;
}

/// Both ends and the mantle of a cylinder about the z axis of `frame`, whose columns are its half extents.
std::vector<std::vector<glm::vec3>> cylinder(const glm::mat3& frame) {
  const std::vector<glm::vec2> outline = roundOutline();
  std::vector<std::vector<glm::vec3>> faces(2);
  const auto at = [&](std::size_t i, float z) { return frame * glm::vec3(outline[i % outline.size()], z); };
  for (std::size_t i = 0; i < outline.size(); ++i) {
    faces[0].push_back(at(i, 1.0F));
    faces[1].push_back(at(outline.size() - 1 - i, -1.0F));
    faces.push_back({at(i, -1.0F), at(i + 1, -1.0F), at(i + 1, 1.0F), at(i, 1.0F)});
  }
  return faces;
}

std::vector<std::vector<glm::vec3>> box(const glm::vec3& half) {
  std::vector<std::vector<glm::vec3>> faces;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const float side : {-1.0F, 1.0F}) {
      std::vector<glm::vec3> face;
      for (const auto& [a, b] :
           {std::pair(-1.0F, -1.0F), std::pair(1.0F, -1.0F), std::pair(1.0F, 1.0F), std::pair(-1.0F, 1.0F)}) {
        glm::vec3 corner(0.0F);
        corner[axis] = side * half[axis];
        corner[u] = side * a * half[u];  // turned about on the far side, so that the front looks outwards
        corner[v] = b * half[v];
        face.push_back(corner);
      }
      faces.push_back(face);
    }
  }
  return faces;
}

/// Rings of quadrilaterals between two caps.
std::vector<std::vector<glm::vec3>> ellipsoid(const glm::vec3& half) {
  constexpr int rings = 6;
  const std::vector<glm::vec2> outline = roundOutline();
  std::vector<std::vector<glm::vec3>> faces;
  const auto at = [&](std::size_t i, int ring) {
    const double angle = std::numbers::pi * ring / rings;
    const auto radius = static_cast<float>(std::sin(angle));
    return half * glm::vec3(radius * outline[i % outline.size()], -static_cast<float>(std::cos(angle)));
  };
  for (int ring = 0; ring < rings; ++ring) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      std::vector<glm::vec3> face = {at(i, ring), at(i + 1, ring), at(i + 1, ring + 1), at(i, ring + 1)};
      if (ring == 0) face.erase(face.begin() + 1);
      if (ring == rings - 1) face.pop_back();
      faces.push_back(face);
    }
  }
  return faces;
}

float areaOf(const std::vector<glm::vec3>& polygon, glm::vec3& normal) {
  normal = glm::vec3(0.0F);
  for (std::size_t i = 2; i < polygon.size(); ++i)
    normal += 0.5F * glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  const float area_m2 = glm::length(normal);
  if (area_m2 > 0.0F) normal /= area_m2;
  return area_m2;
}

}  // namespace

LuminousShape::LuminousShape(const LuminousOpening& opening) {
  using Form = LuminousOpening::Form;
  glm::vec3 extent(opening.extent_m);
  const float longest = std::max({extent.x, extent.y, extent.z});
  if (longest < smallest_m) return;
  const int extents = int{extent.x > 0.0F} + int{extent.y > 0.0F} + int{extent.z > 0.0F};
  if (extents == 1) extent = glm::max(extent, glm::vec3(smallest_m));
  const glm::vec3 half = 0.5F * extent;
  std::vector<std::vector<glm::vec3>> polygons;
  switch (opening.form) {
    case Form::verticalCylinder:
      polygons = cylinder({{half.x, 0, 0}, {0, half.y, 0}, {0, 0, half.z}});
      break;
    case Form::cylinderAlongC0:
      polygons = cylinder({{0, half.y, 0}, {0, 0, half.z}, {half.x, 0, 0}});
      break;
    case Form::cylinderAlongC90:
      polygons = cylinder({{0, 0, half.z}, {half.x, 0, 0}, {0, half.y, 0}});
      break;
    case Form::ellipsoid:
      polygons = ellipsoid(half);
      break;
    default:
      polygons = box(half);
  }
  for (std::vector<glm::vec3>& polygon : polygons) addFace(std::move(polygon));
  faces_ = parts_.size();
  divideFaces();
}

void LuminousShape::addFace(std::vector<glm::vec3> polygon) {
  LuminousPart part{std::move(polygon), glm::vec3(0.0F), glm::vec3(0.0F), 0.0F, 0.0F, 0};
  part.area_m2 = areaOf(part.polygon, part.normal);
  if (part.area_m2 < 1e-9F) return;  // the side of a flat opening
  for (const glm::vec3& corner : part.polygon) {
    part.centre += corner / static_cast<float>(part.polygon.size());
    radius_m_ = std::max(radius_m_, glm::length(corner));
  }
  for (const glm::vec3& corner : part.polygon)
    part.radius_m = std::max(part.radius_m, glm::length(corner - part.centre));
  area_m2_ += part.area_m2;
  parts_.push_back(std::move(part));
}

void LuminousShape::divideFaces() {
  const std::size_t most = faces_ * (std::size_t{1} << (halvings + 1));
  const float smallest = nearApart * 0.1F * radius_m_;
  for (std::size_t i = 0; i < parts_.size() && parts_.size() < most; ++i) {
    const LuminousPart whole = parts_[i];
    if (whole.radius_m < smallest) continue;
    const Halves halves =
        halve({whole.polygon, whole.centre, whole.radius_m, whole.area_m2, whole.area_m2, 1}, whole.normal);
    parts_[i].firstChild = static_cast<std::uint32_t>(parts_.size());
    for (const ElementShape& half : {halves.first, halves.second})
      parts_.push_back({half.corners, half.centre, whole.normal, half.radius_m, half.area_m2, 0});
  }
}

float LuminousShape::projectedArea_m2(const glm::vec3& direction) const {
  float sum = 0.0F;
  for (const LuminousPart& face : faces())
    sum += face.area_m2 * std::max(glm::dot(face.normal, direction), 0.0F);
  return sum;
}

float LuminousShape::reach_m(const glm::vec3& direction) const {
  float reach_m = 0.0F;
  for (const LuminousPart& face : faces()) {
    for (const glm::vec3& corner : face.polygon)
      reach_m = std::max(reach_m, std::abs(glm::dot(corner, direction)));
  }
  return reach_m;
}

LuminousShape::Spot LuminousShape::spot(float u, float v) const {
  float target = u * area_m2_;
  std::size_t i = 0;
  while (i + 1 < faces_ && target >= parts_[i].area_m2) target -= parts_[i++].area_m2;
  const float own = std::clamp(target / parts_[i].area_m2, 0.0F, 0.9999999F);
  return {pointOnPolygon<glm::vec3>(parts_[i].polygon, own, v), parts_[i].normal};
}

Lamp::Lamp(const Luminaire& luminaire, std::shared_ptr<const LuminousShape> shape, const glm::vec3& position,
           std::int32_t domain)
    : shape_(std::move(shape)),
      photometry_(luminaire.photometry),
      position_(position),
      axes_(luminaire.axes),
      factor_(luminaire.factor),
      flux_lm_(luminaire.flux_lm()),
      color_(luminaire.color),
      domain_(domain) {
  const IntensityDistribution& distribution = photometry_->distribution;
  const std::size_t rows = distribution.latitude_deg.size();
  rowMost_cd_.assign(rows, 0.0);
  for (std::size_t i = 0; i < distribution.intensity_cd.size(); ++i)
    rowMost_cd_[i % rows] = std::max(rowMost_cd_[i % rows], factor_ * distribution.intensity_cd[i]);
}

float Lamp::intensity_cd(const glm::vec3& ownDirection) const {
  return static_cast<float>(factor_ * photometry_->distribution.intensity(glm::dvec3(ownDirection)));
}

float Lamp::luminance_cd_m2(const glm::vec3& ownDirection) const {
  const float projected_m2 = shape_->projectedArea_m2(ownDirection);
  if (projected_m2 < leastProjected * shape_->area_m2()) return 0.0F;
  return intensity_cd(ownDirection) / projected_m2;
}

float Lamp::intensityTowards_cd(const glm::vec3& point) const {
  const glm::vec3 way = point - position_;
  const float distance_m = glm::length(way);
  return distance_m > 0.0F ? intensity_cd(turned(way / distance_m)) : 0.0F;
}

float Lamp::intensityBound_cd(const glm::vec3& centre, float radius_m,
                              std::span<const glm::vec3> corners) const {
  const glm::vec3 way = turned(centre - position_);
  const float distance_m = glm::length(way);
  const float reach_m = radius_m + shape_->radius_m();
  const IntensityDistribution& distribution = photometry_->distribution;
  double low_deg = -90.0;
  double high_deg = 90.0;
  if (distance_m > reach_m) {
    constexpr double degrees = 180.0 / std::numbers::pi;
    const double spread_deg = degrees * std::asin(static_cast<double>(reach_m / distance_m));
    const double latitude_deg = distribution.latitudeOf(glm::dvec3(way / distance_m));
    low_deg = latitude_deg - spread_deg;
    high_deg = latitude_deg + spread_deg;
  }
  // What lies on one side of the poles' equator is seen in latitudes of that side alone.
  const glm::vec3 pole(distribution.pole());
  const float lampReach_m = shape_->reach_m(pole);
  float lowest_m = std::numeric_limits<float>::max();
  float highest_m = -lowest_m;
  for (const glm::vec3& corner : corners) {
    const float height_m = glm::dot(turned(corner - position_), pole);
    lowest_m = std::min(lowest_m, height_m - lampReach_m);
    highest_m = std::max(highest_m, height_m + lampReach_m);
  }
  if (!corners.empty() && lowest_m >= 0.0F) low_deg = std::max(low_deg, 0.0);
  if (!corners.empty() && highest_m <= 0.0F) high_deg = std::min(high_deg, 0.0);
  double most_cd = 0.0;
  const std::vector<double>& rows_deg = distribution.latitude_deg;
  for (std::size_t i = 0; i < rows_deg.size(); ++i) {
    const bool isBelow = rows_deg[i] < low_deg && (i + 1 == rows_deg.size() || rows_deg[i + 1] <= low_deg);
    const bool isAbove = rows_deg[i] > high_deg && (i == 0 || rows_deg[i - 1] >= high_deg);
    if (!isBelow && !isAbove) most_cd = std::max(most_cd, rowMost_cd_[i]);
  }
  return static_cast<float>(most_cd);
}

float Lamp::illuminance_lx(const glm::vec3& point, const glm::vec3& normal) const {
  const glm::vec3 way = turned(point - position_);
  const glm::vec3 ownNormal = turned(normal);
  const float distance_m = glm::length(way);
  if (shape_->isPoint() || shape_->radius_m() < farApart * distance_m) {
    const float cosine = -glm::dot(way, ownNormal) / std::max(distance_m, 1e-6F);
    if (cosine <= 0.0F) return 0.0F;
    return intensity_cd(way / distance_m) * cosine / (distance_m * distance_m);
  }
  float sum = 0.0F;
  for (const LuminousPart& face : shape_->faces()) sum += partIlluminance_lx(face, way, ownNormal);
  return sum;
}

float Lamp::partIlluminance_lx(const LuminousPart& part, const glm::vec3& point,
                               const glm::vec3& normal) const {
  const glm::vec3 way = point - part.centre;
  if (glm::dot(point - part.polygon[0], part.normal) <= 0.0F) return 0.0F;
  if (glm::dot(-way, normal) <= -part.radius_m) return 0.0F;
  const float distance_m = glm::length(way);
  // Seen edge-on, a part's luminance varies as one over the cosine.
  const float flatness =
      std::clamp(2.0F * glm::dot(way, part.normal) / std::max(distance_m, 1e-6F), 0.2F, 1.0F);
  if (part.firstChild != 0 && part.radius_m > nearApart * flatness * distance_m) {
    return partIlluminance_lx(shape_->parts()[part.firstChild], point, normal) +
           partIlluminance_lx(shape_->parts()[part.firstChild + 1], point, normal);
  }
  return std::numbers::pi_v<float> * pointToPolygon(point, normal, part.polygon) *
         luminance_cd_m2(way / std::max(distance_m, 1e-6F));
}

Lamp::Ray Lamp::ray(const glm::vec3& point, const glm::vec3& normal, float u, float v) const {
  const LuminousShape::Spot spot =
      shape_->isPoint() ? LuminousShape::Spot{glm::vec3(0.0F), glm::vec3(0.0F)} : shape_->spot(u, v);
  const glm::vec3 way = turned(point - position_) - spot.point;
  const float distance_m = std::max(glm::length(way), 1e-6F);
  const glm::vec3 direction = way / distance_m;
  Ray result{position_ + axes_ * spot.point, 0.0F};
  const float cosine = -glm::dot(direction, turned(normal));
  if (cosine <= 0.0F) return result;
  if (shape_->isPoint()) {
    result.weight = intensity_cd(direction) * cosine / (distance_m * distance_m);
    return result;
  }
  const float leaving = glm::dot(direction, spot.normal);
  if (leaving > 0.0F)
    result.weight = luminance_cd_m2(direction) * leaving * cosine / (distance_m * distance_m);
  return result;
}

std::optional<Lamp::Seen> Lamp::seenAlong(const glm::vec3& from, const glm::vec3& direction,
                                          float limit_m) const {
  const glm::vec3 way = position_ - from;
  const float along_m = glm::dot(way, direction);
  const float radius_m = shape_->radius_m();
  if (shape_->isPoint() || along_m < -radius_m ||
      glm::dot(way, way) - along_m * along_m > radius_m * radius_m)
    return std::nullopt;
  const glm::vec3 eye = turned(-way);
  const glm::vec3 ownDirection = turned(direction);
  std::optional<Seen> nearest;
  for (const LuminousPart& face : shape_->faces()) {
    const float approach = -glm::dot(ownDirection, face.normal);
    if (approach <= 0.0F) continue;
    const float distance_m = glm::dot(eye - face.polygon[0], face.normal) / approach;
    if (distance_m <= 0.0F || distance_m > (nearest ? nearest->distance_m : limit_m)) continue;
    const glm::vec3 point = eye + distance_m * ownDirection;
    bool isInside = true;
    for (std::size_t i = 0, j = face.polygon.size() - 1; i < face.polygon.size() && isInside; j = i++) {
      const glm::vec3 edge = face.polygon[i] - face.polygon[j];
      isInside = glm::dot(glm::cross(edge, point - face.polygon[j]), face.normal) >= 0.0F;
    }
    if (!isInside) continue;
    const float luminance = luminance_cd_m2(-ownDirection);
    if (luminance > 0.0F) nearest = Seen{distance_m, luminance};
  }
  return nearest;
}

std::vector<Lamp> lampsOf(const Building& building, const glm::dvec3& origin) {
  std::map<const Photometry*, std::shared_ptr<const LuminousShape>> shapes;
  std::vector<Lamp> lamps;
  for (std::size_t i = 0; i < building.luminaires.size(); ++i) {
    const Luminaire& luminaire = building.luminaires[i];
    if (building.luminaireDomain[i] < 0) continue;
    std::shared_ptr<const LuminousShape>& shape = shapes[luminaire.photometry.get()];
    if (!shape) shape = std::make_shared<const LuminousShape>(luminaire.photometry->opening);
    lamps.emplace_back(luminaire, shape, glm::vec3(luminaire.position_m - origin),
                       building.luminaireDomain[i]);
  }
  return lamps;
}

std::optional<glm::dvec3> lampLuminance(const World& world, const glm::vec3& from, const glm::vec3& direction,
                                        float limit_m) {
  std::optional<glm::dvec3> luminance;
  for (const Lamp& lamp : world.lamps) {
    const auto seen = lamp.seenAlong(from, direction, limit_m);
    if (!seen) continue;
    limit_m = seen->distance_m;
    luminance = static_cast<double>(seen->luminance_cd_m2) * lamp.color();
  }
  return luminance;
}

}  // namespace clerestory
