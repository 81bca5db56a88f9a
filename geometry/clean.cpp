// SPDX-License-Identifier: GPL-3.0-or-later
// From a scene as it was drawn to convex pieces in canonical order: the steps of the clean-up, one after the
// other.
#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "convex.hpp"
#include "merge.hpp"
#include "panes.hpp"
#include "subdivision.hpp"
#include "weld.hpp"

namespace clerestory {
namespace {

Soup collectFaces(const Scene& scene, const Tolerances& tolerances, CleanModel& model) {
  Soup soup{scene.points, scene.faces, scene.faceMaterial, scene.faceObject, {}};
  model.counts.pointsRead = scene.points.size();
  model.counts.facesRead = scene.faces.size();
  for (const Cage& cage : scene.cages) {
    model.counts.facesRead += cage.faces.size();
    tessellateCage(scene, cage, tolerances, soup, model.counts, model.diagnoses);
  }
  model.counts.cages = scene.cages.size();
  return soup;
}

std::vector<std::uint32_t> ranksOf(std::size_t count, auto nameOf) {
  Loop order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return nameOf(a) < nameOf(b); });
  std::vector<std::uint32_t> ranks(count);
  for (std::uint32_t i = 0; i < count; ++i) ranks[order[i]] = i;
  return ranks;
}

NameRanks rankNames(const Scene& scene) {
  const auto material = [&](std::uint32_t i) -> const std::string& { return scene.materials[i].name; };
  const auto object = [&](std::uint32_t i) -> const std::string& { return scene.objects[i]; };
  return {ranksOf(scene.materials.size(), material), ranksOf(scene.objects.size(), object)};
}

/// Merged polygons whose outlines are drawn twice, though their faces differed.
void dropDuplicatePolygons(const Soup& soup, const NameRanks& ranks, std::vector<PlanarPolygon>& polygons,
                           CleanModel& model) {
  std::vector<Footprint> footprints;
  for (const PlanarPolygon& polygon : polygons) {
    Footprint footprint{polygon.outer, polygon.material, polygon.object,
                        canonicalSign(glm::normalize(doubleAreaVector(soup.points, polygon.outer))) > 0.0};
    for (const Loop& hole : polygon.holes) {
      footprint.corners.insert(footprint.corners.end(), hole.begin(), hole.end());
    }
    std::sort(footprint.corners.begin(), footprint.corners.end());
    footprints.push_back(std::move(footprint));
  }
  const std::vector<bool> duplicate = findDuplicates(std::move(footprints), ranks);
  std::vector<PlanarPolygon> kept;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    if (!duplicate[i]) kept.push_back(std::move(polygons[i]));
  }
  const std::size_t dropped = polygons.size() - kept.size();
  polygons = std::move(kept);
  model.counts.duplicateFaces += dropped;
  if (dropped > 0) {
    addDiagnosis(model.diagnoses,
                 {"G206", "surfaces drawn twice by different faces were dropped", "", dropped});
  }
}

std::vector<DividedPolygon> divide(Soup& soup, std::vector<PlanarPolygon> polygons,
                                   const Tolerances& tolerances, CleanModel& model) {
  std::vector<DividedPolygon> result;
  std::size_t lost = 0;
  for (PlanarPolygon& polygon : polygons) {
    std::vector<Loop> pieces = convexPieces(soup.points, polygon, tolerances);
    if (pieces.empty()) {
      ++lost;
      continue;
    }
    result.push_back({std::move(polygon), std::move(pieces)});
  }
  if (lost > 0) {
    model.diagnoses.push_back({"G207", "surfaces whose outline crosses itself were dropped", "", lost});
  }
  return result;
}

struct Piece {
  Loop loop;
  std::uint32_t polygon, material, object;
};

/// Pieces by the coordinates of their corners, then by names.
std::vector<Piece> orderPieces(const Soup& soup, const NameRanks& ranks,
                               std::vector<DividedPolygon> polygons) {
  std::vector<Piece> pieces;
  for (std::uint32_t i = 0; i < polygons.size(); ++i) {
    const PlanarPolygon& polygon = polygons[i].polygon;
    for (Loop& loop : polygons[i].pieces) {
      startAtSmallest(soup.points, loop);
      pieces.push_back({std::move(loop), i, polygon.material, polygon.object});
    }
  }
  const auto cornerLess = [&](std::uint32_t a, std::uint32_t b) {
    return lexicographicallyLess(soup.points[a], soup.points[b]);
  };
  std::sort(pieces.begin(), pieces.end(), [&](const Piece& a, const Piece& b) {
    const auto less = [&](const Loop& p, const Loop& q) {
      return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end(), cornerLess);
    };
    if (less(a.loop, b.loop)) return true;
    if (less(b.loop, a.loop)) return false;
    return std::tuple(ranks.material[a.material], ranks.object[a.object]) <
           std::tuple(ranks.material[b.material], ranks.object[b.object]);
  });
  return pieces;
}

