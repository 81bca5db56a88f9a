// SPDX-License-Identifier: GPL-3.0-or-later
// Air by free space, not by surfaces: points that hover over the sides of pieces are joined where a bundle of
// rays passes between them. A side may stand in two airs (a skirting that enters the wall); each of its
// points is in one.
#include "airsurvey.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include <geometry/parallel.hpp>
#include <geometry/sampling.hpp>

namespace clerestory {
namespace {

constexpr float buried_m = 1e-5F;          // height that a place's own side is told from others from
constexpr float bundle_m = 0.03F;          // half the width of the narrowest opening
constexpr double worthCutting_m2 = 3.0;    // surface of an air for which a side is cut at its border
constexpr std::uint32_t pointsOfSide = 3;  // at least; one where a side is smaller than an opening
constexpr double pointsOfModel = 4000.0;   // further ones, shared out by area
constexpr std::size_t pointsOfSideMax = 256;
constexpr std::size_t nearPlaces = 16;    // that a way is looked for to from a point on a side
constexpr std::uint32_t closerRays = 32;  // of a closer look
constexpr std::uint32_t closerRaysOfSmall = 8;
constexpr std::uint32_t agreeingRays = 8;  // of these, where all agree with the side's points

/// Few candidates with their votes.
class Votes {
 public:
  void add(std::uint32_t candidate) {
    const auto found = std::find_if(counts_.begin(), counts_.end(),
                                    [&](const auto& count) { return count.first == candidate; });
    if (found != counts_.end()) {
      ++found->second;
    } else {
      counts_.emplace_back(candidate, 1U);
    }
  }
  /// The candidate with most votes, the lowest of equals; nowhere without votes.
  [[nodiscard]] std::uint32_t most() const {
    const auto found = std::max_element(counts_.begin(), counts_.end(), [](const auto& a, const auto& b) {
      return a.second != b.second ? a.second < b.second : a.first > b.first;
    });
    return found == counts_.end() ? nowhere : found->first;
  }
  /// Whether `further` votes cannot change what has most.
  [[nodiscard]] bool isDecided(std::uint32_t further) const {
    const std::uint32_t leader = most();
    std::uint32_t own = 0;
    std::uint32_t second = 0;
    for (const auto& [candidate, count] : counts_) (candidate == leader ? own : second) += count;
    return own > second + further;
  }
  void clear() { counts_.clear(); }

