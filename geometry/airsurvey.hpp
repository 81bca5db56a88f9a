// SPDX-License-Identifier: GPL-3.0-or-later
// Which places over a model's sides share the same air.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <geometry/building.hpp>
#include <geometry/rays.hpp>

namespace clerestory {

inline constexpr std::uint32_t nowhere = RayScene::Hit::none;

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

/// Asks for the air over all sides of a model. What was seen before some pieces were cut is seen again where
/// those pieces are not concerned: cutting moves no surface. Loops over places or sides run on all threads,
/// where each writes to its own entries alone.
class AirSurvey {
 public:
  AirSurvey(const CleanModel& model, const RayScene& rays) : AirSurvey(model, rays, nullptr, nullptr) {}
  AirSurvey(const CleanModel& model, const RayScene& rays, const AirSurvey& earlier, const SameSides& same)
      : AirSurvey(model, rays, &earlier, &same) {}

  /// The air of most of a side's places, as a number below airLimit; nowhere if none is known.
  [[nodiscard]] std::uint32_t airOf(std::uint32_t side) const;
  [[nodiscard]] std::uint32_t outside() const { return outside_; }

  /// Whether a side has places in two airs that are both worth cutting it for.
  [[nodiscard]] bool isInTwoAirs(std::uint32_t side) const;

  /// The air that a side is given after a closer look: the one of those among `lit` that is met most from it;
  /// `own` where none is. Most of a seat's upper face may lie under its cushion.
  [[nodiscard]] std::uint32_t closerAirOf(std::uint32_t side, std::uint32_t own,
                                          const std::vector<bool>& lit) const;
  [[nodiscard]] std::size_t airLimit() const { return parent_.size(); }

  /// Share of a side's light that met nothing.
  [[nodiscard]] double escapedShare(std::uint32_t side) const;

 private:
  /// A place over a side where the air is asked for.
  struct Place {
    glm::vec3 point, normal;
    std::uint32_t side;
    std::uint32_t key;  ///< of its rays' directions
    float free_m;       ///< height over the side, up to the clearance

    /// Has clearance; others only follow.
    [[nodiscard]] bool isFree() const { return free_m >= clearance_m; }
    /// Another surface lies between the side and the point, so that it sees another air than the side's.
    [[nodiscard]] bool isBuried() const { return free_m < rayOffset_m; }
  };

  /// What a ray of a place met.
  struct Meeting {
    std::uint32_t place = nowhere;  ///< that shares the air of the point met, or the outside
    float distance_m = 0.0F;
  };

  /// `earlier` and `same`: both or neither.
  AirSurvey(const CleanModel& model, const RayScene& rays, const AirSurvey* earlier, const SameSides* same);

  [[nodiscard]] bool isSmall(std::uint32_t side) const {
    return firstPlace_[side + 1] - firstPlace_[side] == 1;
  }

  /// Whether a side's places disagree about their air or, where they are few, their rays met another one: a
  /// closer look decides.
  [[nodiscard]] bool isInDoubt(std::uint32_t side, std::uint32_t own) const;

  /// Whether a place's rays met another air, or none that is known.
  [[nodiscard]] bool seesOther(std::uint32_t place, std::uint32_t own) const;

  [[nodiscard]] std::vector<glm::vec3> localPolygon(std::uint32_t piece) const;
  static glm::vec3 middleOf(const std::vector<glm::vec3>& polygon);

  /// Whether a polygon has no room for two airs that something could fly between.
  static bool isSmallerThanOpening(const std::vector<glm::vec3>& polygon);

  std::uint32_t root(std::uint32_t place);
  void join(std::uint32_t a, std::uint32_t b);
  [[nodiscard]] bool isOpen(const glm::vec3& from, const glm::vec3& to) const;

  [[nodiscard]] std::uint32_t countPlaces(std::uint32_t side, double total_m2) const;
  void placeAll(const AirSurvey* earlier, const SameSides* same);
  void placeOver(std::uint32_t side);
  /// Free height over a point of a side, up to the clearance.
  [[nodiscard]] float freeHeight_m(std::uint32_t side, const glm::vec3& point, const glm::vec3& normal) const;

  [[nodiscard]] std::span<const Place> placesOf(std::uint32_t side) const {
    return std::span(places_).subspan(firstPlace_[side], firstPlace_[side + 1] - firstPlace_[side]);
  }

  /// Where a free place's bundles start.
  [[nodiscard]] glm::vec3 hover(std::uint32_t place) const;

  /// Whether a bundle of rays, `half_m` to each side, passes between two points in the air.
  [[nodiscard]] bool isOpenWide(const glm::vec3& from, const glm::vec3& to, float half_m) const;

  /// Comes before all other joins: a side's places have roots among themselves.
  void joinAlongSides();

  /// The place of `side` that shares the air of a point on it: of the nearest ones the first that no surface
  /// keeps it from; nowhere if the way to each is barred.
  [[nodiscard]] std::uint32_t placeNear(std::uint32_t side, const glm::vec3& point, float height_m) const;

  /// The place, or the outside, whose air a ray finds.
  [[nodiscard]] Meeting look(const glm::vec3& from, const glm::vec3& direction) const;

  [[nodiscard]] glm::vec3 directionOf(std::uint32_t place, std::uint32_t ray) const;

  void lookAround(const AirSurvey* earlier, const SameSides* same);

  /// What was met earlier, as a place of this survey; nowhere if it was on a piece that has been cut.
  [[nodiscard]] Meeting seenAgain(const AirSurvey& earlier, const SameSides& same, const Meeting& met) const;

  /// Whether a bundle passes from a free place to what its ray met.
  [[nodiscard]] bool bundlePasses(std::uint32_t place, std::uint32_t ray) const;

  /// Joins the airs that bundles pass between. Which of them are tried first does not matter: a few places
  /// join most airs, and the others then have little left to try.
  void joinAcrossAir();

  /// Surface of each air: its free places' shares of their sides.
  void measureAirs();

  /// Free places know their air, unless it has too little surface to be one: a rug's edge is free, but too
  /// low for a bundle to pass to it. Other places take the air of most of what their rays met, as it becomes
  /// known.
  void follow();

  /// Whether a place, or the outside, knows its air by itself.
  [[nodiscard]] bool isSure(std::uint32_t place) const {
    return air_[place] != nowhere && air_[place] == parent_[place];
  }
  /// Whether a place's rays met one that is sure.
  [[nodiscard]] bool seesFreeAir(std::uint32_t place) const;
  /// The air that a gap before a side opens to; nowhere if no mouth as high as the gap is found.
  [[nodiscard]] std::uint32_t airAtMouth(std::uint32_t side) const;
  /// Gives sides that lie in gaps, and of whose places few see out, the air at the gap's mouth, if any.
  void openThinAir();
  /// Makes an air of places that know none, see each other, and have something among them that shines: no
  /// wall's cavity does.
  void closeThinAir(std::span<const Material> materials);

  static constexpr float clearance_m = 0.05F;  ///< free height over a place that may join airs
  static constexpr double airMin_m2 = 0.5;     ///< surface of the smallest air that is one by itself
  static constexpr std::uint32_t raysOfPoint = 6;
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
  std::vector<bool> isShut_;                      // #sides: in a gap without a mouth
  std::uint32_t outside_ = 0;
};

}  // namespace clerestory
