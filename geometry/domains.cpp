// SPDX-License-Identifier: GPL-3.0-or-later
// Air domains by free space, not by surfaces: points that hover over the sides of pieces are joined where a
// bundle of rays passes between them. A side may stand in two airs (a skirting that enters the wall); each of
// its points is in one.
#include "domains.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <span>

#include <geometry/parallel.hpp>
#include <geometry/sampling.hpp>

#include "cut.hpp"
#include "luminaires.hpp"

namespace clerestory {
namespace {

constexpr float clearance_m = 0.05F;     // free height over a point that may join airs
constexpr float bundle_m = 0.03F;        // half the width of the narrowest opening
constexpr double airMin_m2 = 0.5;        // surface of the smallest air that is one by itself
constexpr double worthCutting_m2 = 3.0;  // surface of an air for which a side is cut at its border
constexpr std::uint32_t raysOfPoint = 6;
constexpr std::uint32_t pointsOfSide = 3;  // at least; one where a side is smaller than an opening
constexpr double pointsOfModel = 4000.0;   // further ones, shared out by area
constexpr std::size_t pointsOfSideMax = 256;
constexpr std::size_t nearPlaces = 16;    // that a way is looked for to from a point on a side
constexpr std::uint32_t closerRays = 32;  // of a closer look
constexpr std::uint32_t closerRaysOfSmall = 8;
constexpr std::uint32_t agreeingRays = 8;  // of these, where all agree with the side's points
constexpr std::uint32_t nowhere = RayScene::Hit::none;

/// A place over a side where the air is asked for.
struct Place {
  glm::vec3 point, normal;
  std::uint32_t side;
  std::uint32_t key;  ///< of its rays' directions
  bool isFree;        ///< has clearance; others only follow
};

/// What a ray of a place met.
struct Meeting {
  std::uint32_t place = nowhere;  ///< that shares the air of the point met, or the outside
  float distance_m = 0.0F;
};

/// Sides of a model before and after some of its pieces were cut, as far as they are the same.
struct SameSides {
  std::vector<std::uint32_t> before;  ///< by side now; nowhere for parts
  std::vector<std::uint32_t> now;     ///< by side before; nowhere for what was cut

  /// `wholeOf`: the former piece that each piece is a part of, by rising numbers.
  SameSides(std::span<const std::uint32_t> wholeOf, std::size_t piecesBefore)
      : before(2 * wholeOf.size(), nowhere), now(2 * piecesBefore, nowhere) {
    for (std::uint32_t piece = 0; piece < wholeOf.size(); ++piece) {
      const std::uint32_t whole = wholeOf[piece];
      const bool isPart = (piece > 0 && wholeOf[piece - 1] == whole) ||
                          (piece + 1 < wholeOf.size() && wholeOf[piece + 1] == whole);
      for (std::uint32_t back = 0; back < 2 && !isPart; ++back) {
        before[2 * piece + back] = 2 * whole + back;
        now[2 * whole + back] = 2 * piece + back;
      }
    }
  }
};

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

/// Asks for the air over all sides of a model. What was seen before some pieces were cut is seen again where
/// those pieces are not concerned: cutting moves no surface. Loops over places or sides run on all threads,
/// where each writes to its own entries alone.
class AirSurvey {
 public:
  AirSurvey(const CleanModel& model, const RayScene& rays) : AirSurvey(model, rays, nullptr, nullptr) {}
  AirSurvey(const CleanModel& model, const RayScene& rays, const AirSurvey& earlier, const SameSides& same)
      : AirSurvey(model, rays, &earlier, &same) {}

  /// The air of most of a side's places, as a number below airLimit; nowhere if none is known.
  [[nodiscard]] std::uint32_t airOf(std::uint32_t side) const {
    Votes votes;
    for (std::uint32_t place = firstPlace_[side]; place < firstPlace_[side + 1]; ++place) {
      if (air_[place] != nowhere) votes.add(air_[place]);
    }
    return votes.most();
  }
  [[nodiscard]] std::uint32_t outside() const { return outside_; }

