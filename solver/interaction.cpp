// SPDX-License-Identifier: GPL-3.0-or-later
// The oracle's estimates, the links' form factors and rays, and how their light is added up.
#include "interaction.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <geometry/sampling.hpp>
#include <solver/formfactor.hpp>

#include "weak.hpp"

namespace clerestory {
namespace {

constexpr float touching_m = 1e-5F;  // below this a point counts as in a plane
// Calibrated on the furnished office (docs/validation.md): errors of surfaces against time.
constexpr float raysInsteadOfLinks = 32.0F;  // up to so many, links are not even looked for
constexpr float weakRaysLeast = 16.0F, weakRaysMost = 256.0F;
constexpr float darkerBySender = 0.2F;  // thresholds that a sender's own shadow may take off
constexpr float clusterTakes = 5.0F;    // thresholds that a cluster takes as one mean

constexpr float farApart = 0.1F;  // (radii) / distance below which centres stand for elements

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
                              const TransportSettings& settings)
    : world_(world),
      tree_(tree),
      unshot_(unshot),
      settings_(settings),
      totalWeight_(std::max(tree.weight[0], 1e-20F)) {
  treeSideOf_.resize(2 * world_.pieces().size(), noNode);
  for (std::uint32_t i = 0; i < tree.sides.size(); ++i) treeSideOf_[tree.sides[i].side] = i;
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
void Interactions<K>::receiveWeak(const Receiver& receiver, WeakSenders& weak, Incoming<K>& incoming,
                                  Tally& tally) const {
  const auto rays =
      static_cast<std::uint32_t>(std::clamp(raysNeeded(weak.variance_lm2), weakRaysLeast, weakRaysMost));
  tally.rays += rays;
  receiveFromWeak(world_, tree_, unshot_, treeSideOf_, receiver, weak.nodes, rays, incoming);
}

template <int K>
Link Interactions<K>::measureLink(const Receiver& receiver, NodeIndex sender) const {
  const Sight seen = look(receiver, sender);
  Link link;
  if (receiver.isCluster()) {
    link.formFactor = seen.bound;
    return link;
  }
  const float apart = (receiver.radius_m + tree_.radius_m[sender]) / std::max(seen.distance_m, 1e-6F);
  if (tree_.isCluster(sender)) {
    link.formFactor = seen.bound;
    link.spread = Link::packSpread(2.0F * std::min(1.0F, receiver.radius_m / seen.distance_m));
  } else if (apart < farApart) {
    const glm::vec3 way = (tree_.centre[sender] - receiver.centre) / seen.distance_m;
    const float cosines =
        std::max(glm::dot(way, receiver.normal), 0.0F) * std::max(-glm::dot(way, tree_.normal(sender)), 0.0F);
    link.formFactor =
        cosines * tree_.area_m2[sender] / (std::numbers::pi_v<float> * seen.distance_m * seen.distance_m);
    link.spread = Link::packSpread(3.0F * receiver.radius_m / seen.distance_m);
  } else {
    measureNear(receiver, sender, apart, link);
  }
  return link;
}

// Points of the receiver tell how the form factor varies over it, and their mean is right but where it rises
// too steeply between them.
template <int K>
void Interactions<K>::measureNear(const Receiver& receiver, NodeIndex sender, float apart, Link& link) const {
  const auto polygon = tree_.polygon(sender);
  const glm::vec3& normal = tree_.normal(sender);
  float low = 1.0F;
  float high = 0.0F;
  float sum = 0.0F;
  const std::size_t count = quadratureCount(receiver.corners);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 point = quadraturePoint(receiver.corners, receiver.centre, i);
    const bool inFront = glm::dot(point - tree_.centre[sender], normal) > 0.0F;
    const float own = inFront ? pointToPolygon(point, receiver.normal, polygon) : 0.0F;
    low = std::min(low, own);
    high = std::max(high, own);
    sum += own;
  }
  link.formFactor = sum / static_cast<float>(count);
  if (apart > touchingApart && std::max(receiver.corners.size(), polygon.size()) <= contourCornersMost) {
    link.formFactor = meanFormFactor(receiver.corners, receiver.normal, receiver.area_m2, polygon, normal);
  }
  link.spread = Link::packSpread(link.formFactor > 0.0F ? cornerRise * (high - low) / link.formFactor : 0.0F);
}

// By the share of the domain's light that a link could carry at most: independent of the light itself, so a
// link computed anew is the one that was cached.
template <int K>
std::uint32_t Interactions<K>::raysOf(const Receiver& receiver, const Link& link) const {
  const float share = link.formFactor * receiver.weight / totalWeight_;
  if (share <= 0.0F) return 0;
  if (share < 1e-6F) return 2;
  if (share < 1e-5F) return 4;
  if (share < 1e-4F) return 8;
  return 16;
}

// Pairs of the spots of both ends, in an order that their keys choose. Rays end on the contents of clusters.
template <int K>
void Interactions<K>::layRays(const Receiver& receiver, const Candidate<K>& candidate,
                              RayBatch& batch) const {
  const NodeIndex sender = candidate.sender;
  const bool anyCluster = receiver.isCluster() || tree_.isCluster(sender);
  const std::uint32_t count = raysOf(receiver, candidate.link);
  const std::uint64_t turn = mixKeys(receiver.key, tree_.key[sender]);
  const std::uint64_t stride = 2U * (turn & 3U) + 1U;
  const std::uint64_t skip = 2U * ((turn >> 2U) & 3U) + 1U;
  const float nearest_m = 0.25F * std::min(receiver.radius_m, tree_.radius_m[sender]);
  std::uint32_t cast = 0;
  // Contents that face away from each other say nothing, so clusters may draw four times as often.
  const std::uint32_t most = anyCluster ? 4U * count : count;
  for (std::uint32_t i = 0; i < most && cast < count; ++i) {
    const std::size_t here = (i + (turn >> 8U)) % spotsOfNode;
    const std::size_t there = (i * stride + (i / spotsOfNode) * skip + (turn >> 16U)) % spotsOfNode;
    const glm::vec3& from = (*receiver.spots)[here];
    const glm::vec3& to = tree_.spots[sender][there];
    const glm::vec3& fromNormal =
        receiver.isCluster() ? tree_.sides[receiver.spotSides[here]].normal : receiver.normal;
    const glm::vec3 way = to - from;
    const float leaving = glm::dot(way, fromNormal);
    const float arriving = -glm::dot(way, tree_.spotNormal(sender, there));
    if (leaving <= 0.0F || arriving <= 0.0F) continue;
    const float squared = std::max(glm::dot(way, way), nearest_m * nearest_m);
    ++cast;
    batch.segments.push_back({from, to});
    batch.kernel.push_back(leaving * arriving / (squared * squared));
    batch.spot.push_back(static_cast<std::uint8_t>(there));
  }
}

// Rays of links that are not known are cast; of known ones it is kept which passed.
template <int K>
void Interactions<K>::castRays(const Receiver& receiver, std::span<Candidate<K>> candidates, RayBatch& batch,
                               Tally& tally) const {
  const auto layAll = [&](bool known) {
    batch.clear();
    for (const Candidate<K>& candidate : candidates) {
      batch.firstRay.push_back(static_cast<std::uint32_t>(batch.segments.size()));
      if (candidate.isKnown == known) layRays(receiver, candidate, batch);
    }
    batch.firstRay.push_back(static_cast<std::uint32_t>(batch.segments.size()));
    batch.blocked.resize(batch.segments.size());
    batch.seen.resize(batch.segments.size());
  };
  const auto weighAll = [&](bool known) {
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (candidates[i].isKnown == known)
        weighRays(receiver, candidates[i], batch, batch.firstRay[i], batch.firstRay[i + 1]);
    }
  };
  layAll(false);
  tally.rays += batch.segments.size();
  world_.visibility(batch.segments, batch.blocked, batch.seen);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i].isKnown) continue;
    for (std::size_t ray = batch.firstRay[i]; ray < batch.firstRay[i + 1]; ++ray)
      candidates[i].link.passed |=
          static_cast<std::uint16_t>((1U - batch.blocked[ray]) << (ray - batch.firstRay[i]));
  }
  weighAll(false);

  layAll(true);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    for (std::size_t ray = batch.firstRay[i]; ray < batch.firstRay[i + 1]; ++ray) {
      const bool passed = ((candidates[i].link.passed >> (ray - batch.firstRay[i])) & 1U) != 0;
      batch.seen[ray] =
          passed ? world_.innerTransmittance(batch.segments[ray].from, batch.segments[ray].to) : 0.0F;
    }
  }
  weighAll(true);
}

