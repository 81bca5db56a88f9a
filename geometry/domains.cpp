// SPDX-License-Identifier: GPL-3.0-or-later
// Air domains by free space, not by surfaces: points that hover over the sides of pieces are joined where a
// bundle of rays passes between them. A side may stand in two airs (a skirting that enters the wall); each of
// its points is in one.
#include "domains.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include <geometry/sampling.hpp>

#include "cut.hpp"

namespace clerestory {
namespace {

constexpr float clearance_m = 0.05F;     // free height over a point that may join airs
constexpr float bundle_m = 0.03F;        // half the width of the narrowest opening
constexpr double airMin_m2 = 0.5;        // surface of the smallest air that is one by itself
constexpr double worthCutting_m2 = 3.0;  // surface of an air for which a side is cut at its border
constexpr std::uint32_t raysOfPoint = 6;
constexpr std::uint32_t pointsOfSide = 3;  // at least
constexpr double pointsOfModel = 4000.0;   // further ones, shared out by area
constexpr std::uint32_t pointsOfSideMax = 256;
constexpr std::uint32_t nowhere = RayScene::Hit::none;

/// A place over a side where the air is asked for.
struct Place {
  glm::vec3 point, normal;
  bool isFree;  ///< has clearance; others only follow
};

class AirSurvey {
 public:
  AirSurvey(const CleanModel& model, const RayScene& rays) : pieces_(model.pieces), rays_(rays) {
    placeAll();
    parent_.resize(places_.size() + 1);
    std::iota(parent_.begin(), parent_.end(), 0U);
    outside_ = static_cast<std::uint32_t>(places_.size());
    joinAlongSides();
    joinAcrossAir();
    follow();
  }

  /// The air of most of a side's places, as a number below airCount; nowhere if none is known.
  [[nodiscard]] std::uint32_t airOf(std::uint32_t side) {
    std::map<std::uint32_t, int> votes;
    for (std::uint32_t place = firstPlace_[side]; place < firstPlace_[side + 1]; ++place) {
      if (known_[place]) ++votes[airAt(place)];
    }
    return mostVotes(votes);
  }
  [[nodiscard]] std::uint32_t outside() { return root(outside_); }

  /// Whether a side has places in two airs that are both worth cutting it for.
  [[nodiscard]] bool isInTwoAirs(std::uint32_t side) {
    std::uint32_t first = nowhere;
    for (std::uint32_t place = firstPlace_[side]; place < firstPlace_[side + 1]; ++place) {
      if (!places_[place].isFree || airArea_m2_[root(place)] < worthCutting_m2) continue;
      if (first != nowhere && first != root(place)) return true;
      first = root(place);
    }
    return false;
  }

  /// Whether a side's places are too few to be sure of, or disagree about their air: a closer look decides.
  [[nodiscard]] bool isInDoubt(std::uint32_t side) {
    if (firstPlace_[side + 1] - firstPlace_[side] <= pointsOfSide + 1) return true;
    std::uint32_t first = nowhere;
    for (std::uint32_t place = firstPlace_[side]; place < firstPlace_[side + 1]; ++place) {
      if (!known_[place]) continue;
      if (first != nowhere && first != airAt(place)) return true;
      first = airAt(place);
    }
    return false;
  }

  /// The air among `lit` that is met from somewhere on a side, by a closer look; nowhere if none is. Most of
  /// a seat's upper face may lie under its cushion.
  [[nodiscard]] std::uint32_t litAirOf(std::uint32_t side, const std::vector<bool>& lit) {
    constexpr std::uint32_t count = 32;
    const auto polygon = localPolygon(side / 2);
    const glm::vec3& normal = places_[firstPlace_[side]].normal;
    const Sequence sequence(mixKeys(0xd2, side));
    std::map<std::uint32_t, int> votes;
    for (std::uint32_t i = 0; i < count; ++i) {
      const glm::vec3 start =
          pointOnPolygon<glm::vec3>(polygon, sequence(i, 0), sequence(i, 1)) + rayOffset_m * normal;
      const std::uint32_t other = placeMet(start, cosineDirection(normal, sequence(i, 2), sequence(i, 3)));
      if (other != nowhere && known_[other] && lit[airAt(other)]) ++votes[airAt(other)];
    }
    return mostVotes(votes);
  }
  [[nodiscard]] std::size_t airLimit() const { return parent_.size(); }

