// SPDX-License-Identifier: GPL-3.0-or-later
// Subdivision cages become facets of their limit surfaces.
//
// The rate of an edge follows from its limit curve alone and its points are evaluated once, from one face, so
// neighbours agree to the bit. Inside a face the rate is raised until its facets keep to the surface. Flat
// parts need no care here: their facets are merged again with their plane.
#include "subdivision.hpp"

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>
#include <opensubdiv/bfr/tessellation.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

namespace clerestory {
namespace {

using namespace OpenSubdiv;
using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;

constexpr int highestRate = 64;
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
  std::vector<int> numberOf(scene.points.size(), -1);
  for (std::size_t face = 0; face < cage.faces.size(); ++face) {
    const auto corners = cage.faces[face];
    const bool sizeFits = cage.scheme == Cage::Scheme::loop
                              ? corners.size() == 3
                              : corners.size() >= 3 && corners.size() <= mostCorners;
    if (!sizeFits) return std::nullopt;
    local.faceSizes.push_back(static_cast<int>(corners.size()));
    for (const std::uint32_t corner : corners) {
      if (corner >= scene.points.size()) return std::nullopt;
      if (numberOf[corner] < 0) {
        numberOf[corner] = static_cast<int>(local.points.size() / 3);
        // On the grid already here: rates must not depend on how a file rounds.
        const glm::dvec3 point = onGrid(scene.points[corner], grid_m);
        for (int i = 0; i < 3; ++i) local.points.push_back(point[i]);
      }
      local.corners.push_back(numberOf[corner]);
    }
  }
  const auto isOwn = [&](std::uint32_t point) { return point < numberOf.size() && numberOf[point] >= 0; };
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

/// The limit surface of one face, ready to be evaluated.
class FaceSurface {
 public:
  FaceSurface(const Bfr::RefinerSurfaceFactory<>& factory, int face, const std::vector<double>& cage) {
    if (!factory.InitVertexSurface(face, &surface_)) return;
    patch_.resize(3 * static_cast<std::size_t>(surface_.GetNumPatchPoints()));
    surface_.PreparePatchPoints(cage.data(), 3, patch_.data(), 3);
  }

  explicit operator bool() const { return surface_.IsValid(); }
  [[nodiscard]] Bfr::Parameterization parameterization() const { return surface_.GetParameterization(); }

  [[nodiscard]] glm::dvec3 at(const double* uv) const {
    glm::dvec3 point;
    surface_.Evaluate(uv, patch_.data(), 3, &point.x);
    return point;
  }
  [[nodiscard]] glm::dvec3 onEdge(int edge, double t) const {
    double uv[2];
    parameterization().GetEdgeCoord(edge, t, uv);
    return at(uv);
  }

