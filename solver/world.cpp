// SPDX-License-Identifier: GPL-3.0-or-later
// Puts the building, the study's sky and its glass into the solver's terms.
#include "world.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clerestory {
namespace {

std::optional<SunBeam> beamOf(const Daylight& daylight, double groundReflectance) {
  if (!(daylight.directNormal_lx > 0.0)) return std::nullopt;
  return SunBeam{glm::vec3(daylight.towardsSun), static_cast<float>(daylight.directNormal_lx),
                 groundReflectance * daylight.directNormal_lx * daylight.towardsSun.z / std::numbers::pi};
}

}  // namespace

World::World(const Building& buildingIn, const Study& study) : World(buildingIn, study, daylightOf(study)) {}

World::World(const Building& buildingIn, const Study& study, const Daylight& daylight)
    : building(buildingIn),
      rays(buildingIn.model, buildingIn.innerGlass),
      sky(daylight.sky),
      sun(beamOf(daylight, study.groundReflectance)),
      layout(columnsFor(buildingIn, sky.horizontalIlluminance_lx() > 0.0, sun.has_value())),
      lamps(lampsOf(buildingIn, rays.origin())),
      portalFactor_(static_cast<float>(study.dirtFactor * study.frameFactor)) {
  for (const Material& material : building.model.materials) {
    glass_.emplace_back();
    if (!material.glazing) continue;
    glass_.back() = material.glass == GlassKind::cie171Clear
                        ? Glass::cie171Clear()
                        : Glass(luminanceOf(material.transmittance), material.panes);
  }
  firstCorner_.push_back(0);
  for (std::size_t piece = 0; piece < pieces().size(); ++piece) {
    for (const std::uint32_t corner : pieces().polygons[piece])
      corners_.push_back(local(pieces().points[corner]));
    firstCorner_.push_back(corners_.size());
  }
  if (sun) sun->towardsImages = imagesOf(sun->towards);
}

// Panes that look the same way show it in the same place; of many ways (a dome) the largest ones.
std::vector<glm::vec3> World::imagesOf(const glm::vec3& towardsSun) const {
  constexpr std::size_t most = 8;
  std::vector<std::pair<double, glm::vec3>> images;
  for (const Portal& portal : building.portals) {
    const glm::vec3 outward = normalOf(2 * portal.piece + (portal.frontIsInside ? 1U : 0U));
    if (glm::dot(outward, towardsSun) <= 0.0F || !isMirror(portal.piece)) continue;
    const glm::vec3 image = glm::reflect(towardsSun, outward);
    const auto known = std::find_if(images.begin(), images.end(), [&](const auto& other) {
      return glm::dot(other.second, image) > sameImage;
    });
    const double area_m2 = pieces().area_m2[portal.piece];
    if (known == images.end()) {
      images.emplace_back(area_m2, image);
    } else {
      known->first += area_m2;
    }
  }
  std::stable_sort(images.begin(), images.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<glm::vec3> ways;
  for (const auto& [area_m2, image] : images) {
    if (ways.size() < most) ways.push_back(image);
  }
  return ways;
}

glm::dvec3 World::tintOf(std::uint32_t piece) const {
  const glm::dvec3& transmittance = materialOf(piece).transmittance;
  const double luminance = luminanceOf(transmittance);
  return luminance > 0.0 ? transmittance / luminance : glm::dvec3(1.0);
}

glm::dvec3 World::reflectanceOf(std::uint32_t piece) const {
  const Material& material = materialOf(piece);
  return material.glazing ? glm::dvec3(glassOf(piece).hemisphericalReflectance()) : material.reflectance;
}

float World::innerTransmittance(const glm::vec3& from, const glm::vec3& to) const {
  if (!rays.hasInnerGlass()) return 1.0F;
  const glm::vec3 direction = glm::normalize(to - from);
  float product = 1.0F;
  for (const std::uint32_t piece : rays.innerGlassBetween(from, to)) {
    product *= glassOf(piece).transmittance(std::abs(glm::dot(direction, normalOf(2 * piece))));
  }
  return product;
}

float World::visibility(const glm::vec3& from, const glm::vec3& to) const {
  if (rays.occluded(from, to, RayScene::Barrier::opaqueAndGlass)) return 0.0F;
  return innerTransmittance(from, to);
}

void World::visibility(std::span<const RayScene::Segment> segments, std::span<std::uint8_t> blocked,
                       std::span<float> visible) const {
  rays.occluded(segments, RayScene::Barrier::opaqueAndGlass, blocked);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    visible[i] = blocked[i] != 0 ? 0.0F : innerTransmittance(segments[i].from, segments[i].to);
  }
}

}  // namespace clerestory
