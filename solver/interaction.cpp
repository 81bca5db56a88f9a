// SPDX-License-Identifier: GPL-3.0-or-later
// One interaction of a shooting step: the oracle, form factor and visibility of a link, and the light it
// moves.
#include "interaction.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <geometry/sampling.hpp>
#include <solver/formfactor.hpp>

namespace clerestory {
namespace {

constexpr float touching_m = 1e-5F;       // below this a point counts as in a plane
constexpr float linearDeviation = 0.29F;  // 1 / sqrt(12): rms of a linear ramp, of its whole rise
constexpr float cornerRise = 1.7F;        // of the rise between points 0.58 of the way to the corners
constexpr float farApart = 0.1F;          // (radii) / distance below which centres stand for elements

/// Where a receiver is asked for its form factor: Gauss-like points, towards each corner.
glm::vec3 quadraturePoint(const ElementShape& shape, std::size_t i) {
  const float share = shape.corners.size() == 3 ? 0.5F : 0.57735F;
  return shape.centre + share * (shape.corners[i] - shape.centre);
}

/// Rays of a link by the share of the domain's light that it could carry at most: independent of the light
/// itself, so a link computed anew is the one that was cached.
std::uint32_t raysFor(float share) {
  if (share < 1e-6F) return 2;
  if (share < 1e-5F) return 4;
  if (share < 1e-4F) return 8;
  return 16;
}

}  // namespace

template <int K>
Interactions<K>::Interactions(const SolvedLight<K>& light, std::int32_t domain, const Hierarchy& tree,
                              const Unshot<K>& unshot, const TransportSettings& settings)
    : light_(light),
      world_(light.world()),
      domain_(domain),
      tree_(tree),
      unshot_(unshot),
      settings_(settings),
      totalWeight_(std::max(tree.weight[0], 1e-20F)) {}

template <int K>
bool Interactions<K>::canDivide(const Element& receiver) const {
  const bool hasChildren = receiver.node != noNode && !tree_.isLeaf(receiver.node);
  return hasChildren || (mayGrow && receiver.shape.radius_m > settings_.elementMin_m);
}

template <int K>
bool Interactions<K>::isBehind(NodeIndex node, const glm::vec3& onPlane, const glm::vec3& normal) const {
  if (tree_.isCluster(node)) {
    const glm::vec3& low = tree_.corners[tree_.firstCorner[node]];
    const glm::vec3& high = tree_.corners[tree_.firstCorner[node] + 1];
    const glm::vec3 furthest(normal.x > 0 ? high.x : low.x, normal.y > 0 ? high.y : low.y,
                             normal.z > 0 ? high.z : low.z);
    return glm::dot(furthest - onPlane, normal) <= touching_m;
  }
  const auto polygon = tree_.polygon(node);
  return std::all_of(polygon.begin(), polygon.end(), [&](const glm::vec3& corner) {
    return glm::dot(corner - onPlane, normal) <= touching_m;
  });
}

template <int K>
auto Interactions<K>::look(const glm::vec3& centre, float radius_m, NodeIndex sender) const -> Sight {
  const float own = tree_.radius_m[sender];
  const float distance_m = glm::length(tree_.centre[sender] - centre);
  // The sender's sphere seen from the receiver's nearest point, and its area at the nearest distance.
  const float sine = own / std::max(distance_m - radius_m, own);
  const float gap_m = std::max(distance_m - radius_m - own, 1e-4F);
  const float facing = tree_.isCluster(sender) ? 0.5F : 1.0F;
  const float bound =
      std::min(sine * sine, facing * tree_.area_m2[sender] / (std::numbers::pi_v<float> * gap_m * gap_m));
  return {unshot_.strength[sender], distance_m, bound};
}

template <int K>
auto Interactions<K>::oracleForCluster(NodeIndex receiver, NodeIndex sender, Link& link, Tally& tally) const
    -> Verdict {
  if (unshot_.highest[sender] <= 0.0F || tree_.weight[receiver] <= 0.0F) return Verdict::nothing;
  const bool senderIsCluster = tree_.isCluster(sender);
  if (!senderIsCluster && isBehind(receiver, tree_.centre[sender], tree_.normal(sender)))
    return Verdict::nothing;

  const float radius_m = tree_.radius_m[receiver];
  const Sight seen = look(tree_.centre[receiver], radius_m, sender);
  const float power = seen.strength * seen.bound * tree_.weight[receiver];
  const float senderRadius_m = tree_.radius_m[sender];
  const bool canRefineSender = !tree_.isLeaf(sender);
  const bool apart = seen.distance_m > radius_m + senderRadius_m;
  const float relative =
      std::min(1.0F, std::max(radius_m, canRefineSender ? senderRadius_m : 0.0F) / seen.distance_m);
  if (power > threshold_lm && (!apart || 0.5F * power * relative > threshold_lm)) {
    return canRefineSender && senderRadius_m > radius_m ? Verdict::refineSender : Verdict::refineReceiver;
  }
  link.formFactor = seen.bound;
  const std::uint64_t key = mixKeys(tree_.key[receiver], tree_.key[sender]);
  const std::uint32_t count = raysFor(seen.bound * tree_.weight[receiver] / totalWeight_);
  link.visibility = Link::packVisibility(sampledVisibility(key, count, receiver, nullptr, sender, tally));
  return Verdict::accept;
}

template <int K>
auto Interactions<K>::oracleForElement(const Element& receiver, NodeIndex sender,
                                       std::span<const CachedLink> cached, Link& link, Tally& tally) const
    -> Verdict {
  const ElementShape& shape = receiver.shape;
  const glm::vec3& normal = tree_.sides[receiver.treeSide].normal;
  if (unshot_.highest[sender] <= 0.0F || shape.weight <= 0.0F) return Verdict::nothing;
  if (tree_.treeSide[sender] == receiver.treeSide) return Verdict::nothing;
  if (isBehind(sender, shape.centre, normal)) return Verdict::nothing;
  const bool senderIsCluster = tree_.isCluster(sender);
  if (!senderIsCluster) {
    const glm::vec3& facing = tree_.normal(sender);
    const bool behind = std::all_of(shape.corners.begin(), shape.corners.end(), [&](const glm::vec3& corner) {
      return glm::dot(corner - tree_.centre[sender], facing) <= touching_m;
    });
    if (behind) return Verdict::nothing;
  }

  const Sight seen = look(shape.centre, shape.radius_m, sender);
  const float senderRadius_m = tree_.radius_m[sender];
  const bool canRefineReceiver = canDivide(receiver);
  const bool canRefineSender = !tree_.isLeaf(sender);
  // A leaf sends evenly and its form factor is exact; a divided element errs by its unevenness, a cluster by
  // all.
  const float uneven = senderIsCluster ? seen.strength : unshot_.highest[sender] - unshot_.lowest[sender];
  const float senderShare = canRefineSender ? std::min(1.0F, senderRadius_m / seen.distance_m) : 0.0F;
  const float receiverShare = std::min(1.0F, shape.radius_m / seen.distance_m);
  const auto refineLarger = [&] {
    if (canRefineSender && (senderRadius_m > shape.radius_m || !canRefineReceiver))
      return Verdict::refineSender;
    return Verdict::refineReceiver;
  };
  const float weight = shape.weight;
  const bool isSmall = seen.strength * seen.bound * weight <= threshold_lm;
  if (!isSmall && senderIsCluster && seen.distance_m < shape.radius_m + senderRadius_m) return refineLarger();
  if (seen.strength * seen.bound * weight > threshold_lm) {
    const float roughly =
        seen.bound * weight * linearDeviation *
        std::max(seen.strength * receiverShare * (canRefineReceiver ? 1.0F : 0.0F), uneven * senderShare);
    if (roughly > 8.0F * threshold_lm) return refineLarger();
  }

  const auto found = std::lower_bound(cached.begin(), cached.end(), sender,
                                      [](const CachedLink& a, NodeIndex b) { return a.sender < b; });
  if (found != cached.end() && found->sender == sender) {
    link = found->link;
    ++tally.reused;
  } else {
    link = elementLink(receiver, sender, tally);
  }

  const float visible = link.visible();
  const float arriving = link.formFactor * weight;
  const float receiverError =
      linearDeviation * seen.strength * arriving * visible * link.spreadOverReceiver();
  const float shadowError = 0.5F * seen.strength * arriving * std::sqrt(visible * (1.0F - visible));
  const float senderError =
      (senderIsCluster ? 0.5F : linearDeviation) * uneven * arriving * visible * senderShare;
  if (senderError > threshold_lm && senderError >= receiverError) return Verdict::refineSender;
  if (receiverError > threshold_lm && canRefineReceiver) return Verdict::refineReceiver;
  if (senderError > threshold_lm) return Verdict::refineSender;
  if (shadowError > threshold_lm && (canRefineReceiver || canRefineSender)) return refineLarger();
  return Verdict::accept;
}

template <int K>
Link Interactions<K>::elementLink(const Element& receiver, NodeIndex sender, Tally& tally) const {
  const ElementShape& shape = receiver.shape;
  const glm::vec3& normal = tree_.sides[receiver.treeSide].normal;
  const Sight seen = look(shape.centre, shape.radius_m, sender);
  Link link;
  const float apart = (shape.radius_m + tree_.radius_m[sender]) / std::max(seen.distance_m, 1e-6F);
  if (tree_.isCluster(sender)) {
    link.formFactor = seen.bound;
    link.spread = Link::packSpread(2.0F * std::min(1.0F, shape.radius_m / seen.distance_m));
  } else if (apart < farApart) {
    const glm::vec3 way = (tree_.centre[sender] - shape.centre) / seen.distance_m;
    const float cosines =
        std::max(glm::dot(way, normal), 0.0F) * std::max(-glm::dot(way, tree_.normal(sender)), 0.0F);
    link.formFactor =
        cosines * tree_.area_m2[sender] / (std::numbers::pi_v<float> * seen.distance_m * seen.distance_m);
    link.spread = Link::packSpread(3.0F * shape.radius_m / seen.distance_m);
  } else {
    const auto polygon = tree_.polygon(sender);
    float low = 1.0F;
    float high = 0.0F;
    float sum = 0.0F;
    for (std::size_t i = 0; i < shape.corners.size(); ++i) {
      const glm::vec3 point = quadraturePoint(shape, i);
      const bool inFront = glm::dot(point - tree_.centre[sender], tree_.normal(sender)) > 0.0F;
      const float own = inFront ? pointToPolygon(point, normal, polygon) : 0.0F;
      low = std::min(low, own);
      high = std::max(high, own);
      sum += own;
    }
    link.formFactor = sum / static_cast<float>(shape.corners.size());
    link.spread =
        Link::packSpread(link.formFactor > 0.0F ? cornerRise * (high - low) / link.formFactor : 0.0F);
  }
  if (link.formFactor > 0.0F) {
    const std::uint32_t count = raysFor(link.formFactor * shape.weight / totalWeight_);
    const std::uint64_t key = mixKeys(shape.key, tree_.key[sender]);
    link.visibility = Link::packVisibility(sampledVisibility(key, count, noNode, &receiver, sender, tally));
  }
  return link;
}

template <int K>
auto Interactions<K>::spotOn(NodeIndex node, float u, float v, float choice) const -> Spot {
  while (tree_.isCluster(node)) {
    const NodeIndex first = tree_.firstChild[node];
    const float share = tree_.area_m2[first] / tree_.area_m2[node];
    const bool second = choice >= share;
    choice = second ? (choice - share) / std::max(1.0F - share, 1e-7F) : choice / std::max(share, 1e-7F);
    node = first + (second ? 1U : 0U);
  }
  return {pointOnPolygon<glm::vec3>(tree_.polygon(node), u, v), tree_.normal(node)};
}

// The share of the kernel between receiver and sender that is not blocked. Rays end on the contents of
// clusters.
template <int K>
float Interactions<K>::sampledVisibility(std::uint64_t key, std::uint32_t count, NodeIndex receiverNode,
                                         const Element* receiver, NodeIndex sender, Tally& tally) const {
  const bool anyCluster = receiver == nullptr || tree_.isCluster(sender);
  const Sequence fromReceiver(key);
  const Sequence fromSender(key + 0x51ed);
  const float receiverRadius_m =
      receiver != nullptr ? receiver->shape.radius_m : tree_.radius_m[receiverNode];
  const float nearest_m = 0.25F * std::min(receiverRadius_m, tree_.radius_m[sender]);
  float seen = 0.0F;
  float total = 0.0F;
  std::uint32_t cast = 0;
  // Contents that face away from each other say nothing, so clusters may draw four times as often.
  for (std::uint32_t i = 0; i < (anyCluster ? 4 * count : count) && cast < count; ++i) {
    Spot from;
    if (receiver != nullptr) {
      from.point = pointOnPolygon<glm::vec3>(receiver->shape.corners, fromReceiver(i, 0), fromReceiver(i, 1));
      from.normal = tree_.sides[receiver->treeSide].normal;
    } else {
      from = spotOn(receiverNode, fromReceiver(i, 0), fromReceiver(i, 1), fromReceiver(i, 2));
    }
    const Spot to = spotOn(sender, fromSender(i, 0), fromSender(i, 1), fromSender(i, 2));
    const glm::vec3 way = to.point - from.point;
    const float leaving = glm::dot(way, from.normal);
    const float arriving = -glm::dot(way, to.normal);
    if (leaving <= 0.0F || arriving <= 0.0F) continue;
    const float squared = std::max(glm::dot(way, way), nearest_m * nearest_m);
    const float kernel = leaving * arriving / (squared * squared);
    ++cast;
    total += kernel;
    seen += kernel * world_.visibility(from.point, to.point);
  }
  tally.rays += cast;
  return total > 0.0F ? std::min(seen / total, 1.0F) : 0.0F;
}

// A cluster's contents stand for it at its centre; nearer than its own size, or than its contents could fill
// the view, the inverse square is held, so that no interaction brings more light than its sender has.
template <int K>
float Interactions<K>::heldSquare(NodeIndex sender, float distance_m, float receiverRadius_m) const {
  const float nearest_m = std::max({distance_m, receiverRadius_m, tree_.radius_m[sender]});
  return std::max(nearest_m * nearest_m, tree_.area_m2[sender] / (2.0F * std::numbers::pi_v<float>));
}

template <int K>
void Interactions<K>::addToElement(Received<K>& next, const Element& receiver, NodeIndex sender,
                                   const Link& link) const {
  const Received<K> even{unshot_.radiosity_lm_m2[sender], 1.0F};
  if (!tree_.isCluster(sender)) {
    next += (link.formFactor * link.visible()) * even;
    return;
  }
  const ElementShape& shape = receiver.shape;
  const glm::vec3& normal = tree_.sides[receiver.treeSide].normal;
  const glm::vec3 way = tree_.centre[sender] - shape.centre;
  const float distance_m = glm::length(way);
  if (distance_m < shape.radius_m + tree_.radius_m[sender]) {
    next += (link.visible() * isotropicShare(sender, shape.radius_m)) * even;
    return;
  }
  const glm::vec3 direction = way / distance_m;
  const float cosine = std::max(glm::dot(direction, normal), 0.0F);
  const float factor =
      link.visible() * cosine / (std::numbers::pi_v<float> * heldSquare(sender, distance_m, shape.radius_m));
  next += factor * sentAlong(sender, -direction);
}

// What a cluster sends in a direction: the parts of its six that go that way. [lm, m²]
template <int K>
Received<K> Interactions<K>::sentAlong(NodeIndex cluster, const glm::vec3& direction) const {
  Received<K> sent;
  for (std::size_t k = 0; k < 6; ++k) {
    sent += alongDirection(direction, k) *
            Received<K>{unshot_.byDirection_lm[cluster][k], tree_.crossSection_m2[cluster][k]};
  }
  return sent;
}

// Of the view from within a cluster, the share that its contents may fill: a quarter of their area is seen on
// average.
template <int K>
float Interactions<K>::isotropicShare(NodeIndex sender, float receiverRadius_m) const {
  const float radius_m = std::max(receiverRadius_m, tree_.radius_m[sender]);
  return std::min(1.0F, tree_.area_m2[sender] / (4.0F * std::numbers::pi_v<float> * radius_m * radius_m));
}

template <int K>
void Interactions<K>::addToCluster(SixReceived<K>& next, NodeIndex receiver, NodeIndex sender,
                                   const Link& link) const {
  const Received<K> even{unshot_.radiosity_lm_m2[sender], 1.0F};
  const glm::vec3 way = tree_.centre[sender] - tree_.centre[receiver];
  const float distance_m = glm::length(way);
  if (distance_m < tree_.radius_m[receiver] + tree_.radius_m[sender]) {
    // From all around; a plane that leans gets up to three directions' worth, half as much again on average.
    const float share = link.visible() * isotropicShare(sender, tree_.radius_m[receiver]) / 1.5F;
    for (Received<K>& side : next) side += share * even;
    return;
  }
  if (!tree_.isCluster(sender)) {
    if (glm::dot(way, tree_.normal(sender)) >= 0.0F) return;
    const auto polygon = tree_.polygon(sender);
    for (std::size_t k = 0; k < 6; ++k) {
      next[k] += (link.visible() * pointToPolygon(tree_.centre[receiver], sixDirections[k], polygon)) * even;
    }
    return;
  }
  const glm::vec3 direction = way / distance_m;
  const float square = heldSquare(sender, distance_m, tree_.radius_m[receiver]);
  const Received<K> arriving =  // on a plane square to the way
      (link.visible() / (std::numbers::pi_v<float> * square)) * sentAlong(sender, -direction);
  for (std::size_t k = 0; k < 6; ++k) next[k] += alongDirection(direction, k) * arriving;
}

// Light that no node of the tree sends: from the portals, or from the sky where no glass is between.
template <int K>
auto Interactions<K>::receiveFromOutside(const Element& receiver, NodeIndex sender, Columns<K>& next,
                                         Tally& tally) const -> Verdict {
  return sender == openSky ? receiveFromSky(receiver, next, tally)
                           : receiveFromPortals(receiver, next, tally);
}

template <int K>
auto Interactions<K>::receiveFromSky(const Element& receiver, Columns<K>& next, Tally& tally) const
    -> Verdict {
  if (receiver.node != noNode && !tree_.isLeaf(receiver.node)) return Verdict::refineReceiver;
  const ElementShape& shape = receiver.shape;
  const glm::vec3& normal = tree_.sides[receiver.treeSide].normal;
  const Sequence sequence(mixKeys(shape.key, 0x5c1));
  // An element that nothing asks for is lit by a few rays, for the little that it reflects.
  const std::uint32_t count = shape.weight > 0.0F ? settings_.skyRays : 32;
  Columns<K> sum;
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::vec3 from =
        pointOnPolygon<glm::vec3>(shape.corners, sequence(i, 0), sequence(i, 1)) + rayOffset_m * normal;
    const glm::vec3 direction = cosineDirection(normal, sequence(i, 2), sequence(i, 3));
    const auto hit = world_.rays.nearest(from, direction, RayScene::Barrier::opaqueAndGlass);
    if (!hit)
      sum += world_.innerTransmittance(from, from + 1e4F * direction) * light_.skyLuminance(direction);
  }
  tally.rays += count;
  next += (std::numbers::pi_v<float> / static_cast<float>(count)) * sum;
  return Verdict::accept;
}

