// SPDX-License-Identifier: GPL-3.0-or-later
// Limit surfaces of subdivision cages: closed, on the limit, sharp where creased.
#include <gtest/gtest.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "drawn.hpp"

namespace clerestory {
namespace {

using namespace drawn;

Scene cubeCage(Cage::Scheme scheme, double tolerance_m) {
  Scene scene = Drawing().scene;
  Cage cage;
  cage.scheme = scheme;
  cage.tolerance_m = tolerance_m;
  for (int i = 0; i < 8; ++i) scene.points.emplace_back(i & 1, i >> 1 & 1, i >> 2 & 1);
  const std::vector<std::vector<std::uint32_t>> quads = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                         {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}};
  for (const auto& quad : quads) {
    if (scheme == Cage::Scheme::loop) {
      cage.faces.add(std::vector{quad[0], quad[1], quad[2]});
      cage.faces.add(std::vector{quad[0], quad[2], quad[3]});
    } else {
      cage.faces.add(quad);
    }
  }
  scene.cages.push_back(cage);
  return scene;
}

/// Whether each edge is used once in each direction, as pieces were drawn.
bool isClosed(const Pieces& pieces) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    const auto loop = pieces.polygons[piece];
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t from = loop[i];
      const std::uint32_t to = loop[(i + 1) % loop.size()];
      ++uses[pieces.isDrawnForBack[piece] ? std::pair(to, from) : std::pair(from, to)];
    }
  }
  return std::ranges::all_of(uses, [&](const auto& use) {
    const auto twin = uses.find({use.first.second, use.first.first});
    return use.second == 1 && twin != uses.end() && twin->second == 1;
  });
}

struct RefinedPoint {
  glm::dvec3 p{0.0};
  void Clear() { p = glm::dvec3(0.0); }
  void AddWithWeight(const RefinedPoint& other, float weight) { p += static_cast<double>(weight) * other.p; }
};

/// Points of the cube's Catmull-Clark cage after `levels` steps of OpenSubdiv's uniform refinement, on the
/// limit.
std::vector<glm::dvec3> limitPointsOfCube(int levels) {
  using namespace OpenSubdiv;
  const Scene scene = cubeCage(Cage::Scheme::catmark, 0.01);
  std::vector<int> corners(scene.cages[0].faces.corners.begin(), scene.cages[0].faces.corners.end());
  const std::vector<int> sizes(6, 4);
  Far::TopologyDescriptor descriptor;
  descriptor.numVertices = 8;
  descriptor.numFaces = 6;
  descriptor.numVertsPerFace = sizes.data();
  descriptor.vertIndicesPerFace = corners.data();
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  const std::unique_ptr<Far::TopologyRefiner> refiner(
      Factory::Create(descriptor, Factory::Options(Sdc::SCHEME_CATMARK)));
  Far::TopologyRefiner::UniformOptions uniform(levels);
  uniform.fullTopologyInLastLevel = true;  // limit masks ask for it
  refiner->RefineUniform(uniform);
  std::vector<RefinedPoint> from(8);
  for (std::size_t i = 0; i < 8; ++i) from[i].p = scene.points[i];
  const Far::PrimvarRefiner primvars(*refiner);
  for (int level = 1; level <= levels; ++level) {
    std::vector<RefinedPoint> to(static_cast<std::size_t>(refiner->GetLevel(level).GetNumVertices()));
    RefinedPoint* target = to.data();
    primvars.Interpolate(level, from.data(), target);
    from = std::move(to);
  }
  std::vector<RefinedPoint> limit(from.size());
  RefinedPoint* target = limit.data();
  primvars.Limit(from.data(), target);
  std::vector<glm::dvec3> result;
  for (const RefinedPoint& point : limit) result.push_back(point.p);
  return result;
}

double distanceToTriangle(const glm::dvec3& point, const std::array<glm::dvec3, 3>& triangle) {
  const glm::dvec3 normal = glm::normalize(glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]));
  double nearest = 1e300;
  bool inside = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3& a = triangle[i];
    const glm::dvec3 way = triangle[(i + 1) % 3] - a;
    inside = inside && glm::dot(glm::cross(way, point - a), normal) >= 0.0;
    const double along = glm::clamp(glm::dot(point - a, way) / glm::dot(way, way), 0.0, 1.0);
    nearest = std::min(nearest, glm::length(point - a - along * way));
  }
  return inside ? std::abs(glm::dot(point - triangle[0], normal)) : nearest;
}