 private:
  std::vector<std::pair<std::uint32_t, std::uint32_t>> counts_;
};

}  // namespace

std::uint32_t AirSurvey::airOf(std::uint32_t side) const {
  Votes votes;
  for (std::uint32_t place = firstPlace_[side]; place < firstPlace_[side + 1]; ++place) {
    if (air_[place] != nowhere) votes.add(air_[place]);
  }
  return votes.most();
}

bool AirSurvey::isInTwoAirs(std::uint32_t side) const {
  std::uint32_t first = nowhere;
  for (std::uint32_t place = firstPlace_[side]; place < firstPlace_[side + 1]; ++place) {
    if (!places_[place].isFree() || airArea_m2_[parent_[place]] < worthCutting_m2) continue;
    if (first != nowhere && first != parent_[place]) return true;
    first = parent_[place];
  }
  return false;
}

std::uint32_t AirSurvey::closerAirOf(std::uint32_t side, std::uint32_t own,
                                     const std::vector<bool>& lit) const {
  const bool isLit = own != nowhere && lit[own];
  if (isLit && (isSmall(side) || !isInDoubt(side, own))) return own;
  const std::uint32_t rays = isSmall(side) ? closerRaysOfSmall : closerRays;
  const auto polygon = localPolygon(side / 2);
  const glm::vec3& normal = places_[firstPlace_[side]].normal;
  const Sequence sequence(mixKeys(0xd2, side));
  Votes votes;
  bool agree = isLit;
  for (std::uint32_t i = 0; i < rays; ++i) {
    if (votes.isDecided(rays - i) || (agree && i == agreeingRays)) break;
    const glm::vec3 point = pointOnPolygon<glm::vec3>(polygon, sequence(i, 0), sequence(i, 1));
    // What is seen from within a gap without a mouth is seen through a crack.
    if (isShut_[side] && freeHeight_m(side, point, normal) < clearance_m) continue;
    const glm::vec3 start = point + rayOffset_m * normal;
    const std::uint32_t other = look(start, cosineDirection(normal, sequence(i, 2), sequence(i, 3))).place;
    const std::uint32_t met = other == nowhere ? nowhere : air_[other];
    if (met != nowhere && lit[met]) votes.add(met);
    agree = agree && met == own;
  }
  const std::uint32_t most = votes.most();
  return most == nowhere ? own : most;
}

double AirSurvey::escapedShare(std::uint32_t side) const {
  double escaped = 0.0;
  const std::size_t first = std::size_t{firstPlace_[side]} * raysOfPoint;
  const std::size_t last = std::size_t{firstPlace_[side + 1]} * raysOfPoint;
  for (std::size_t ray = first; ray < last; ++ray) escaped += met_[ray].place == outside_ ? 1.0 : 0.0;
  return escaped / static_cast<double>(last - first);
}

AirSurvey::AirSurvey(const CleanModel& model, const RayScene& rays, const AirSurvey* earlier,
                     const SameSides* same)
    : pieces_(model.pieces), rays_(rays) {
  placeAll(earlier, same);
  parent_.resize(places_.size() + 1);
  std::iota(parent_.begin(), parent_.end(), 0U);
  outside_ = static_cast<std::uint32_t>(places_.size());
  joinAlongSides();
  lookAround(earlier, same);
  joinAcrossAir();
  measureAirs();
  follow();
  openThinAir();
  closeThinAir(model.materials);
}

bool AirSurvey::isInDoubt(std::uint32_t side, std::uint32_t own) const {
  const bool areFew = firstPlace_[side + 1] - firstPlace_[side] <= pointsOfSide + 1;
  for (std::uint32_t place = firstPlace_[side]; place < firstPlace_[side + 1]; ++place) {
    if (air_[place] != nowhere && air_[place] != own) return true;
    if (areFew && seesOther(place, own)) return true;
  }
  return false;
}

bool AirSurvey::seesOther(std::uint32_t place, std::uint32_t own) const {
  for (std::uint32_t ray = 0; ray < raysOfPoint; ++ray) {
    const std::uint32_t met = met_[std::size_t{place} * raysOfPoint + ray].place;
    if (met == nowhere || air_[met] != own) return true;
  }
  return false;
}

std::vector<glm::vec3> AirSurvey::localPolygon(std::uint32_t piece) const {
  std::vector<glm::vec3> polygon;
  for (const std::uint32_t corner : pieces_.polygons[piece]) {
    polygon.emplace_back(pieces_.points[corner] - rays_.origin());
  }
  return polygon;
}

glm::vec3 AirSurvey::middleOf(const std::vector<glm::vec3>& polygon) {
  return std::accumulate(polygon.begin(), polygon.end(), glm::vec3(0.0F)) /
         static_cast<float>(polygon.size());
}

bool AirSurvey::isSmallerThanOpening(const std::vector<glm::vec3>& polygon) {
  return std::ranges::all_of(
      polygon, [&](const glm::vec3& corner) { return glm::distance(corner, polygon[0]) < 2.0F * bundle_m; });
}

std::uint32_t AirSurvey::root(std::uint32_t place) {
  while (parent_[place] != place) place = parent_[place] = parent_[parent_[place]];
  return place;
}

void AirSurvey::join(std::uint32_t a, std::uint32_t b) {
  a = root(a);
  b = root(b);
  parent_[std::min(a, b)] = std::max(a, b);  // the outside, the highest, stays a root
}

bool AirSurvey::isOpen(const glm::vec3& from, const glm::vec3& to) const {
  const glm::vec3 way = to - from;
  const float length_m = glm::length(way);
  return length_m < 1e-6F ||
         !rays_.meetsAny(from, way / length_m, RayScene::Barrier::opaqueAndGlass, length_m);
}

std::uint32_t AirSurvey::countPlaces(std::uint32_t side, double total_m2) const {
  const double share = pieces_.area_m2[side / 2] / std::max(total_m2, 1e-9);
  const auto further = static_cast<std::uint32_t>(pointsOfModel * share);
  const std::uint32_t least = isSmallerThanOpening(localPolygon(side / 2)) ? 1 : pointsOfSide;
  return std::min(least + further, std::uint32_t{pointsOfSideMax});
}

void AirSurvey::placeAll(const AirSurvey* earlier, const SameSides* same) {
  const auto sides = static_cast<std::uint32_t>(2 * pieces_.size());
  const auto before = [&](std::uint32_t side) { return same != nullptr ? same->before[side] : nowhere; };
  const double total_m2 = std::accumulate(pieces_.area_m2.begin(), pieces_.area_m2.end(), 0.0);
  firstPlace_.push_back(0);
  for (std::uint32_t side = 0; side < sides; ++side) {
    const std::size_t count =
        before(side) != nowhere ? earlier->placesOf(before(side)).size() : countPlaces(side, total_m2);
    firstPlace_.push_back(firstPlace_.back() + static_cast<std::uint32_t>(count));
  }
  places_.resize(firstPlace_.back());
  forEachIndex(sides, sidesOfTask, [&](std::size_t index) {
    const auto side = static_cast<std::uint32_t>(index);
    if (before(side) == nowhere) {
      placeOver(side);
      return;
    }
    const auto known = earlier->placesOf(before(side));
    std::copy(known.begin(), known.end(), places_.begin() + firstPlace_[side]);
    for (std::uint32_t place = firstPlace_[side]; place < firstPlace_[side + 1]; ++place) {
      places_[place].side = side;
    }
  });
  for (int axis = 0; axis < 3; ++axis) {
    coordinate_[static_cast<std::size_t>(axis)].reserve(places_.size());
    for (const Place& place : places_)
      coordinate_[static_cast<std::size_t>(axis)].push_back(place.point[axis]);
  }
}

void AirSurvey::placeOver(std::uint32_t side) {
  const auto polygon = localPolygon(side / 2);
  const glm::vec3 normal(side % 2 == 0 ? pieces_.normal[side / 2] : -pieces_.normal[side / 2]);
  const Sequence sequence(mixKeys(0xd0, side));
  const std::uint32_t count = firstPlace_[side + 1] - firstPlace_[side];
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::vec3 point =
        count == 1 ? middleOf(polygon) : pointOnPolygon<glm::vec3>(polygon, sequence(i, 0), sequence(i, 1));
    const std::uint32_t place = firstPlace_[side] + i;
    places_[place] = {point + rayOffset_m * normal, normal, side, place, freeHeight_m(side, point, normal)};
  }
}

