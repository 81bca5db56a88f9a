// SPDX-License-Identifier: GPL-3.0-or-later
// What lies on a surface knows whether there is light above it: a larger one's sides were asked all over.
#include "covered.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include <geometry/rays.hpp>

#include "overlaps.hpp"

namespace clerestory {
namespace {

constexpr double coveredLeast_m2 = 0.05;  // a chair's legs are not worth a cut

/// A piece that lies on another in one plane.
struct Cover {
  std::uint32_t upperSide;  ///< that looks away from the lower one
  std::uint32_t lowerSide;  ///< that is covered
  bool isGuess;             ///< both might be seen

  [[nodiscard]] std::uint32_t upper() const { return upperSide / 2; }
  [[nodiscard]] std::uint32_t lower() const { return lowerSide / 2; }
};

/// Finds which of two pieces lies on the other.
class Covers {
 public:
  explicit Covers(const Building& building) : building_(building) {
    const Pieces& pieces = building.model.pieces;
    for (std::uint32_t piece = 0; piece < pieces.size(); ++piece)
      polygon_m2_[pieces.polygon[piece]] += pieces.area_m2[piece];
  }

  /// Of two pieces over each other in one plane, if light on their sides tells.
  [[nodiscard]] std::optional<Cover> between(std::uint32_t a, std::uint32_t b) const {
    const Pieces& pieces = building_.model.pieces;
    const double ofA_m2 = polygon_m2_.at(pieces.polygon[a]);
    const double ofB_m2 = polygon_m2_.at(pieces.polygon[b]);
    const bool isALarger = ofA_m2 > ofB_m2 || (ofA_m2 == ofB_m2 && a < b);
    const std::uint32_t large = isALarger ? a : b;
    const std::uint32_t small = isALarger ? b : a;
    const std::uint32_t turned = glm::dot(pieces.normal[a], pieces.normal[b]) < 0.0 ? 1U : 0U;
    const auto largeSide = [&](std::uint32_t back) { return 2 * large + back; };
    const auto smallSide = [&](std::uint32_t back) { return 2 * small + (back ^ turned); };
    // Dark above the small one, light above the large one elsewhere: something stands there.
    const std::array stands = {isLit(largeSide(0)) && !isLit(smallSide(0)),
                               isLit(largeSide(1)) && !isLit(smallSide(1))};
    if (stands[0] != stands[1]) {
      const std::uint32_t back = stands[1] ? 1U : 0U;
      return Cover{smallSide(back), largeSide(back), false};
    }
    // Of two that are drawn for opposite sides each has its own (partBackToBack).
    const bool areDrawnAlike = glm::dot(drawnNormal(pieces, a), drawnNormal(pieces, b)) > 0.0;
    if (stands[0] || !areDrawnAlike) return std::nullopt;
    // Light above both: the small one is seen, on the side that is lit or, of two, that both are drawn for.
    const auto isShared = [&](std::uint32_t back) {
      return isLit(largeSide(back)) &&
             building_.sideDomain[largeSide(back)] == building_.sideDomain[smallSide(back)];
    };
    std::uint32_t back = pieces.isDrawnForBack[large] ? 1U : 0U;
    if (!isShared(back)) back ^= 1U;
    if (!isShared(back)) return std::nullopt;
    return Cover{smallSide(back), largeSide(back), true};
  }

 private:
  [[nodiscard]] bool isLit(std::uint32_t side) const {
    const std::int32_t domain = building_.sideDomain[side];
    return domain >= 0 && building_.domains[static_cast<std::size_t>(domain)].lit;
  }

  const Building& building_;
  std::map<std::uint32_t, double> polygon_m2_;  // of whole polygons
};

/// Tells what is a guess in a room: of each object the largest piece.
void tellGuesses(Building& building, const std::vector<Cover>& covers) {
  const Pieces& pieces = building.model.pieces;
  const auto area_m2 = [&](const Cover& cover) { return pieces.area_m2[cover.upper()]; };
  std::map<std::uint32_t, Cover> largest;  // by surface
  for (const Cover& cover : covers) {
    if (!cover.isGuess || building.sideRoom[cover.lowerSide] < 0 || area_m2(cover) < coveredLeast_m2)
      continue;
    Cover& known = largest.try_emplace(pieces.surface[cover.upper()], cover).first->second;
    if (area_m2(cover) > area_m2(known)) known = cover;
  }
  if (largest.empty()) return;
  const auto placeOf = [&](const Cover& cover) {
    const auto corners = pieces.polygons[cover.upper()];
    glm::dvec3 sum(0.0);
    for (const std::uint32_t corner : corners) sum += pieces.points[corner];
    return sum / static_cast<double>(corners.size());
  };
  const auto nameOf = [&](std::uint32_t surface) { return building.model.surfaces[surface].name; };
  for (const auto& [surface, cover] : largest)
    building.marks.push_back({"G221", nameOf(surface), placeOf(cover)});
  const auto& [surface, cover] =
      *std::ranges::max_element(largest, {}, [&](const auto& entry) { return area_m2(entry.second); });
  addDiagnosis(
      building.diagnoses,
      {"G221",
       "surfaces lie in the plane of larger ones, as seen from a room; where they overlap the smaller "
       "counts; the largest is named",
       "object \"" + nameOf(surface) + "\"", largest.size(), placeOf(cover)});
}

/// Cuts pieces where a smaller one lies on them.
void cutCovered(Building& building) {
  const CleanModel& model = building.model;
  std::vector<std::uint32_t> among;
  for (std::uint32_t piece = 0; piece < model.pieces.size(); ++piece)
    if (!model.materials[model.pieces.material[piece]].glazing) among.push_back(piece);
  const Covers covers(building);
  cutOverlaps(building, Overlaps(model.pieces, among, coveredLeast_m2, [&](std::uint32_t a, std::uint32_t b) {
                return covers.between(a, b).has_value();
              }));
}

}  // namespace

void darkenCovered(Building& building) {
  cutCovered(building);
  std::vector<Cover> found;
  const Covers covers(building);
  for (const std::vector<std::uint32_t>& layers : layersOf(building.model)) {
    for (std::size_t i = 0; i < layers.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j)
        if (const auto cover = covers.between(layers[i], layers[j])) found.push_back(*cover);
    }
  }
  tellGuesses(building, found);
  Pieces& pieces = building.model.pieces;
  for (const Cover& cover : found) {
    darken(building, cover.lowerSide);
    darken(building, cover.upperSide ^ 1U);
    const double offset_m = rayOffset_m;
    move(pieces, cover.lower(),
         (cover.lowerSide % 2 == 0 ? -offset_m : offset_m) * pieces.normal[cover.lower()]);
  }
}

}  // namespace clerestory
