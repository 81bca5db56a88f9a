// SPDX-License-Identifier: GPL-3.0-or-later
// Clean-up of single faces, and the canonical result that does not depend on how a model was written.
#include <gtest/gtest.h>

#include <cmath>

#include "redrawn.hpp"
#include "soup.hpp"

namespace clerestory {
namespace {

using namespace drawn;

TEST(Clean, WeldsPointsWithinAMillimetre) {
  Drawing drawing;
  drawing.face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  drawing.face({{1.0004, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1.0004, 1, 0}});
  const CleanModel model = cleanScene(drawing.scene);
  EXPECT_EQ(model.counts.pointsWelded, 2U);
  ASSERT_EQ(model.pieces.size(), 1U);
  EXPECT_DOUBLE_EQ(model.pieces.area_m2[0], 2.0);
}

TEST(Clean, KeepsPointsFurtherApart) {
  Drawing drawing;
  drawing.face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  drawing.face({{1.0012, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1.0012, 1, 0}});
  const CleanModel model = cleanScene(drawing.scene);
  EXPECT_EQ(model.counts.pointsWelded, 0U);
  EXPECT_EQ(model.pieces.size(), 2U);
}

TEST(Clean, DropsDegenerateFacesAndCorners) {
  Drawing drawing;
  drawing.face({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  drawing.face({{0, 0, 1}, {1, 0, 1}, {2, 0, 1}});
  drawing.face({{0, 0, 2}, {1, 0, 2}, {0, 0, 2.0004}});
  const CleanModel model = cleanScene(drawing.scene);
  EXPECT_EQ(model.counts.degenerateFaces, 2U);
  EXPECT_EQ(countOf(model, "G201"), 2U);
  ASSERT_EQ(model.pieces.size(), 1U);
  EXPECT_EQ(model.pieces.polygons[0].size(), 4U);
}

TEST(Clean, DropsFacesDrawnTwice) {
  const Outline square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  Outline back(square.rbegin(), square.rend());
  Drawing same;
  same.face(square);
  same.face(back);
  EXPECT_EQ(cleanScene(same.scene).pieces.size(), 1U);
  EXPECT_EQ(cleanScene(same.scene).counts.duplicateFaces, 1U);

  Drawing ofTwoObjects;  // each has a side
  ofTwoObjects.face(square);
  ofTwoObjects.face(back, 0, 1);
  EXPECT_EQ(cleanScene(ofTwoObjects.scene).pieces.size(), 2U);
  ofTwoObjects.face(square);
  EXPECT_EQ(cleanScene(ofTwoObjects.scene).pieces.size(), 2U);

  Drawing twoSided;  // another material on its other side
  twoSided.face(square);
  twoSided.face(back, 2);
  EXPECT_EQ(cleanScene(twoSided.scene).pieces.size(), 2U);

  Drawing covered;  // another material on the same side
  covered.face(square);
  covered.face(square, 2);
  const CleanModel model = cleanScene(covered.scene);
  ASSERT_EQ(model.pieces.size(), 1U);
  EXPECT_EQ(model.materials[model.pieces.material[0]].name, "plaster");
  EXPECT_EQ(countOf(model, "G202"), 1U);
}

// Drawn both ways in one material, a sheet has both of its sides: one of another material has none, whichever
// way it is wound.
TEST(Clean, SheetDrawnBothWaysHasBothSides) {
  const Outline sheet = upright(0, 0, 1, 1);
  const Outline other(sheet.rbegin(), sheet.rend());
  for (const Outline& wood : {sheet, other}) {
    Drawing drawing;
    drawing.face(sheet, 0);
    drawing.face(other, 0);
    drawing.face(wood, 2);
    const CleanModel model = cleanScene(drawing.scene);
    EXPECT_EQ(model.pieces.size(), 1U);
    EXPECT_EQ(countOf(model, "G202"), 2U);
  }
}

// A corner of a larger surface near to it pulls at a corner, not at a point that only divides an edge: that
// follows the ends of its edge.
TEST(Clean, DividingAFaceChangesNothing) {
  const auto cleaned = [](const std::vector<double>& heights) {
    Drawing drawing;  // beside the wood's lower corner, and beside the middle of its edge
    drawing.face({{-0.0004, 0, 0}, {-0.0004, 0, 1.5}, {-4, 0, 5}, {-4, 0, 0}});
    for (std::size_t i = 1; i < heights.size(); ++i)
      drawing.face(upright(0, heights[i - 1], 1, heights[i]), 2, 1);
    return cleanScene(drawing.scene);
  };
  const CleanModel whole = cleaned({0.0, 3.0});
  ASSERT_EQ(whole.pieces.size(), 2U);
  for (const auto& heights : {std::vector{0.0, 1.5, 3.0}, std::vector{0.0, 0.7, 1.5, 1.9, 3.0}})
    EXPECT_TRUE(samePieces(cleaned(heights), whole));
}

TEST(Clean, SplitsWarpedFaces) {
  Drawing drawing;
  drawing.face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.01}, {0, 1, 0}});
  drawing.face({{5, 0, 0}, {6, 0, 0}, {6, 1, 0.0012}, {5, 1, 0}});
  const CleanModel model = cleanScene(drawing.scene);
  EXPECT_EQ(model.counts.nonPlanarFaces, 1U);
  EXPECT_EQ(model.pieces.size(), 3U);
  EXPECT_EQ(countOf(model, "G203"), 1U);
}

TEST(Clean, TriangulatedCubeIsTheCube) {
  Drawing quads;
  Drawing triangles;
  std::size_t centre = 0;
  for (const Outline& side : box({0, 0, 0}, {1, 2, 3})) {
    quads.face(side);
    triangles.fan(side, centre++ % 4);
  }
  const CleanModel expected = cleanScene(quads.scene);
  EXPECT_EQ(expected.pieces.size(), 6U);
  EXPECT_EQ(expected.pieces.points.size(), 8U);
  EXPECT_DOUBLE_EQ(totalArea_m2(expected), 22.0);
  for (unsigned seed = 0; seed < 5; ++seed) {
    EXPECT_TRUE(samePieces(expected, cleanScene(shuffled(triangles.scene, seed))));
    EXPECT_TRUE(samePieces(expected, cleanScene(shuffled(quads.scene, seed))));
  }
}

TEST(Clean, KeepsTheSideThatAFaceIsDrawnFor) {
  Drawing drawing;
  const std::vector<glm::dvec2> plan{{-0.5, -0.3}, {1.5, -0.3}, {-0.5, 0.7}};  // the same from no two sides
  Outline bottom;
  Outline top;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const glm::dvec2& to = plan[(i + 1) % plan.size()];
    drawing.fan({{plan[i], -0.5}, {to, -0.5}, {to, 0.5}, {plan[i], 0.5}});
    bottom.insert(bottom.begin(), {plan[i], -0.5});
    top.emplace_back(plan[i], 0.5);
  }
  drawing.face(bottom);
  drawing.face(top);
  for (const Scene& scene : {drawing.scene, reversed(mirrored(drawing.scene)), turned(drawing.scene, 2.0)}) {
    const CleanModel model = cleanScene(scene);
    EXPECT_EQ(model.pieces.size(), 5U);
    for (std::size_t i = 0; i < model.pieces.size(); ++i) {
      const glm::dvec3& out = model.pieces.points[model.pieces.polygons[i][0]];  // from a point within
      EXPECT_GT(glm::dot(out, drawnNormal(model, i)), 0.0);
    }
  }
}