// The points that integrate the light over a receiver also tell its rise, shadows included; what is within
// their own noise is no rise.
template <int K>
auto Interactions<K>::receiveFromPortals(const Element& receiver, Columns<K>& next, Tally& tally) const
    -> Verdict {
  const ElementShape& shape = receiver.shape;
  const glm::vec3& normal = tree_.sides[receiver.treeSide].normal;
  const auto lightAt = [&](const glm::vec3& point, std::uint64_t number) {
    const DirectLight<K> direct = directFromPortals(light_, domain_, point + rayOffset_m * normal, normal,
                                                    settings_.direct, mixKeys(shape.key, number));
    tally.rays += direct.rays;
    return direct;
  };
  const bool canRefine = canDivide(receiver);
  const DirectLight<K> middle = lightAt(shape.centre, 0);
  if (!canRefine) {
    next += middle.illuminance_lx;
    return Verdict::accept;
  }
  Columns<K> sum;
  float low = world_.layout.strength(middle.illuminance_lx);
  float high = low;
  float noise = middle.deviation_lx;
  const std::size_t count = shape.corners.size();
  for (std::size_t i = 0; i < count; ++i) {
    const DirectLight<K> own = lightAt(quadraturePoint(shape, i), i + 1);
    const float strength = world_.layout.strength(own.illuminance_lx);
    low = std::min(low, strength);
    high = std::max(high, strength);
    noise = std::max(noise, own.deviation_lx);
    sum += (1.0F / static_cast<float>(count)) * own.illuminance_lx;
  }
  const float rise = std::max(cornerRise * (high - low) - 2.0F * noise, 0.0F);
  if (linearDeviation * rise * shape.weight > threshold_lm) return Verdict::refineReceiver;
  next += sum;
  return Verdict::accept;
}

