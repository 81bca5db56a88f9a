// SPDX-License-Identifier: GPL-3.0-or-later
// Rays a second in the sample office: the nearest hit, and whether two points see each other.
#include <benchmark/benchmark.h>

#include <filesystem>

#include <geometry/rays.hpp>
#include <geometry/sampling.hpp>

namespace clerestory {
namespace {

const Building& office() {
  static const Building building = [] {
    const std::filesystem::path file = std::filesystem::path(CLERESTORY_SAMPLES) / "office/office.glb";
    Study study = studyOfModel(file);
    return makeBuilding(cleanScene(readModel(file, {})), study);
  }();
  return building;
}

// A point in the office's air.
glm::vec3 placeOf(const Sequence& sequence, std::uint32_t i, const RayScene& rays) {
  return glm::vec3(glm::dvec3(0.3 + 11.0 * static_cast<double>(sequence(i, 0)),
                              0.3 + 7.0 * static_cast<double>(sequence(i, 1)), 1.4) -
                   rays.origin());
}

void nearest(benchmark::State& state) {
  const RayScene rays(office().model, office().innerGlass);
  const Sequence sequence(1);
  std::uint32_t i = 0;
  for (auto _ : state) {
    const glm::vec3 direction =
        cosineDirection({0, 0, i % 2 == 0 ? 1.0F : -1.0F}, sequence(i, 2), sequence(i, 3));
    benchmark::DoNotOptimize(
        rays.nearest(placeOf(sequence, i, rays), direction, RayScene::Barrier::opaqueAndGlass));
    ++i;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(nearest);

void occluded(benchmark::State& state) {
  const RayScene rays(office().model, office().innerGlass);
  const Sequence from(2);
  const Sequence to(3);
  std::uint32_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(rays.occluded(placeOf(from, i, rays), placeOf(to, i, rays) - glm::vec3(0, 0, 1),
                                           RayScene::Barrier::opaqueAndGlass));
    ++i;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(occluded);

}  // namespace
}  // namespace clerestory
