// SPDX-License-Identifier: GPL-3.0-or-later
// Links of one interaction: their form factors, their rays, and what is seen along them.
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <geometry/sampling.hpp>
#include <solver/formfactor.hpp>

#include "interaction.hpp"

namespace clerestory {
namespace {

constexpr float farApart = 0.1F;  // (radii) / distance below which centres stand for elements

}  // namespace

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
  const SeenFromPoints seen(receiver, polygon, tree_.centre[sender], normal);
  for (const float own : std::span(seen.formFactors).first(seen.count)) {
    low = std::min(low, own);
    high = std::max(high, own);
    sum += own;
  }
  link.formFactor = sum / static_cast<float>(seen.count);
  if (apart > touchingApart && std::max(receiver.corners.size(), polygon.size()) <= contourCornersMost) {
    link.formFactor = meanFormFactor(receiver.corners, receiver.normal, receiver.area_m2, polygon, normal);
  }
  link.spread = Link::packSpread(link.formFactor > 0.0F ? cornerRise * (high - low) / link.formFactor : 0.0F);
}

// Pairs of the spots of both ends, in an order that their keys choose. Rays end on the contents of clusters.
template <int K>
void Interactions<K>::layRays(const Receiver& receiver, const Candidate<K>& candidate,
                              RayBatch& batch) const {
  const NodeIndex sender = candidate.sender;
  const bool anyCluster = receiver.isCluster() || tree_.isCluster(sender);
  const std::uint32_t count = raysOf(receiver, candidate);
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
    const Columns<K>& own = isEven ? unshot_.radiosity_lm_m2[sender]
                                   : unshot_.radiosity_lm_m2[tree_.spotLeaves[sender][batch.spot[ray]]];
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

#define CLERESTORY_INSTANTIATE(K)                                               \
  template Link Interactions<K>::measureLink(const Receiver&, NodeIndex) const; \
  template void Interactions<K>::castRays(const Receiver&, std::span<Candidate<K>>, RayBatch&, Tally&) const;
CLERESTORY_TRANSPORT_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