// Light that enters by the portals, by many directions over each pane. [lm]
template <int K>
Columns<K> Interactions<K>::portalFlux() const {
  Columns<K> flux;
  for (const Portal& portal : world_.building.portals) {
    if (portal.inside != domain_ || !world_.layout.sky) continue;
    const glm::vec3 outward = world_.normalOf(2 * portal.piece + (portal.frontIsInside ? 1U : 0U));
    const auto polygon = world_.polygon(portal.piece);
    const Sequence sequence(mixKeys(0xf10c, portal.piece));
    const std::uint32_t count = settings_.portalFluxRays;
    Columns<K> sum;
    for (std::uint32_t i = 0; i < count; ++i) {
      const glm::vec3 point = pointOnPolygon<glm::vec3>(polygon, sequence(i, 0), sequence(i, 1));
      const glm::vec3 direction = cosineDirection(outward, sequence(i, 2), sequence(i, 3));
      sum += light_.throughPortal(portal, point - 1e-3F * direction, point);
    }
    const auto area_m2 = static_cast<float>(world_.pieces().area_m2[portal.piece]);
    flux += (std::numbers::pi_v<float> * area_m2 / static_cast<float>(count)) * sum;
  }
  return flux;
}

template class Interactions<1>;
template class Interactions<2>;
template class Interactions<4>;
template class Interactions<8>;

}  // namespace clerestory
