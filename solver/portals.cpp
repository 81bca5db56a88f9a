// SPDX-License-Identifier: GPL-3.0-or-later
// Judges light from portals by exact form factors, and brings it by rays to points on the panes.
#include "portals.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <geometry/sampling.hpp>
#include <solver/formfactor.hpp>

#include "sphericalpolygon.hpp"

namespace clerestory {
namespace {

// Through strips between blades few rays meet the sky: their flux takes as many more as its deviation asks
// for.
constexpr double evenPane =
    2.0;  // deviation of what a pane without them shows, at most, in terms of the mean
constexpr double raysTimesMost = 16.0;
constexpr float nearSamples = 8.0F;  // of a near element, whose points see different parts of the pane

/// Whether the portal's form factor may rise steeply over an element.
template <int K>
bool isNear(const PortalSender<K>& portal, const Receiver& element) {
  const float distance_m = glm::length(portal.centre - element.centre);
  return element.radius_m + portal.radius_m > touchingApart * distance_m &&
         std::max(element.corners.size(), portal.polygon.size()) <= contourCornersMost;
}

/// What a clear pane mirrors towards a point of the sun's first light on the domain: of the patches that the
/// beam lights, and of what other panes show of sunlit ground. A patch on the floor before a pane lies at a
/// grazing angle to it, and the ceiling sees it there a second time. [cd/m²]
template <int K>
Columns<K> mirroredSunlight(const SolvedLight<K>& light, const PortalSender<K>& portal,
                            const glm::vec3& point, const glm::vec3& onPane) {
  const World& world = light.world();
  const std::uint32_t pane = world.building.portals[portal.portal].piece;
  const glm::vec3 direction = glm::normalize(onPane - point);
  const glm::vec3 mirrored = glm::reflect(direction, portal.inward);
  const glm::vec3 from = onPane + rayOffset_m * portal.inward;
  const auto hit = world.rays.nearest(from, mirrored, RayScene::Barrier::opaqueAndGlass);
  if (!hit) return {};
  const glm::vec3 met = from + hit.distance_m * mirrored;
  const float share = world.glassOf(pane).reflectance(std::abs(glm::dot(direction, portal.inward))) *
                      world.innerTransmittance(point, onPane) * world.innerTransmittance(from, met);
  if (world.materialOf(hit.piece).glazing) {
    const Columns<K> shown = light.paneLuminance(hit.piece, met, mirrored);
    return share * world.layout.template light<K>(world.layout.sunColumn(),
                                                  world.layout.colourOf(shown, world.layout.sunColumn()));
  }
  const glm::vec3 normal = world.normalOf(hit.side());
  const glm::dvec3 beam_lx(sunlightAt(world, met + rayOffset_m * normal, normal));
  return std::numbers::inv_pi_v<float> * share *
         world.layout.template light<K>(world.layout.sunColumn(), world.reflectanceOf(hit.piece) * beam_lx);
}

/// What a portal shows towards a point that sees it: the outside, and mirrored patches. [cd/m²]
template <int K>
Columns<K> shownTo(const SolvedLight<K>& light, const PortalSender<K>& portal, const glm::vec3& point,
                   const glm::vec3& onPane) {
  Columns<K> luminance = light.behindPortal(light.world().building.portals[portal.portal], point, onPane);
  if (portal.mirrored_lm_m2 > 0.0F) luminance += mirroredSunlight(light, portal, point, onPane);
  return luminance;
}

/// Exitance that a portal shows towards a point, were nothing outdoors but sky and ground; not less than half
/// of what it lets in on average, since facades outdoors may be brighter than the sky there. What it mirrors
/// counts by its mean.
template <int K>
float exitanceTowards(const SolvedLight<K>& light, const PortalSender<K>& portal, const glm::vec3& point) {
  const World& world = light.world();
  const glm::vec3 outward = glm::normalize(portal.centre - point);
  const std::uint32_t piece = world.building.portals[portal.portal].piece;
  if (world.materialOf(piece).diffusing) return portal.exitance_lm_m2;
  const float transmittance = world.portalFactor(piece) *
                              world.glassOf(piece).transmittance(std::abs(glm::dot(outward, portal.inward)));
  const float sky = world.layout.strength(
      transmittance * (world.layout.template property<K>(world.tintOf(piece)) * light.skyLuminance(outward)));
  return std::max(std::numbers::pi_v<float> * sky, 0.5F * portal.exitance_lm_m2) + portal.mirrored_lm_m2;
}

}  // namespace

template <int K>
std::vector<PortalSender<K>> portalsOf(const SolvedLight<K>& light, std::int32_t domain, std::uint32_t rays,
                                       bool mirrorsPatches) {
  const World& world = light.world();
  std::vector<PortalSender<K>> senders;
  for (std::uint32_t i = 0; i < world.building.portals.size(); ++i) {
    const Portal& portal = world.building.portals[i];
    if (portal.inside != domain) continue;
    const bool isLitOutside = world.layout.sky || world.layout.sun ||
                              std::any_of(world.lamps.begin(), world.lamps.end(),
                                          [&](const Lamp& lamp) { return lamp.domain() == portal.outside; });
    if (!isLitOutside) continue;
    PortalSender<K> sender{};
    sender.portal = i;
    sender.polygon = world.polygon(portal.piece);
    sender.inward = world.normalOf(2 * portal.piece + (portal.frontIsInside ? 0U : 1U));
    sender.area_m2 = static_cast<float>(world.pieces().area_m2[portal.piece]);
    for (const glm::vec3& corner : sender.polygon)
      sender.centre += corner / static_cast<float>(sender.polygon.size());
    for (const glm::vec3& corner : sender.polygon)
      sender.radius_m = std::max(sender.radius_m, glm::length(corner - sender.centre));

    const Sequence sequence(mixKeys(0xf10c, portal.piece));
    const bool mirrors = mirrorsPatches && world.sun && world.isMirror(portal.piece);
    Columns<K> sum;
    Columns<K> mirrored;
    double squares = 0.0;
    const auto deviationOver = [&](std::uint32_t count) {
      const double mean = static_cast<double>(world.layout.strength(sum)) / count;
      return mean > 0.0 ? std::sqrt(std::max(squares / count / (mean * mean) - 1.0, 0.0)) : 0.0;
    };
    std::uint32_t count = rays;
    for (std::uint32_t ray = 0; ray < count; ++ray) {
      const glm::vec3 point = pointOnPolygon<glm::vec3>(sender.polygon, sequence(ray, 0), sequence(ray, 1));
      const glm::vec3 direction = cosineDirection(-sender.inward, sequence(ray, 2), sequence(ray, 3));
      const Columns<K> shown = light.throughPortal(portal, point - 1e-3F * direction, point);
      sum += shown;
      squares += std::pow(static_cast<double>(world.layout.strength(shown)), 2.0);
      if (mirrors) mirrored += mirroredSunlight(light, sender, point - 1e-3F * direction, point);
      if (ray + 1 == rays)
        count = rays * static_cast<std::uint32_t>(
                           std::clamp(std::pow(deviationOver(rays) / evenPane, 2.0), 1.0, raysTimesMost));
    }
    const float ofEach = std::numbers::pi_v<float> / static_cast<float>(count);
    const Columns<K> exitance = ofEach * sum;
    sender.flux_lm = (ofEach * sender.area_m2) * (sum + mirrored);
    sender.deviation = static_cast<float>(deviationOver(count));
    sender.mirrored_lm_m2 = world.layout.strength(ofEach * mirrored);
    sender.exitance_lm_m2 = world.layout.strength(exitance);
    senders.push_back(sender);
  }
  return senders;
}

template <int K>
PortalSight lookAtPortal(const SolvedLight<K>& light, const PortalSender<K>& portal,
                         const Receiver& receiver) {
  PortalSight sight;
  if (receiver.isCluster()) {
    const glm::vec3 way = portal.centre - receiver.centre;
    const float distance_m = glm::length(way);
    if (glm::dot(-way, portal.inward) <= -receiver.radius_m) return sight;  // all behind the pane
    const float sine = portal.radius_m / std::max(distance_m - receiver.radius_m, portal.radius_m);
    const float gap_m = std::max(distance_m - receiver.radius_m - portal.radius_m, 1e-4F);
    sight.formFactor = std::min(sine * sine, portal.area_m2 / (std::numbers::pi_v<float> * gap_m * gap_m));
    sight.light_lx = sight.formFactor * exitanceTowards(light, portal, receiver.centre);
    sight.rise_lx = std::min(1.0F, (receiver.radius_m + portal.radius_m) / distance_m) * sight.light_lx;
    return sight;
  }
  float low = std::numeric_limits<float>::max();
  float high = 0.0F;
  const SeenFromPoints seen(receiver, portal.polygon, portal.centre, portal.inward);
  const auto count = static_cast<float>(seen.count);
  for (std::size_t i = 0; i < seen.count; ++i) {
    const float own = seen.formFactors[i];
    const float own_lx = own > 0.0F ? own * exitanceTowards(light, portal, seen.points[i]) : 0.0F;
    low = std::min(low, own_lx);
    high = std::max(high, own_lx);
    sight.formFactor += own / count;
    sight.light_lx += own_lx / count;
  }
  sight.rise_lx = cornerRise * (high - low);
  if (isNear(portal, receiver)) {
    const float exact =
        meanFormFactor(receiver.corners, receiver.normal, receiver.area_m2, portal.polygon, portal.inward);
    sight.light_lx = sight.formFactor > 0.0F ? sight.light_lx * exact / sight.formFactor
                                             : exact * exitanceTowards(light, portal, receiver.centre);
    sight.formFactor = exact;
  }
  return sight;
}

namespace {

/// One of the points of a pane that a receiver looks at. Each receiver has its own: what eight points shared
/// by all of them miss of a strip between blades would be missed everywhere.
template <int K>
glm::vec3 spotOnPane(const PortalSender<K>& portal, const Sequence& sequence, std::size_t i) {
  const auto number = static_cast<std::uint32_t>(i);
  return pointOnPolygon<glm::vec3>(portal.polygon, sequence(number, 0), sequence(number, 1));
}

}  // namespace

template <int K>
float seenOfPortal(const World& world, const PortalSender<K>& portal, const Receiver& receiver) {
  std::array<RayScene::Segment, spotsOfNode> segments;
  std::array<std::uint8_t, spotsOfNode> blocked;
  const Sequence onPane(mixKeys(receiver.key, portal.portal));
  for (std::size_t i = 0; i < spotsOfNode; ++i)
    segments[i] = {(*receiver.spots)[i], spotOnPane(portal, onPane, i)};
  world.rays.occluded(segments, RayScene::Barrier::opaque, blocked);
  std::size_t seen = 0;
  for (const std::uint8_t isBlocked : blocked) seen += isBlocked == 0 ? 1U : 0U;
  return static_cast<float>(seen) / static_cast<float>(spotsOfNode);
}

namespace {

/// Ways from points of an element to points on a pane, and what each counts.
struct PaneSamples {
  std::vector<RayScene::Segment> ways;
  std::vector<float> weights;
};

/// By the view of the pane from the element's middle, or, without it, by one from each point.
template <int K>
PaneSamples samplesOf(const PortalSender<K>& portal, const Receiver& element, std::uint32_t count,
                      const std::optional<SphericalPolygon>& fromMiddle) {
  const Sequence onPortal(mixKeys(element.key, portal.portal));
  const Sequence onElement(mixKeys(element.key, 0x9a3e + std::uint64_t{portal.portal}));
  const glm::vec3 lift = rayOffset_m * element.normal;
  PaneSamples samples;
  samples.ways.reserve(count);
  samples.weights.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::vec3 point =
        pointOnPolygon<glm::vec3>(element.corners, onElement(i, 2), onElement(i, 3)) + lift;
    const glm::vec3 eye = fromMiddle ? element.centre + lift : point;
    const float u = onPortal(i, 0);
    const float v = onPortal(i, 1);
    const std::optional<SphericalSample> seen =
        fromMiddle ? SphericalSample{fromMiddle->direction(u, v), fromMiddle->solidAngle_sr()}
                   : sampleSeen(point, element.normal, portal.polygon, u, v);
    if (!seen) continue;
    const glm::vec3& direction = seen->direction;
    const float approach = glm::dot(direction, portal.inward);
    const float cosine = glm::dot(direction, element.normal);
    if (approach >= 0.0F || cosine <= 0.0F) continue;
    samples.ways.push_back(
        {point, eye + (glm::dot(portal.centre - eye, portal.inward) / approach) * direction});
    samples.weights.push_back(static_cast<float>(seen->solidAngle_sr) * cosine);
  }
  return samples;
}

}  // namespace