double distanceToPieces(const Pieces& pieces, const glm::dvec3& point) {
  double nearest = 1e300;
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    const auto loop = pieces.polygons[piece];
    for (std::size_t i = 2; i < loop.size(); ++i) {
      nearest = std::min(
          nearest, distanceToTriangle(
                       point, {pieces.points[loop[0]], pieces.points[loop[i - 1]], pieces.points[loop[i]]}));
    }
  }
  return nearest;
}

TEST(Subdivision, FacetsKeepToTheLimitSurface) {
  const std::vector<glm::dvec3> limit = limitPointsOfCube(5);
  for (const double tolerance_m : {0.02, 0.005, 0.002}) {
    const CleanModel model = cleanScene(cubeCage(Cage::Scheme::catmark, tolerance_m));
    const Pieces& pieces = model.pieces;
    for (const glm::dvec3& point : pieces.points) {  // corners lie on it
      double nearest = 1e300;
      for (const glm::dvec3& other : limit) nearest = std::min(nearest, glm::length(other - point));
      EXPECT_LT(nearest, 0.04);  // spacing of the samples
    }
    double worst = 0.0;
    for (const glm::dvec3& point : limit) worst = std::max(worst, distanceToPieces(pieces, point));
    EXPECT_LT(worst, 1.15 * tolerance_m + 2e-5);
    EXPECT_GT(worst, 0.1 * tolerance_m);  // no finer than asked for
    EXPECT_TRUE(isClosed(pieces));
  }
}

TEST(Subdivision, EverySchemeIsClosed) {
  for (const auto scheme : {Cage::Scheme::catmark, Cage::Scheme::loop, Cage::Scheme::bilinear}) {
    const CleanModel model = cleanScene(cubeCage(scheme, 0.01));
    EXPECT_TRUE(isClosed(model.pieces));
    EXPECT_EQ(model.counts.cages, 1U);
    EXPECT_GE(model.counts.cageFacets, 6U);
  }
}

TEST(Subdivision, InfinitelySharpCubeStaysACube) {
  Scene scene = cubeCage(Cage::Scheme::catmark, 0.005);
  for (std::uint32_t i = 0; i < 8; ++i) {
    for (const std::uint32_t bit : {1U, 2U, 4U}) {
      if ((i & bit) == 0) scene.cages[0].creases.push_back({i, i | bit, 10.0F});
    }
  }
  const CleanModel model = cleanScene(scene);
  EXPECT_EQ(model.pieces.size(), 6U);
  EXPECT_NEAR(totalArea_m2(model), 6.0, 1e-9);
}

TEST(Subdivision, CreasedRimStaysSharp) {
  Scene scene = cubeCage(Cage::Scheme::catmark, 0.005);
  for (const auto& [a, b] : {std::pair{4U, 5U}, {5U, 7U}, {7U, 6U}, {6U, 4U}}) {
    scene.cages[0].creases.push_back({a, b, 10.0F});
  }
  const CleanModel model = cleanScene(scene);
  EXPECT_TRUE(isClosed(model.pieces));
  // The top is flat to its rim, a rounded square in the plane of the crease.
  std::size_t top = 0;
  for (std::size_t i = 0; i < model.pieces.size(); ++i) {
    if (model.pieces.normal[i].z > 0.9999 &&
        std::abs(model.pieces.points[model.pieces.polygons[i][0]].z - 1.0) < 1e-4) {
      ++top;
    }
  }
  EXPECT_EQ(top, 1U);
}

TEST(Subdivision, FlatSheetIsOnePiece) {
  Scene scene = Drawing().scene;
  Cage cage;
  for (std::uint32_t j = 0; j < 4; ++j) {
    for (std::uint32_t i = 0; i < 4; ++i) scene.points.emplace_back(i, j, 2.0);
  }
  for (std::uint32_t j = 0; j < 3; ++j) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t first = 4 * j + i;
      cage.faces.add(std::vector{first, first + 1, first + 5, first + 4});
    }
  }
  scene.cages.push_back(cage);
  const CleanModel model = cleanScene(scene);
  ASSERT_EQ(model.pieces.size(), 1U);
  EXPECT_NEAR(model.pieces.area_m2[0], 9.0, 1e-9);
  scene.cages[0].holes.push_back(4);
  EXPECT_NEAR(totalArea_m2(cleanScene(scene)), 8.0, 1e-9);
}

