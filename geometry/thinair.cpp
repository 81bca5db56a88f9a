// SPDX-License-Identifier: GPL-3.0-or-later
// Air that nothing as wide as an opening flies through: it is that at its mouth, or one by itself where
// something in it shines. What is sealed and dark, as in walls and furniture, stays none.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <geometry/parallel.hpp>
#include <geometry/sampling.hpp>

#include "airsurvey.hpp"

namespace clerestory {
namespace {

constexpr double thinLeast_m2 = 0.05;     // of a side, for the mouth of the gap before it to be looked for
constexpr std::size_t placesOfMouth = 8;  // of a side, from which it is looked for
constexpr std::uint32_t waysToMouth = 8;  // of each
constexpr float bundleShare = 0.3F;       // half of a bundle's width, of the gap's height
constexpr float wayShare = 0.9F;          // of the way to what a ray met, that a bundle is to pass

}  // namespace

// Whether a cosine ray finds its way out of a gap far wider than high is chance. One that flies between its
// sides meets what is at its end, and a bundle more than half as high as the gap tells the gap's mouth from a
// crack.
std::uint32_t AirSurvey::airAtMouth(std::uint32_t side) const {
  const auto places = placesOf(side);
  const Sequence sequence(mixKeys(0xd3, side));
  for (std::uint32_t i = 0; i < std::min(places.size(), placesOfMouth); ++i) {
    const Place& place = places[i];
    if (place.isBuried()) continue;
    const glm::vec3 from = place.point + (0.5F * place.free_m - rayOffset_m) * place.normal;
    glm::vec3 u;
    glm::vec3 v;
    tangentFrame(place.normal, u, v);
    for (std::uint32_t k = 0; k < waysToMouth; ++k) {
      const float angle = 2.0F * std::numbers::pi_v<float> * (static_cast<float>(k) + sequence(i, 0)) /
                          static_cast<float>(waysToMouth);
      const glm::vec3 way = std::cos(angle) * u + std::sin(angle) * v;
      const Meeting met = look(from, way);
      if (met.place == nowhere || !isSure(met.place)) continue;
      const glm::vec3 to = from + (met.place == outside_ ? 1e4F : wayShare * met.distance_m) * way;
      if (isOpenWide(from, to, bundleShare * place.free_m)) return air_[met.place];
    }
  }
  return nowhere;
}

bool AirSurvey::seesFreeAir(std::uint32_t place) const {
  for (std::uint32_t ray = 0; ray < raysOfPoint; ++ray) {
    const std::uint32_t met = met_[std::size_t{place} * raysOfPoint + ray].place;
    if (met != nowhere && isSure(met)) return true;
  }
  return false;
}

void AirSurvey::openThinAir() {
  std::vector<std::uint8_t> isThin(firstPlace_.size() - 1, 0);
  std::vector<std::uint32_t> found(isThin.size(), nowhere);
  forEachIndex(isThin.size(), sidesOfTask, [&](std::size_t index) {
    const auto side = static_cast<std::uint32_t>(index);
    if (pieces_.area_m2[side / 2] < thinLeast_m2) return;
    std::size_t seeing = 0;
    for (std::uint32_t place = firstPlace_[side]; place < firstPlace_[side + 1]; ++place) {
      if (isSure(place)) return;
      seeing += seesFreeAir(place) ? 1U : 0U;
    }
    if (2 * seeing >= placesOf(side).size()) return;
    isThin[side] = 1;
    found[side] = airAtMouth(side);
  });
  isShut_.assign(found.size(), false);
  for (std::uint32_t side = 0; side < found.size(); ++side) {
    if (isThin[side] == 0) continue;
    std::fill(air_.begin() + firstPlace_[side], air_.begin() + firstPlace_[side + 1], found[side]);
    isShut_[side] = found[side] == nowhere;
  }
}

void AirSurvey::closeThinAir(std::span<const Material> materials) {
  const auto isUnknown = [&](std::uint32_t place) {
    return air_[place] == nowhere && !places_[place].isBuried();
  };
  const auto shines = [&](std::uint32_t place) {
    return materials[pieces_.material[places_[place].side / 2]].exitance_lm_m2 != glm::dvec3(0.0);
  };
  std::vector<bool> isLit(places_.size(), false);  // by root
  for (std::uint32_t place = 0; place < places_.size(); ++place)
    isLit[place] = isUnknown(place) && shines(place);
  if (std::ranges::find(isLit, true) == isLit.end()) return;
  for (std::uint32_t place = 0; place < places_.size(); ++place) {
    for (std::uint32_t ray = 0; isUnknown(place) && ray < raysOfPoint; ++ray) {
      const std::uint32_t other = met_[std::size_t{place} * raysOfPoint + ray].place;
      if (other != nowhere && other != outside_ && isUnknown(other)) join(place, other);
    }
  }
  std::vector<double> area_m2(places_.size(), 0.0);  // by root
  for (std::uint32_t place = 0; place < places_.size(); ++place) {
    if (!isUnknown(place)) continue;
    const std::uint32_t own = root(place);
    area_m2[own] +=
        pieces_.area_m2[places_[place].side / 2] / static_cast<double>(placesOf(places_[place].side).size());
    if (isLit[place]) isLit[own] = true;
  }
  for (std::uint32_t place = 0; place < places_.size(); ++place) {
    const std::uint32_t own = root(place);
    if (isUnknown(place) && isLit[own] && area_m2[own] >= airMin_m2) air_[place] = own;
  }
}

}  // namespace clerestory
