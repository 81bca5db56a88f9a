// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes on which methods fail, at draft, standard and fine accuracy: what is known of them holds, all
// figures are finite and not negative, light is neither made nor lost, and the work stays bounded.
// docs/stability.md lists the cases.
#include <numbers>
#include <numeric>

#include "../solver/solved.hpp"
#include "cases.hpp"
#include "paths.hpp"

namespace clerestory {
namespace {

using namespace unstable;

constexpr double draft = 0.10, standard = 0.05, fine = 0.02;

struct Bounds {
  double defect = 0.01;             ///< share of the power that links may miss before it is mended
  std::uint64_t elements = 500000;  ///< far above what a small scene should take
  std::uint64_t rays = 50000000;
  double draftFromFine = draft + fine;        ///< each is as far from the truth as it promises at most …
  double standardFromFine = standard + fine;  ///< … so a coarser one from the finest by the sum
};

void expectSound(const Solved& scene, const Bounds& bounds) {
  const auto sound = [](double value) { return std::isfinite(value) && value >= 0.0; };
  for (const double figure : figuresOf(scene.solution)) {
    // Of the figures room -1, outside, alone is negative.
    ASSERT_TRUE(sound(figure) || figure == -1.0) << figure;
  }
  for (const EnergyBalance& balance : scene.solution.balances) {
    const double left_lm = balance.absorbed_lm + balance.escaped_lm;
    EXPECT_NEAR(left_lm, balance.emitted_lm, 0.01 * balance.emitted_lm);
    EXPECT_LT(balance.unscaledDefect, bounds.defect);
    std::cout << "  emitted " << balance.emitted_lm << " lm, left " << left_lm << " lm, unscaled defect "
              << 100.0 * balance.unscaledDefect << " %\n";
  }
  std::uint64_t rays = 0;
  for (const IterationStatistics& row : scene.solution.iterations) rays += row.visibilityTests;
  std::cout << "  " << scene.solution.elements << " elements, " << rays << " rays\n";
  EXPECT_LT(scene.solution.elements, bounds.elements);
  EXPECT_LT(rays, bounds.rays);
}

/// A scene at the three accuracies, from draft to fine.
struct Three {
  std::vector<Solved> at;

  [[nodiscard]] std::vector<double> fineSensors_lx() const { return at.back().sensors_lx(); }
};

constexpr double accuracies[] = {draft, standard, fine};

Three solvedAtThree(Case scene, const Bounds& bounds = {}) {
  addSurroundings(scene.study, scene.drawing.scene);
  Three three;
  for (const double accuracy : accuracies) {
    SCOPED_TRACE("accuracy " + std::to_string(accuracy));
    scene.study.accuracy = accuracy;
    three.at.push_back(solved(scene.drawing.scene, scene.study));
    expectSound(three.at.back(), bounds);
  }
  const std::vector<double> best = three.fineSensors_lx();
  if (std::accumulate(best.begin(), best.end(), 0.0) <= 0.0) return three;
  EXPECT_LT(measuredErrors("draft against fine", three.at[0].sensors_lx(), best).p95, bounds.draftFromFine);
  EXPECT_LT(measuredErrors("standard against fine", three.at[1].sensors_lx(), best).p95,
            bounds.standardFromFine);
  return three;
}

/// Every sensor of every accuracy has `truth_lx`, to within that accuracy.
void expectEven(const Three& three, double truth_lx) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (const double value_lx : three.at[i].sensors_lx())
      EXPECT_NEAR(value_lx, truth_lx, accuracies[i] * truth_lx) << "accuracy " << accuracies[i];
  }
}

/// Surfaces of a furnace: every element of every side that faces the room.
void expectEvenSurfaces(const Three& three, double truth_lx) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (const SurfaceValue& row : three.at[i].solution.surfaces) {
      if (row.room < 0) continue;
      EXPECT_NEAR(row.illuminanceMean_lx, truth_lx, 0.01 * truth_lx)
          << three.at[i].building.model.surfaces[row.surface].name << ", accuracy " << accuracies[i];
    }
  }
}

void expectFurnace(const Three& three, double reflectance) {
  expectEven(three, 1.0 / (1.0 - reflectance));
  expectEvenSurfaces(three, 1.0 / (1.0 - reflectance));
}

double meanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// What the lamp gives is absorbed: the mean irradiance of all that reflects is known without the shape. Most
// of it ends in the black lamp, half of that in the gap above, so a small error there is a large one of the
// whole room, which paths tell.
void expectBrightRoom(double reflectance, const Bounds& bounds = {}) {
  const Three three = solvedAtThree(litRoom(reflectance), bounds);
  const Building& building = three.at[0].building;
  const double truth_lx = meanOf(byPaths_lx(building, building.grids[0], 2000));
  constexpr double truthError = 0.003;  // standard error: a path brings 0.9 of the mean, more or less
  for (std::size_t i = 0; i < 3; ++i) {
    const Solved& room = three.at[i];
    double absorbed_lm = 0.0;
    double emitted_lm = 0.0;
    for (const EnergyBalance& balance : room.solution.balances) {
      absorbed_lm += balance.absorbed_lm;
      emitted_lm += balance.emitted_lm;
    }
    EXPECT_NEAR(emitted_lm, 2000.0, 1.0);  // both sides of the panel
    EXPECT_NEAR(absorbed_lm, 2000.0, 20.0);
    EXPECT_NEAR(meanOf(room.sensors_lx()), truth_lx, (accuracies[i] + 2.0 * truthError) * truth_lx);
  }
}

TEST(Stability, Reflectance99) {
  expectBrightRoom(0.99);
}
// Its 130 steps take 81 million rays at fine. With 50 million, each step held to a quarter of the threshold
// instead of a sixteenth, it is 10, 3.3 and 2.4 % too dark against paths.
TEST(Stability, Reflectance999) {
  expectBrightRoom(0.999, {.rays = 100000000});
}

TEST(Stability, Plates1Millimetre) {
  expectFurnace(solvedAtThree(plates(1e-3, 0.8)), 0.8);
}
// So much wider than the gap is high that hardly a ray from between them finds its way out.
TEST(Stability, WidePlates1Millimetre) {
  expectFurnace(solvedAtThree(plates(1e-3, 0.8, 8.0)), 0.8);
}
TEST(Stability, PlatesTenthOfAMillimetre) {
  expectFurnace(solvedAtThree(plates(1e-4, 0.8)), 0.8);
}
TEST(Stability, PlatesThatTouch) {
  expectFurnace(solvedAtThree(plates(0.0, 0.8)), 0.8);
}

TEST(Stability, WallsAt1Degree) {
  expectFurnace(solvedAtThree(wedge(1.0, 0.8)), 0.8);
}
TEST(Stability, WallsAt179Degrees) {
  expectFurnace(solvedAtThree(wedge(179.0, 0.8)), 0.8);
}
TEST(Stability, WallsAt30Degrees) {
  expectFurnace(solvedAtThree(wedge(30.0, 0.8)), 0.8);
}
TEST(Stability, WallsAt90Degrees) {
  expectFurnace(solvedAtThree(wedge(90.0, 0.8)), 0.8);
}
TEST(Stability, WallsAt150Degrees) {
  expectFurnace(solvedAtThree(wedge(150.0, 0.8)), 0.8);
}

TEST(Stability, Slivers) {
  expectFurnace(solvedAtThree(slivers(0.8)), 0.8);
}

// A rug drawn in the floor's plane and one across its edge, of the floor's reflectance: as if they were not.
TEST(Stability, CoplanarFacesOverlap) {
  Case rugs = litRoom(0.5);
  rugs.drawing.scene.materials[wood].reflectance = glm::dvec3(0.5);
  const std::uint32_t rug = addObject(rugs.drawing, "rug");
  rugs.drawing.face({{1, 1, 0}, {3, 1, 0}, {3, 2, 0}, {1, 2, 0}}, wood, rug);
  rugs.drawing.face({{2, 1.5, 0}, {3.5, 1.5, 0}, {3.5, 3, 0}, {2, 3, 0}}, wood,
                    addObject(rugs.drawing, "second rug"));
  const Three with = solvedAtThree(rugs);
  const Three without = solvedAtThree(litRoom(0.5));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT(measuredErrors("rugs", with.at[i].sensors_lx(), without.at[i].sensors_lx()).p95,
              2.0 * accuracies[i]);
  }
}

