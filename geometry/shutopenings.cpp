// SPDX-License-Identifier: GPL-3.0-or-later
// An opening has an edge. Beside each edge of what faces a dark room a bundle of rays is tried, into the room
// and against it.
#include "shutopenings.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include <geometry/parallel.hpp>

namespace clerestory {
namespace {

constexpr std::array widths_m{0.005F, 0.01F, 0.02F, 0.04F};  // cracks up to the first are a model's own
constexpr float bundleShare = 0.48F;                         // half of a bundle, of an opening's width
constexpr float wayShare = 0.9F;                             // of the way to what a ray met
constexpr float offPlane_m = 1e-3F;
constexpr double betweenTries_m = 0.02;
constexpr double triesOfEdge = 16.0;

struct Opening {
  float width_m = 0.0F;  ///< that is surely open; 0 for none
  std::uint32_t piece = 0;
  glm::dvec3 place_m{0.0};
};

class OpeningSearch {
 public:
  OpeningSearch(const Building& building, const RayScene& rays) : building_(building), rays_(rays) {}

  /// The widest opening at an edge of a side.
  [[nodiscard]] Opening widestAt(std::uint32_t side) const {
    const Pieces& pieces = building_.model.pieces;
    const auto corners = pieces.polygons[side / 2];
    const glm::dvec3& front = pieces.normal[side / 2];
    const glm::vec3 normal(side % 2 == 0 ? front : -front);
    Opening widest;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const glm::dvec3& from = pieces.points[corners[i]];
      const glm::dvec3 along = pieces.points[corners[(i + 1) % corners.size()]] - from;
      const double length_m = glm::length(along);
      if (length_m < static_cast<double>(widths_m[0])) continue;
      const glm::dvec3 outward = glm::cross(along / length_m, front);
      const double tries = std::clamp(std::floor(length_m / betweenTries_m), 1.0, triesOfEdge);
      for (double k = 0.0; k < tries; ++k) {
        const glm::dvec3 place = from + (k + 0.5) / tries * along;
        const float width_m =
            widthBeside(side, glm::vec3(place - rays_.origin()), glm::vec3(outward), normal);
        if (width_m > widest.width_m)
          widest = {width_m, side / 2, place + 0.5 * static_cast<double>(width_m) * outward};
      }
    }
    return widest;
  }

 private:
  [[nodiscard]] float widthBeside(std::uint32_t side, const glm::vec3& edge, const glm::vec3& outward,
                                  const glm::vec3& normal) const {
    float open_m = 0.0F;
    for (const float width_m : widths_m) {
      if (!isOpen(side, edge + 0.5F * width_m * outward, outward, normal, width_m)) break;
      open_m = width_m;
    }
    return open_m;
  }

  [[nodiscard]] bool isOpen(std::uint32_t side, const glm::vec3& middle, const glm::vec3& outward,
                            const glm::vec3& normal, float width_m) const {
    constexpr auto all = RayScene::Barrier::opaqueAndGlass;
    const glm::vec3 from = middle + offPlane_m * normal;
    if (rays_.meetsAny(from, -normal, all, 2.0F * offPlane_m)) return false;  // the plane goes on
    const auto behind = rays_.nearest(from, -normal, all);
    if (!isLit(behind, building_.sideDomain[side])) return false;
    const auto before = rays_.nearest(from, normal, all);
    if (!before || building_.sideDomain[before.side()] != building_.sideDomain[side]) return false;
    const float way_m = behind ? wayShare * behind.distance_m : 1e4F;
    const float half_m = bundleShare * width_m;
    const glm::vec3 along = glm::cross(outward, normal);
    return std::ranges::none_of(std::array{outward, -outward, along, -along}, [&](const glm::vec3& aside) {
      return rays_.meetsAny(from, aside, all, half_m) ||
             rays_.meetsAny(from + half_m * aside, -normal, all, way_m);
    });
  }

  /// What a ray met shows the air of another domain that is lit; where it met nothing, the outside.
  [[nodiscard]] bool isLit(const RayScene::Hit& hit, std::int32_t own) const {
    if (!hit) return true;
    const std::int32_t domain = building_.sideDomain[hit.side()];
    return domain >= 0 && domain != own && building_.domains[static_cast<std::size_t>(domain)].lit;
  }

  const Building& building_;
  const RayScene& rays_;
};

}  // namespace

void tellShutOpenings(Building& building, const RayScene& rays) {
  std::set<std::int32_t> dark;
  for (const Room& room : building.rooms)
    if (!building.domains[static_cast<std::size_t>(room.domain)].lit) dark.insert(room.domain);
  std::vector<std::uint32_t> sides;
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side)
    if (dark.contains(building.sideDomain[side])) sides.push_back(side);
  const OpeningSearch search(building, rays);
  std::vector<Opening> found(sides.size());
  forEachIndex(sides.size(), 64, [&](std::size_t i) { found[i] = search.widestAt(sides[i]); });
  Opening widest;
  std::set<std::int32_t> open;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (found[i].width_m > 0.0F) open.insert(building.sideDomain[sides[i]]);
    if (found[i].width_m > widest.width_m) widest = found[i];
  }
  if (open.empty()) return;
  double floor_m2 = 0.0;
  std::size_t rooms = 0;
  for (const Room& room : building.rooms) {
    if (!open.contains(room.domain)) continue;
    floor_m2 += room.floorArea_m2;
    ++rooms;
  }
  char text[200];
  std::snprintf(
      text, sizeof text,
      "rooms that nothing lights open to lit air by less than 6 cm, which counts as shut: %.2f m2 of "
      "floor stay dark; the widest opening, of %.0f mm or more, is named",
      floor_m2, 1000.0 * static_cast<double>(widest.width_m));
  const std::string& object = building.model.surfaces[building.model.pieces.surface[widest.piece]].name;
  building.marks.push_back({"G252", object, widest.place_m});
  addDiagnosis(building.diagnoses, {"G252", text, "object \"" + object + "\"", rooms, widest.place_m});
}

}  // namespace clerestory