// Halfway between two points of the grid, as half a millimetre in inches may be, rounding decides nothing.
TEST(Clean, HalvesOfTheGridGoUp) {
  constexpr double grid_m = 1e-9;
  for (int step = 0; step < 5000; step += 7) {
    const double half_m = (step + 0.5) * grid_m;
    for (const double value_m : {half_m, std::nextafter(half_m, 0.0), std::nextafter(half_m, 1.0)})
      EXPECT_EQ(onGrid(glm::dvec3(value_m), grid_m).x, (step + 1) / 1e9) << step;
  }
}

// Of two faces that the weld has made alike the one stays whose corners it has not moved, in whatever order
// they come: the other would be taken for warped, and for one with the face beside it, 4 mrad out of its
// plane.
TEST(Clean, OfFacesMadeAlikeKeepsTheOneNotMoved) {
  const Outline exact{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const Outline moved{{0.0005, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  std::vector<CleanModel> models;
  for (const bool isMovedFirst : {false, true}) {
    Drawing drawing;
    drawing.face(isMovedFirst ? moved : exact);
    drawing.face(isMovedFirst ? exact : moved);
    drawing.face({{1, 0, 0}, {1.4, 0, 0.0016}, {1.4, 1, 0.0016}, {1, 1, 0}});
    drawing.face({{0, 0, 0}, {0, -5, 0}, {0, -5, -5}, {0, 0, -5}}, 1, 1);  // larger: it keeps its corner
    models.push_back(cleanScene(drawing.scene));
  }
  EXPECT_EQ(models[0].counts.duplicateFaces, 1U);
  EXPECT_EQ(models[0].pieces.size(), 3U);
  EXPECT_TRUE(samePieces(models[0], models[1]));
}

/// An office with a reveal, written out by hand: floor, ceiling, walls, a window wall with hole, pane and
/// sill.
Drawing office(bool triangles, double turn_rad) {
  Drawing drawing;
  drawing.scene.objects = {"floor", "wall", "pane", "reveal"};
  const auto add = [&](Outline outline, std::uint32_t material, std::uint32_t object, std::size_t centre) {
    for (glm::dvec3& p : outline) {
      p = {std::cos(turn_rad) * p.x - std::sin(turn_rad) * p.y,
           std::sin(turn_rad) * p.x + std::cos(turn_rad) * p.y, p.z};
    }
    if (triangles) {
      drawing.fan(outline, centre, material, object);
    } else {
      drawing.face(outline, material, object);
    }
  };
  const auto sides = box({0, 0, 0}, {3.6, 8.2, 2.8});
  add(sides[0], 0, 0, 1);
  for (const std::size_t side : {1U, 3U, 4U, 5U}) add(sides[side], 0, 1, side % 4);
  for (const double y : {0.0, -0.3}) {
    add(upright(0, 0, 3.6, 0.8, y), 0, 1, 1);
    add(upright(0, 2.5, 3.6, 2.8, y), 0, 1, 2);
    add(upright(0, 0.8, 0.4, 2.5, y), 0, 1, 3);
    add(upright(3.2, 0.8, 3.6, 2.5, y), 0, 1, 0);
  }
  add(upright(0.4, 0.8, 3.2, 2.5, -0.15), 1, 2, 0);
  add({{0.4, -0.3, 0.8}, {3.2, -0.3, 0.8}, {3.2, 0, 0.8}, {0.4, 0, 0.8}}, 0, 3, 2);
  add({{0.4, -0.3, 2.5}, {0.4, 0, 2.5}, {3.2, 0, 2.5}, {3.2, -0.3, 2.5}}, 0, 3, 1);
  return drawing;
}

TEST(Clean, ResultIsCanonical) {
  for (const double turn_rad : {0.0, 0.3, 1.0}) {
    const CleanModel expected = cleanScene(office(false, turn_rad).scene);
    // Two window walls of four rectangles, five other faces of the room, the pane and two faces of the
    // reveal.
    EXPECT_EQ(expected.pieces.size(), 2U * 4U + 5U + 1U + 2U);
    EXPECT_EQ(expected.counts.polygons, 2U + 5U + 1U + 2U);
    ASSERT_EQ(expected.surfaces.size(), 4U);
    EXPECT_EQ(expected.surfaces[0].name, "floor");
    EXPECT_TRUE(allConvex(expected));
    for (unsigned seed = 0; seed < 4; ++seed) {
      EXPECT_TRUE(samePieces(expected, cleanScene(shuffled(office(false, turn_rad).scene, seed))));
      EXPECT_TRUE(samePieces(expected, cleanScene(shuffled(office(true, turn_rad).scene, seed))));
    }
  }
}

TEST(Clean, EmptySceneIsEmpty) {
  const CleanModel model = cleanScene(Scene());
  EXPECT_EQ(model.pieces.size(), 0U);
  EXPECT_TRUE(model.surfaces.empty());
}

}  // namespace
}  // namespace clerestory
