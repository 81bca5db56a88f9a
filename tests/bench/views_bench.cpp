// SPDX-License-Identifier: GPL-3.0-or-later
// A study's pictures beside brute force: at pixels chosen at random, light gathered by thousands of rays at
// each of many places of the pixel, with nothing shared or smoothed. CPU time of each picture, and how far
// the logarithm of its luminance is off.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <optional>
#include <set>

#include <geometry/parallel.hpp>
#include <geometry/sampling.hpp>

#include "bright.hpp"
#include "camera.hpp"
#include "outside.hpp"
#include "reconstruction.hpp"
#include "shooting.hpp"
#include "view.hpp"
#include "watch.hpp"

namespace clerestory {
namespace {

struct Options {
  std::filesystem::path study;
  std::size_t pixels = 1000, worst = 0;
  std::uint32_t spots = 16, rays = 512;
  int threads = 2;
};

std::vector<std::uint32_t> sidesOf(const Building& building, std::int32_t domain) {
  std::vector<std::uint32_t> sides;
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
    if (building.sideDomain[side] == domain && !building.innerGlass[side / 2]) sides.push_back(side);
  }
  return sides;
}

/// All rooms of a building solved, and the outside before them.
template <int K>
void solveInto(SolvedLight<K>& light, const Study& study) {
  const World& world = light.world();
  const TransportSettings settings = transportFor(study.accuracy);
  std::set<std::int32_t> asked{0};
  for (const Room& room : world.building.rooms) asked.insert(room.domain);
  bool arePanesLit = false;
  for (const std::int32_t domain : asked) {
    const Domain& air = world.building.domains[static_cast<std::size_t>(domain)];
    const std::vector<std::uint32_t> sides = sidesOf(world.building, domain);
    if (!air.lit || sides.empty()) continue;
    if (!air.open && !arePanesLit) {
      light.lightDiffusingPanes();
      arePanesLit = true;
    }
    Hierarchy tree = air.open
                         ? outsideTree(world, study, domain, sides)
                         : Hierarchy(world.pieces(), sides, world.rays.origin(), std::span<const float>());
    LinkCache cache(std::size_t{16} << 20);
    SolvedDomain<K> solved = shootingHR(light, domain, std::move(tree), settings, cache);
    if (solved.threshold_lm > 0.0F) reconstruct(world, solved.threshold_lm, solved.radiosity);
    findBrightParts(world.layout, solved.radiosity);
    light.add(domain, std::move(solved.radiosity));
  }
}

/// What brute force says of a pixel.
struct Truth {
  std::size_t pixel = 0;
  double luminance_cd_m2 = 0.0, illuminance_lx = 0.0;
  bool isWithinOnePiece = false;
};

/// Nothing for a pixel that shows glass, sky or a lamp anywhere: these need no gather.
template <int K>
std::optional<Truth> truthOf(const SolvedLight<K>& light, const Camera& camera, const glm::vec3& eye,
                             std::size_t pixel, const Options& options) {
  const World& world = light.world();
  const GatherSettings settings{
      {2.0F * static_cast<float>(options.rays), 0.125F * static_cast<float>(options.rays)}, options.rays};
  const Sequence sequence(mixKeys(0xb37c, pixel));
  const auto width = static_cast<std::size_t>(camera.width());
  std::set<std::uint32_t> pieces;
  Truth truth;
  truth.pixel = pixel;
  for (std::uint32_t i = 0; i < options.spots; ++i) {
    const auto direction = camera.direction(static_cast<float>(pixel % width) + sequence(i, 0),
                                            static_cast<float>(pixel / width) + sequence(i, 1));
    if (!direction) return std::nullopt;
    const auto hit = world.rays.nearest(eye, *direction, RayScene::Barrier::opaqueAndGlass);
    if (!hit || !light.isSolved(hit) || world.materialOf(hit.piece).glazing ||
        lampLuminance(world, eye, *direction, hit.distance_m))
      return std::nullopt;
    pieces.insert(hit.piece);
    const std::int32_t domain = world.building.sideDomain[hit.side()];
    const glm::vec3 normal = world.normalOf(hit.side());
    const glm::vec3 point = eye + hit.distance_m * *direction + rayOffset_m * normal;
    const std::uint64_t key = mixKeys(0xb37d, pixel * options.spots + i);
    const Gathered<K> arriving = gather(light, domain, point, normal, settings, key);
    const Columns<K> irradiance =
        arriving.direct_lx + arriving.reflected_lx +
        world.layout.template light<K>(world.layout.sunColumn(),
                                       glm::dvec3(sunlightByDisc(world, point, normal, 16, key)));
    const Columns<K> exitance =
        world.layout.template property<K>(world.reflectanceOf(hit.piece)) * irradiance +
        world.layout.template light<K>(world.layout.electricColumn(),
                                       world.materialOf(hit.piece).exitance_lm_m2);
    truth.illuminance_lx += luminanceOf(world.layout.totalColour(irradiance)) / options.spots;
    truth.luminance_cd_m2 +=
        std::numbers::inv_pi * luminanceOf(world.layout.totalColour(exitance)) / options.spots;
  }
  truth.isWithinOnePiece = pieces.size() == 1;
  return truth;
}

template <int K>
std::vector<Truth> truthsOf(const SolvedLight<K>& light, const ViewSettings& view, const Options& options) {
  const Camera camera(view);
  const glm::vec3 eye = light.world().local(view.eye_m);
  const auto count = static_cast<std::size_t>(camera.width()) * static_cast<std::size_t>(camera.height());
  std::vector<std::optional<Truth>> found(options.pixels);
  const Sequence sequence(0xb37b);
  forEachIndex(found.size(), 4, [&](std::size_t i) {
    const auto at = static_cast<double>(sequence(static_cast<std::uint32_t>(i), 0));
    found[i] =
        truthOf(light, camera, eye, static_cast<std::size_t>(at * static_cast<double>(count)), options);
  });
  std::vector<Truth> truths;
  for (const std::optional<Truth>& truth : found) {
    if (truth && truth->luminance_cd_m2 > 0.0) truths.push_back(*truth);
  }
  return truths;
}

void print(const std::string& what, std::vector<double> errors) {
  if (errors.empty()) return;
  double squares = 0.0;
  double sum = 0.0;
  for (double& error : errors) {
    squares += error * error;
    sum += error;
    error = std::abs(error);
  }
  const auto count = static_cast<double>(errors.size());
  std::sort(errors.begin(), errors.end());
  const auto quantile = [&](double share) { return errors[static_cast<std::size_t>(share * (count - 1.0))]; };
  std::cout << "  " << what << ", " << errors.size() << " pixels: rms " << std::sqrt(squares / count)
            << ", bias " << sum / count << ", median " << quantile(0.5) << ", p95 " << quantile(0.95)
            << ", p99 " << quantile(0.99) << std::endl;
}

template <int K>
void measure(const World& world, const Study& study, const Options& options) {
  SolvedLight<K> light(world);
  solveInto(light, study);
  for (const ViewSettings& view : study.views) {
    const Watch watch;
    const LuminanceImage image = renderView(light, view, picturesFor(study.accuracy));
    const Seconds seconds = watch.elapsed();
    std::cout << view.name << ": " << seconds.cpu << " s of CPU, " << seconds.wall << " s" << std::endl;
    std::vector<double> all;
    std::vector<double> within;
    std::vector<std::pair<double, Truth>> worst;
    for (const Truth& truth : truthsOf(light, view, options)) {
      const double own = luminanceOf(glm::dvec3(image.pixels_cd_m2[truth.pixel]));
      const double error = std::log(std::max(own, 1e-6) / truth.luminance_cd_m2);
      all.push_back(error);
      worst.emplace_back(std::abs(error), truth);
      if (!truth.isWithinOnePiece) continue;
      within.push_back(error);
    }
    print("all", all);
    print("within one piece", within);
    std::sort(worst.begin(), worst.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    worst.resize(std::min(worst.size(), options.worst));
    for (const auto& [error, truth] : worst) {
      std::cout << "    pixel " << truth.pixel % static_cast<std::size_t>(image.width) << ", "
                << truth.pixel / static_cast<std::size_t>(image.width) << ": "
                << luminanceOf(glm::dvec3(image.pixels_cd_m2[truth.pixel])) << " for "
                << truth.luminance_cd_m2 << " cd/m2" << (truth.isWithinOnePiece ? "" : ", at an edge")
                << std::endl;
    }
  }
}

void run(const Options& options) {
  Study study = readStudy(options.study);
  Scene scene = readModel(study.modelFile, study.model);
  applyMaterialRules(study, scene);
  addSurroundings(study, scene);
  withThreads(options.threads, [&] {
    const Building building = makeBuilding(cleanScene(scene), study);
    const World world(building, study);
    const int used = world.layout.used();
    if (used <= 1) {
      measure<1>(world, study, options);
    } else if (used <= 2) {
      measure<2>(world, study, options);
    } else if (used <= 4) {
      measure<4>(world, study, options);
    } else if (used <= 8) {
      measure<8>(world, study, options);
    } else {
      measure<12>(world, study, options);
    }
  });
}

}  // namespace
}  // namespace clerestory

int main(int argc, char** argv) {
  clerestory::Options options;
  CLI::App app("pictures against brute force");
  app.add_option("study", options.study, "a study with views")->required();
  app.add_option("--pixels", options.pixels, "of each picture that are looked at");
  app.add_option("--worst", options.worst, "of these to be listed");
  app.add_option("--spots", options.spots, "of a pixel");
  app.add_option("--rays", options.rays, "of a spot, for reflected light");
  app.add_option("--threads", options.threads, "to run on");
  CLI11_PARSE(app, argc, argv);
  clerestory::run(options);
}
