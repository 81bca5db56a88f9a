// SPDX-License-Identifier: GPL-3.0-or-later
// Faults of a mesh as drawn, each by itself.
#include <gtest/gtest.h>

#include <geometry/faults.hpp>

#include "drawn.hpp"

namespace clerestory {
namespace {

using namespace drawn;

const Outline square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

TEST(Faults, PointsAndFacesDrawnAgain) {
  Drawing drawing;
  drawing.face(square);
  drawing.face({square[2], square[1], square[0], square[3]});
  drawing.face({{5, 0, 0}, {6, 0, 0}, {7, 0, 0}});
  const DrawnFaults faults = countFaults(drawing.scene);
  EXPECT_EQ(faults.repeatedPoints, 4U);
  EXPECT_EQ(faults.repeatedFaces, 1U);
  EXPECT_EQ(faults.facesWithoutArea, 1U);
}

TEST(Faults, EdgesByTheirFaces) {
  Drawing drawing;
  drawing.face(square);
  drawing.face({{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}});  // wound alike
  EXPECT_EQ(countFaults(drawing.scene).edgesWoundApart, 0U);
  drawing.face({{0, 0, 0}, {1, 0, 0}, {1, -1, 0}, {0, -1, 0}});  // the other way
  EXPECT_EQ(countFaults(drawing.scene).edgesWoundApart, 1U);
  EXPECT_EQ(countFaults(drawing.scene).nonManifoldEdges, 0U);
  drawing.face({{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}});
  EXPECT_EQ(countFaults(drawing.scene).nonManifoldEdges, 1U);
}

TEST(Faults, PointsWithinEdges) {
  Drawing drawing;
  drawing.face(square);
  drawing.face({{1, 0, 0}, {2, 0, 0}, {2, 0.4, 0}, {1, 0.4, 0}});
  EXPECT_EQ(countFaults(drawing.scene).tJunctions, 1U);
}

}  // namespace
}  // namespace clerestory