template <int K>
PortalLight<K> elementLightFromPortal(const SolvedLight<K>& light, const PortalSender<K>& portal,
                                      const Receiver& element, const PortalSight& sight, float samples) {
  const World& world = light.world();
  // Near by, or where the middle sees nothing, each point of the element has a view of the pane of its own.
  std::optional<SphericalPolygon> fromMiddle;
  if (!isNear(portal, element)) {
    fromMiddle.emplace(element.centre + rayOffset_m * element.normal, element.normal, portal.polygon);
    if (fromMiddle->solidAngle_sr() <= 0.0) fromMiddle.reset();
  }
  const float least = fromMiddle ? 0.0F : nearSamples;
  const auto count = static_cast<std::uint32_t>(std::ceil(std::max(samples, least)));
  const auto [ways, counts] = samplesOf(portal, element, count, fromMiddle);
  std::vector<std::uint8_t> blocked(ways.size());
  world.rays.occluded(ways, RayScene::Barrier::opaque, blocked);
  PortalLight<K> result;
  result.rays = ways.size();
  Columns<K> sum;
  Columns<K> squared;
  float weights = 0.0F;
  float squares = 0.0F;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const float weight = counts[i];
    weights += weight;
    squares += weight * weight;
    if (blocked[i] != 0) continue;
    result.visible += weight;
    const Columns<K> luminance = shownTo(light, portal, ways[i].from, ways[i].to);
    sum += weight * luminance;
    squared += weight * weight * luminance;
  }
  if (weights <= 0.0F) return result;
  result.visible = std::min(result.visible / weights, 1.0F);
  // Weights and what is seen go together: on the floor, the higher on a pane the more of it counts and the
  // brighter is the sky there. A ratio of means is too dark by what the two share, which for even points in
  // four dimensions is n^(-5/4) of what single samples do (Tin 1965).
  const auto n = static_cast<float>(count);
  const float share = std::pow(n, -1.25F);
  const Columns<K> ratio = (1.0F / weights) * sum;
  const Columns<K> missed = (share / (1.0F - share) * n / (weights * weights)) * (squared - squares * ratio);
  const Columns<K> luminance = ratio + missed;
  for (int c = 0; c < K; ++c) {
    result.illuminance_lx[c] = std::max(std::numbers::pi_v<float> * sight.formFactor * luminance[c], 0.0F);
  }
  return result;
}

