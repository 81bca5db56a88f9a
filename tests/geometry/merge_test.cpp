// SPDX-License-Identifier: GPL-3.0-or-later
// Merging of coplanar faces into polygons with holes, and their division into convex pieces.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "drawn.hpp"

namespace clerestory {
namespace {

using namespace drawn;

/// Every sample in the wall is in one piece, samples in the window in none.
void expectWallWithWindow(const CleanModel& model) {
  EXPECT_EQ(model.counts.polygons, 1U);
  EXPECT_EQ(model.pieces.size(), 4U);
  EXPECT_DOUBLE_EQ(totalArea_m2(model), 4.0 * 3.0 - 2.0 * 1.5);
  EXPECT_TRUE(allConvex(model));
  for (double x = 0.037; x < 4.0; x += 0.1) {
    for (double z = 0.041; z < 3.0; z += 0.1) {
      const bool inWindow = x > 1.0 && x < 3.0 && z > 1.0 && z < 2.5;
      EXPECT_EQ(cover(model, {x, 0.0, z}), inWindow ? 0 : 1) << x << ' ' << z;
    }
  }
}

Drawing wallOfTriangles() {
  Drawing drawing;
  const auto a = upright(0, 0, 4, 3);
  const auto b = upright(1, 1, 3, 2.5);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    drawing.face({a[i], a[j], b[j]});
    drawing.face({a[i], b[j], b[i]});
  }
  return drawing;
}

TEST(Merge, WallWithWindowFromTriangles) {
  expectWallWithWindow(cleanScene(wallOfTriangles().scene));
}

TEST(Merge, WallWithWindowFromKeyhole) {
  const auto a = upright(0, 0, 4, 3);
  const auto b = upright(1, 1, 3, 2.5);
  Drawing drawing;
  drawing.face({a[0], a[1], a[2], a[3], a[0], b[0], b[3], b[2], b[1], b[0]});
  const CleanModel model = cleanScene(drawing.scene);
  expectWallWithWindow(model);
  EXPECT_TRUE(samePieces(model, cleanScene(wallOfTriangles().scene)));
}

TEST(Merge, KeyholeWithItsHoleWoundTheSameWay) {
  const auto a = upright(0, 0, 4, 3);
  const auto b = upright(1, 1, 3, 2.5);
  Drawing drawing;
  drawing.face({a[0], a[1], a[2], a[3], a[0], b[0], b[1], b[2], b[3], b[0]});
  const CleanModel model = cleanScene(drawing.scene);
  expectWallWithWindow(model);
  EXPECT_EQ(countOf(model, "G204"), 0U);
}

TEST(Merge, WallWithWindowFromStripsWithTJunctions) {
  Drawing drawing;
  drawing.face(upright(0, 0, 4, 1));
  drawing.face(upright(0, 1, 1, 2.5));
  drawing.face(upright(3, 1, 4, 2.5));
  drawing.face(upright(0, 2.5, 4, 3));
  expectWallWithWindow(cleanScene(drawing.scene));
}

TEST(Merge, MixedWindingMerges) {
  Drawing drawing;
  drawing.face(upright(0, 0, 2, 1));
  const auto other = upright(2, 0, 5, 1);
  drawing.face(Outline(other.rbegin(), other.rend()));
  const CleanModel model = cleanScene(drawing.scene);
  ASSERT_EQ(model.pieces.size(), 1U);
  EXPECT_DOUBLE_EQ(model.pieces.area_m2[0], 5.0);
  EXPECT_DOUBLE_EQ(drawnNormal(model, 0).y, 1.0);  // the larger face's
}

TEST(Merge, FacesBentByTheWeldMergeWhetherTrianglesOrNot) {
  const Outline cover = {{0, 0, 0}, {0.2, 0, 0}, {0.2, 0, 0.3}, {0, 0, 0.3}};
  const Outline neighbour = {{0.2, -0.0009, 0}, {0.5, -0.0009, 0}, {0.5, -0.3, 0}};
  Drawing quad;
  quad.face(cover);
  quad.face(neighbour, 2);
  for (std::size_t centre = 0; centre < 2; ++centre) {
    Drawing triangles;
    triangles.fan(cover, centre);
    triangles.face(neighbour, 2);
    EXPECT_TRUE(samePieces(cleanScene(quad.scene), cleanScene(triangles.scene)));
  }
}

TEST(Merge, MaterialsAndObjectsStayApart) {
  Drawing drawing;
  drawing.face(upright(0, 0, 1, 1));
  drawing.face(upright(1, 0, 2, 1), 2);
  drawing.face(upright(2, 0, 3, 1), 0, 1);
  const CleanModel model = cleanScene(drawing.scene);
  EXPECT_EQ(model.pieces.size(), 3U);
  EXPECT_EQ(model.surfaces.size(), 3U);
}

TEST(Merge, LShapedFloorIsTwoRectangles) {
  for (const double turn : {0.0, 0.7}) {
    Outline floor = {{0, 0, 0}, {5, 0, 0}, {5, 2, 0}, {2, 2, 0}, {2, 6, 0}, {0, 6, 0}};
    for (glm::dvec3& p : floor) {
      p = {std::cos(turn) * p.x - std::sin(turn) * p.y, std::sin(turn) * p.x + std::cos(turn) * p.y, 0.0};
    }
    Drawing drawing;
    drawing.face(floor);
    const CleanModel model = cleanScene(drawing.scene);
    EXPECT_EQ(model.pieces.size(), 2U);
    EXPECT_NEAR(totalArea_m2(model), 18.0, 2e-4);
    EXPECT_TRUE(allConvex(model));
  }
}

TEST(Merge, OverlappingFacesCountOnce) {
  Drawing crossing;
  crossing.face(upright(0, 0, 2, 1));
  crossing.face(upright(1, -1, 1.5, 2));
  crossing.face(upright(0, 0, 1, 1));
  const CleanModel model = cleanScene(crossing.scene);
  EXPECT_DOUBLE_EQ(totalArea_m2(model), 2.0 + 0.5 * 3.0 - 0.5);

  Drawing twice;  // the same wall with other diagonals, back to back
  const auto wall = upright(0, 0, 3, 2);
  twice.fan(wall, 0);
  twice.fan(Outline(wall.rbegin(), wall.rend()), 0);
  twice.fan(wall, 1);
  const CleanModel single = cleanScene(twice.scene);
  ASSERT_EQ(single.pieces.size(), 1U);
  EXPECT_DOUBLE_EQ(single.pieces.area_m2[0], 6.0);
  EXPECT_EQ(countOf(single, "G204"), 1U);
}

// As one whose faces are the same from both sides: whichever way other materials are wound, those of later
// names have no side left, and those of earlier names leave one.
TEST(Merge, WallDrawnBothWaysHasTheSidesThatAreLeft) {
  const auto wall = upright(0, 0, 3, 2);
  const Outline behind(wall.rbegin(), wall.rend());
  const auto cleaned = [&](const Outline& other, std::uint32_t material, std::uint32_t otherMaterial) {
    Drawing drawing;
    drawing.fan(wall, 0, material);
    drawing.fan(behind, 0, material);
    drawing.face(other, otherMaterial, 1);
    return cleanScene(drawing.scene);
  };
  for (const Outline& other : {wall, behind}) {
    EXPECT_EQ(cleaned(other, 0, 2).pieces.size(), 1U);
    const CleanModel both = cleaned(other, 2, 0);
    ASSERT_EQ(both.pieces.size(), 2U);
    EXPECT_NEAR(glm::dot(drawnNormal(both, 0), drawnNormal(both, 1)), -1.0, 1e-12);
  }
}

/// Five lines of one outline cross within a tenth of a millimetre: what lies between the crossings has no
/// size.
TEST(Merge, RingsWithoutSizeAreNoSurfaces) {
  Drawing drawing;
  drawing.face({{1.994775, -0.144480, 0},
                {-1.994776, 0.144453, 0},
                {-1.482509, -1.342448, 0},
                {1.482520, 1.342436, 0},
                {0.842514, 1.813883, 0},
                {-0.842406, -1.813933, 0},
                {0.713906, -1.868245, 0},
                {-0.713916, 1.868241, 0},
                {-1.624872, 1.166100, 0},
                {1.624897, -1.166066, 0}});
  const CleanModel model = cleanScene(drawing.scene);
  EXPECT_EQ(countOf(model, "G207"), 0U);
  EXPECT_NEAR(totalArea_m2(model), 5.8065, 1e-4);
}

TEST(Merge, RegionsThatOnlyTouchAtACornerComeApart) {
  Drawing drawing;
  drawing.face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  drawing.face({{1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}});
  EXPECT_EQ(cleanScene(drawing.scene).counts.polygons, 2U);
  EXPECT_EQ(cleanScene(drawing.scene).pieces.size(), 2U);
}

TEST(Merge, HoleThatTouchesTheOutline) {
  Drawing drawing;  // a square frame round a diamond that touches one side
  const Outline outer = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  drawing.face({{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {2, 2, 0}, {0, 4, 0}});
  drawing.face({{2, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {2, 2, 0}, {3, 1, 0}});
  const CleanModel model = cleanScene(drawing.scene);
  EXPECT_EQ(model.counts.polygons, 1U);
  EXPECT_NEAR(totalArea_m2(model), 14.0, 1e-12);
  EXPECT_TRUE(allConvex(model));
}

TEST(Merge, IslandInAHole) {
  Drawing drawing = wallOfTriangles();
  drawing.face(upright(1.5, 1.5, 2.0, 2.0));
  drawing.face(upright(3, 1, 3.5, 0.5, 1.0));
  const CleanModel model = cleanScene(drawing.scene);
  EXPECT_EQ(model.counts.polygons, 3U);
  EXPECT_NEAR(totalArea_m2(model), 9.0 + 0.25 + 0.25, 1e-12);
}

TEST(Merge, RoundHoleIsNotGroundToSlivers) {
  constexpr int sides = 32;
  Drawing drawing;
  Outline keyhole = upright(0, 0, 4, 3);
  keyhole.push_back(keyhole[0]);
  for (int i = 0; i <= sides; ++i) {
    const double angle = -2.0 * std::numbers::pi * i / sides;
    keyhole.emplace_back(2.0 + 0.8 * std::cos(angle), 0.0, 1.5 + 0.8 * std::sin(angle));
  }
  drawing.face(keyhole);
  const CleanModel model = cleanScene(drawing.scene);
  const double round_m2 = 0.5 * sides * 0.8 * 0.8 * std::sin(2.0 * std::numbers::pi / sides);
  EXPECT_NEAR(totalArea_m2(model), 12.0 - round_m2, 1e-4);
  EXPECT_LE(model.pieces.size(), static_cast<std::size_t>(sides) + 4U);
  EXPECT_TRUE(allConvex(model));
}

TEST(Merge, CurvedSurfacesKeepTheirFacets) {
  Drawing drawing;
  constexpr int sides = 48;
  for (int i = 0; i < sides; ++i) {
    const double a = 2.0 * std::numbers::pi * i / sides;
    const double b = 2.0 * std::numbers::pi * (i + 1) / sides;
    drawing.fan({{std::cos(a), std::sin(a), 0},
                 {std::cos(b), std::sin(b), 0},
                 {std::cos(b), std::sin(b), 2},
                 {std::cos(a), std::sin(a), 2}});
  }
  EXPECT_EQ(cleanScene(drawing.scene).pieces.size(), static_cast<std::size_t>(sides));
}

TEST(Merge, ManyWindowsStayFewRectangles) {
  Drawing drawing;  // a facade of 6 × 10 windows in small tiles
  double window_m2 = 0.0;
  for (int i = 0; i < 21; ++i) {
    for (int j = 0; j < 13; ++j) {
      if (i % 2 == 1 && j % 2 == 1) {
        window_m2 += 1.0;
      } else {
        drawing.fan(upright(i, j, i + 1.0, j + 1.0), static_cast<std::size_t>(i + j) % 4);
      }
    }
  }
  const CleanModel model = cleanScene(drawing.scene);
  EXPECT_EQ(model.counts.polygons, 1U);
  EXPECT_NEAR(totalArea_m2(model), 21.0 * 13.0 - window_m2, 1e-9);
  EXPECT_LE(model.pieces.size(), 90U);  // 7 bands and 6 × 11 piers are 73
}

}  // namespace
}  // namespace clerestory