TEST(Stability, MillimetreInAKilometre) {
  const Three with = solvedAtThree(millimetreInKilometre({0, 0, 0}, true));
  const Three without = solvedAtThree(millimetreInKilometre({0, 0, 0}, false));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT(measuredErrors("with cube", with.at[i].sensors_lx(), without.at[i].sensors_lx()).maximum,
              2.0 * accuracies[i]);
  }
}

// Where a national grid has its buildings: 2,600 km east, 1,200 km north.
TEST(Stability, MillimetreInAKilometreFarFromTheOrigin) {
  const Three far = solvedAtThree(millimetreInKilometre({2.6e6, 1.2e6, 400.0}, true));
  const Three near = solvedAtThree(millimetreInKilometre({0, 0, 0}, true));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT(measuredErrors("far", far.at[i].sensors_lx(), near.at[i].sensors_lx()).maximum,
              2.0 * accuracies[i]);
  }
}

// Luminance times solid angle: the opening is far smaller than the way to it.
TEST(Stability, PinholeToTheSky) {
  const double luminance = 10000.0 / std::numbers::pi;
  for (const double side_m : {0.01, 0.001}) {
    const Three three = solvedAtThree(pinhole(side_m, 0.0));
    for (std::size_t i = 0; i < 3; ++i) {
      const std::vector<double> values_lx = three.at[i].sensors_lx();
      const double way2 = 3.0 * 3.0;
      const double below_lx = luminance * side_m * side_m / way2;
      const double beside_lx = luminance * side_m * side_m * way2 / ((way2 + 1.0) * (way2 + 1.0));
      EXPECT_NEAR(values_lx[0], below_lx, accuracies[i] * below_lx);
      for (std::size_t k = 1; k < 5; ++k)
        EXPECT_NEAR(values_lx[k], beside_lx, accuracies[i] * beside_lx) << "side " << k;
    }
  }
}

TEST(Stability, PinholeToTheSkyInAWhiteRoom) {
  const Three three = solvedAtThree(pinhole(0.01, 0.9));
  // Four sensors around the middle are the same by symmetry.
  for (std::size_t i = 0; i < 3; ++i) {
    const std::vector<double> values_lx = three.at[i].sensors_lx();
    for (std::size_t k = 2; k < 5; ++k)
      EXPECT_NEAR(values_lx[k], values_lx[1], 2.0 * accuracies[i] * values_lx[1]);
  }
}

// An opening too narrow to join airs leaves a room dark, but not in silence.
TEST(Stability, RoomBehindAKeyholeIsToldToBeDark) {
  for (const Solved& rooms : solvedAtThree(keyhole()).at) {
    EXPECT_GT(rooms.sensors_lx().at(0), 0.0);
    EXPECT_EQ(rooms.sensors_lx().at(1), 0.0);
    const auto told = std::ranges::find(rooms.building.diagnoses, "G252", &Diagnosis::code);
    ASSERT_NE(told, rooms.building.diagnoses.end());
    EXPECT_NE(told->message.find("12.00 m2"), std::string::npos) << told->message;
    ASSERT_TRUE(told->place_m);
    EXPECT_LT(glm::length(*told->place_m - glm::dvec3(4.0, 1.5, 1.025)), 0.03);
  }
}

TEST(Stability, ThousandsOfTinyPolygons) {
  expectFurnace(solvedAtThree(tinyPolygons(0.5)), 0.5);
}

// A floor under nothing but a uniform sky.
TEST(Stability, OnePolygon) {
  Case scene;
  scene.drawing.face({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}});
  scene.study.sky.cieType = 5;
  scene.study.grids = {gridOf({{5, 5, 0.85}, {1, 1, 0.001}, {5, 5, 3}, {20, 5, 1}})};
  expectEven(solvedAtThree(scene), 10000.0);
}

// Without reflection there is only what comes straight: nothing is reflected, not even a little.
TEST(Stability, BlackScene) {
  for (const Case& scene : {litRoom(0.0), openRoom(0.0)}) {
    const Three three = solvedAtThree(scene);
    for (const Solved& room : three.at) {
      for (const SensorValue& sensor : room.solution.grids.at(0).sensors) {
        EXPECT_GT(sensor.direct_lx, 0.0);
        EXPECT_LT(sensor.reflected_lx, 0.02 * sensor.direct_lx);  // the inner face of the glass
      }
    }
  }
}

