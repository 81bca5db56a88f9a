// SPDX-License-Identifier: GPL-3.0-or-later
// Follows the beam from a point to the sun, and throws the panes' outlines along it onto elements.
#include "sunlight.hpp"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <geometry/sampling.hpp>
#include <solver/daylight.hpp>

namespace clerestory {
namespace {

constexpr int panesMost = 16;                                 // that a beam is followed through
constexpr float beyond_m = 1e4F;                              // nothing of the model is further than that
constexpr float samplesLeast = 16.0F, samplesMost = 1024.0F;  // of the part of an element that a pane lights
constexpr float samplesPerThreshold = 1.0F / 16.0F;
constexpr std::uint32_t samplesOfPane = 256;  // for the power that enters by it
constexpr std::uint32_t samplesOutdoors = 32, samplesUnasked = 4;

/// What comes through towards a point, and the first barrier of glass on the way there.
struct Passed {
  glm::vec3 share{0.0F};
  std::uint32_t firstPane = RayScene::Hit::none;
};

Passed passedAlong(const World& world, glm::vec3 from, const glm::vec3& direction) {
  Passed passed;
  if (world.rays.meetsAny(from, direction, RayScene::Barrier::opaque, beyond_m)) return passed;
  glm::vec3 share(1.0F);
  for (int pane = 0; pane < panesMost; ++pane) {
    const auto hit = world.rays.nearest(from, direction, RayScene::Barrier::opaqueAndGlass);
    const glm::vec3 end = from + (hit ? hit.distance_m : beyond_m) * direction;
    share *= world.innerTransmittance(from, end);
    if (!hit) {
      passed.share = share;
      return passed;
    }
    const Material& material = world.materialOf(hit.piece);
    if (!material.glazing || material.diffusing) return passed;  // what it scatters is the pane's own light
    if (pane == 0) passed.firstPane = hit.piece;
    const float cosine = std::abs(glm::dot(direction, world.normalOf(hit.side())));
    share *= world.portalFactor(hit.piece) * world.glassOf(hit.piece).transmittance(cosine) *
             glm::vec3(world.tintOf(hit.piece));
    from = end + rayOffset_m * direction;
  }
  return passed;
}

/// A pane that the sun shines in by.
struct Beam {
  std::uint32_t piece;
  std::vector<glm::vec3> outline;
  glm::vec3 centre{0.0F};
  float radius_m = 0.0F;
};

std::vector<Beam> beamsInto(const World& world, std::int32_t domain) {
  std::vector<Beam> beams;
  for (const Portal& portal : world.building.portals) {
    if (portal.inside != domain) continue;
    const glm::vec3 inward = world.normalOf(2 * portal.piece + (portal.frontIsInside ? 0U : 1U));
    if (glm::dot(inward, world.sun->towards) >= 0.0F) continue;
    const auto polygon = world.polygon(portal.piece);
    Beam beam{portal.piece, {polygon.begin(), polygon.end()}};
    for (const glm::vec3& corner : polygon) beam.centre += corner / static_cast<float>(polygon.size());
    for (const glm::vec3& corner : polygon)
      beam.radius_m = std::max(beam.radius_m, glm::length(corner - beam.centre));
    beams.push_back(std::move(beam));
  }
  return beams;
}

/// The part of a convex polygon where the plane's n·x + d is not negative (Sutherland and Hodgman).
std::vector<glm::vec3> clipped(const std::vector<glm::vec3>& polygon, const glm::vec4& plane) {
  std::vector<glm::vec3> kept;
  const auto height = [&](const glm::vec3& point) { return glm::dot(glm::vec3(plane), point) + plane.w; };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::vec3& from = polygon[i];
    const glm::vec3& to = polygon[(i + 1) % polygon.size()];
    const float here = height(from), there = height(to);
    if (here >= 0.0F) kept.push_back(from);
    if ((here >= 0.0F) != (there >= 0.0F)) kept.push_back(from + here / (here - there) * (to - from));
  }
  return kept;
}

float areaOf(const std::vector<glm::vec3>& polygon) {
  glm::vec3 sum(0.0F);
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum += glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return 0.5F * glm::length(sum);
}

/// Lights one closed domain.
class Patches {
 public:
  Patches(const World& world, Hierarchy& tree, const std::vector<Beam>& beams, float thresholdShare,
          float elementMin_m, std::size_t memoryBytes)
      : world_(world),
        tree_(tree),
        towards_(world.sun->towards),
        elementMin_m_(elementMin_m),
        memoryBytes_(memoryBytes) {
    for (const Beam& beam : beams) beams_.push_back(&beam);
    threshold_lm_ = thresholdShare * enteringPower_lm();
  }

  Sunlight light() && {
    light_.illuminance_lx.resize(tree_.size());
    light_.mayReach.resize(tree_.size());
    if (threshold_lm_ > 0.0F) visit(0, beams_);
    return std::move(light_);
  }

 private:
  using Beams = std::vector<const Beam*>;

