// SPDX-License-Identifier: GPL-3.0-or-later
// Hands a cage to OpenSubdiv once nothing in it can hurt.
#include "limitcage.hpp"

#include <glm/vec3.hpp>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <utility>

namespace clerestory {
namespace {

using namespace OpenSubdiv;
using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;

constexpr int mostCorners = 1000;  ///< of one face
constexpr int mostFaces = 1000;    ///< at one vertex

/// The cage in OpenSubdiv's terms: only its own points, numbered by first use, cut where it is no surface.
struct LocalCage {
  std::vector<double> points;  ///< 3 × #points
  std::vector<int> faceSizes, corners, creaseEnds, cornerPoints, holes;
  std::vector<float> creaseWeights, cornerWeights;
};

/// Which corners of faces are one: a forest of corners with a root for each.
class CornerSets {
 public:
  explicit CornerSets(std::size_t corners) : parent_(corners) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  std::uint32_t root(std::uint32_t corner) {
    while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
    return corner;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

/// A face's edge: the corners at its ends.
struct EdgeUse {
  std::uint32_t a, b;  ///< points, a < b
  std::uint32_t atA, atB;
  std::uint32_t face;
  bool forward;
};

std::vector<EdgeUse> edgeUses(const PolygonList& faces) {
  std::vector<EdgeUse> uses;
  for (std::uint32_t face = 0; face < faces.size(); ++face) {
    const std::uint32_t begin = faces.begin[face];
    const auto count = static_cast<std::uint32_t>(faces[face].size());
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t from = begin + i;
      const std::uint32_t to = begin + (i + 1) % count;
      const bool forward = faces.corners[from] < faces.corners[to];
      uses.push_back({faces.corners[forward ? from : to], faces.corners[forward ? to : from],
                      forward ? from : to, forward ? to : from, face, forward});
    }
  }
  std::ranges::stable_sort(uses, {}, [](const EdgeUse& use) { return std::pair(use.a, use.b); });
  return uses;
}

/// Calls `visit` with the uses of each edge.
template <class Visit>
void forEachEdge(std::span<const EdgeUse> uses, const Visit& visit) {
  for (std::size_t first = 0; first < uses.size();) {
    std::size_t end = first;
    while (end < uses.size() && uses[end].a == uses[first].a && uses[end].b == uses[first].b) ++end;
    visit(uses.subspan(first, end - first));
    first = end;
  }
}

/// The vertex of each corner. Faces share vertices across edges where two of them meet, wound alike; at all
/// other edges the surface is cut, which is what subdivision makes of them anyway: boundaries. (OpenSubdiv's
/// Bfr reads beyond its arrays where three faces meet at an edge.)
std::vector<int> cutVertices(const PolygonList& faces, std::span<const EdgeUse> uses) {
  CornerSets sets(faces.corners.size());
  forEachEdge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 2 && edge[0].face != edge[1].face && edge[0].forward != edge[1].forward) {
      sets.join(edge[0].atA, edge[1].atA);
      sets.join(edge[0].atB, edge[1].atB);
    }
  });
  std::vector<int> vertexOf(faces.corners.size(), -1);
  std::vector<int> vertices;
  int count = 0;
  for (std::uint32_t corner = 0; corner < faces.corners.size(); ++corner) {
    int& vertex = vertexOf[sets.root(corner)];
    if (vertex < 0) vertex = count++;
    vertices.push_back(vertex);
  }
  return vertices;
}

bool isInRange(const Scene& scene, const Cage& cage) {
  for (std::size_t face = 0; face < cage.faces.size(); ++face) {
    const std::size_t size = cage.faces[face].size();
    if (size < 3 || size > (cage.scheme == Cage::Scheme::loop ? 3U : std::size_t{mostCorners})) return false;
  }
  const auto isPoint = [&](std::uint32_t point) { return point < scene.points.size(); };
  return std::ranges::all_of(cage.faces.corners, isPoint) &&
         std::ranges::all_of(cage.creases, [&](const auto& c) { return isPoint(c.a) && isPoint(c.b); }) &&
         std::ranges::all_of(cage.corners, [&](const auto& c) { return isPoint(c.point); }) &&
         std::ranges::all_of(cage.holes, [&](std::uint32_t hole) { return hole < cage.faces.size(); });
}

/// Creases and corners at all vertices that are left of their points.
void addTags(const Cage& cage, std::span<const EdgeUse> uses, std::span<const int> vertices,
             LocalCage& local) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, float> creases;
  for (const Cage::Crease& crease : cage.creases) {
    creases[std::minmax(crease.a, crease.b)] = crease.sharpness;
  }
  std::set<std::pair<int, int>> known;
  for (const EdgeUse& use : uses) {
    const auto crease = creases.find({use.a, use.b});
    if (crease == creases.end() || !known.emplace(vertices[use.atA], vertices[use.atB]).second) continue;
    local.creaseEnds.insert(local.creaseEnds.end(), {vertices[use.atA], vertices[use.atB]});
    local.creaseWeights.push_back(crease->second);
  }
  std::map<std::uint32_t, float> corners;
  for (const Cage::Corner& corner : cage.corners) corners[corner.point] = corner.sharpness;
  std::set<int> sharp;
  for (std::size_t i = 0; i < cage.faces.corners.size(); ++i) {
    const auto corner = corners.find(cage.faces.corners[i]);
    if (corner == corners.end() || !sharp.insert(vertices[i]).second) continue;
    local.cornerPoints.push_back(vertices[i]);
    local.cornerWeights.push_back(corner->second);
  }
}

/// Empty where an index is out of range or a face cannot be subdivided: OpenSubdiv must not see it.
std::optional<LocalCage> checkedCage(const Scene& scene, const Cage& cage, double grid_m) {
  if (!isInRange(scene, cage)) return std::nullopt;
  const std::vector<EdgeUse> uses = edgeUses(cage.faces);
  LocalCage local;
  local.corners = cutVertices(cage.faces, uses);
  for (std::size_t i = 0; i < local.corners.size(); ++i) {
    if (static_cast<std::size_t>(local.corners[i]) < local.points.size() / 3) continue;
    // On the grid already here: rates must not depend on how a file rounds.
    const glm::dvec3 point = onGrid(scene.points[cage.faces.corners[i]], grid_m);
    for (int c = 0; c < 3; ++c) local.points.push_back(point[c]);
  }
  for (std::size_t face = 0; face < cage.faces.size(); ++face) {
    local.faceSizes.push_back(static_cast<int>(cage.faces[face].size()));
  }
  addTags(cage, uses, local.corners, local);
  local.holes.assign(cage.holes.begin(), cage.holes.end());
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
    const int faces = level.GetVertexFaces(vertex).size();
    if (faces > mostFaces || (faces < 3 && !level.IsVertexBoundary(vertex))) return false;
  }
  return true;
}

}  // namespace clerestory