TEST(Stability, NoLight) {
  Case scene;
  addBox(scene.drawing, {0, 0, 0}, {4, 4, 3});
  scene.study.grids = {gridOf({{2, 2, 0.85}})};
  expectEven(solvedAtThree(scene), 0.0);
  Case night = openRoom(0.5);
  night.study.sky.diffuseHorizontal_lx = 0.0;
  const Three three = solvedAtThree(night);
  for (const Solved& room : three.at) {
    for (const double value_lx : room.sensors_lx()) EXPECT_EQ(value_lx, 0.0);
  }
}

Case sunny(double altitude_deg, double azimuth_deg) {
  Case scene = openRoom(0.5);
  scene.study.sky.diffuseHorizontal_lx = 0.0;
  scene.study.sky.directNormal_lx = 60000.0;
  scene.study.sky.sun_deg = glm::dvec2(altitude_deg, azimuth_deg);
  return scene;
}

TEST(Stability, OnlyASun) {
  const Three three = solvedAtThree(sunny(40.0, 180.0));
  for (const Solved& room : three.at) {
    for (const SensorValue& sensor : room.solution.grids.at(0).sensors) {
      EXPECT_GT(sensor.sun_lx, 0.0);
      EXPECT_EQ(sensor.sky_lx, 0.0);
    }
  }
}

// The sun half a degree above the horizon, and half a degree off the plane of the window.
TEST(Stability, GrazingSun) {
  solvedAtThree(sunny(0.5, 180.0));
  solvedAtThree(sunny(30.0, 90.5));
}

// A lamp that lies 1 mm above the floor and shines along it.
TEST(Stability, GrazingLamp) {
  Case scene = litRoom(0.5);
  const std::uint32_t strip = addObject(scene.drawing, "strip");
  const std::uint32_t lamp = addLamp(scene.drawing, 1e6);
  addBox(scene.drawing, {0.5, 1.0, 0.001}, {0.502, 3.0, 0.003}, lamp, strip);
  solvedAtThree(scene);
}

// Paths (tests/bench/reference_paths.cpp, under this sky) have 22.55 lx behind white blades and 17.61 lx
// behind black ones, each within 0.2 %. The defect is held to what is reached: see docs/stability.md.
TEST(Stability, LouvresWith500Blades) {
  const Three black = solvedAtThree(louvres(0.0), {.defect = 0.07});
  const Three white = solvedAtThree(louvres(0.8), {.defect = 0.07});
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(meanOf(black.at[i].sensors_lx()), 17.61, accuracies[i] * 17.61);
    EXPECT_NEAR(meanOf(white.at[i].sensors_lx()), 22.55, accuracies[i] * 22.55);
  }
}

TEST(Stability, LampInsideACluster) {
  solvedAtThree(lampInCluster(0.5));
}

// Between plates that go on for ever light is thrown to and fro: E of the upper one is M / (1 -
// reflectance²).
TEST(Stability, LargeNearPlates) {
  const Three three = solvedAtThree(nearPlates(0.5));
  const double upper_lx = 1000.0 / (1.0 - 0.25);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::vector<double> values_lx = three.at[i].sensors_lx();
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(values_lx[k], upper_lx, accuracies[i] * upper_lx);
  }
}

// Accuracies that cannot be meant are refused; the coarsest that is taken is still sound.
TEST(Stability, AbsurdAccuracies) {
  for (const char* absurd : {"0.0001%", "0%", "-5%", "1000%", "nan%"})
    EXPECT_FALSE(parseAccuracy(absurd)) << absurd;
  Case scene = litRoom(0.5);
  scene.study.accuracy = 0.5;
  expectSound(solved(scene.drawing.scene, scene.study), {.defect = 0.05});
}

Solved solvedWithin(Case scene, double accuracy, std::size_t bytes, int threads = 0) {
  scene.study.accuracy = accuracy;
  SolveOptions options;
  options.pictures = false;
  options.memoryBytes = bytes;
  options.threads = threads;
  Building building = buildingOf(scene.drawing.scene, scene.study);
  Solution solution = solve(building, scene.study, options);
  return {std::move(building), std::move(solution)};
}