// Near the edge of a wedge the other wall is nearer than the points from which rays start. Farther out than
// coordinates have digits for, rays start no lower than those.
float AirSurvey::freeHeight_m(std::uint32_t side, const glm::vec3& point, const glm::vec3& normal) const {
  const float reach_m = std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
  float from_m =
      std::min(std::max(buried_m, 16.0F * std::numeric_limits<float>::epsilon() * reach_m), rayOffset_m);
  const auto meet = [&] {
    return rays_.nearest(point + from_m * normal, normal, RayScene::Barrier::opaqueAndGlass,
                         clearance_m - from_m);
  };
  auto hit = meet();
  if (hit && hit.piece == side / 2 && from_m < rayOffset_m) {  // itself, by rounding
    from_m = rayOffset_m;
    hit = meet();
  }
  return hit ? from_m + hit.distance_m : clearance_m;
}

glm::vec3 AirSurvey::hover(std::uint32_t place) const {
  return places_[place].point + 0.9F * clearance_m * places_[place].normal;
}

bool AirSurvey::isOpenWide(const glm::vec3& from, const glm::vec3& to, float half_m) const {
  if (!isOpen(from, to)) return false;
  const glm::vec3 way = to - from;
  if (glm::length(way) < 1e-6F) return true;
  glm::vec3 u;
  glm::vec3 v;
  tangentFrame(glm::normalize(way), u, v);
  for (const glm::vec3& aside : {half_m * u, -half_m * u, half_m * v, -half_m * v}) {
    if (!isOpen(from, from + aside) || !isOpen(from + aside, to + aside)) return false;
  }
  return true;
}