  /// Share of a side's light that met nothing.
  [[nodiscard]] double escapedShare(std::uint32_t side) const {
    double escaped = 0.0;
    const std::size_t first = std::size_t{firstPlace_[side]} * raysOfPoint;
    const std::size_t last = std::size_t{firstPlace_[side + 1]} * raysOfPoint;
    for (std::size_t ray = first; ray < last; ++ray) escaped += met_[ray] == outside_ ? 1.0 : 0.0;
    return escaped / static_cast<double>(last - first);
  }

 private:
  static std::uint32_t mostVotes(const std::map<std::uint32_t, int>& votes) {
    const auto most = std::max_element(votes.begin(), votes.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == votes.end() ? nowhere : most->first;
  }
  [[nodiscard]] std::vector<glm::vec3> localPolygon(std::uint32_t piece) const {
    std::vector<glm::vec3> polygon;
    for (const std::uint32_t corner : pieces_.polygons[piece]) {
      polygon.emplace_back(pieces_.points[corner] - rays_.origin());
    }
    return polygon;
  }
  std::uint32_t root(std::uint32_t place) {
    while (parent_[place] != place) place = parent_[place] = parent_[parent_[place]];
    return place;
  }
  std::uint32_t airAt(std::uint32_t place) { return air_[place] != nowhere ? air_[place] : root(place); }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::min(a, b)] = std::max(a, b);  // the outside, the highest, stays a root
  }
  [[nodiscard]] bool isOpen(const glm::vec3& from, const glm::vec3& to) const {
    const glm::vec3 way = to - from;
    const float length_m = glm::length(way);
    return length_m < 1e-6F ||
           !rays_.nearest(from, way / length_m, RayScene::Barrier::opaqueAndGlass, length_m);
  }

  void placeAll() {
    const double total_m2 = std::accumulate(pieces_.area_m2.begin(), pieces_.area_m2.end(), 0.0);
    firstPlace_.push_back(0);
    for (std::uint32_t side = 0; side < 2 * pieces_.size(); ++side) {
      const auto polygon = localPolygon(side / 2);
      const glm::vec3 normal(side % 2 == 0 ? pieces_.normal[side / 2] : -pieces_.normal[side / 2]);
      const double share = pieces_.area_m2[side / 2] / std::max(total_m2, 1e-9);
      const auto count =
          std::min(pointsOfSide + static_cast<std::uint32_t>(pointsOfModel * share), pointsOfSideMax);
      const Sequence sequence(mixKeys(0xd0, side));
      for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3 point = pointOnPolygon<glm::vec3>(polygon, sequence(i, 0), sequence(i, 1));
        const glm::vec3 start = point + rayOffset_m * normal;
        places_.push_back({start, normal, isOpen(start, point + clearance_m * normal)});
      }
      firstPlace_.push_back(static_cast<std::uint32_t>(places_.size()));
    }
  }

  [[nodiscard]] glm::vec3 hover(std::uint32_t place) const {
    return places_[place].point + 0.9F * clearance_m * places_[place].normal;
  }

  /// Whether a bundle of rays as wide as an opening passes between two points in the air.
  [[nodiscard]] bool isOpenWide(const glm::vec3& from, const glm::vec3& to) const {
    if (!isOpen(from, to)) return false;
    const glm::vec3 way = to - from;
    if (glm::length(way) < 1e-6F) return true;
    glm::vec3 u;
    glm::vec3 v;
    tangentFrame(glm::normalize(way), u, v);
    for (const glm::vec3& aside : {bundle_m * u, -bundle_m * u, bundle_m * v, -bundle_m * v}) {
      if (!isOpen(from, from + aside) || !isOpen(from + aside, to + aside)) return false;
    }
    return true;
  }

  void joinAlongSides() {
    for (std::uint32_t side = 0; side + 1 < firstPlace_.size(); ++side) {
      for (std::uint32_t a = firstPlace_[side]; a < firstPlace_[side + 1]; ++a) {
        for (std::uint32_t b = firstPlace_[side]; b < a; ++b) {
          if (!places_[a].isFree || !places_[b].isFree || root(a) == root(b)) continue;
          if (isOpen(hover(a), hover(b))) join(a, b);
        }
      }
    }
  }

  /// The place of `side` that shares the air of a point on it; nowhere if the way to each is barred.
  [[nodiscard]] std::uint32_t placeNear(std::uint32_t side, const glm::vec3& point, float height_m) const {
    std::uint32_t best = nowhere;
    float least = std::numeric_limits<float>::infinity();
    for (std::uint32_t place = firstPlace_[side]; place < firstPlace_[side + 1]; ++place) {
      const float distance = glm::length(places_[place].point - point);
      if (distance >= least) continue;
      const glm::vec3 up = height_m * places_[place].normal;
      if (!isOpen(point + up, places_[place].point + up)) continue;
      least = distance;
      best = place;
    }
    return best;
  }