  [[nodiscard]] float enteringPower_lm() const {
    float power_lm = 0.0F;
    for (const Beam* beam : beams_) {
      const Sequence sequence(mixKeys(0x50b, beam->piece));
      float seen = 0.0F;
      for (std::uint32_t i = 0; i < samplesOfPane; ++i) {
        const glm::vec3 point =
            pointOnPolygon<glm::vec3>(beam->outline, sequence(i, 0), sequence(i, 1)) - rayOffset_m * towards_;
        seen += passedAlong(world_, point, towards_).share.g;
      }
      power_lm += seen / samplesOfPane * areaOf(beam->outline) * world_.sun->normal_lx *
                  std::abs(glm::dot(towards_, world_.normalOf(2 * beam->piece)));
    }
    return power_lm;
  }

  void visit(NodeIndex node, const Beams& beams) {
    Beams near;
    for (const Beam* beam : beams) {
      const glm::vec3 way = tree_.centre[node] - beam->centre;
      const float reach_m = tree_.radius_m[node] + beam->radius_m;
      const float upstream_m = glm::dot(way, towards_);
      const float aside2 = glm::dot(way, way) - upstream_m * upstream_m;
      if (upstream_m < reach_m && aside2 < reach_m * reach_m * 1.0001F) near.push_back(beam);
    }
    if (near.empty()) return;
    if (tree_.isCluster(node)) {
      for (NodeIndex child = tree_.firstChild[node], i = 0; i < 2; ++i) visit(child + i, near);
      return;
    }
    if (glm::dot(tree_.normal(node), towards_) > 0.0F) visitElement(node, near);
  }

  void visitElement(NodeIndex element, const Beams& beams) {
    const glm::vec3 normal = tree_.normal(element);
    const float full_lx = world_.sun->normal_lx * glm::dot(normal, towards_);
    const float power_lm = full_lx * tree_.weight[element];
    const float count = std::clamp(samplesPerThreshold * power_lm / threshold_lm_, samplesLeast, samplesMost);
    const Sequence sequence(mixKeys(tree_.key[element], 0x50a));
    float lit = 0.0F;
    glm::vec3 mean(0.0F);
    bool isReached = false;
    for (const Beam* beam : beams) {
      const std::vector<glm::vec3> patch = patchOn(element, normal, *beam);
      const float share = areaOf(patch) / tree_.area_m2[element];
      if (patch.size() < 3 || share <= 1e-7F) continue;
      isReached = true;
      const auto samples = static_cast<std::uint32_t>(std::ceil(std::max(count * share, samplesLeast)));
      const float weight = share / static_cast<float>(samples);
      for (std::uint32_t i = 0; i < samples; ++i) {
        const glm::vec3 point = pointOnPolygon<glm::vec3>(patch, sequence(i, 0), sequence(i, 1));
        const Passed passed = passedAlong(world_, point + rayOffset_m * normal, towards_);
        if (passed.firstPane != beam->piece) continue;  // another pane's
        lit += passed.share.g > 0.0F ? weight : 0.0F;
        mean += weight * passed.share;
      }
    }
    if (!isReached) return;
    lit = std::min(lit, 1.0F);
    const float misplaced_lm = 0.5F * power_lm * std::sqrt(lit * (1.0F - lit));
    if (misplaced_lm > threshold_lm_ && tree_.radius_m[element] > elementMin_m_ &&
        tree_.bytes() < memoryBytes_) {
      const Halves halves = halve(tree_.shape(element), normal);
      const NodeIndex child = tree_.divide(element, halves.first, halves.second, halves.plane);
      light_.illuminance_lx.resize(tree_.size());
      light_.mayReach.resize(tree_.size());
      visit(child, beams);
      visit(child + 1, beams);
      return;
    }
    light_.illuminance_lx[element] = full_lx * mean;
    light_.mayReach[element] = 1;
  }

  /// Where on an element the beam through a pane would fall, were nothing else in its way.
  [[nodiscard]] std::vector<glm::vec3> patchOn(NodeIndex element, const glm::vec3& normal,
                                               const Beam& beam) const {
    const glm::vec3& centre = tree_.centre[element];
    std::vector<glm::vec3> patch = clipped(beam.outline, {normal, -glm::dot(normal, centre)});
    for (glm::vec3& point : patch)
      point -= glm::dot(point - centre, normal) / glm::dot(towards_, normal) * towards_;
    const auto corners = tree_.polygon(element);
    for (std::size_t i = 0; i < corners.size() && patch.size() > 2; ++i) {
      const glm::vec3 inwards = glm::cross(normal, corners[(i + 1) % corners.size()] - corners[i]);
      const float height = glm::dot(inwards, centre - corners[i]);
      const glm::vec3 edge = height < 0.0F ? -inwards : inwards;
      patch = clipped(patch, {edge, -glm::dot(edge, corners[i])});
    }
    return patch;
  }