/// Surfaces by object name, material name and, where both are alike, the first of their pieces.
std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> orderSurfaces(
    const Scene& scene, const std::vector<Piece>& pieces, CleanModel& model) {
  using Pair = std::pair<std::uint32_t, std::uint32_t>;  // object, material
  std::vector<Pair> pairs;
  std::map<Pair, std::uint32_t> placeOf;
  for (const Piece& piece : pieces) {
    const Pair pair(piece.object, piece.material);
    if (placeOf.try_emplace(pair, 0U).second) pairs.push_back(pair);
  }
  std::stable_sort(pairs.begin(), pairs.end(), [&](const Pair& a, const Pair& b) {
    return std::tie(scene.objects[a.first], scene.materials[a.second].name) <
           std::tie(scene.objects[b.first], scene.materials[b.second].name);
  });
  for (const Pair& pair : pairs) {
    placeOf[pair] = static_cast<std::uint32_t>(model.surfaces.size());
    model.surfaces.push_back({scene.objects[pair.first], pair.second});
  }
  return placeOf;
}

void assemble(const Scene& scene, const Soup& soup, const std::vector<Piece>& pieces, CleanModel& model) {
  const auto surfaceOf = orderSurfaces(scene, pieces, model);
  // By place, not by index: points made by different polygons may coincide.
  const auto pointLess = [](const glm::dvec3& a, const glm::dvec3& b) { return lexicographicallyLess(a, b); };
  std::map<glm::dvec3, std::uint32_t, decltype(pointLess)> numberOf(pointLess);
  std::map<std::uint32_t, std::uint32_t> polygonOf;  // canonical number by the number as read
  Pieces& out = model.pieces;
  for (const Piece& piece : pieces) {
    Loop loop;
    for (const std::uint32_t corner : piece.loop) {
      const auto [found, isNew] =
          numberOf.try_emplace(soup.points[corner], static_cast<std::uint32_t>(out.points.size()));
      if (isNew) out.points.push_back(soup.points[corner]);
      loop.push_back(found->second);
    }
    const glm::dvec3 doubleArea = doubleAreaVector(out.points, loop);
    out.polygons.add(loop);
    out.normal.push_back(glm::normalize(doubleArea) + 0.0);
    out.area_m2.push_back(0.5 * glm::length(doubleArea));
    out.polygon.push_back(
        polygonOf.try_emplace(piece.polygon, static_cast<std::uint32_t>(polygonOf.size())).first->second);
    out.surface.push_back(surfaceOf.at({piece.object, piece.material}));
    out.material.push_back(piece.material);
  }
}

}  // namespace

CleanModel cleanScene(const Scene& scene) {
  const Tolerances tolerances;
  const NameRanks ranks = rankNames(scene);
  CleanModel model;
  model.materials = scene.materials;
  model.luminaires = luminairesOf(scene.lights);

  Soup soup = weld(collectFaces(scene, tolerances, model), tolerances, model.counts);
  dropDegenerateFaces(soup, tolerances, model.counts, model.diagnoses);
  dropDuplicateFaces(soup, ranks, model.counts, model.diagnoses);
  splitWarpedFaces(soup, tolerances, model.counts, model.diagnoses);

  std::vector<PlanarPolygon> polygons = mergeCoplanar(soup, tolerances, model.diagnoses);
  dropDuplicatePolygons(soup, ranks, polygons, model);
  std::vector<DividedPolygon> divided = divide(soup, std::move(polygons), tolerances, model);
  dropFurtherPaneSheets(soup.points, scene.materials, tolerances, divided, model.counts);
  model.counts.polygons = divided.size();

  const std::vector<Piece> pieces = orderPieces(soup, ranks, std::move(divided));
  model.counts.pieces = pieces.size();
  assemble(scene, soup, pieces, model);
  return model;
}

}  // namespace clerestory