TEST(Subdivision, BoundaryRules) {
  Scene scene = cubeCage(Cage::Scheme::catmark, 0.005);
  Cage& cage = scene.cages[0];
  PolygonList open;
  for (std::size_t face = 0; face < 5; ++face) open.add(cage.faces[face]);
  cage.faces = open;
  cage.boundary = Cage::Boundary::none;
  EXPECT_EQ(countOf(cleanScene(scene), "G211"), 1U);
  const double smooth = totalArea_m2(cleanScene(scene));
  cage.boundary = Cage::Boundary::edgeOnly;
  EXPECT_DOUBLE_EQ(totalArea_m2(cleanScene(scene)), smooth);
  EXPECT_EQ(countOf(cleanScene(scene), "G211"), 0U);
}

TEST(Subdivision, FoldedFacesAreTakenAsDrawn) {
  Scene scene = cubeCage(Cage::Scheme::catmark, 0.005);
  Cage& cage = scene.cages[0];
  const auto face = cage.faces[0];
  PolygonList folded;  // one face of the cube and the same seen from its back: each corner has two faces
  folded.add(face);
  folded.add(std::vector(face.rbegin(), face.rend()));
  cage.faces = folded;
  const CleanModel model = cleanScene(scene);
  EXPECT_EQ(countOf(model, "G213"), 1U);
  EXPECT_GT(totalArea_m2(model), 0.99);
}

/// OpenSubdiv reads beyond its arrays from 16,000 faces at a point on.
TEST(Subdivision, FansOfManyFacesAreTakenAsDrawn) {
  constexpr std::uint32_t blades = 20000;
  Scene scene = Drawing().scene;
  scene.points = {{0, 0, 1}};
  Cage cage;
  cage.scheme = Cage::Scheme::loop;
  for (std::uint32_t i = 0; i < blades; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / blades;
    scene.points.emplace_back(100.0 * std::cos(angle), 100.0 * std::sin(angle), 0.0);
    cage.faces.add(std::vector<std::uint32_t>{0, 1 + i, 1 + (i + 1) % blades});
  }
  scene.cages.push_back(cage);
  const CleanModel model = cleanScene(scene);
  EXPECT_EQ(countOf(model, "G213"), 1U);
  EXPECT_GT(totalArea_m2(model), 0.999 * 1e4 * std::numbers::pi);
}

/// Three square sheets of one cage meet at an edge, which is a boundary of each.
TEST(Subdivision, IsCutWhereThreeFacesMeet) {
  Scene scene = Drawing().scene;
  scene.points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0, 1}, {-1, 0, 0}, {-1, 0, 1}, {0, 1, 0}, {0, 1, 1}};
  Cage cage;
  for (const std::uint32_t side : {2U, 4U, 6U})
    cage.faces.add(std::vector<std::uint32_t>{0, side, side + 1, 1});
  cage.corners = {{0, 10.0F}, {1, 10.0F}};
  scene.cages.push_back(cage);
  const CleanModel model = cleanScene(scene);
  EXPECT_TRUE(model.diagnoses.empty());
  EXPECT_NEAR(totalArea_m2(model), 3.0, 1e-9) << "corners of a boundary stay";
}

TEST(Subdivision, IndicesOutOfRangeAreRefused) {
  Scene scene = cubeCage(Cage::Scheme::catmark, 0.005);
  scene.cages[0].creases.push_back({0, 99, 2.0F});
  EXPECT_EQ(countOf(cleanScene(scene), "G210"), 1U);
  scene.cages[0].creases.clear();
  scene.cages[0].holes.push_back(6);
  EXPECT_EQ(cleanScene(scene).pieces.size(), 0U);
  scene.cages[0].holes.clear();
  scene.cages[0].faces.corners[3] = 1000000;
  EXPECT_EQ(countOf(cleanScene(scene), "G210"), 1U);
}

}  // namespace
}  // namespace clerestory