  /// Whether a side has places in two airs that are both worth cutting it for.
  [[nodiscard]] bool isInTwoAirs(std::uint32_t side) const {
    std::uint32_t first = nowhere;
    for (std::uint32_t place = firstPlace_[side]; place < firstPlace_[side + 1]; ++place) {
      if (!places_[place].isFree || airArea_m2_[parent_[place]] < worthCutting_m2) continue;
      if (first != nowhere && first != parent_[place]) return true;
      first = parent_[place];
    }
    return false;
  }

  /// The air that a side is given after a closer look: the one of those among `lit` that is met most from it;
  /// `own` where none is. Most of a seat's upper face may lie under its cushion.
  [[nodiscard]] std::uint32_t closerAirOf(std::uint32_t side, std::uint32_t own,
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
      const glm::vec3 start =
          pointOnPolygon<glm::vec3>(polygon, sequence(i, 0), sequence(i, 1)) + rayOffset_m * normal;
      const std::uint32_t other = look(start, cosineDirection(normal, sequence(i, 2), sequence(i, 3))).place;
      const std::uint32_t met = other == nowhere ? nowhere : air_[other];
      if (met != nowhere && lit[met]) votes.add(met);
      agree = agree && met == own;
    }
    const std::uint32_t most = votes.most();
    return most == nowhere ? own : most;
  }
  [[nodiscard]] std::size_t airLimit() const { return parent_.size(); }

  /// Share of a side's light that met nothing.
  [[nodiscard]] double escapedShare(std::uint32_t side) const {
    double escaped = 0.0;
    const std::size_t first = std::size_t{firstPlace_[side]} * raysOfPoint;
    const std::size_t last = std::size_t{firstPlace_[side + 1]} * raysOfPoint;
    for (std::size_t ray = first; ray < last; ++ray) escaped += met_[ray].place == outside_ ? 1.0 : 0.0;
    return escaped / static_cast<double>(last - first);
  }

 private:
  /// `earlier` and `same`: both or neither.
  AirSurvey(const CleanModel& model, const RayScene& rays, const AirSurvey* earlier, const SameSides* same)
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
  }

  [[nodiscard]] bool isSmall(std::uint32_t side) const {
    return firstPlace_[side + 1] - firstPlace_[side] == 1;
  }

  /// Whether a side's places disagree about their air or, where they are few, their rays met another one: a
  /// closer look decides.
  [[nodiscard]] bool isInDoubt(std::uint32_t side, std::uint32_t own) const {
    const bool areFew = firstPlace_[side + 1] - firstPlace_[side] <= pointsOfSide + 1;
    for (std::uint32_t place = firstPlace_[side]; place < firstPlace_[side + 1]; ++place) {
      if (air_[place] != nowhere && air_[place] != own) return true;
      if (areFew && seesOther(place, own)) return true;
    }
    return false;
  }

  /// Whether a place's rays met another air, or none that is known.
  [[nodiscard]] bool seesOther(std::uint32_t place, std::uint32_t own) const {
    for (std::uint32_t ray = 0; ray < raysOfPoint; ++ray) {
      const std::uint32_t met = met_[std::size_t{place} * raysOfPoint + ray].place;
      if (met == nowhere || air_[met] != own) return true;
    }
    return false;
  }

  [[nodiscard]] std::vector<glm::vec3> localPolygon(std::uint32_t piece) const {
    std::vector<glm::vec3> polygon;
    for (const std::uint32_t corner : pieces_.polygons[piece]) {
      polygon.emplace_back(pieces_.points[corner] - rays_.origin());
    }
    return polygon;
  }

  static glm::vec3 middleOf(const std::vector<glm::vec3>& polygon) {
    return std::accumulate(polygon.begin(), polygon.end(), glm::vec3(0.0F)) /
           static_cast<float>(polygon.size());
  }

  /// Whether a polygon has no room for two airs that something could fly between.
  static bool isSmallerThanOpening(const std::vector<glm::vec3>& polygon) {
    return std::ranges::all_of(polygon, [&](const glm::vec3& corner) {
      return glm::distance(corner, polygon[0]) < 2.0F * bundle_m;
    });
  }