 private:
  Bfr::Surface<double> surface_;
  std::vector<double> patch_;
};

double distanceToChord(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 way = b - a;
  const double squared = glm::dot(way, way);
  const double along = squared > 0.0 ? glm::clamp(glm::dot(point - a, way) / squared, 0.0, 1.0) : 0.0;
  return glm::length(point - a - along * way);
}

double distanceToPlane(const glm::dvec3& point, const std::array<glm::dvec3, 3>& triangle) {
  const glm::dvec3 normal = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  const double length = glm::length(normal);
  return length > 0.0 ? std::abs(glm::dot(point - triangle[0], normal)) / length : 0.0;
}

/// The lowest rate whose chords keep to the curve of an edge.
int rateOfEdge(const FaceSurface& surface, int edge, double tolerance_m) {
  for (int rate = 1; rate < highestRate; rate = rate < 4 ? rate + 1 : rate + rate / 2) {
    double worst = 0.0;
    for (int i = 0; i < rate; ++i) {
      const auto place = [&](double t) { return surface.onEdge(edge, (i + t) / rate); };
      const glm::dvec3 a = place(0.0);
      const glm::dvec3 b = place(1.0);
      for (const double t : {0.25, 0.5, 0.75}) worst = std::max(worst, distanceToChord(place(t), a, b));
    }
    if (worst <= tolerance_m) return rate;
  }
  return highestRate;
}

/// One face's tessellation: parameters of its points, boundary first, and its facets.
struct Pattern {
  std::vector<double> uv;
  std::vector<glm::dvec3> points;
  std::vector<std::array<int, 4>> facets;  ///< the last is -1 for triangles
  std::size_t boundary = 0;
};

Pattern makePattern(const FaceSurface& surface, const std::vector<int>& rates) {
  Bfr::Tessellation::Options options;
  options.SetFacetSize(4).PreserveQuads(true);
  const Bfr::Tessellation tessellation(surface.parameterization(), static_cast<int>(rates.size()),
                                       rates.data(), options);
  Pattern pattern;
  if (!tessellation.IsValid()) return pattern;
  pattern.uv.resize(2 * static_cast<std::size_t>(tessellation.GetNumCoords()));
  tessellation.GetCoords(pattern.uv.data());
  pattern.facets.resize(static_cast<std::size_t>(tessellation.GetNumFacets()));
  tessellation.GetFacets(pattern.facets.front().data());
  pattern.boundary = static_cast<std::size_t>(tessellation.GetNumBoundaryCoords());
  for (std::size_t i = 0; i < pattern.uv.size(); i += 2) pattern.points.push_back(surface.at(&pattern.uv[i]));
  return pattern;
}

/// Largest distance of the surface from the pattern's triangles, at their middles and their sides'.
double facetError_m(const FaceSurface& surface, const Pattern& pattern) {
  const Bfr::Parameterization domain = surface.parameterization();
  const auto uv = [&](int i) { return &pattern.uv[2 * static_cast<std::size_t>(i)]; };
  const auto error = [&](int a, int b, int c) {
    // Parameters of a face in parts jump between them: only triangles within one part can be judged.
    if (domain.HasSubFaces() && (domain.GetSubFace(uv(a)) != domain.GetSubFace(uv(b)) ||
                                 domain.GetSubFace(uv(a)) != domain.GetSubFace(uv(c)))) {
      return 0.0;
    }
    const auto point = [&](int i) { return pattern.points[static_cast<std::size_t>(i)]; };
    const std::array<glm::dvec3, 3> triangle{point(a), point(b), point(c)};
    double most = 0.0;
    constexpr double weights[4][3] = {
        {1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.5, 0.5, 0.0}, {0.0, 0.5, 0.5}, {0.5, 0.0, 0.5}};
    for (const auto& w : weights) {
      const double place[2] = {w[0] * uv(a)[0] + w[1] * uv(b)[0] + w[2] * uv(c)[0],
                               w[0] * uv(a)[1] + w[1] * uv(b)[1] + w[2] * uv(c)[1]};
      most = std::max(most, distanceToPlane(surface.at(place), triangle));
    }
    return most;
  };
  double worst = 0.0;
  for (const auto& facet : pattern.facets) {
    worst = std::max(worst, error(facet[0], facet[1], facet[2]));
    if (facet[3] >= 0) worst = std::max(worst, error(facet[0], facet[2], facet[3]));
  }
  return worst;
}

/// Raises the inner rates until the facets keep to the surface.
Pattern fittingPattern(const FaceSurface& surface, std::vector<int> rates, double tolerance_m) {
  const std::size_t edges = rates.size();
  if (surface.parameterization().GetType() == Bfr::Parameterization::QUAD) {
    rates.push_back(std::max(rates[0], rates[2]));
    rates.push_back(std::max(rates[1], rates[3]));
  } else {
    rates.push_back(*std::max_element(rates.begin(), rates.end()));
  }
  for (;;) {
    Pattern pattern = makePattern(surface, rates);
    const bool isFine = rates[edges] >= highestRate && rates.back() >= highestRate;
    if (pattern.facets.empty() || isFine || facetError_m(surface, pattern) <= tolerance_m) return pattern;
    for (std::size_t i = edges; i < rates.size(); ++i)
      rates[i] = std::min(highestRate, rates[i] + (rates[i] + 1) / 2);
  }
}

/// Builds the facets of one cage; points of the cage's vertices and edges are shared between its faces.
class CageFacets {
 public:
  CageFacets(const Far::TopologyRefiner& refiner, const LocalCage& local, double tolerance_m, double planar_m,
             Soup& soup)
      : level_(refiner.GetLevel(0)),
        local_(local),
        factory_(refiner),
        tolerance_m_(tolerance_m),
        planar_m_(planar_m),
        soup_(soup),
        vertexPoint_(static_cast<std::size_t>(level_.GetNumVertices()), none),
        edges_(static_cast<std::size_t>(level_.GetNumEdges())) {}

  /// Returns the number of facets; `withoutLimit` counts faces that have no limit surface.
  std::size_t build(const Cage& cage, std::size_t& withoutLimit) {
    std::size_t facets = 0;
    for (int face = 0; face < level_.GetNumFaces(); ++face) {
      if (level_.IsFaceHole(face)) continue;
      const FaceSurface surface(factory_, face, local_.points);
      if (!surface) {
        ++withoutLimit;
        continue;
      }
      const std::vector<int> rates = shareEdges(face, surface);
      const Pattern pattern = fittingPattern(surface, rates, tolerance_m_);
      const Loop points = pointsOf(face, pattern);
      for (const auto& facet : pattern.facets) facets += addFacet(cage, points, facet);
    }
    return facets;
  }

 private:
  static constexpr std::uint32_t none = 0xffffffffU;
  struct Edge {
    int rate = 0;  ///< 0: not met yet
    int firstVertex = -1;
    Loop inner;  ///< from the first vertex on
  };