  void joinAcrossAir() {
    met_.reserve(places_.size() * raysOfPoint);
    for (std::uint32_t place = 0; place < places_.size(); ++place) {
      const Place& own = places_[place];
      const Sequence sequence(mixKeys(0xd1, place));
      for (std::uint32_t i = 0; i < raysOfPoint; ++i) {
        const glm::vec3 direction = cosineDirection(own.normal, sequence(i, 0), sequence(i, 1));
        met_.push_back(meet(place, direction));
      }
    }
  }

  /// The place, or the outside, whose air a ray finds.
  [[nodiscard]] std::uint32_t placeMet(const glm::vec3& from, const glm::vec3& direction) const {
    const auto hit = rays_.nearest(from, direction, RayScene::Barrier::opaqueAndGlass);
    if (!hit) return outside_;
    const glm::vec3 normal(hit.front ? pieces_.normal[hit.piece] : -pieces_.normal[hit.piece]);
    return placeNear(hit.side(), from + hit.distance_m * direction + rayOffset_m * normal,
                     0.2F * clearance_m);
  }

  /// Sends a ray; returns the place, or the outside, whose air it found, and joins that air where a bundle
  /// passes.
  std::uint32_t meet(std::uint32_t place, const glm::vec3& direction) {
    const Place& own = places_[place];
    const auto hit = rays_.nearest(own.point, direction, RayScene::Barrier::opaqueAndGlass);
    if (!hit) {
      if (own.isFree && root(place) != root(outside_) &&
          isOpenWide(hover(place), hover(place) + 1e4F * direction)) {
        join(place, outside_);
      }
      return outside_;
    }
    const glm::vec3 normal(hit.front ? pieces_.normal[hit.piece] : -pieces_.normal[hit.piece]);
    const glm::vec3 point = own.point + hit.distance_m * direction + rayOffset_m * normal;
    const std::uint32_t other = placeNear(hit.side(), point, 0.2F * clearance_m);
    if (other == nowhere || !own.isFree || root(place) == root(other)) return other;
    const glm::vec3 above = point + 0.9F * clearance_m * normal;
    if (places_[other].isFree && isOpen(point, above) && isOpen(above, hover(other)) &&
        isOpenWide(hover(place), above)) {
      join(place, other);
    }
    return other;
  }

  /// Airs of too little surface are none: a rug's edge is free, but too low for a bundle to pass to it.
  void findKnown() {
    std::vector<double>& area_m2 = airArea_m2_;
    area_m2.assign(places_.size() + 1, 0.0);
    for (std::uint32_t side = 0; side + 1 < firstPlace_.size(); ++side) {
      const double share_m2 = pieces_.area_m2[side / 2] / (firstPlace_[side + 1] - firstPlace_[side]);
      for (std::uint32_t place = firstPlace_[side]; place < firstPlace_[side + 1]; ++place) {
        if (places_[place].isFree) area_m2[root(place)] += share_m2;
      }
    }
    known_.assign(places_.size() + 1, false);
    for (std::uint32_t place = 0; place < places_.size(); ++place) {
      known_[place] =
          places_[place].isFree && (root(place) == root(outside_) || area_m2[root(place)] >= airMin_m2);
    }
    known_[outside_] = true;
  }

  /// Other places take the air of most of what their rays met, as it becomes known.
  void follow() {
    findKnown();
    air_.assign(places_.size() + 1, nowhere);
    for (int round = 0; round < 4; ++round) {
      std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
      for (std::uint32_t place = 0; place < places_.size(); ++place) {
        if (known_[place]) continue;
        std::map<std::uint32_t, int> votes;
        for (std::uint32_t i = 0; i < raysOfPoint; ++i) {
          const std::uint32_t other = met_[std::size_t{place} * raysOfPoint + i];
          if (other != nowhere && known_[other]) ++votes[airAt(other)];
        }
        if (const std::uint32_t most = mostVotes(votes); most != nowhere) found.emplace_back(place, most);
      }
      for (const auto& [place, air] : found) {
        known_[place] = true;
        air_[place] = air;
      }
    }
  }

  const Pieces& pieces_;
  const RayScene& rays_;
  std::vector<Place> places_;
  std::vector<std::uint32_t> firstPlace_;  // #sides + 1
  std::vector<std::uint32_t> met_;         // #places × raysOfPoint: place, outside or nowhere
  std::vector<std::uint32_t> parent_;      // union-find over places and the outside
  std::vector<bool> known_;
  std::vector<std::uint32_t> air_;  // of places that follow
  std::vector<double> airArea_m2_;  // by root
  std::uint32_t outside_ = 0;
};

