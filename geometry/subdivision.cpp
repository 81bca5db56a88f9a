// SPDX-License-Identifier: GPL-3.0-or-later
// Subdivision cages become facets of their limit surfaces.
//
// Rates of edges are raised until the facets of their faces keep to the surface; a face's inside has the
// rates of its edges, so its facets are quadrilaterals in rows where opposite edges agree. An edge's points
// are evaluated once, from one face, so neighbours agree to the bit. Flat parts need no care here: their
// facets are merged again with their plane.
#include "subdivision.hpp"

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>
#include <opensubdiv/bfr/tessellation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "limitcage.hpp"

namespace clerestory {
namespace {

using namespace OpenSubdiv;

constexpr int highestRate = 64;

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

int raised(int rate) {
  return std::min(highestRate, rate + std::max(1, rate / 4));
}

/// The lowest rate whose chords keep to the curve of an edge.
int rateOfEdge(const FaceSurface& surface, int edge, double tolerance_m) {
  for (int rate = 1; rate < highestRate; rate = raised(rate)) {
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

/// With a rate for each edge; inside, the larger one of each direction.
Pattern makePattern(const FaceSurface& surface, std::vector<int> rates) {
  if (rates.size() == 4) {
    rates.insert(rates.end(), {std::max(rates[0], rates[2]), std::max(rates[1], rates[3])});
  } else {
    rates.push_back(*std::max_element(rates.begin(), rates.end()));
  }
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
  const auto uv = [&](int i) { return &pattern.uv[2 * static_cast<std::size_t>(i)]; };
  const auto error = [&](int a, int b, int c) {
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

/// Builds the facets of one cage; points of the cage's vertices and edges are shared between its faces.
class CageFacets {
 public:
  CageFacets(const LimitCage& cage, double tolerance_m, double planar_m, Soup& soup)
      : level_(cage.refiner->GetLevel(0)),
        tolerance_m_(tolerance_m),
        planar_m_(planar_m),
        soup_(soup),
        vertexPoint_(static_cast<std::size_t>(level_.GetNumVertices()), none),
        edges_(static_cast<std::size_t>(level_.GetNumEdges())) {
    const Bfr::RefinerSurfaceFactory<> factory(*cage.refiner);
    for (int face = 0; face < level_.GetNumFaces(); ++face)
      surfaces_.emplace_back(factory, face, cage.points);
  }

  /// Whether every face but holes has a limit surface.
  [[nodiscard]] bool isWhole() const {
    for (int face = 0; face < level_.GetNumFaces(); ++face) {
      if (!level_.IsFaceHole(face) && !surfaces_[static_cast<std::size_t>(face)]) return false;
    }
    return true;
  }

  /// Returns the number of facets; the cage has to be whole.
  std::size_t build(const Cage& cage) {
    chooseRates();
    std::size_t facets = 0;
    for (int face = 0; face < level_.GetNumFaces(); ++face) {
      if (level_.IsFaceHole(face)) continue;
      const FaceSurface& surface = surfaces_[static_cast<std::size_t>(face)];
      evaluateEdges(face, surface);
      const Pattern pattern = makePattern(surface, ratesOf(face));
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

  [[nodiscard]] std::vector<int> ratesOf(int face) const {
    std::vector<int> rates;
    for (const int edge : level_.GetFaceEdges(face))
      rates.push_back(edges_[static_cast<std::size_t>(edge)].rate);
    return rates;
  }

  /// Edges first by their own curves; then, in rounds, those of the faces whose facets leave the surface. In
  /// a round every face sees the same rates, so like faces of a symmetric cage come out alike.
  void chooseRates() {
    std::set<int> pending;
    for (int face = 0; face < level_.GetNumFaces(); ++face) {
      if (level_.IsFaceHole(face)) continue;
      pending.insert(face);
      const auto edges = level_.GetFaceEdges(face);
      for (int i = 0; i < edges.size(); ++i) {
        int& rate = edges_[static_cast<std::size_t>(edges[i])].rate;
        if (rate == 0) rate = rateOfEdge(surfaces_[static_cast<std::size_t>(face)], i, tolerance_m_);
      }
    }
    while (!pending.empty()) {
      std::map<int, int> raises;  // by edge
      for (const int face : pending) {
        const std::vector<int> rates = ratesOf(face);
        if (errorOf(face, rates) <= tolerance_m_) continue;
        const std::vector<int> better = bestRaise(face, rates);
        const auto edges = level_.GetFaceEdges(face);
        for (int i = 0; i < edges.size(); ++i) {
          const auto at = static_cast<std::size_t>(i);
          if (better[at] > rates[at]) raises[edges[i]] = std::max(raises[edges[i]], better[at]);
        }
      }
      pending.clear();
      for (const auto& [edge, rate] : raises) {
        edges_[static_cast<std::size_t>(edge)].rate = rate;
        for (const int beside : level_.GetEdgeFaces(edge)) {
          if (!level_.IsFaceHole(beside)) pending.insert(beside);
        }
      }
    }
  }

  /// No error where no rate can help any more.
  [[nodiscard]] double errorOf(int face, const std::vector<int>& rates) const {
    const FaceSurface& surface = surfaces_[static_cast<std::size_t>(face)];
    const bool isFinest = std::ranges::all_of(rates, [](int rate) { return rate >= highestRate; });
    return isFinest ? 0.0 : facetError_m(surface, makePattern(surface, rates));
  }

  /// Of a face with four edges, the direction is raised that gains more; else all edges.
  [[nodiscard]] std::vector<int> bestRaise(int face, const std::vector<int>& rates) const {
    const auto with = [&](std::size_t first, std::size_t step) {
      std::vector<int> more = rates;
      for (std::size_t i = first; i < more.size(); i += step) more[i] = raised(more[i]);
      return more;
    };
    if (rates.size() != 4) return with(0, 1);
    const std::vector<int> along = with(0, 2);
    const std::vector<int> across = with(1, 2);
    if (along == rates || across == rates) return with(0, 1);
    return errorOf(face, along) <= errorOf(face, across) ? along : across;
  }

  /// Evaluates the points of edges and vertices that no face before it had.
  void evaluateEdges(int face, const FaceSurface& surface) {
    const auto vertices = level_.GetFaceVertices(face);
    const auto edges = level_.GetFaceEdges(face);
    for (int i = 0; i < edges.size(); ++i) {
      std::uint32_t& corner = vertexPoint_[static_cast<std::size_t>(vertices[i])];
      if (corner == none) corner = addPoint(surface.onEdge(i, 0.0));
      Edge& edge = edges_[static_cast<std::size_t>(edges[i])];
      if (edge.firstVertex < 0) {
        edge.firstVertex = vertices[i];
        for (int k = 1; k < edge.rate; ++k) {
          edge.inner.push_back(addPoint(surface.onEdge(i, static_cast<double>(k) / edge.rate)));
        }
      }
    }
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
  std::vector<FaceSurface> surfaces_;  ///< #faces
  double tolerance_m_;
  double planar_m_;
  Soup& soup_;
  Loop vertexPoint_;
  std::vector<Edge> edges_;
};

/// The cage's own faces.
void addDrawn(const Scene& scene, const Cage& cage, Soup& soup) {
  std::map<std::uint32_t, std::uint32_t> pointOf;
  for (std::uint32_t face = 0; face < cage.faces.size(); ++face) {
    if (std::ranges::binary_search(cage.holes, face)) continue;
    Loop corners;
    for (const std::uint32_t corner : cage.faces[face]) {
      const auto [point, isNew] = pointOf.try_emplace(corner, static_cast<std::uint32_t>(soup.points.size()));
      if (isNew) soup.points.push_back(scene.points[corner]);
      corners.push_back(point->second);
    }
    soup.faces.add(corners);
    soup.material.push_back(cage.material);
    soup.object.push_back(cage.object);
  }
}

}  // namespace

void tessellateCage(const Scene& scene, const Cage& cage, const Tolerances& tolerances, Soup& soup,
                    CleanupCounts& counts, Findings& findings) {
  if (cage.faces.size() == 0) return;
  const auto note = [&](const char* code, std::size_t count, const std::string& message) {
    Loop corners;
    std::ranges::copy_if(cage.faces.corners, std::back_inserter(corners),
                         [&](std::uint32_t corner) { return corner < scene.points.size(); });
    findings.note(code, scene.points, corners, cage.object, 0.0, count);
    findings.tell(code, message);
  };
  const std::optional<LimitCage> limit = limitCage(scene, cage, tolerances.drawn_m);
  if (!limit) {
    note("G210", 1, "a subdivision cage could not be read and was left out");
    return;
  }
  constexpr double finest_m = 1e-4;
  std::optional<CageFacets> facets;
  if (takesSurfaces(*limit))
    facets.emplace(*limit, std::max(cage.tolerance_m, finest_m), tolerances.planar_m, soup);
  if (!facets || !facets->isWhole()) {
    note("G213", 1, "a subdivision cage without a limit surface was taken as it is drawn");
    addDrawn(scene, cage, soup);
    return;
  }
  if (cage.boundary == Cage::Boundary::none) {
    note("G211", 1, "a subdivision cage without boundary interpolation was given smooth boundary edges");
  }
  counts.cageFacets += facets->build(cage);
}

}  // namespace clerestory
