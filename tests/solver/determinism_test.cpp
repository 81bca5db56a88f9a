// SPDX-License-Identifier: GPL-3.0-or-later
// The same bits with every size of the link cache and on every number of threads.
#include "solved.hpp"

namespace clerestory {
namespace {

// Furnished, so that there are clusters, shadows and cached links, and in two columns: daylight and a ceiling
// that shines.
TEST(Determinism, CachesAndThreadsChangeNoBit) {
  Study study;
  study.accuracy = 0.1;
  study.materials.push_back({.glob = "ceiling",
                             .reflectance = {},
                             .transmittance = {},
                             .panes = {},
                             .exitance_lm_m2 = glm::dvec3(100.0)});
  study.grids = {drawn::gridOf(drawn::pointsOver({0.2, 0.2, 0}, {3.4, 8.0, 2.8}, 0.85, 0.8))};
  const Building building = drawn::buildingOf(testModel("reference/furnished/furnished.obj", study), study);
  std::vector<double> first;
  std::uint64_t reusedMost = 0;
  constexpr std::size_t kibi = 1024;
  for (const auto& [bytes, threads] :
       {std::pair{0 * kibi, 1}, std::pair{0 * kibi, 3}, std::pair{kibi, 2}, std::pair{16 * kibi, 3},
        std::pair{256 * kibi, 2}, std::pair{kibi * kibi, 1}, std::pair{kibi * kibi * kibi, 3}}) {
    SolveOptions options;
    options.threads = threads;
    options.linkCacheBytes = bytes;
    options.pictures = false;
    const Solution solution = solve(building, study, options);
    const std::vector<double> figures = figuresOf(solution);
    if (first.empty()) {
      first = figures;
      EXPECT_EQ(solution.columns, 2);
      EXPECT_GT(first.size(), 100U);
    }
    EXPECT_TRUE(figures == first) << bytes << " bytes, " << threads << " threads";
    std::uint64_t reused = 0;
    for (const IterationStatistics& row : solution.iterations) reused += row.linksReused;
    reusedMost = std::max(reusedMost, reused);
  }
  EXPECT_GT(reusedMost, 0U);  // or nothing has been tested
}

}  // namespace
}  // namespace clerestory