  std::uint32_t root(std::uint32_t place) {
    while (parent_[place] != place) place = parent_[place] = parent_[parent_[place]];
    return place;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::min(a, b)] = std::max(a, b);  // the outside, the highest, stays a root
  }
  [[nodiscard]] bool isOpen(const glm::vec3& from, const glm::vec3& to) const {
    const glm::vec3 way = to - from;
    const float length_m = glm::length(way);
    return length_m < 1e-6F ||
           !rays_.meetsAny(from, way / length_m, RayScene::Barrier::opaqueAndGlass, length_m);
  }

  [[nodiscard]] std::uint32_t countPlaces(std::uint32_t side, double total_m2) const {
    const double share = pieces_.area_m2[side / 2] / std::max(total_m2, 1e-9);
    const auto further = static_cast<std::uint32_t>(pointsOfModel * share);
    const std::uint32_t least = isSmallerThanOpening(localPolygon(side / 2)) ? 1 : pointsOfSide;
    return std::min(least + further, std::uint32_t{pointsOfSideMax});
  }

  void placeAll(const AirSurvey* earlier, const SameSides* same) {
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

  void placeOver(std::uint32_t side) {
    const auto polygon = localPolygon(side / 2);
    const glm::vec3 normal(side % 2 == 0 ? pieces_.normal[side / 2] : -pieces_.normal[side / 2]);
    const Sequence sequence(mixKeys(0xd0, side));
    const std::uint32_t count = firstPlace_[side + 1] - firstPlace_[side];
    for (std::uint32_t i = 0; i < count; ++i) {
      const glm::vec3 point =
          count == 1 ? middleOf(polygon) : pointOnPolygon<glm::vec3>(polygon, sequence(i, 0), sequence(i, 1));
      const glm::vec3 start = point + rayOffset_m * normal;
      const std::uint32_t place = firstPlace_[side] + i;
      places_[place] = {start, normal, side, place, isOpen(start, point + clearance_m * normal)};
    }
  }

  [[nodiscard]] std::span<const Place> placesOf(std::uint32_t side) const {
    return std::span(places_).subspan(firstPlace_[side], firstPlace_[side + 1] - firstPlace_[side]);
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

  /// Comes before all other joins: a side's places have roots among themselves.
  void joinAlongSides() {
    forEachIndex(firstPlace_.size() - 1, sidesOfTask, [&](std::size_t side) {
      for (std::uint32_t a = firstPlace_[side]; a < firstPlace_[side + 1]; ++a) {
        for (std::uint32_t b = firstPlace_[side]; b < a; ++b) {
          if (!places_[a].isFree || !places_[b].isFree || root(a) == root(b)) continue;
          if (isOpenWide(hover(a), hover(b))) join(a, b);
        }
      }
    });
  }

  /// The place of `side` that shares the air of a point on it: of the nearest ones the first that no surface
  /// keeps it from; nowhere if the way to each is barred.
  [[nodiscard]] std::uint32_t placeNear(std::uint32_t side, const glm::vec3& point, float height_m) const {
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

  /// The place, or the outside, whose air a ray finds.
  [[nodiscard]] Meeting look(const glm::vec3& from, const glm::vec3& direction) const {
    const auto hit = rays_.nearest(from, direction, RayScene::Barrier::opaqueAndGlass);
    if (!hit) return {outside_, hit.distance_m};
    const glm::vec3 normal(hit.front ? pieces_.normal[hit.piece] : -pieces_.normal[hit.piece]);
    const glm::vec3 point = from + hit.distance_m * direction + rayOffset_m * normal;
    return {placeNear(hit.side(), point, 0.2F * clearance_m), hit.distance_m};
  }

  [[nodiscard]] glm::vec3 directionOf(std::uint32_t place, std::uint32_t ray) const {
    const Sequence sequence(mixKeys(0xd1, places_[place].key));
    return cosineDirection(places_[place].normal, sequence(ray, 0), sequence(ray, 1));
  }

  void lookAround(const AirSurvey* earlier, const SameSides* same) {
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
        if (met.place == nowhere) met = look(places_[place].point, directionOf(place, ray));
      }
    });
  }

  /// What was met earlier, as a place of this survey; nowhere if it was on a piece that has been cut.
  [[nodiscard]] Meeting seenAgain(const AirSurvey& earlier, const SameSides& same, const Meeting& met) const {
    if (met.place == nowhere) return met;
    if (met.place == earlier.outside_) return {outside_, met.distance_m};
    const std::uint32_t formerSide = earlier.places_[met.place].side;
    const std::uint32_t side = same.now[formerSide];
    if (side == nowhere) return {};
    return {firstPlace_[side] + met.place - earlier.firstPlace_[formerSide], met.distance_m};
  }

  /// Whether a bundle passes from a free place to what its ray met.
  [[nodiscard]] bool bundlePasses(std::uint32_t place, std::uint32_t ray) const {
    const Meeting& met = met_[std::size_t{place} * raysOfPoint + ray];
    const glm::vec3 direction = directionOf(place, ray);
    if (met.place == outside_) return isOpenWide(hover(place), hover(place) + 1e4F * direction);
    const Place& other = places_[met.place];
    if (!other.isFree) return false;
    const glm::vec3 point = places_[place].point + met.distance_m * direction + rayOffset_m * other.normal;
    const glm::vec3 above = point + 0.9F * clearance_m * other.normal;
    return isOpen(point, above) && isOpenWide(above, hover(met.place)) && isOpenWide(hover(place), above);
  }

  /// Joins the airs that bundles pass between. Which of them are tried first does not matter: a few places
  /// join most airs, and the others then have little left to try.
  void joinAcrossAir() {
    constexpr std::uint8_t none = raysOfPoint;
    std::vector<std::uint8_t> tried(places_.size(), 0);  // rays
    std::vector<std::uint8_t> passing(places_.size());   // the ray that a bundle follows
    for (const std::size_t every : {64U, 8U, 1U}) {
      for (std::uint32_t place = 0; place < parent_.size(); ++place) parent_[place] = root(place);
      std::fill(passing.begin(), passing.end(), none);
      forEachIndex((places_.size() + every - 1) / every, sidesOfTask, [&](std::size_t index) {
        const auto place = static_cast<std::uint32_t>(index * every);
        if (!places_[place].isFree) return;
        while (tried[place] < raysOfPoint && passing[place] == none) {
          const std::uint8_t ray = tried[place]++;
          const std::uint32_t other = met_[std::size_t{place} * raysOfPoint + ray].place;
          const bool areApart = other != nowhere && parent_[place] != parent_[other];
          if (areApart && bundlePasses(place, ray)) passing[place] = ray;
        }
      });
      for (std::uint32_t place = 0; place < places_.size(); ++place) {
        if (passing[place] != none)
          join(place, met_[std::size_t{place} * raysOfPoint + passing[place]].place);
      }
    }
    for (std::uint32_t place = 0; place < places_.size(); ++place) {
      for (std::uint32_t ray = tried[place]; places_[place].isFree && ray < raysOfPoint; ++ray) {
        const std::uint32_t other = met_[std::size_t{place} * raysOfPoint + ray].place;
        if (other != nowhere && root(place) != root(other) && bundlePasses(place, ray)) join(place, other);
      }
    }
    for (std::uint32_t place = 0; place < parent_.size(); ++place) parent_[place] = root(place);
  }

  /// Surface of each air: its free places' shares of their sides.
  void measureAirs() {
    airArea_m2_.assign(places_.size() + 1, 0.0);
    for (std::uint32_t side = 0; side + 1 < firstPlace_.size(); ++side) {
      const double share_m2 = pieces_.area_m2[side / 2] / (firstPlace_[side + 1] - firstPlace_[side]);
      for (std::uint32_t place = firstPlace_[side]; place < firstPlace_[side + 1]; ++place) {
        if (places_[place].isFree) airArea_m2_[parent_[place]] += share_m2;
      }
    }
  }

  /// Free places know their air, unless it has too little surface to be one: a rug's edge is free, but too
  /// low for a bundle to pass to it. Other places take the air of most of what their rays met, as it becomes
  /// known.
  void follow() {
    air_.assign(places_.size() + 1, nowhere);
    air_[outside_] = outside_;
    for (std::uint32_t place = 0; place < places_.size(); ++place) {
      if (!places_[place].isFree) continue;
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

  static constexpr std::size_t sidesOfTask = 64;  ///< or places
  const Pieces& pieces_;
  const RayScene& rays_;
  std::vector<Place> places_;
  std::array<std::vector<float>, 3> coordinate_;  // of their points, again
  std::vector<std::uint32_t> firstPlace_;         // #sides + 1
  std::vector<Meeting> met_;                      // #places × raysOfPoint
  std::vector<std::uint32_t> parent_;             // union-find over places and the outside; in the end roots
  std::vector<std::uint32_t> air_;                // #places + 1: nowhere where it is not known
  std::vector<double> airArea_m2_;                // by root
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
  std::map<std::uint32_t, std::uint32_t> joined;  // an air and the lower one that it has become a part of
  const auto find = [&](std::uint32_t own) {
    for (auto found = joined.find(own); found != joined.end(); found = joined.find(own)) own = found->second;
    return own;
  };
  for (std::uint32_t piece = 0; piece < model.pieces.size(); ++piece) {
    if (!isGlass(model, piece)) continue;
    if (air[2 * piece] == nowhere || air[2 * piece + 1] == nowhere) {
      inner[piece] = true;  // pressed between other surfaces
      continue;
    }
    const std::uint32_t front = find(air[2 * piece]);
    const std::uint32_t back = find(air[2 * piece + 1]);
    if ((front == outside) != (back == outside)) continue;
    inner[piece] = true;
    if (front != back) joined.emplace(std::max(front, back), std::min(front, back));
  }
  for (std::uint32_t& own : air) own = find(own);
  return inner;
}

/// Pieces that stand in two airs, for which they are worth cutting.
std::vector<bool> piecesInTwoAirs(const CleanModel& model, const AirSurvey& survey) {
  std::vector<bool> inTwoAirs(model.pieces.size());
  for (std::uint32_t piece = 0; piece < model.pieces.size(); ++piece) {
    inTwoAirs[piece] =
        !isGlass(model, piece) && (survey.isInTwoAirs(2 * piece) || survey.isInTwoAirs(2 * piece + 1));
  }
  return inTwoAirs;
}

}  // namespace