  const World& world_;
  Hierarchy& tree_;
  glm::vec3 towards_;
  float elementMin_m_, threshold_lm_ = 0.0F;
  std::size_t memoryBytes_;
  Beams beams_;
  Sunlight light_;
};

Sunlight sunlightOutdoors(const World& world, const Hierarchy& tree) {
  Sunlight light;
  light.illuminance_lx.resize(tree.size());
  light.mayReach.resize(tree.size());
  const glm::vec3& towards = world.sun->towards;
  for (NodeIndex node = 0; node < tree.size(); ++node) {
    if (tree.isCluster(node) || !tree.isLeaf(node)) continue;
    const glm::vec3& normal = tree.normal(node);
    const auto faces = [&](const glm::vec3& way) { return glm::dot(normal, way) > 0.0F; };
    const std::vector<glm::vec3>& images = world.sun->towardsImages;
    if (!faces(towards) && std::none_of(images.begin(), images.end(), faces)) continue;
    light.mayReach[node] = 1;
    const std::uint32_t count = tree.weight[node] > 0.0F ? samplesOutdoors : samplesUnasked;
    const Sequence sequence(mixKeys(tree.key[node], 0x50a));
    for (std::uint32_t i = 0; i < count; ++i) {
      const glm::vec3 point = pointOnPolygon<glm::vec3>(tree.polygon(node), sequence(i, 0), sequence(i, 1)) +
                              rayOffset_m * normal;
      light.illuminance_lx[node] +=
          (sunlightAt(world, point, normal) + mirroredSunlightAt(world, point, normal)) /
          static_cast<float>(count);
    }
  }
  return light;
}

}  // namespace

glm::vec3 sunlightAt(const World& world, const glm::vec3& point, const glm::vec3& normal) {
  if (!world.sun) return glm::vec3(0.0F);
  const float cosine = glm::dot(normal, world.sun->towards);
  if (cosine <= 0.0F) return glm::vec3(0.0F);
  return world.sun->normal_lx * cosine * passedAlong(world, point, world.sun->towards).share;
}

glm::vec3 mirroredSunlightAt(const World& world, const glm::vec3& point, const glm::vec3& normal) {
  glm::vec3 sum(0.0F);
  if (!world.sun) return sum;
  for (const glm::vec3& image : world.sun->towardsImages) {
    const float cosine = glm::dot(normal, image);
    if (cosine <= 0.0F) continue;
    const auto hit = world.rays.nearest(point, image, RayScene::Barrier::opaqueAndGlass);
    if (!hit || !world.isMirror(hit.piece)) continue;
    const glm::vec3 pane = world.normalOf(hit.side());
    if (glm::dot(glm::reflect(world.sun->towards, pane), image) < sameImage) continue;
    const glm::vec3 onPane = point + hit.distance_m * image + rayOffset_m * pane;
    sum += cosine * world.glassOf(hit.piece).reflectance(std::abs(glm::dot(image, pane))) *
           passedAlong(world, onPane, world.sun->towards).share;
  }
  return world.sun->normal_lx * sum;
}

glm::vec3 sunDiscLuminance(const World& world, const glm::vec3& from, const glm::vec3& direction) {
  if (!world.sun) return glm::vec3(0.0F);
  static const float radius_rad = static_cast<float>(glm::radians(sunRadius_deg));
  // The chord: a cosine so near to 1 has no digits left in float.
  if (glm::length(direction - world.sun->towards) > radius_rad) return glm::vec3(0.0F);
  const float solidAngle_sr = std::numbers::pi_v<float> * radius_rad * radius_rad;
  return world.sun->normal_lx / solidAngle_sr * passedAlong(world, from, direction).share;
}

glm::vec3 sunlightByDisc(const World& world, const glm::vec3& point, const glm::vec3& normal,
                         std::uint32_t rays, std::uint64_t key) {
  glm::vec3 sum(0.0F);
  if (!world.sun || glm::dot(normal, world.sun->towards) < -0.01F) return sum;
  glm::vec3 tangent, bitangent;
  tangentFrame(world.sun->towards, tangent, bitangent);
  const Sequence sequence(mixKeys(key, 0x50d));
  static const auto radius = static_cast<float>(std::tan(glm::radians(sunRadius_deg)));
  for (std::uint32_t i = 0; i < rays; ++i) {
    const float away = radius * std::sqrt(sequence(i, 0));
    const float angle = 2.0F * std::numbers::pi_v<float> * sequence(i, 1);
    const glm::vec3 direction = glm::normalize(world.sun->towards + away * std::cos(angle) * tangent +
                                               away * std::sin(angle) * bitangent);
    const float cosine = glm::dot(normal, direction);
    if (cosine > 0.0F) sum += cosine * passedAlong(world, point, direction).share;
  }
  return world.sun->normal_lx / static_cast<float>(rays) * sum;
}

Sunlight sunlightOn(const World& world, std::int32_t domain, Hierarchy& tree, float thresholdShare,
                    float elementMin_m, std::size_t memoryBytes) {
  if (!world.sun) return {};
  if (world.building.domains[static_cast<std::size_t>(domain)].open) return sunlightOutdoors(world, tree);
  const std::vector<Beam> beams = beamsInto(world, domain);
  return Patches(world, tree, beams, thresholdShare, elementMin_m, memoryBytes).light();
}

}  // namespace clerestory