template <int K>
void Interactions<K>::weighRays(const Receiver& receiver, Candidate<K>& candidate, const RayBatch& batch,
                                std::size_t first, std::size_t last) const {
  float total = 0.0F;
  float seen = 0.0F;
  for (std::size_t ray = first; ray < last; ++ray) {
    total += batch.kernel[ray];
    seen += batch.kernel[ray] * batch.seen[ray];
  }
  candidate.visible = total > 0.0F ? std::min(seen / total, 1.0F) : 0.0F;
  for (int c = 0; c < K; ++c) candidate.lit[c] = candidate.visible;
  if (candidate.visible > 0.0F && candidate.visible < 1.0F)
    shareLight(receiver, candidate, batch, first, last);
}

// Where a link is half in shadow, means err the same way for all links. What is hidden of an uneven sender is
// rather its dark part, since what lights it sees it too: shares of its light are taken by radiosity. And the
// hidden part of a receiver is hidden from others too: its children get what their own rays brought.
template <int K>
void Interactions<K>::shareLight(const Receiver& receiver, Candidate<K>& candidate, const RayBatch& batch,
                                 std::size_t first, std::size_t last) const {
  const NodeIndex sender = candidate.sender;
  const bool isEven = !(unshot_.highest[sender] > unshot_.lowest[sender]);
  const bool hasChildren = receiver.node != noNode && !receiver.isCluster() && !tree_.isLeaf(receiver.node);
  if (isEven && !hasChildren) return;
  Columns<K> sent;
  std::array<Columns<K>, 2> arriving;
  std::array<float, 2> open{};
  std::array<float, 2> rays{};
  for (std::size_t ray = first; ray < last; ++ray) {
    const Columns<K>& own = isEven ? unshot_.radiosity_lm_m2[sender] : radiosityAt(sender, batch.spot[ray]);
    const std::size_t child = hasChildren ? tree_.whichChild(receiver.node, batch.segments[ray].from) : 0;
    const float passing = batch.kernel[ray] * batch.seen[ray];
    sent += batch.kernel[ray] * own;
    arriving[child] += passing * own;
    open[child] += passing;
    rays[child] += 1.0F;
  }
  const Columns<K> all = arriving[0] + arriving[1];
  for (int c = 0; c < K; ++c) {
    if (sent[c] > 0.0F) candidate.lit[c] = all[c] / sent[c];
  }
  candidate.differs = rays[0] > 0.0F && rays[1] > 0.0F;
  if (!candidate.differs) return;
  const float share = tree_.area_m2[tree_.firstChild[receiver.node]] / receiver.area_m2;
  const auto ofMean = [&](float one, float other, std::size_t child) {
    const std::array<float, 2> means = {one / rays[0], other / rays[1]};
    const float mean = share * means[0] + (1.0F - share) * means[1];
    return mean > 0.0F ? means[child] / mean : 1.0F;
  };
  for (std::size_t child = 0; child < 2; ++child) {
    candidate.viewOnChild[child] = ofMean(open[0], open[1], child);
    for (int c = 0; c < K; ++c) candidate.onChild[child][c] = ofMean(arriving[0][c], arriving[1][c], child);
  }
}