  /// Adds one facet, or the two triangles of a warped one; returns how many.
  std::size_t addFacet(const Cage& cage, const Loop& points, const std::array<int, 4>& facet) {
    Loop corners;
    for (const int corner : facet) {
      if (corner >= 0) corners.push_back(points[static_cast<std::size_t>(corner)]);
    }
    const auto add = [&](const Loop& loop) {
      soup_.faces.add(loop);
      soup_.material.push_back(cage.material);
      soup_.object.push_back(cage.object);
    };
    if (corners.size() == 4) {
      const auto at = [&](std::size_t i) { return soup_.points[corners[i]]; };
      // The fourth corner stands off the plane of the others by about twice the warp about the mean plane.
      if (distanceToPlane(at(3), {at(0), at(1), at(2)}) > planar_m_) {
        add({corners[0], corners[1], corners[2]});
        add({corners[0], corners[2], corners[3]});
        return 2;
      }
    }
    add(corners);
    return 1;
  }

  std::uint32_t addPoint(const glm::dvec3& point) {
    soup_.points.push_back(point);
    return static_cast<std::uint32_t>(soup_.points.size() - 1);
  }

  /// Rates of the face's edges; evaluates the points of edges and vertices that no face before it had.
  std::vector<int> shareEdges(int face, const FaceSurface& surface) {
    const auto vertices = level_.GetFaceVertices(face);
    const auto edges = level_.GetFaceEdges(face);
    std::vector<int> rates;
    for (int i = 0; i < edges.size(); ++i) {
      std::uint32_t& corner = vertexPoint_[static_cast<std::size_t>(vertices[i])];
      if (corner == none) corner = addPoint(surface.onEdge(i, 0.0));
      Edge& edge = edges_[static_cast<std::size_t>(edges[i])];
      if (edge.rate == 0) {
        edge.rate = rateOfEdge(surface, i, tolerance_m_);
        edge.firstVertex = vertices[i];
        for (int k = 1; k < edge.rate; ++k) {
          edge.inner.push_back(addPoint(surface.onEdge(i, static_cast<double>(k) / edge.rate)));
        }
      }
      rates.push_back(edge.rate);
    }
    return rates;
  }

  /// Indices in the soup of the pattern's points.
  Loop pointsOf(int face, const Pattern& pattern) {
    const auto vertices = level_.GetFaceVertices(face);
    const auto edges = level_.GetFaceEdges(face);
    Loop points;
    for (int i = 0; i < edges.size(); ++i) {
      points.push_back(vertexPoint_[static_cast<std::size_t>(vertices[i])]);
      const Edge& edge = edges_[static_cast<std::size_t>(edges[i])];
      if (edge.firstVertex == vertices[i]) {
        points.insert(points.end(), edge.inner.begin(), edge.inner.end());
      } else {
        points.insert(points.end(), edge.inner.rbegin(), edge.inner.rend());
      }
    }
    for (std::size_t i = pattern.boundary; i < pattern.points.size(); ++i)
      points.push_back(addPoint(pattern.points[i]));
    return points;
  }

  const Far::TopologyLevel& level_;
  const LocalCage& local_;
  Bfr::RefinerSurfaceFactory<> factory_;
  double tolerance_m_;
  double planar_m_;
  Soup& soup_;
  Loop vertexPoint_;
  std::vector<Edge> edges_;
};

}  // namespace

void tessellateCage(const Scene& scene, const Cage& cage, const Tolerances& tolerances, Soup& soup,
                    CleanupCounts& counts, std::vector<Diagnosis>& diagnoses) {
  const std::string name = cage.object < scene.objects.size() ? scene.objects[cage.object] : "";
  if (cage.faces.size() == 0) return;
  const std::optional<LocalCage> local = checkedCage(scene, cage, tolerances.grid_m);
  const std::unique_ptr<Far::TopologyRefiner> refiner = local ? makeRefiner(*local, cage) : nullptr;
  if (!refiner) {
    addDiagnosis(diagnoses, {"G210", "a subdivision cage could not be read and was left out", name});
    return;
  }
  if (cage.boundary == Cage::Boundary::none) {
    addDiagnosis(
        diagnoses,
        {"G211", "a subdivision cage without boundary interpolation was given smooth boundary edges", name});
  }
  constexpr double finest_m = 1e-4;
  std::size_t withoutLimit = 0;
  CageFacets facets(*refiner, *local, std::max(cage.tolerance_m, finest_m), tolerances.planar_m, soup);
  counts.cageFacets += facets.build(cage, withoutLimit);
  if (withoutLimit > 0) {
    addDiagnosis(diagnoses, {"G212", "faces of a subdivision cage have no limit surface and were left out",
                             name, withoutLimit});
  }
}

}  // namespace clerestory