bool isGlass(const CleanModel& model, std::uint32_t piece) {
  return model.materials[model.pieces.material[piece]].glazing;
}

bool isEmitter(const CleanModel& model, std::uint32_t piece) {
  return model.materials[model.pieces.material[piece]].exitance_lm_m2 != glm::dvec3(0.0);
}

/// Glass with the outside, or with closed air, on both of its sides bounds nothing: its two airs become one.
std::vector<bool> joinAcrossInnerGlass(const CleanModel& model, std::vector<std::uint32_t>& air,
                                       std::uint32_t outside) {
  std::vector<bool> inner(model.pieces.size(), false);
  for (std::uint32_t piece = 0; piece < model.pieces.size(); ++piece) {
    if (!isGlass(model, piece)) continue;
    const std::uint32_t front = air[2 * piece];
    const std::uint32_t back = air[2 * piece + 1];
    if (front == nowhere || back == nowhere) {
      inner[piece] = true;  // pressed between other surfaces
      continue;
    }
    if ((front == outside) != (back == outside)) continue;
    inner[piece] = true;
    if (front != back) std::replace(air.begin(), air.end(), std::max(front, back), std::min(front, back));
  }
  return inner;
}

}  // namespace

bool cutAtBorders(CleanModel& model) {
  const RayScene rays(model, {});
  AirSurvey survey(model, rays);
  std::vector<bool> inTwoAirs(model.pieces.size());
  bool any = false;
  for (std::uint32_t piece = 0; piece < model.pieces.size(); ++piece) {
    inTwoAirs[piece] =
        !isGlass(model, piece) && (survey.isInTwoAirs(2 * piece) || survey.isInTwoAirs(2 * piece + 1));
    any = any || inTwoAirs[piece];
  }
  if (any) cutWhereMet(model.pieces, inTwoAirs);
  return any;
}

void findDomains(Building& building) {
  const CleanModel& model = building.model;
  const RayScene rays(model, {});
  AirSurvey survey(model, rays);
  std::vector<std::uint32_t> air(2 * model.pieces.size());
  for (std::uint32_t side = 0; side < air.size(); ++side) air[side] = survey.airOf(side);
  const std::uint32_t outside = survey.outside();
  std::vector<bool> lit(survey.airLimit(), false);
  lit[outside] = true;
  for (std::uint32_t side = 0; side < air.size(); ++side) {
    const bool brings = isGlass(model, side / 2) || isEmitter(model, side / 2);
    if (brings && air[side] != nowhere) lit[air[side]] = true;
  }
  for (std::uint32_t side = 0; side < air.size(); ++side) {
    if (air[side] != nowhere && lit[air[side]] && !survey.isInDoubt(side)) continue;
    const std::uint32_t met = survey.litAirOf(side, lit);
    if (met != nowhere) air[side] = met;
  }
  building.innerGlass = joinAcrossInnerGlass(model, air, outside);

  // Domains are numbered by their first side, the outside first.
  std::map<std::uint32_t, std::int32_t> numbers;
  if (std::find(air.begin(), air.end(), outside) != air.end()) numbers.emplace(outside, 0);
  building.sideDomain.assign(air.size(), -1);
  for (std::uint32_t side = 0; side < air.size(); ++side) {
    if (air[side] == nowhere) continue;
    building.sideDomain[side] =
        numbers.emplace(air[side], static_cast<std::int32_t>(numbers.size())).first->second;
  }
  building.domains.assign(numbers.size(), {});
  for (std::uint32_t side = 0; side < air.size(); ++side) {
    if (air[side] == nowhere) continue;
    Domain& domain = building.domains[static_cast<std::size_t>(building.sideDomain[side])];
    domain.open = air[side] == outside;
    domain.area_m2 += model.pieces.area_m2[side / 2];
    domain.escape_m2 += model.pieces.area_m2[side / 2] * survey.escapedShare(side);
    domain.lit = domain.lit || domain.open || isEmitter(model, side / 2);
  }

  for (std::uint32_t piece = 0; piece < model.pieces.size(); ++piece) {
    if (!isGlass(model, piece) || building.innerGlass[piece]) continue;
    const bool frontIsInside = air[2 * piece + 1] == outside;
    const std::int32_t front = building.sideDomain[2 * piece];
    const std::int32_t back = building.sideDomain[2 * piece + 1];
    building.portals.push_back(
        {piece, frontIsInside, frontIsInside ? front : back, frontIsInside ? back : front});
    building.domains[static_cast<std::size_t>(building.portals.back().inside)].lit = true;
  }
}

}  // namespace clerestory