void AirSurvey::joinAlongSides() {
  forEachIndex(firstPlace_.size() - 1, sidesOfTask, [&](std::size_t side) {
    for (std::uint32_t a = firstPlace_[side]; a < firstPlace_[side + 1]; ++a) {
      for (std::uint32_t b = firstPlace_[side]; b < a; ++b) {
        if (!places_[a].isFree() || !places_[b].isFree() || root(a) == root(b)) continue;
        if (isOpenWide(hover(a), hover(b), bundle_m)) join(a, b);
      }
    }
  });
}

std::uint32_t AirSurvey::placeNear(std::uint32_t side, const glm::vec3& point, float height_m) const {
  const std::uint32_t first = firstPlace_[side];
  const std::size_t count = firstPlace_[side + 1] - first;
  const std::array<const float*, 3> at{&coordinate_[0][first], &coordinate_[1][first],
                                       &coordinate_[2][first]};
  std::array<std::uint32_t, pointsOfSideMax> square;  // bits of floats, which are in order as they are
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 way = glm::vec3(at[0][i], at[1][i], at[2][i]) - point;
    square[i] = std::bit_cast<std::uint32_t>(glm::dot(way, way));
  }
  for (std::size_t tried = 0; tried < std::min(count, nearPlaces); ++tried) {
    std::uint32_t least = square[0];
    for (std::size_t i = 1; i < count; ++i) least = std::min(least, square[i]);
    std::size_t nearest = 0;
    while (square[nearest] != least) ++nearest;
    const Place& place = places_[first + nearest];
    const glm::vec3 up = height_m * place.normal;
    if (isOpen(point + up, place.point + up)) return first + static_cast<std::uint32_t>(nearest);
    square[nearest] = std::numeric_limits<std::uint32_t>::max();
  }
  return nowhere;
}

AirSurvey::Meeting AirSurvey::look(const glm::vec3& from, const glm::vec3& direction) const {
  const auto hit = rays_.nearest(from, direction, RayScene::Barrier::opaqueAndGlass);
  if (!hit) return {outside_, hit.distance_m};
  const glm::vec3 normal(hit.front ? pieces_.normal[hit.piece] : -pieces_.normal[hit.piece]);
  const glm::vec3 point = from + hit.distance_m * direction + rayOffset_m * normal;
  return {placeNear(hit.side(), point, 0.2F * clearance_m), hit.distance_m};
}

glm::vec3 AirSurvey::directionOf(std::uint32_t place, std::uint32_t ray) const {
  const Sequence sequence(mixKeys(0xd1, places_[place].key));
  return cosineDirection(places_[place].normal, sequence(ray, 0), sequence(ray, 1));
}

void AirSurvey::lookAround(const AirSurvey* earlier, const SameSides* same) {
  met_.resize(places_.size() * raysOfPoint);
  forEachIndex(places_.size(), sidesOfTask, [&](std::size_t index) {
    const auto place = static_cast<std::uint32_t>(index);
    const std::uint32_t side = places_[place].side;
    const bool isKnown = same != nullptr && same->before[side] != nowhere;
    for (std::uint32_t ray = 0; ray < raysOfPoint; ++ray) {
      Meeting& met = met_[index * raysOfPoint + ray];
      if (isKnown) {
        const std::uint32_t former = earlier->firstPlace_[same->before[side]] + place - firstPlace_[side];
        met = seenAgain(*earlier, *same, earlier->met_[std::size_t{former} * raysOfPoint + ray]);
      }
      if (met.place == nowhere && !places_[place].isBuried())
        met = look(places_[place].point, directionOf(place, ray));
    }
  });
}

AirSurvey::Meeting AirSurvey::seenAgain(const AirSurvey& earlier, const SameSides& same,
                                        const Meeting& met) const {
  if (met.place == nowhere) return met;
  if (met.place == earlier.outside_) return {outside_, met.distance_m};
  const std::uint32_t formerSide = earlier.places_[met.place].side;
  const std::uint32_t side = same.now[formerSide];
  if (side == nowhere) return {};
  return {firstPlace_[side] + met.place - earlier.firstPlace_[formerSide], met.distance_m};
}

