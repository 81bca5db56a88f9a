// SPDX-License-Identifier: GPL-3.0-or-later
// The oracle's estimates, and how the light of links is added up; links.cpp measures them.
#include "interaction.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <geometry/sampling.hpp>
#include <solver/formfactor.hpp>

#include "mirrored.hpp"
#include "otherways.hpp"
#include "weak.hpp"

namespace clerestory {
namespace {

constexpr float touching_m = 1e-5F;  // below this a point counts as in a plane
// Calibrated on the furnished office (docs/validation.md): errors of surfaces against time.
constexpr float raysInsteadOfLinks = 32.0F;  // up to so many, links are not even looked for
constexpr float weakRaysLeast = 16.0F, weakRaysMost = 256.0F;
constexpr float looksIntoDark = 16.0F, looksForShadow = 8.0F;  // further ones, where all rays agree
constexpr std::uint32_t raysToPanes = 16;
constexpr float darkerBySender = 0.2F;  // thresholds that a sender's own shadow may take off
constexpr float clusterTakes = 5.0F;    // thresholds that a cluster takes as one mean

/// Of each of a tree's sides the root of its exitance, in terms of what all of them emit per area; 1 at
/// least. By exitance itself an office with luminous panels takes 1.2 times as long.
template <int K>
std::vector<float> brillianceOf(const World& world, const Hierarchy& tree,
                                std::span<const Columns<K>> exitance_lm_m2) {
  std::vector<float> brilliance(tree.sides.size(), 1.0F);
  float emitted_lm = 0.0F;
  for (std::size_t i = 0; i < tree.sides.size(); ++i)
    emitted_lm += world.layout.strength(exitance_lm_m2[i]) * tree.area_m2[tree.sides[i].root];
  if (!(emitted_lm > 0.0F)) return brilliance;
  const float even_lm_m2 = emitted_lm / tree.area_m2[0];
  for (std::size_t i = 0; i < tree.sides.size(); ++i)
    brilliance[i] = std::max(std::sqrt(world.layout.strength(exitance_lm_m2[i]) / even_lm_m2), 1.0F);
  return brilliance;
}

}  // namespace

TransportSettings transportFor(double accuracy) {
  const double finer = 0.05 / accuracy;  // 1 at the standard accuracy
  TransportSettings settings;
  settings.epsilon = static_cast<float>(2e-5 / (finer * finer));
  settings.elementMin_m = static_cast<float>(std::max(0.08 / finer, 0.02));
  settings.portalFluxRays = static_cast<std::uint32_t>(std::clamp(1024.0 * finer * finer, 512.0, 65536.0));
  settings.skyRays = static_cast<std::uint32_t>(256.0 * finer);
  settings.endShare = 0.1 * accuracy;
  return settings;
}

template <int K>
Interactions<K>::Interactions(const World& world, const Hierarchy& tree, const Unshot<K>& unshot,
                              std::span<const Columns<K>> exitance_lm_m2, const TransportSettings& settings)
    : world_(world),
      tree_(tree),
      unshot_(unshot),
      settings_(settings),
      totalWeight_(std::max(tree.weight[0], 1e-20F)),
      brilliance_(brillianceOf(world, tree, exitance_lm_m2)) {
  treeSideOf_.resize(2 * world_.pieces().size(), noNode);
  for (std::uint32_t i = 0; i < tree.sides.size(); ++i) treeSideOf_[tree.sides[i].side] = i;
  seesPanes_ = std::ranges::any_of(tree.sides, [&](const TreeSide& side) {
    const auto domain = static_cast<std::size_t>(world.building.sideDomain[side.side]);
    return world.building.domains[domain].open && world.isMirror(side.side / 2);
  });
}

template <int K>
bool Interactions<K>::canDivide(const Receiver& receiver) const {
  const bool hasChildren = receiver.node != noNode && !tree_.isLeaf(receiver.node);
  return hasChildren || (mayGrow && receiver.radius_m > settings_.elementMin_m);
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
bool Interactions<K>::isBehind(const Receiver& receiver, const glm::vec3& onPlane,
                               const glm::vec3& normal) const {
  if (receiver.isCluster()) return isBehind(receiver.node, onPlane, normal);
  return std::all_of(receiver.corners.begin(), receiver.corners.end(), [&](const glm::vec3& corner) {
    return glm::dot(corner - onPlane, normal) <= touching_m;
  });
}

template <int K>
auto Interactions<K>::look(const Receiver& receiver, NodeIndex sender) const -> Sight {
  const float own = tree_.radius_m[sender];
  const float distance_m = glm::length(tree_.centre[sender] - receiver.centre);
  // The sender's sphere seen from the receiver's nearest point, and its area at the nearest distance.
  const float sine = own / std::max(distance_m - receiver.radius_m, own);
  const float gap_m = std::max(distance_m - receiver.radius_m - own, 1e-4F);
  const float facing = tree_.isCluster(sender) ? 0.5F : 1.0F;
  const float bound =
      std::min(sine * sine, facing * tree_.area_m2[sender] / (std::numbers::pi_v<float> * gap_m * gap_m));
  return {unshot_.strength[sender], distance_m, bound};
}

/// A leaf sends evenly and its form factor is exact; a divided element errs by its unevenness, a cluster by
/// all.
template <int K>
float Interactions<K>::uneven(NodeIndex sender) const {
  return tree_.isCluster(sender) ? unshot_.strength[sender]
                                 : unshot_.highest[sender] - unshot_.lowest[sender];
}

template <int K>
Verdict Interactions<K>::refineLarger(const Receiver& receiver, NodeIndex sender) const {
  const bool canRefineSender = !tree_.isLeaf(sender);
  const bool canRefineReceiver = receiver.isCluster() || canDivide(receiver);
  if (!canRefineSender && !canRefineReceiver) return Verdict::accept;
  return canRefineSender && (tree_.radius_m[sender] > receiver.radius_m || !canRefineReceiver)
             ? Verdict::refineSender
             : Verdict::refineReceiver;
}

template <int K>
Verdict Interactions<K>::judgeOnSight(const Receiver& receiver, NodeIndex sender) const {
  if (receiver.weight <= 0.0F || (unshot_.highest[sender] <= 0.0F && !linksDark)) return Verdict::nothing;
  const bool senderIsCluster = tree_.isCluster(sender);
  if (!receiver.isCluster()) {
    if (tree_.treeSide[sender] == receiver.treeSide) return Verdict::nothing;
    if (isBehind(sender, receiver.centre, receiver.normal)) return Verdict::nothing;
  }
  if (!senderIsCluster && isBehind(receiver, tree_.centre[sender], tree_.normal(sender)))
    return Verdict::nothing;

  if (receiver.node != noNode && tree_.isOverGap(receiver.node)) return Verdict::refineReceiver;
  const Sight seen = look(receiver, sender);
  if (settings_.oracle == Oracle::transportedPower) return judgePower(receiver, sender, seen);
  return receiver.isCluster() ? judgeCluster(receiver, sender, seen) : judgeElement(receiver, sender, seen);
}

// Section 4.1: the amount of transported power decides.
template <int K>
Verdict Interactions<K>::judgePower(const Receiver& receiver, NodeIndex sender, const Sight& seen) const {
  const bool isSmall = seen.strength * seen.bound * receiver.weight <= threshold_lm;
  return isSmall ? Verdict::accept : refineLarger(receiver, sender);
}

template <int K>
Verdict Interactions<K>::judgeCluster(const Receiver& receiver, NodeIndex sender, const Sight& seen) const {
  const float power = seen.strength * seen.bound * receiver.weight;
  if (power <= threshold_lm) {
    if (!usesRays()) return Verdict::accept;
    return raysNeeded(power * unshot_.highest[sender] * receiver.weight) <= raysInsteadOfLinks
               ? Verdict::weak
               : refineLarger(receiver, sender);
  }
  const float senderRadius_m = tree_.isLeaf(sender) ? 0.0F : tree_.radius_m[sender];
  const bool apart = seen.distance_m > receiver.radius_m + tree_.radius_m[sender];
  const float relative = std::min(1.0F, std::max(receiver.radius_m, senderRadius_m) / seen.distance_m);
  if (!usesRays() && apart && 0.5F * power * relative <= threshold_lm) return Verdict::accept;
  return refineLarger(receiver, sender);
}

template <int K>
Verdict Interactions<K>::judgeElement(const Receiver& receiver, NodeIndex sender, const Sight& seen) const {
  const float power = seen.strength * seen.bound * receiver.weight;
  if (power <= threshold_lm) {
    if (!usesRays()) return Verdict::accept;
    // Rays would hardly ever meet a small and bright sender; a link knows where it is.
    const float rays = raysNeeded(power * unshot_.highest[sender] * receiver.weight);
    if (rays <= raysInsteadOfLinks) return Verdict::weak;
    return tree_.isCluster(sender) ? Verdict::refineSender : Verdict::accept;
  }
  const bool apart = seen.distance_m >= receiver.radius_m + tree_.radius_m[sender];
  if (tree_.isCluster(sender) && (usesRays() || !apart)) return refineLarger(receiver, sender);
  const float senderShare =
      tree_.isLeaf(sender) ? 0.0F : std::min(1.0F, tree_.radius_m[sender] / seen.distance_m);
  const float receiverShare =
      canDivide(receiver) ? std::min(1.0F, receiver.radius_m / seen.distance_m) : 0.0F;
  // What is far above the threshold by any measure is not looked at closely.
  const float roughly = seen.bound * receiver.weight * linearDeviation *
                        std::max(seen.strength * receiverShare, uneven(sender) * senderShare);
  return roughly > 8.0F * threshold_lm ? refineLarger(receiver, sender) : Verdict::accept;
}

template <int K>
float Interactions<K>::raysNeeded(float variance_lm2) const {
  const float noise_lm = rayNoise * threshold_lm;
  return variance_lm2 / (noise_lm * noise_lm);
}

template <int K>
void Interactions<K>::addWeak(WeakSenders& weak, const Receiver& receiver, NodeIndex sender) const {
  const Sight seen = look(receiver, sender);
  const float power_lm = seen.strength * seen.bound * receiver.weight;
  weak.nodes.push_back(sender);
  weak.power_lm += power_lm;
  weak.variance_lm2 += power_lm * unshot_.highest[sender] * receiver.weight;
}

// A cluster's contents share what comes by rays, so it takes less of that than an element.
template <int K>
bool Interactions<K>::takesWeak(const Receiver& receiver, const WeakSenders& weak) const {
  return !receiver.isCluster() || weak.power_lm <= clusterTakes * threshold_lm;
}

template <int K>
bool Interactions<K>::leavesToRays(const Receiver& receiver, std::span<const Sender> senders,
                                   WeakSenders& weak) const {
  if (!usesRays() || receiver.weight <= 0.0F) return false;
  if (receiver.node != noNode && tree_.isOverGap(receiver.node)) return false;
  WeakSenders all = weak;
  for (const Sender sender : senders) {
    if (sender >= firstPortal || unshot_.highest[sender] <= 0.0F) continue;
    addWeak(all, receiver, sender);
    if (raysNeeded(all.variance_lm2) > raysInsteadOfLinks || !takesWeak(receiver, all)) return false;
  }
  weak = std::move(all);
  return true;
}

template <int K>
void Interactions<K>::receiveWeak(const Receiver& receiver, const WeakSenders& weak, Incoming<K>& incoming,
                                  Tally& tally) const {
  const auto rays =
      static_cast<std::uint32_t>(std::clamp(raysNeeded(weak.variance_lm2), weakRaysLeast, weakRaysMost));
  tally.rays += rays;
  receiveFromWeak(world_, tree_, unshot_, treeSideOf_, receiver, weak.nodes, rays, incoming);
}

template <int K>
void Interactions<K>::receiveMirrored(const Receiver& receiver, Incoming<K>& incoming, Tally& tally) const {
  if (!seesPanes_ || receiver.isCluster() || receiver.weight <= 0.0F || !(unshot_.highest[0] > 0.0F)) return;
  clerestory::receiveMirrored(world_, tree_, unshot_, treeSideOf_, receiver, raysToPanes,
                              incoming.own.irradiance_lx);
  tally.rays += raysToPanes;
}

// By the share of the domain's light that a link could carry, were all as bright as each other but for what
// shines by itself: independent of what is unshot, so a link computed anew is the one that was cached.
template <int K>
std::uint32_t Interactions<K>::raysOf(const Receiver& receiver, const Candidate<K>& candidate) const {
  const float brilliance =
      tree_.isCluster(candidate.sender) ? 1.0F : brilliance_[tree_.treeSide[candidate.sender]];
  const float share = brilliance * candidate.link.formFactor * receiver.weight / totalWeight_;
  if (share <= 0.0F) return 0;
  if (share < 1e-6F) return 2;
  if (share < 1e-5F) return 4;
  if (share < 1e-4F) return 8;
  return 16;
}

// Where one of few rays differs from the rest a receiver is divided. Were it taken as dark or as lit where
// none does, it would be too dark on average behind a door, and too bright beside a table.
template <int K>
Verdict Interactions<K>::judgeSeen(const Receiver& receiver, const Candidate<K>& candidate,
                                   Tally& tally) const {
  if (receiver.isCluster() || settings_.oracle == Oracle::transportedPower) return Verdict::accept;
  const Verdict verdict = judgeVisible(receiver, candidate, candidate.visible, threshold_lm);
  const bool isDark = candidate.visible <= 0.0F;
  const bool agree = isDark || candidate.visible >= 1.0F;
  const std::uint32_t rays = raysOf(receiver, candidate);
  const bool mayErr = agree && rays > 0 && !tree_.isCluster(candidate.sender);
  if (verdict != Verdict::accept || !mayErr) return verdict;
  const float ofOne = 1.0F / static_cast<float>(rays);
  const Verdict other = judgeVisible(receiver, candidate, isDark ? ofOne : 1.0F - ofOne, missedThreshold_lm);
  return other != Verdict::accept && isOtherwise(receiver, candidate, tally) ? other : verdict;
}

/// Whether a link whose rays all passed, or none, has ways that do not.
template <int K>
bool Interactions<K>::isOtherwise(const Receiver& receiver, const Candidate<K>& candidate,
                                  Tally& tally) const {
  const NodeIndex sender = candidate.sender;
  const Target target{tree_.polygon(sender), rayOffset_m * tree_.normal(sender),
                      mixKeys(tree_.key[sender], 0x11)};
  const float thresholds = powerOf(receiver, candidate) / missedThreshold_lm;
  return candidate.visible > 0.0F
             ? findsWay(world_, receiver, target, Way::blocked, looksForShadow * thresholds, tally.rays)
             : findsWay(world_, receiver, target, Way::open, looksIntoDark * thresholds, tally.rays);
}

template <int K>
Verdict Interactions<K>::judgeVisible(const Receiver& receiver, const Candidate<K>& candidate, float visible,
                                      float allowed_lm) const {
  const NodeIndex sender = candidate.sender;
  const Link& link = candidate.link;
  const bool canRefineReceiver = canDivide(receiver);
  const bool canRefineSender = !tree_.isLeaf(sender);
  const float arriving = link.formFactor * receiver.weight;
  const float power = unshot_.strength[sender] * arriving;
  const float receiverError = linearDeviation * power * visible * link.spreadOverReceiver();
  const float spreadOfShadow = 0.5F * std::sqrt(visible * (1.0F - visible));
  const float shadowError = power * spreadOfShadow;
  float senderError = 0.0F;
  if (canRefineSender) {
    const float distance_m = glm::length(tree_.centre[sender] - receiver.centre);
    const float senderShare = std::min(1.0F, tree_.radius_m[sender] / distance_m);
    senderError = (tree_.isCluster(sender) ? 0.5F : linearDeviation) * uneven(sender) * arriving * visible *
                  senderShare;
  }
  if (senderError > allowed_lm && senderError >= receiverError) return Verdict::refineSender;
  if (receiverError > allowed_lm && canRefineReceiver) return Verdict::refineReceiver;
  if (senderError > allowed_lm) return Verdict::refineSender;
  if (shadowError > allowed_lm) return refineLarger(receiver, sender);
  // Of a sender half in shadow the lit parts are mostly those that are seen: their mean errs the same way for
  // all receivers.
  if (canRefineSender && uneven(sender) * arriving * spreadOfShadow > darkerBySender * allowed_lm)
    return Verdict::refineSender;
  return Verdict::accept;
}

template <int K>
void Interactions<K>::add(Incoming<K>& incoming, const Receiver& receiver,
                          const Candidate<K>& candidate) const {
  if (receiver.isCluster()) {
    addToCluster(*incoming.six, receiver, candidate);
  } else {
    Received<K> next;
    addToElement(next, receiver, candidate);
    if (!candidate.differs) {
      incoming.own += next;
      return;
    }
    for (std::size_t child = 0; child < 2; ++child)
      incoming.ofChildren[child] +=
          {candidate.onChild[child] * next.irradiance_lx, candidate.viewOnChild[child] * next.view};
  }
}

// A cluster's contents stand for it at its centre; nearer than its own size, or than its contents could fill
// the view, the inverse square is held, so that no interaction brings more light than its sender has.
template <int K>
float Interactions<K>::heldSquare(NodeIndex sender, float distance_m, float receiverRadius_m) const {
  const float nearest_m = std::max({distance_m, receiverRadius_m, tree_.radius_m[sender]});
  return std::max(nearest_m * nearest_m, tree_.area_m2[sender] / (2.0F * std::numbers::pi_v<float>));
}

// What a divided sender brings beyond its mean radiosity times its form factor: its brighter parts may be
// those that the receiver sees best. Left out, that errs the same way for all receivers, so it is sampled: a
// few pairs of spots give the covariance of radiosity and kernel, too noisy for one link but right over many.
template <int K>
Columns<K> Interactions<K>::unevenLight(const Receiver& receiver, NodeIndex sender, float formFactor) const {
  constexpr std::uint32_t count = 4;
  const std::uint64_t turn = mixKeys(tree_.key[sender], receiver.key);
  const float nearest_m = 0.25F * std::min(receiver.radius_m, tree_.radius_m[sender]);
  const glm::vec3& normal = tree_.normal(sender);
  Columns<K> weighted;
  Columns<K> radiosity;
  float kernel = 0.0F;
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::vec3& from = (*receiver.spots)[(i + (turn >> 8U)) % spotsOfNode];
    const std::size_t there = (i * (2U * (turn & 3U) + 1U) + (turn >> 16U)) % spotsOfNode;
    const glm::vec3& to = tree_.spots[sender][there];
    const glm::vec3 way = to - from;
    const float squared = std::max(glm::dot(way, way), nearest_m * nearest_m);
    const float own = std::max(glm::dot(way, receiver.normal), 0.0F) *
                      std::max(-glm::dot(way, normal), 0.0F) / (squared * squared);
    const Columns<K>& sent = unshot_.radiosity_lm_m2[tree_.spotLeaves[sender][there]];
    weighted += own * sent;
    radiosity += sent;
    kernel += own;
  }
  const float scale = tree_.area_m2[sender] * std::numbers::inv_pi_v<float> / static_cast<float>(count - 1);
  Columns<K> beyond = scale * (weighted - (kernel / static_cast<float>(count)) * radiosity);
  // Held alike on both sides, so that no light falls below zero and the mean stays.
  const Columns<K> most = formFactor * unshot_.radiosity_lm_m2[sender];
  for (int c = 0; c < K; ++c) beyond[c] = std::clamp(beyond[c], -most[c], most[c]);
  return beyond;
}

/// What a link lets through of what its sender sends.
template <int K>
Received<K> throughTo(const Candidate<K>& candidate, const Received<K>& sent) {
  return {candidate.lit * sent.irradiance_lx, candidate.visible * sent.view};
}

template <int K>
void Interactions<K>::addToElement(Received<K>& next, const Receiver& receiver,
                                   const Candidate<K>& candidate) const {
  const NodeIndex sender = candidate.sender;
  const Received<K> even{candidate.lit * unshot_.radiosity_lm_m2[sender], candidate.visible};
  if (!tree_.isCluster(sender)) {
    next += candidate.link.formFactor * even;
    if (unshot_.highest[sender] > unshot_.lowest[sender])
      next.irradiance_lx += candidate.lit * unevenLight(receiver, sender, candidate.link.formFactor);
    return;
  }
  const glm::vec3 way = tree_.centre[sender] - receiver.centre;
  const float distance_m = glm::length(way);
  if (distance_m < receiver.radius_m + tree_.radius_m[sender]) {
    next += isotropicShare(sender, receiver.radius_m) * even;
    return;
  }
  const glm::vec3 direction = way / distance_m;
  const float cosine = std::max(glm::dot(direction, receiver.normal), 0.0F);
  const float factor =
      cosine / (std::numbers::pi_v<float> * heldSquare(sender, distance_m, receiver.radius_m));
  next += factor * throughTo(candidate, sentAlong(sender, -direction));
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
void Interactions<K>::addToCluster(SixReceived<K>& next, const Receiver& receiver,
                                   const Candidate<K>& candidate) const {
  const NodeIndex sender = candidate.sender;
  const Received<K> even{candidate.lit * unshot_.radiosity_lm_m2[sender], candidate.visible};
  const glm::vec3 way = tree_.centre[sender] - receiver.centre;
  const float distance_m = glm::length(way);
  if (distance_m < receiver.radius_m + tree_.radius_m[sender]) {
    // From all around; a plane that leans gets up to three directions' worth, half as much again on average.
    const float share = isotropicShare(sender, receiver.radius_m) / 1.5F;
    for (Received<K>& side : next) side += share * even;
    return;
  }
  if (!tree_.isCluster(sender)) {
    if (glm::dot(way, tree_.normal(sender)) >= 0.0F) return;
    const auto polygon = tree_.polygon(sender);
    for (std::size_t k = 0; k < 6; ++k) {
      next[k] += pointToPolygon(receiver.centre, sixDirections[k], polygon) * even;
    }
    return;
  }
  const glm::vec3 direction = way / distance_m;
  const float square = heldSquare(sender, distance_m, receiver.radius_m);
  const Received<K> arriving =  // on a plane square to the way
      (1.0F / (std::numbers::pi_v<float> * square)) * throughTo(candidate, sentAlong(sender, -direction));
  for (std::size_t k = 0; k < 6; ++k) next[k] += alongDirection(direction, k) * arriving;
}

#define CLERESTORY_INSTANTIATE(K) template class Interactions<K>;
CLERESTORY_TRANSPORT_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