/// Radiosity at a spot of a sender.
template <int K>
const Columns<K>& Interactions<K>::radiosityAt(NodeIndex sender, std::size_t spot) const {
  const NodeIndex root = tree_.isCluster(sender) ? tree_.sides[tree_.spotSides[sender][spot]].root : sender;
  return unshot_.radiosity_lm_m2[tree_.leafAt(root, tree_.spots[sender][spot])];
}

template <int K>
Verdict Interactions<K>::judgeSeen(const Receiver& receiver, const Candidate<K>& candidate) const {
  if (receiver.isCluster() || settings_.oracle == Oracle::transportedPower) return Verdict::accept;
  const NodeIndex sender = candidate.sender;
  const Link& link = candidate.link;
  const bool canRefineReceiver = canDivide(receiver);
  const bool canRefineSender = !tree_.isLeaf(sender);
  const float visible = candidate.visible;
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
  if (senderError > threshold_lm && senderError >= receiverError) return Verdict::refineSender;
  if (receiverError > threshold_lm && canRefineReceiver) return Verdict::refineReceiver;
  if (senderError > threshold_lm) return Verdict::refineSender;
  if (shadowError > threshold_lm) return refineLarger(receiver, sender);
  // Of a sender half in shadow the lit parts are mostly those that are seen: their mean errs the same way for
  // all receivers.
  if (canRefineSender && uneven(sender) * arriving * spreadOfShadow > darkerBySender * threshold_lm)
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
    const glm::vec3& to = tree_.spots[sender][(i * (2U * (turn & 3U) + 1U) + (turn >> 16U)) % spotsOfNode];
    const glm::vec3 way = to - from;
    const float squared = std::max(glm::dot(way, way), nearest_m * nearest_m);
    const float own = std::max(glm::dot(way, receiver.normal), 0.0F) *
                      std::max(-glm::dot(way, normal), 0.0F) / (squared * squared);
    const Columns<K>& sent = unshot_.radiosity_lm_m2[tree_.leafAt(sender, to)];
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
