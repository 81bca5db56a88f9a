// SPDX-License-Identifier: GPL-3.0-or-later
// What more columns cost: the same transport with 1, 2, 4, 8, 16 and 152 of them, all lit. CPU time and bytes
// as CSV.
#include <CLI/CLI.hpp>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>

#include <geometry/parallel.hpp>

#include "stage.hpp"

namespace clerestory {
namespace {

struct Cost {
  double first_s = 1e30, steps_s = 1e30;  ///< CPU: light from outside; its reflections
  std::uint64_t links = 0, rays = 0;
  std::size_t nodes = 0, geometryBytes = 0, valueBytes = 0;
  std::vector<float> firstColumn_lx;  ///< #nodes
};

double cpu_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Column c carries the first one's light times a power of two, so that exact arithmetic keeps them in step.
template <int K>
Columns<K> spread(float first) {
  Columns<K> columns;
  for (int c = 0; c < K; ++c) columns[c] = first * static_cast<float>(1 << (c % 4));
  return columns;
}

template <int K>
void checkColumns(const Hierarchy& tree, const std::vector<Columns<K>>& irradiance_lx) {
  for (NodeIndex node = 0; node < tree.size(); ++node) {
    if (!tree.isLeaf(node)) continue;
    const Columns<K> expected = spread<K>(irradiance_lx[node][0]);
    for (int c = 0; c < K; ++c) {
      if (irradiance_lx[node][c] != expected[c]) throw std::runtime_error("columns carry different light");
    }
  }
}

/// SHOOTING-HR over a room: the first step from outside, whose light is in the first column alone; then its
/// reflections in all columns.
template <int K>
Cost shoot(const Stage<K>& stage, const TransportSettings& settings) {
  const World& world = stage.world();
  SolvedDomain<K> solved(world, stage.domains[0], stage.trees[0]);
  for (Columns<K>& reflectance : solved.radiosity.reflectance) {
    for (int c = 1; c < K; ++c) reflectance[c] = reflectance[0];
  }
  const Hierarchy& tree = solved.radiosity.tree;
  LinkCache cache(std::size_t{16} << 20);
  Cost cost;

  const double start_s = cpu_s();
  Transport<K> transport(stage.outside, stage.domains[0], solved.radiosity, settings, cache, Links::madeAnew);
  transport.setFirstLight(world.layout.strength(transport.enteringPower_lm()));
  std::vector<Columns<K>>& sum = solved.radiosity.irradiance_lx;
  std::vector<Columns<K>> unshot(tree.size());
  float before_lm = 0.0F;
  for (int step = 1; step <= settings.stepsMax; ++step) {
    const std::size_t nodesBefore = tree.size();
    transport.send(unshot, step == 1);
    inheritValues(tree, nodesBefore, sum);
    unshot.resize(tree.size());
    for (NodeIndex node = 0; node < tree.size(); ++node) {
      if (!tree.isLeaf(node)) continue;
      const Columns<K>& received = transport.received()[node].irradiance_lx;
      const Columns<K> next = step == 1 ? spread<K>(received[0]) : received;
      sum[node] += next;
      unshot[node] = solved.reflected(node, next);
    }
    const float after_lm = world.layout.strength(transport.powerOf(unshot));
    transport.handOverLinks(step == 1 ? 1.0F : std::min(after_lm / before_lm, 1.0F));
    before_lm = after_lm;
    cost.links += transport.tally().links;
    cost.rays += transport.tally().rays;
    if (step == 1) cost.first_s = cpu_s() - start_s;
    if (after_lm <= static_cast<float>(settings.endShare) * world.layout.strength(transport.powerOf(sum)))
      break;
  }
  cost.steps_s = cpu_s() - start_s - cost.first_s;

  checkColumns(tree, sum);
  cost.nodes = tree.size();
  cost.geometryBytes = tree.bytes();
  cost.valueBytes = Transport<K>::valueBytes(tree);
  for (const Columns<K>& irradiance_lx : sum) cost.firstColumn_lx.push_back(irradiance_lx[0]);
  return cost;
}

template <int K>
void measure(const World& world, const Study& study, const TransportSettings& settings, int repeats,
             std::map<int, Cost>& costs) {
  const auto stage = makeStage<K>(world, study, 0);
  Cost& best = costs[K];
  for (int i = 0; i < repeats; ++i) {
    Cost cost = shoot(stage, settings);
    cost.first_s = std::min(cost.first_s, best.first_s);
    cost.steps_s = std::min(cost.steps_s, best.steps_s);
    best = std::move(cost);
  }
  if (best.firstColumn_lx != costs.begin()->second.firstColumn_lx)
    throw std::runtime_error("the first column depends on the others");
}

void measureOn(const std::filesystem::path& input, double accuracy, int repeats, std::ostream& table) {
  const bool isStudy = input.extension() == ".toml";
  const Study study = isStudy ? readStudy(input) : studyOfModel(input);
  Scene model = readModel(study.modelFile, study.model);
  applyMaterialRules(study, model);
  const Building building = makeBuilding(cleanScene(model), study);
  World world(building, study);
  world.layout = {true, true, false};  // daylight, grey: one column is what the oracle looks at
  std::map<int, Cost> costs;
#define CLERESTORY_MEASURE(K) measure<K>(world, study, transportFor(accuracy), repeats, costs);
  withThreads(1, [&] { CLERESTORY_TRANSPORT_WIDTHS(CLERESTORY_MEASURE) });
  const Cost& one = costs.begin()->second;
  for (const auto& [columns, cost] : costs) {
    table << study.modelFile.stem().string() << ',' << columns << ',' << cost.first_s << ',' << cost.steps_s
          << ',' << cost.first_s / one.first_s << ',' << cost.steps_s / one.steps_s << ','
          << (cost.first_s + cost.steps_s) / (one.first_s + one.steps_s) << ',' << cost.links << ','
          << cost.rays << ',' << cost.nodes << ',' << cost.geometryBytes / cost.nodes << ','
          << cost.valueBytes / cost.nodes << std::endl;
  }
}

int run(int argc, char** argv) {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path folder = ".";
  double accuracy = 0.05;
  int repeats = 3;
  CLI::App app("The cost of columns");
  app.add_option("inputs", inputs, "studies or models of one room; the furnished one and the sample office");
  app.add_option("--folder", folder, "where columns.csv is written");
  app.add_option("--accuracy", accuracy);
  app.add_option("--repeats", repeats, "the quickest counts");
  CLI11_PARSE(app, argc, argv);
  if (inputs.empty()) {
    inputs = {std::filesystem::path(CLERESTORY_TEST_DATA) / "reference/furnished/furnished.obj",
              std::filesystem::path(CLERESTORY_SAMPLES) / "office/study.toml"};
  }
  std::ofstream table(folder / "columns.csv");
  table << "scene,columns,first_s,steps_s,first_ratio,steps_ratio,ratio,links,rays,nodes,"
           "geometry_bytes_per_node,value_bytes_per_node\n";
  for (const std::filesystem::path& input : inputs) measureOn(input, accuracy, repeats, table);
  return table ? 0 : 1;
}

}  // namespace
}  // namespace clerestory

int main(int argc, char** argv) {
  return clerestory::run(argc, argv);
}
