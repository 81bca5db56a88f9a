// SPDX-License-Identifier: GPL-3.0-or-later
// A whole solve in its order: the outside, then each domain behind glass, then sensors, surfaces and views.
#include <algorithm>
#include <cmath>
#include <set>

#include <geometry/parallel.hpp>
#include <import/error.hpp>
#include <solver/solution.hpp>

#include "bright.hpp"
#include "gathering.hpp"
#include "importance.hpp"
#include "outside.hpp"
#include "plain.hpp"
#include "reconstruction.hpp"
#include "rooms.hpp"
#include "sensors.hpp"
#include "shooting.hpp"
#include "surfaces.hpp"
#include "view.hpp"

namespace clerestory {
namespace {

/// What an interaction errs by, as a share of what it may: what is within the noise of that is smoothed away,
/// and at 1 the floor of twelve offices loses a hundredth of its reflected light with it
/// (docs/validation.md).
constexpr float errorOfInteraction = 0.2F;

/// What an asked accuracy sets inside, beside the transport's settings as well calibrated.
struct Tuning {
  TransportSettings transport;
  GatherSettings sensors;
  PictureSettings views;
  PlainSettings plain;
};

Tuning tuningFor(double accuracy, const SolveOptions& options) {
  const double finer = 0.05 / accuracy;  // 1 at the standard accuracy
  Tuning tuning;
  tuning.transport = transportFor(accuracy);
  tuning.transport.memoryBytes = options.memoryBytes;
  tuning.sensors.direct = {static_cast<float>(32.0 * finer), static_cast<float>(32.0 * finer)};
  tuning.sensors.rays = static_cast<std::uint32_t>(std::clamp(128.0 * finer, 32.0, 4096.0));
  tuning.sensors.deviationMost = static_cast<float>(0.2 * accuracy);
  tuning.views = picturesFor(accuracy);
  tuning.plain.elementSize_m = static_cast<float>(0.4 / std::sqrt(finer));
  tuning.plain.raysPerElement = static_cast<std::uint32_t>(std::max(128.0 * finer, 8.0));
  tuning.plain.direct = {static_cast<float>(15.0 * finer), static_cast<float>(2.0 * finer)};
  tuning.plain.endShare = 0.02 * accuracy;

  if (options.epsilon) tuning.transport.epsilon = *options.epsilon;
  if (options.sensorRays) {
    const float ofPolygons = static_cast<float>(*options.sensorRays) / 2.0F;
    tuning.sensors = {{ofPolygons, ofPolygons}, *options.sensorRays};
  }
  return tuning;
}

/// The threshold falls with the root of the rooms, so the error of each still grows with their number,
/// slowly.
SolverError solverError(double accuracy, double rooms, double meanReflected_lm_m2) {
  return {.surfaces = (0.0075 + 0.5 * accuracy) * std::pow(rooms, 0.125),
          .reflected = (0.0125 + 0.07 * accuracy) * std::pow(rooms, 0.25),
          .even_lx = 0.32 * accuracy * std::pow(rooms, 0.125) * meanReflected_lm_m2,
          .gaps = 0.0175 + 0.29 * accuracy,
          .sunInGaps = 0.029};
}

std::vector<std::uint32_t> sidesOf(const Building& building, std::int32_t domain) {
  std::vector<std::uint32_t> sides;
  for (std::uint32_t side = 0; side < building.sideDomain.size(); ++side) {
    if (building.sideDomain[side] == domain && !building.innerGlass[side / 2]) sides.push_back(side);
  }
  return sides;
}

/// Domains that somebody asks about: air that holds a sensor or an eye, or all rooms where neither is
/// indoors. Others (a flat next door, a lit hollow in a ceiling) send nothing anywhere. The outside lights
/// the rest, so it is always among them.
std::set<std::int32_t> askedDomains(const World& world, const Study& study) {
  const Building& building = world.building;
  std::set<std::int32_t> asked;
  for (const SensorGrid& grid : building.grids) {
    if (grid.room >= 0) {
      asked.insert(building.rooms[static_cast<std::size_t>(grid.room)].domain);
      continue;
    }
    for (const glm::dvec3& point : grid.points) asked.insert(domainAt(world, world.local(point)));
  }
  for (const ViewSettings& view : study.views) asked.insert(domainAt(world, world.local(view.eye_m)));
  const bool isIndoors = std::ranges::any_of(asked, [&](std::int32_t domain) {
    return domain >= 0 && !building.domains[static_cast<std::size_t>(domain)].open;
  });
  if (!isIndoors)
    for (const Room& room : building.rooms) asked.insert(room.domain);
  asked.insert(0);
  return asked;
}

void report(const SolveOptions& options, const std::string& stage, double fraction) {
  if (options.progress) options.progress(stage, fraction);
}

/// Plain radiosity as if it had taken one step without links.
template <int K>
SolvedDomain<K> plainDomain(const SolvedLight<K>& light, std::int32_t domain, Hierarchy tree,
                            const PlainSettings& settings) {
  const Stopwatch watch;
  SolvedDomain<K> solved(light.world(), domain, tree);
  PlainSolution<K> plain = plainRadiosity(light, domain, std::move(tree), settings);
  solved.radiosity = std::move(plain.radiosity);
  Tally tally;
  tally.rays = plain.rays;
  solved.addStatistics(tally, 0, 0.0F, watch.seconds());
  return solved;
}

/// Rooms of a domain but for those that importance leaves out, 1 at least. What one interaction may err by is
/// a share of all light in the domain; of twelve rooms that is twelve times as much to each of them. Outdoors
/// nothing may weigh anything: where nobody looks.
double roomsAsked(const World& world, std::int32_t domain, const Hierarchy& tree) {
  const auto rooms = std::ranges::count(world.building.rooms, domain, &Room::domain);
  double area_m2 = 0.0;
  double weight_m2 = 0.0;
  double squares_m2 = 0.0;
  for (const TreeSide& side : tree.sides) {
    const auto own_m2 = static_cast<double>(tree.area_m2[side.root]);
    const auto asked_m2 = static_cast<double>(tree.weight[side.root]);
    area_m2 += own_m2;
    weight_m2 += asked_m2;
    squares_m2 += asked_m2 * asked_m2 / own_m2;
  }
  if (!(squares_m2 > 0.0)) return 1.0;
  const double share = weight_m2 * weight_m2 / (area_m2 * squares_m2);
  return std::max(share * static_cast<double>(rooms), 1.0);
}

/// The outside is always shot: the methods differ in what they do with the light that comes in.
template <int K>
SolvedDomain<K> solveDomain(const SolvedLight<K>& light, std::int32_t domain, Hierarchy tree,
                            const SolveOptions& options, const Tuning& tuning, double rooms) {
  TransportSettings transport = tuning.transport;
  if (!options.epsilon) transport.epsilon /= static_cast<float>(std::sqrt(rooms));
  const bool isOpen = light.world().building.domains[static_cast<std::size_t>(domain)].open;
  if (options.method == Method::gathering && !isOpen)
    return gatheringHR(light, domain, std::move(tree), transport);
  if (options.method == Method::plain && !isOpen)
    return plainDomain(light, domain, std::move(tree), tuning.plain);
  LinkCache cache(options.linkCacheBytes);
  return shootingHR(light, domain, std::move(tree), transport, cache);
}

template <int K>
void solveDomains(const World& world, const Study& study, const SolveOptions& options, const Tuning& tuning,
                  SolvedLight<K>& light, Solution& solution) {
  const auto count = static_cast<std::int32_t>(world.building.domains.size());
  const std::set<std::int32_t> asked = askedDomains(world, study);
  bool arePanesLit = false;
  for (std::int32_t domain = 0; domain < count; ++domain) {
    const Domain& air = world.building.domains[static_cast<std::size_t>(domain)];
    const std::vector<std::uint32_t> sides = sidesOf(world.building, domain);
    if (!air.lit || sides.empty() || !asked.contains(domain)) continue;
    if (!air.open && !arePanesLit) light.lightDiffusingPanes();
    arePanesLit = arePanesLit || !air.open;
    report(options, "light", static_cast<double>(domain) / count);
    Hierarchy tree = air.open ? outsideTree(world, study, domain, sides)
                              : Hierarchy(world.pieces(), sides, world.rays.origin(),
                                          importanceOf(world, study, domain, sides));
    const double rooms = roomsAsked(world, domain, tree);
    SolvedDomain<K> solved = solveDomain(light, domain, std::move(tree), options, tuning, rooms);
    solved.radiosity.solverError = solverError(
        study.accuracy, rooms, luminanceOf(world.layout.totalColour(solved.meanReflected_lm_m2())));
    solution.iterations.insert(solution.iterations.end(), solved.statistics.begin(), solved.statistics.end());
    if (!air.open) solution.balances.push_back(solved.balance);
    for (Diagnosis& diagnosis : solved.diagnoses) addDiagnosis(solution.diagnoses, std::move(diagnosis));
    const Hierarchy& grown = solved.radiosity.tree;
    solution.elements += solved.statistics.empty() ? 0 : solved.statistics.back().elements;
    solution.hierarchyBytes += grown.bytes() + grown.size() * (sizeof(Columns<K>) + sizeof(Plane<K>));
    if (solved.threshold_lm > 0.0F)
      reconstruct(world, errorOfInteraction * solved.threshold_lm, solved.radiosity);
    findBrightParts(world.layout, solved.radiosity);
    light.add(domain, std::move(solved.radiosity));
  }
}

template <int K>
Solution solveColumns(const World& world, const Study& study, const SolveOptions& options) {
  const Tuning tuning = tuningFor(study.accuracy, options);
  Solution solution;
  solution.columns = world.layout.used();
  solution.grey = world.layout.grey;
  SolvedLight<K> light(world);
  solveDomains(world, study, options, tuning, light, solution);

  const std::vector<SensorGrid>& grids = world.building.grids;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    report(options, "sensors", static_cast<double>(i) / static_cast<double>(grids.size()));
    solution.grids.push_back(senseGrid(light, grids[i], tuning.sensors));
  }
  solution.surfaces = measureSurfaces(light, solution.mesh);
  solution.rooms = measureRooms(world, study);
  if (options.pictures) {
    for (std::size_t i = 0; i < study.views.size(); ++i) {
      report(options, "pictures", static_cast<double>(i) / static_cast<double>(study.views.size()));
      solution.views.push_back(renderView(light, study.views[i], tuning.views));
    }
  }
  return solution;
}

}  // namespace

Solution solve(const Building& building, const Study& study, const SolveOptions& options) {
  const World world(building, study);
  if (options.method == Method::plain && (world.sun || !world.lamps.empty()))
    throw InputError("plain radiosity knows neither the sun's beam nor luminaires; chart without it");
  Solution solution;
  withThreads(options.threads, [&] {
    const int used = world.layout.used();
    if (used <= 1) {
      solution = solveColumns<1>(world, study, options);
    } else if (used <= 2) {
      solution = solveColumns<2>(world, study, options);
    } else if (used <= 4) {
      solution = solveColumns<4>(world, study, options);
    } else if (used <= 8) {
      solution = solveColumns<8>(world, study, options);
    } else {
      solution = solveColumns<12>(world, study, options);
    }
  });
  return solution;
}

}  // namespace clerestory