bool AirSurvey::bundlePasses(std::uint32_t place, std::uint32_t ray) const {
  const Meeting& met = met_[std::size_t{place} * raysOfPoint + ray];
  const glm::vec3 direction = directionOf(place, ray);
  if (met.place == outside_) return isOpenWide(hover(place), hover(place) + 1e4F * direction, bundle_m);
  const Place& other = places_[met.place];
  if (!other.isFree()) return false;
  const glm::vec3 point = places_[place].point + met.distance_m * direction + rayOffset_m * other.normal;
  const glm::vec3 above = point + 0.9F * clearance_m * other.normal;
  return isOpen(point, above) && isOpenWide(above, hover(met.place), bundle_m) &&
         isOpenWide(hover(place), above, bundle_m);
}

void AirSurvey::joinAcrossAir() {
  constexpr std::uint8_t none = raysOfPoint;
  std::vector<std::uint8_t> tried(places_.size(), 0);  // rays
  std::vector<std::uint8_t> passing(places_.size());   // the ray that a bundle follows
  for (const std::size_t every : {64U, 8U, 1U}) {
    for (std::uint32_t place = 0; place < parent_.size(); ++place) parent_[place] = root(place);
    std::fill(passing.begin(), passing.end(), none);
    forEachIndex((places_.size() + every - 1) / every, sidesOfTask, [&](std::size_t index) {
      const auto place = static_cast<std::uint32_t>(index * every);
      if (!places_[place].isFree()) return;
      while (tried[place] < raysOfPoint && passing[place] == none) {
        const std::uint8_t ray = tried[place]++;
        const std::uint32_t other = met_[std::size_t{place} * raysOfPoint + ray].place;
        const bool areApart = other != nowhere && parent_[place] != parent_[other];
        if (areApart && bundlePasses(place, ray)) passing[place] = ray;
      }
    });
    for (std::uint32_t place = 0; place < places_.size(); ++place) {
      if (passing[place] != none) join(place, met_[std::size_t{place} * raysOfPoint + passing[place]].place);
    }
  }
  for (std::uint32_t place = 0; place < places_.size(); ++place) {
    for (std::uint32_t ray = tried[place]; places_[place].isFree() && ray < raysOfPoint; ++ray) {
      const std::uint32_t other = met_[std::size_t{place} * raysOfPoint + ray].place;
      if (other != nowhere && root(place) != root(other) && bundlePasses(place, ray)) join(place, other);
    }
  }
  for (std::uint32_t place = 0; place < parent_.size(); ++place) parent_[place] = root(place);
}

void AirSurvey::measureAirs() {
  airArea_m2_.assign(places_.size() + 1, 0.0);
  for (std::uint32_t side = 0; side + 1 < firstPlace_.size(); ++side) {
    const double share_m2 = pieces_.area_m2[side / 2] / (firstPlace_[side + 1] - firstPlace_[side]);
    for (std::uint32_t place = firstPlace_[side]; place < firstPlace_[side + 1]; ++place) {
      if (places_[place].isFree()) airArea_m2_[parent_[place]] += share_m2;
    }
  }
}

void AirSurvey::follow() {
  air_.assign(places_.size() + 1, nowhere);
  air_[outside_] = outside_;
  for (std::uint32_t place = 0; place < places_.size(); ++place) {
    if (!places_[place].isFree()) continue;
    const std::uint32_t air = parent_[place];
    if (air == outside_ || airArea_m2_[air] >= airMin_m2) air_[place] = air;
  }
  for (int round = 0; round < 4; ++round) {
    std::vector<std::uint32_t> next = air_;
    forEachIndex(places_.size(), sidesOfTask, [&](std::size_t place) {
      if (air_[place] != nowhere) return;
      Votes votes;
      for (std::uint32_t ray = 0; ray < raysOfPoint; ++ray) {
        const std::uint32_t other = met_[place * raysOfPoint + ray].place;
        if (other != nowhere && air_[other] != nowhere) votes.add(air_[other]);
      }
      next[place] = votes.most();
    });
    air_ = std::move(next);
  }
}

}  // namespace clerestory
