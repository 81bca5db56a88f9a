// SPDX-License-Identifier: GPL-3.0-or-later
// Hands a cage to OpenSubdiv once nothing in it can hurt.
#include "limitcage.hpp"

#include <glm/vec3.hpp>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <utility>

namespace clerestory {
namespace {

using namespace OpenSubdiv;
using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;

constexpr std::size_t mostCorners = 1000;  ///< of one face

/// The cage in OpenSubdiv's terms: only its own points, numbered by first use.
struct LocalCage {
  std::vector<double> points;  ///< 3 × #points
  std::vector<int> faceSizes, corners, creaseEnds, cornerPoints, holes;
  std::vector<float> creaseWeights, cornerWeights;
};

/// Empty where an index is out of range or a face cannot be subdivided: OpenSubdiv must not see it.
std::optional<LocalCage> checkedCage(const Scene& scene, const Cage& cage, double grid_m) {
  LocalCage local;
  std::unordered_map<std::uint32_t, int> numberOf;
  for (std::size_t face = 0; face < cage.faces.size(); ++face) {
    const auto corners = cage.faces[face];
    const bool sizeFits = cage.scheme == Cage::Scheme::loop
                              ? corners.size() == 3
                              : corners.size() >= 3 && corners.size() <= mostCorners;
    if (!sizeFits) return std::nullopt;
    local.faceSizes.push_back(static_cast<int>(corners.size()));
    for (const std::uint32_t corner : corners) {
      if (corner >= scene.points.size()) return std::nullopt;
      const auto [number, isNew] = numberOf.try_emplace(corner, static_cast<int>(numberOf.size()));
      if (isNew) {
        // On the grid already here: rates must not depend on how a file rounds.
        const glm::dvec3 point = onGrid(scene.points[corner], grid_m);
        for (int i = 0; i < 3; ++i) local.points.push_back(point[i]);
      }
      local.corners.push_back(number->second);
    }
  }
  const auto isOwn = [&](std::uint32_t point) { return numberOf.contains(point); };
  for (const Cage::Crease& crease : cage.creases) {
    if (!isOwn(crease.a) || !isOwn(crease.b)) return std::nullopt;
    local.creaseEnds.push_back(numberOf[crease.a]);
    local.creaseEnds.push_back(numberOf[crease.b]);
    local.creaseWeights.push_back(crease.sharpness);
  }
  for (const Cage::Corner& corner : cage.corners) {
    if (!isOwn(corner.point)) return std::nullopt;
    local.cornerPoints.push_back(numberOf[corner.point]);
    local.cornerWeights.push_back(corner.sharpness);
  }
  for (const std::uint32_t hole : cage.holes) {
    if (hole >= cage.faces.size()) return std::nullopt;
    local.holes.push_back(static_cast<int>(hole));
  }
  return local;
}

std::unique_ptr<Far::TopologyRefiner> makeRefiner(const LocalCage& local, const Cage& cage) {
  Far::TopologyDescriptor descriptor;
  descriptor.numVertices = static_cast<int>(local.points.size() / 3);
  descriptor.numFaces = static_cast<int>(local.faceSizes.size());
  descriptor.numVertsPerFace = local.faceSizes.data();
  descriptor.vertIndicesPerFace = local.corners.data();
  descriptor.numCreases = static_cast<int>(local.creaseWeights.size());
  descriptor.creaseVertexIndexPairs = local.creaseEnds.data();
  descriptor.creaseWeights = local.creaseWeights.data();
  descriptor.numCorners = static_cast<int>(local.cornerWeights.size());
  descriptor.cornerVertexIndices = local.cornerPoints.data();
  descriptor.cornerWeights = local.cornerWeights.data();
  descriptor.numHoles = static_cast<int>(local.holes.size());
  descriptor.holeIndices = local.holes.data();

  Sdc::Options rules;
  // Without interpolation the boundary faces would have no limit surface: their edges are kept instead.
  rules.SetVtxBoundaryInterpolation(cage.boundary == Cage::Boundary::edgeAndCorner
                                        ? Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER
                                        : Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
  const Sdc::SchemeType scheme = cage.scheme == Cage::Scheme::catmark ? Sdc::SCHEME_CATMARK
                                 : cage.scheme == Cage::Scheme::loop  ? Sdc::SCHEME_LOOP
                                                                      : Sdc::SCHEME_BILINEAR;
  Factory::Options options(scheme, rules);
  options.validateFullTopology = true;
  return std::unique_ptr<Far::TopologyRefiner>(Factory::Create(descriptor, options));
}

/// One step of subdivision: the same limit surface from faces that all have four corners.
LocalCage afterOneStep(const LocalCage& local, Far::TopologyRefiner& refiner) {
  struct Point {
    double p[3];
    void Clear() { p[0] = p[1] = p[2] = 0.0; }
    void AddWithWeight(const Point& other, float weight) {
      for (int i = 0; i < 3; ++i) p[i] += static_cast<double>(weight) * other.p[i];
    }
  };
  Far::TopologyRefiner::UniformOptions once(1);
  once.fullTopologyInLastLevel = true;
  refiner.RefineUniform(once);
  const Far::TopologyLevel& level = refiner.GetLevel(1);
  std::vector<Point> from(local.points.size() / 3);
  for (std::size_t i = 0; i < local.points.size(); ++i) from[i / 3].p[i % 3] = local.points[i];
  std::vector<Point> to(static_cast<std::size_t>(level.GetNumVertices()));
  Point* target = to.data();
  Far::PrimvarRefiner(refiner).Interpolate(1, from.data(), target);

  LocalCage refined;
  for (const Point& point : to)
    refined.points.insert(refined.points.end(), std::begin(point.p), std::end(point.p));
  for (int face = 0; face < level.GetNumFaces(); ++face) {
    const auto corners = level.GetFaceVertices(face);
    refined.faceSizes.push_back(corners.size());
    refined.corners.insert(refined.corners.end(), corners.begin(), corners.end());
    if (level.IsFaceHole(face)) refined.holes.push_back(face);
  }
  for (int edge = 0; edge < level.GetNumEdges(); ++edge) {
    if (const float sharpness = level.GetEdgeSharpness(edge); sharpness > 0.0F) {
      const auto ends = level.GetEdgeVertices(edge);
      refined.creaseEnds.insert(refined.creaseEnds.end(), {ends[0], ends[1]});
      refined.creaseWeights.push_back(sharpness);
    }
  }
  for (int vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
    if (const float sharpness = level.GetVertexSharpness(vertex); sharpness > 0.0F) {
      refined.cornerPoints.push_back(vertex);
      refined.cornerWeights.push_back(sharpness);
    }
  }
  return refined;
}

}  // namespace

std::optional<LimitCage> limitCage(const Scene& scene, const Cage& cage, double grid_m) {
  std::optional<LocalCage> local = checkedCage(scene, cage, grid_m);
  std::unique_ptr<Far::TopologyRefiner> refiner = local ? makeRefiner(*local, cage) : nullptr;
  if (!refiner) return std::nullopt;
  const bool isRegular = cage.scheme == Cage::Scheme::loop ||
                         std::ranges::all_of(local->faceSizes, [](int size) { return size == 4; });
  if (!isRegular) {
    local = afterOneStep(*local, *refiner);
    refiner = makeRefiner(*local, cage);
    if (!refiner) return std::nullopt;
  }
  return LimitCage{std::move(local->points), std::move(refiner)};
}

bool takesSurfaces(const LimitCage& cage) {
  const Far::TopologyLevel& level = cage.refiner->GetLevel(0);
  for (int vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
    if (level.GetVertexFaces(vertex).size() < 3 && !level.IsVertexBoundary(vertex)) return false;
  }
  return true;
}

}  // namespace clerestory