template <int K>
std::array<Columns<K>, 6> clusterLightFromPortal(const SolvedLight<K>& light, const PortalSender<K>& portal,
                                                 const Hierarchy& tree, NodeIndex cluster,
                                                 std::uint64_t& rays) {
  const World& world = light.world();
  const Spots& spots = tree.spots[cluster];
  const Sequence sequence(mixKeys(tree.key[cluster], portal.portal));
  Columns<K> seen;
  float count = 0.0F;
  for (std::size_t i = 0; i < spotsOfNode; ++i) {
    const glm::vec3 onPane = spotOnPane(portal, sequence, i);
    const glm::vec3 way = onPane - spots[i];
    if (glm::dot(way, tree.spotNormal(cluster, i)) <= 0.0F || glm::dot(way, portal.inward) >= 0.0F) continue;
    count += 1.0F;
    const glm::vec3 spot = spots[i] + rayOffset_m * tree.spotNormal(cluster, i);
    if (!world.rays.occluded(spot, onPane, RayScene::Barrier::opaque))
      seen += shownTo(light, portal, spot, onPane);
  }
  rays += static_cast<std::uint64_t>(count);
  std::array<Columns<K>, 6> six{};
  if (count == 0.0F) return six;
  for (std::size_t k = 0; k < 6; ++k) {
    const float formFactor = pointToPolygon(tree.centre[cluster], sixDirections[k], portal.polygon);
    six[k] = (std::numbers::pi_v<float> * formFactor / count) * seen;
  }
  return six;
}

#define CLERESTORY_INSTANTIATE(K)                                                                        \
  template std::vector<PortalSender<K>> portalsOf<K>(const SolvedLight<K>&, std::int32_t, std::uint32_t, \
                                                     bool);                                              \
  template PortalSight lookAtPortal<K>(const SolvedLight<K>&, const PortalSender<K>&, const Receiver&);  \
  template float seenOfPortal<K>(const World&, const PortalSender<K>&, const Receiver&);                 \
  template PortalLight<K> elementLightFromPortal<K>(const SolvedLight<K>&, const PortalSender<K>&,       \
                                                    const Receiver&, const PortalSight&, float);         \
  template std::array<Columns<K>, 6> clusterLightFromPortal<K>(                                          \
      const SolvedLight<K>&, const PortalSender<K>&, const Hierarchy&, NodeIndex, std::uint64_t&);
CLERESTORY_TRANSPORT_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
