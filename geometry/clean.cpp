// SPDX-License-Identifier: GPL-3.0-or-later
// From a scene as it was drawn to convex pieces in canonical order: the steps of the clean-up, one after the
// other.
#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "convex.hpp"
#include "findings.hpp"
#include "merge.hpp"
#include "ownframe.hpp"
#include "panes.hpp"
#include "subdivision.hpp"
#include "weld.hpp"

namespace clerestory {
namespace {

/// The scene in its own frame, to the grid that all formats share.
Scene sceneIn(const PlanFrame& frame, const Tolerances& tolerances, Scene scene) {
  for (glm::dvec3& point : scene.points) point = onGrid(intoFrame(frame, point), tolerances.grid_m);
  return scene;
}

/// Winds faces about their canonical normals and keeps which side they were drawn for; `areMirrored`: all are
/// drawn for the other one.
void windCanonically(Soup& soup, bool areMirrored) {
  PolygonList faces;
  for (std::size_t face = 0; face < soup.faces.size(); ++face) {
    Loop loop(soup.faces[face].begin(), soup.faces[face].end());
    const bool isCanonical = canonicalSign(glm::normalize(doubleAreaVector(soup.points, loop))) > 0.0;
    if (!isCanonical) std::reverse(loop.begin(), loop.end());
    startAtSmallest(soup.points, loop);
    faces.add(loop);
    const bool isFront = isCanonical != areMirrored;
    soup.drawn.push_back({isFront, !isFront});
  }
  soup.faces = std::move(faces);
}

Soup collectFaces(const Scene& scene, const Tolerances& tolerances, CleanModel& model, Findings& findings) {
  Soup soup{scene.points, scene.faces, scene.faceMaterial, scene.faceObject, {}, {}};
  model.counts.pointsRead = scene.points.size();
  model.counts.facesRead = scene.faces.size();
  for (const Cage& cage : scene.cages) {
    model.counts.facesRead += cage.faces.size();
    tessellateCage(scene, cage, tolerances, soup, model.counts, findings);
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

/// The larger, the worse.
void notePolygon(const char* code, const Soup& soup, const PlanarPolygon& polygon, Findings& findings) {
  findings.note(code, soup.points, polygon.outer, polygon.object,
                0.5 * glm::length(doubleAreaVector(soup.points, polygon.outer)));
}

/// Merged polygons whose outlines are drawn twice, though their faces differed.
void dropDuplicatePolygons(const Soup& soup, const NameRanks& ranks, std::vector<PlanarPolygon>& polygons,
                           CleanModel& model, Findings& findings) {
  std::vector<Footprint> footprints;
  for (const PlanarPolygon& polygon : polygons) {
    Footprint footprint{polygon.outer, polygon.material, polygon.object,
                        model.materials[polygon.material].glazing, polygon.drawn};
    for (const Loop& hole : polygon.holes) {
      footprint.corners.insert(footprint.corners.end(), hole.begin(), hole.end());
    }
    std::sort(footprint.corners.begin(), footprint.corners.end());
    footprints.push_back(std::move(footprint));
  }
  markDuplicates(footprints, ranks);
  std::vector<PlanarPolygon> kept;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    if (footprints[i].isDrawnAlready) {
      notePolygon("G206", soup, polygons[i], findings);
      continue;
    }
    polygons[i].drawn = footprints[i].drawn;
    kept.push_back(std::move(polygons[i]));
  }
  polygons = std::move(kept);
  model.counts.duplicateFaces += findings.count("G206");
  findings.tell("G206", "surfaces drawn twice by different faces were dropped; the largest is named");
}

std::vector<DividedPolygon> divide(Soup& soup, std::vector<PlanarPolygon> polygons,
                                   const Tolerances& tolerances, Findings& findings) {
  std::vector<DividedPolygon> result;
  for (PlanarPolygon& polygon : polygons) {
    std::vector<Loop> pieces = convexPieces(soup.points, polygon, tolerances);
    if (pieces.empty()) {
      notePolygon("G207", soup, polygon, findings);
      continue;
    }
    result.push_back({std::move(polygon), std::move(pieces)});
  }
  findings.tell("G207", "surfaces whose outline crosses itself were dropped; the largest is named");
  return result;
}

struct Piece {
  Loop loop;
  glm::dvec3 normal;  ///< unit, of its polygon's plane; either sign
  std::uint32_t polygon, material, object;
  bool isDrawnForBack;
};

/// Pieces by the coordinates of their corners, then by names.
std::vector<Piece> orderPieces(const Soup& soup, const NameRanks& ranks,
                               std::vector<DividedPolygon> polygons) {
  std::vector<Piece> pieces;
  for (std::uint32_t i = 0; i < polygons.size(); ++i) {
    const PlanarPolygon& polygon = polygons[i].polygon;
    for (Loop& loop : polygons[i].pieces) {
      startAtSmallest(soup.points, loop);
      pieces.push_back(
          {std::move(loop), polygon.normal, i, polygon.material, polygon.object, !polygon.drawn.front});
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
    // In the plane of its polygon, from which the weld may have bent it a little.
    const double along = glm::dot(doubleArea, piece.normal);
    out.normal.push_back(onGrid(along < 0.0 ? -piece.normal : piece.normal, normalGrid));
    out.area_m2.push_back(0.5 * std::abs(along));
    out.polygon.push_back(
        polygonOf.try_emplace(piece.polygon, static_cast<std::uint32_t>(polygonOf.size())).first->second);
    out.surface.push_back(surfaceOf.at({piece.object, piece.material}));
    out.material.push_back(piece.material);
    out.isDrawnForBack.push_back(piece.isDrawnForBack);
  }
}

/// Triangles of a ring and of the holes in it.
std::size_t trianglesIn(const PlanarPolygon& polygon) {
  std::size_t count = polygon.outer.size() - 2;
  for (const Loop& hole : polygon.holes) count += hole.size() + 2;
  return count;
}

void addSize(CleanupCounts& counts, const char* step, const PolygonList& faces) {
  counts.sizes.push_back({step, faces.size(), faces.corners.size() - 2 * faces.size()});
}

void addSize(CleanupCounts& counts, const char* step, std::span<const DividedPolygon> divided) {
  StepSize& size = counts.sizes.emplace_back(step, divided.size());
  for (const DividedPolygon& each : divided) size.triangles += trianglesIn(each.polygon);
}

}  // namespace

CleanModel cleanScene(const Scene& drawn) {
  const Tolerances tolerances;
  const PlanFrame frame = ownFrameOf(drawn.points, drawn.faces);
  const Scene scene = sceneIn(frame, tolerances, drawn);
  const NameRanks ranks = rankNames(scene);
  CleanModel model;
  model.materials = scene.materials;
  model.luminaires = luminairesOf(scene.lights);
  model.axes = scene.axes;

  Findings findings(scene.objects);
  addSize(model.counts, scene.cages.empty() ? "faces as read" : "faces as read, without cages", scene.faces);
  Soup soup = collectFaces(scene, tolerances, model, findings);
  if (!scene.cages.empty()) addSize(model.counts, "with facets of subdivision cages", soup.faces);
  windCanonically(soup, isMirrored(frame));
  soup = weld(soup, tolerances, model.counts);
  dropDegenerateFaces(soup, tolerances, model.counts, findings);
  sortFaces(soup, ranks);
  addSize(model.counts, "welded, without degenerate faces", soup.faces);
  dropDuplicateFaces(soup, scene.materials, ranks, model.counts, findings);
  addSize(model.counts, "without duplicates", soup.faces);
  splitWarpedFaces(soup, tolerances, model.counts, findings);
  addSize(model.counts, "non-planar faces split", soup.faces);

  std::vector<PlanarPolygon> polygons = mergeCoplanar(soup, tolerances, findings);
  dropDuplicatePolygons(soup, ranks, polygons, model, findings);
  std::vector<DividedPolygon> divided = divide(soup, std::move(polygons), tolerances, findings);
  addSize(model.counts, "coplanar neighbours merged", divided);
  dropFurtherPaneSheets(soup.points, scene.materials, tolerances, divided, model.counts);
  model.counts.polygons = divided.size();
  addSize(model.counts, "one sheet a pane", divided);

  const std::vector<Piece> pieces = orderPieces(soup, ranks, std::move(divided));
  model.counts.pieces = pieces.size();
  assemble(scene, soup, pieces, model);
  addSize(model.counts, "convex pieces", model.pieces.polygons);
  turnOutOf(frame, model.pieces);
  model.diagnoses = findings.diagnoses();
  model.marks = findings.marks();
  for (Diagnosis& diagnosis : model.diagnoses)
    if (diagnosis.place_m) diagnosis.place_m = outOfFrame(frame, *diagnosis.place_m);
  for (Mark& mark : model.marks) mark.place_m = outOfFrame(frame, mark.place_m);
  return model;
}

}  // namespace clerestory
