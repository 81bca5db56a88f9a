// SPDX-License-Identifier: GPL-3.0-or-later
// Nanoseconds of a form factor: near and clipped by the horizon, at middle distance, and far enough for the
// area form.
#include <benchmark/benchmark.h>

#include <array>
#include <vector>

#include <solver/formfactor.hpp>

namespace clerestory {
namespace {

const std::array<glm::vec3, 4> kQuad{
    {{-0.5F, -0.5F, 0.0F}, {0.5F, -0.5F, 0.0F}, {0.5F, 0.5F, 0.0F}, {-0.5F, 0.5F, 0.0F}}};

template <class Vector>
void pointToQuad(benchmark::State& state, const glm::vec3& point, const glm::vec3& normal) {
  std::vector<Vector> polygon(kQuad.begin(), kQuad.end());
  Vector from(point);
  const Vector up(normal);
  for (auto _ : state) {
    benchmark::DoNotOptimize(from);
    benchmark::DoNotOptimize(pointToPolygon(from, up, polygon));
  }
}

void inFloat(benchmark::State& state, const glm::vec3& point, const glm::vec3& normal) {
  pointToQuad<glm::vec3>(state, point, normal);
}
void inDouble(benchmark::State& state, const glm::vec3& point, const glm::vec3& normal) {
  pointToQuad<glm::dvec3>(state, point, normal);
}

const glm::vec3 kDown(0.0F, 0.0F, -1.0F);
BENCHMARK_CAPTURE(inFloat, near, glm::vec3(0.3F, 0.1F, 0.4F), kDown);
BENCHMARK_CAPTURE(inFloat, clipped, glm::vec3(0.1F, 0.1F, 0.4F), glm::vec3(1.0F, 0.0F, 0.0F));
BENCHMARK_CAPTURE(inFloat, middle, glm::vec3(1.0F, 2.0F, 5.0F), kDown);
BENCHMARK_CAPTURE(inFloat, far, glm::vec3(10.0F, 20.0F, 50.0F), kDown);
BENCHMARK_CAPTURE(inDouble, near, glm::vec3(0.3F, 0.1F, 0.4F), kDown);

}  // namespace
}  // namespace clerestory
