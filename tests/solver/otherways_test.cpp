// SPDX-License-Identifier: GPL-3.0-or-later
// Ways between two squares with a screen half way, of which a known share is open or blocked.
#include "otherways.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include <geometry/sampling.hpp>

#include "../scenes.hpp"

namespace clerestory {
namespace {

using drawn::Drawing;

/// Squares of 1 m, 1 m apart, that look at each other; what stands half way between them is `screen`.
struct Squares {
  static constexpr double hole_m = 0.1;
  Study study;
  Building building;
  World world;
  std::vector<glm::vec3> below, above;

  explicit Squares(void (*screen)(Drawing&))
      : building([&] {
          Drawing drawing;
          screen(drawing);
          return drawn::buildingOf(drawing.scene);
        }()),
        world(building, study) {
    for (const auto& [x, y] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}) {
      below.push_back(world.local({x, y, 0.0}));
      above.push_back(world.local({x, y, 1.0}));
    }
  }

  /// Share of `seeds` receivers that find a way as asked.
  double found(Way asked, float looks, std::uint64_t seeds) const {
    std::uint64_t count = 0;
    std::uint64_t rays = 0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      Receiver receiver;
      receiver.treeSide = 0;
      receiver.corners = below;
      receiver.normal = {0.0F, 0.0F, 1.0F};
      receiver.key = mixKey(seed);
      count += findsWay(world, receiver, {above, {0.0F, 0.0F, -rayOffset_m}, 7}, asked, looks, rays) ? 1 : 0;
    }
    EXPECT_LE(rays, seeds * static_cast<std::uint64_t>(looks));
    return static_cast<double>(count) / static_cast<double>(seeds);
  }
};

void addPlate(Drawing& drawing) {
  constexpr double h = 0.5 * Squares::hole_m;
  drawing.face({{-h, -h, 0.5}, {h, -h, 0.5}, {h, h, 0.5}, {-h, h, 0.5}});
}

void addScreenWithHole(Drawing& drawing) {
  constexpr double h = 0.5 * Squares::hole_m;
  drawing.face({{-2, -2, 0.5}, {2, -2, 0.5}, {2, -h, 0.5}, {-2, -h, 0.5}});
  drawing.face({{-2, h, 0.5}, {2, h, 0.5}, {2, 2, 0.5}, {-2, 2, 0.5}});
  drawing.face({{-2, -h, 0.5}, {-h, -h, 0.5}, {-h, h, 0.5}, {-2, h, 0.5}});
  drawing.face({{h, -h, 0.5}, {2, -h, 0.5}, {2, h, 0.5}, {h, h, 0.5}});
}

// The middle of a way is the mean of two even numbers, so |x| < h for 4 h (1 - h) of them. Ways that are
// drawn alone find what a share v is in 1 - (1 - v)^n of all cases, and no n ways in more than n v; those of
// a sequence lie apart and come between.
void expectFound(const Squares& squares, Way asked) {
  constexpr double h = 0.5 * Squares::hole_m;
  constexpr std::uint64_t seeds = 20000;
  const double ofAxis = 4.0 * h * (1.0 - h);
  const double share = ofAxis * ofAxis;
  for (const double looks : {1.0, 4.0, 8.0}) {
    const double least = 1.0 - std::pow(1.0 - share, looks);
    const double deviation = std::sqrt(least * (1.0 - least) / static_cast<double>(seeds));
    const double found = squares.found(asked, static_cast<float>(looks), seeds);
    EXPECT_GT(found, least - 3.0 * deviation) << looks;
    EXPECT_LT(found, looks * share + 3.0 * deviation) << looks;
  }
  EXPECT_GT(squares.found(asked, 1000.0F, 100), 0.999);
}

TEST(OtherWays, HoleIsFoundAsOftenAsItCounts) {
  expectFound(Squares(addScreenWithHole), Way::open);
}

TEST(OtherWays, PlateIsFoundAsOftenAsItCounts) {
  expectFound(Squares(addPlate), Way::blocked);
}

TEST(OtherWays, WhatIsNotThereIsNotFound) {
  const Squares hidden([](Drawing& drawing) {
    drawing.face({{-2, -2, 0.5}, {2, -2, 0.5}, {2, 2, 0.5}, {-2, 2, 0.5}});
  });
  EXPECT_EQ(hidden.found(Way::open, 1000.0F, 10), 0.0);
  const Squares open([](Drawing& drawing) {
    drawing.face({{2, -2, 0.5}, {4, -2, 0.5}, {4, 2, 0.5}, {2, 2, 0.5}});
  });
  EXPECT_EQ(open.found(Way::blocked, 1000.0F, 10), 0.0);
}

}  // namespace
}  // namespace clerestory
