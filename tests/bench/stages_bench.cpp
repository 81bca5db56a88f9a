// SPDX-License-Identifier: GPL-3.0-or-later
// CPU seconds of each stage from a model's file to the start of its solve:
// build/…/bench_stages MODEL…
#include <chrono>
#include <cstdio>
#include <ctime>
#include <numeric>
#include <string>

#include <geometry/rays.hpp>
#include <solver/solution.hpp>

#include "hierarchy.hpp"

namespace clerestory {
namespace {

/// Prints the CPU and wall time of a stage as soon as it ends.
template <class Stage>
auto timed(const char* name, const Stage& stage) {
  const std::clock_t cpu = std::clock();
  const auto wall = std::chrono::steady_clock::now();
  auto result = stage();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - wall;
  std::printf("  %-10s %8.2f s CPU %8.2f s\n", name, static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC,
              elapsed.count());
  return result;
}

/// The sides of the domain that has most of them among those that are closed and lit.
std::vector<std::uint32_t> sidesOfLargestDomain(const Building& building) {
  std::vector<std::vector<std::uint32_t>> sides(building.domains.size());
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
    const std::int32_t domain = building.sideDomain[side];
    if (domain >= 0) sides[static_cast<std::size_t>(domain)].push_back(side);
  }
  std::vector<std::uint32_t> largest;
  for (std::size_t domain = 0; domain < sides.size(); ++domain) {
    const Domain& own = building.domains[domain];
    if (own.lit && !own.open && sides[domain].size() > largest.size()) largest = sides[domain];
  }
  return largest;
}

void measure(const std::filesystem::path& file) {
  std::printf("%s\n", file.string().c_str());
  Study study = studyOfModel(file);
  study.grids.clear();
  Scene scene = timed("reading", [&] { return readModel(file, study.model); });
  CleanModel clean = timed("cleaning", [&] { return cleanScene(scene); });
  std::printf("  %zu faces, %zu polygons, %zu pieces\n", clean.counts.facesRead, clean.counts.polygons,
              clean.counts.pieces);
  scene = {};
  const Building building = timed("airs", [&] { return makeBuilding(std::move(clean), study); });
  std::printf("  %zu pieces, %zu airs, %zu rooms\n", building.model.pieces.size(), building.domains.size(),
              building.rooms.size());
  const RayScene rays = timed("ray trees", [&] { return RayScene(building.model, building.innerGlass); });
  const std::vector<std::uint32_t> sides = sidesOfLargestDomain(building);
  const Hierarchy tree =
      timed("hierarchy", [&] { return Hierarchy(building.model.pieces, sides, rays.origin(), {}); });
  // What a ray pays for the tree: the surface of its boxes against that of the root.
  double surface = 0.0;
  for (NodeIndex node = 0; node < tree.trunkSize(); ++node) {
    if (!tree.isCluster(node)) continue;
    const glm::dvec3 size(tree.corners[tree.firstCorner[node] + 1] - tree.corners[tree.firstCorner[node]]);
    surface += size.x * size.y + size.y * size.z + size.z * size.x;
  }
  const glm::dvec3 whole(tree.corners[tree.firstCorner[0] + 1] - tree.corners[tree.firstCorner[0]]);
  std::printf("  %zu sides in its tree; its boxes have %.2f times the root's surface\n", sides.size(),
              surface / (whole.x * whole.y + whole.y * whole.z + whole.z * whole.x));
}

}  // namespace
}  // namespace clerestory

int main(int count, char** files) {
  for (int i = 1; i < count; ++i) clerestory::measure(files[i]);
  return count > 1 ? 0 : 2;
}