void findDomains(Building& building) {
  CleanModel& model = building.model;
  const RayScene whole(model, {});
  auto survey = std::make_unique<AirSurvey>(model, whole);
  std::optional<RayScene> cut;
  const std::vector<bool> inTwoAirs = piecesInTwoAirs(model, *survey);
  if (std::find(inTwoAirs.begin(), inTwoAirs.end(), true) != inTwoAirs.end()) {
    const std::size_t piecesBefore = model.pieces.size();
    const SameSides same(cutWhereMet(model.pieces, inTwoAirs), piecesBefore);
    cut.emplace(model, std::vector<bool>());
    survey = std::make_unique<AirSurvey>(model, *cut, *survey, same);
  }
  std::vector<std::uint32_t> air(2 * model.pieces.size());
  for (std::uint32_t side = 0; side < air.size(); ++side) air[side] = survey->airOf(side);
  const std::uint32_t outside = survey->outside();
  std::vector<bool> lit(survey->airLimit(), false);
  lit[outside] = true;
  for (std::uint32_t side = 0; side < air.size(); ++side) {
    const bool brings = isGlass(model, side / 2) || isEmitter(model, side / 2);
    if (brings && air[side] != nowhere) lit[air[side]] = true;
  }
  const RayScene& rays = cut ? *cut : whole;
  for (const Luminaire& luminaire : building.luminaires) {
    const auto seen = sideSeenBy(luminaire, rays, [&](std::uint32_t side) { return air[side] != nowhere; });
    if (seen && *seen) lit[air[seen->side()]] = true;
  }
  forEachIndex(air.size(), 64, [&](std::size_t side) {
    air[side] = survey->closerAirOf(static_cast<std::uint32_t>(side), air[side], lit);
  });
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
    domain.escape_m2 += model.pieces.area_m2[side / 2] * survey->escapedShare(side);
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

  const auto isAir = [&](std::uint32_t side) { return building.sideDomain[side] >= 0; };
  const bool hasOutside = !building.domains.empty() && building.domains[0].open;
  for (const Luminaire& luminaire : building.luminaires) {
    const auto seen = sideSeenBy(luminaire, rays, isAir);
    std::int32_t domain = -1;
    if (seen && *seen) domain = building.sideDomain[seen->side()];
    if (seen && !*seen && hasOutside) domain = 0;
    building.luminaireDomain.push_back(domain);
    if (domain >= 0) building.domains[static_cast<std::size_t>(domain)].lit = true;
  }
}

}  // namespace clerestory