bool saysMemory(const Solved& scene) {
  const auto& diagnoses = scene.solution.diagnoses;
  return std::any_of(diagnoses.begin(), diagnoses.end(),
                     [](const Diagnosis& diagnosis) { return diagnosis.code == "S301"; });
}

TEST(Stability, MemoryReached) {
  for (const double accuracy : accuracies) {
    const Case scene = openRoom(0.5);
    const Solved room = solvedWithin(scene, accuracy, std::size_t{64} << 10);
    expectSound(room, {.defect = 0.05});
    EXPECT_TRUE(saysMemory(room));
    const Solved whole = solvedWithin(scene, accuracy, std::size_t{4} << 30);
    EXPECT_FALSE(saysMemory(whole));
    EXPECT_LT(measuredErrors("within 64 KiB", room.sensors_lx(), whole.sensors_lx()).p95, 0.25);
  }
}

// The library takes 0.01 %, for which there is no room: it ends with what there is room for, which is the
// same on any number of threads.
TEST(Stability, AccuracyBeyondTheMemory) {
  constexpr std::size_t bytes = std::size_t{8} << 20;
  const Case scene = openRoom(0.5);
  const Solved room = solvedWithin(scene, 1e-4, bytes);
  expectSound(room, {});
  EXPECT_TRUE(saysMemory(room));
  EXPECT_LE(room.solution.hierarchyBytes, bytes);
  EXPECT_GT(room.solution.elements, 5000U);
  EXPECT_EQ(solvedWithin(scene, 1e-4, bytes, 1).sensors_lx(), room.sensors_lx());
  const Solved whole = solvedWithin(scene, 2e-3, std::size_t{4} << 30);
  EXPECT_LT(measuredErrors("within 8 MiB", room.sensors_lx(), whole.sensors_lx()).p95, fine);
}

// More light in, more out: a lamp is added to a room with a window, or its walls are whiter.
TEST(Stability, MoreLightInIsMoreOut) {
  const Case dim = openRoom(0.5);
  Case bright = dim;
  bright.drawing.face({{1.5, 2.5, 2.9}, {1.5, 3.5, 2.9}, {2.5, 3.5, 2.9}, {2.5, 2.5, 2.9}},
                      addLamp(bright.drawing), addObject(bright.drawing, "lamp"));
  Case whiter = openRoom(0.6);
  const Three low = solvedAtThree(dim);
  const Three high = solvedAtThree(bright);
  const Three reflecting = solvedAtThree(whiter);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < low.at[i].sensors_lx().size(); ++k) {
      const double value_lx = low.at[i].sensors_lx()[k];
      EXPECT_GT(high.at[i].sensors_lx()[k], (1.0 - accuracies[i]) * value_lx);
      EXPECT_GT(reflecting.at[i].sensors_lx()[k], (1.0 - accuracies[i]) * value_lx);
    }
    EXPECT_GT(meanOf(high.at[i].sensors_lx()), meanOf(low.at[i].sensors_lx()));
    EXPECT_GT(meanOf(reflecting.at[i].sensors_lx()), meanOf(low.at[i].sensors_lx()));
  }
}

// A square room with its lamp in the middle has eight places alike for each.
TEST(Stability, SymmetricRoomIsSymmetric) {
  const Three three = solvedAtThree(litRoom(0.8));
  for (std::size_t i = 0; i < 3; ++i) {
    const std::vector<double> values_lx = three.at[i].sensors_lx();  // 8 x 8
    for (std::size_t row = 0; row < 8; ++row) {
      for (std::size_t column = 0; column < 8; ++column) {
        const double value_lx = values_lx[8 * row + column];
        for (const std::size_t other : {8 * row + 7 - column, 8 * (7 - row) + column, 8 * column + row})
          EXPECT_NEAR(values_lx[other], value_lx, 2.0 * accuracies[i] * value_lx);
      }
    }
  }
}

// A bound that is not kept is refused where it is stated, in words.
TEST(Stability, TimeLimitIsRefused) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "stability_time.toml";
  std::ofstream(file) << "[model]\nfile = \"room.obj\"\n[accuracy]\ntime_limit_s = 5\n";
  try {
    readStudy(file);
    FAIL() << "a time limit was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("time_limit_s"), std::string::npos) << error.what();
  }
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace clerestory
