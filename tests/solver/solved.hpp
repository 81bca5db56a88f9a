// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes solved through the public API, and what the tests ask of a solution.
#pragma once

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include <solver/solution.hpp>

#include "../reference.hpp"
#include "../scenes.hpp"

namespace clerestory {

struct Solved {
  Building building;
  Solution solution;

  /// Illuminances of the first grid.
  [[nodiscard]] std::vector<double> sensors_lx() const {
    std::vector<double> values;
    for (const SensorValue& sensor : solution.grids.at(0).sensors) values.push_back(sensor.illuminance_lx);
    return values;
  }
  /// Where the light of a domain went; fails the test if it was not solved.
  [[nodiscard]] EnergyBalance balanceOf(std::int32_t domain) const {
    for (const EnergyBalance& balance : solution.balances) {
      if (balance.domain == domain) return balance;
    }
    ADD_FAILURE() << "domain " << domain << " has no energy balance";
    return {};
  }
};

inline Solved solved(const Scene& scene, const Study& study) {
  SolveOptions options;
  options.pictures = false;
  Building building = drawn::buildingOf(scene, study);
  Solution solution = solve(building, study, options);
  return {std::move(building), std::move(solution)};
}

/// Every figure of a solution, for comparison to the bit.
inline std::vector<double> figuresOf(const Solution& solution) {
  std::vector<double> figures;
  for (const GridValues& grid : solution.grids) {
    for (const SensorValue& sensor : grid.sensors) {
      figures.insert(figures.end(), {sensor.illuminance_lx, sensor.direct_lx, sensor.reflected_lx,
                                     sensor.sky_lx, sensor.sun_lx, sensor.electric_lx, sensor.error_lx});
    }
  }
  for (const SurfaceValue& row : solution.surfaces) {
    figures.insert(
        figures.end(),
        {static_cast<double>(row.surface), static_cast<double>(row.room), row.area_m2, row.illuminanceMean_lx,
         row.illuminanceMin_lx, row.illuminanceMax_lx, row.exitanceMean_lm_m2.x, row.exitanceMean_lm_m2.y,
         row.exitanceMean_lm_m2.z, row.error_lx, static_cast<double>(row.elements)});
  }
  return figures;
}

/// A model of tests/data, with the study's rules on it.
inline Scene testModel(const std::string& name, const Study& study) {
  Scene scene = readModel(std::filesystem::path(CLERESTORY_TEST_DATA) / name, {});
  applyMaterialRules(study, scene);
  return scene;
}

inline std::vector<glm::dvec3> placesOf(const std::vector<ReferencePoint>& points) {
  std::vector<glm::dvec3> places;
  for (const ReferencePoint& point : points)
    places.emplace_back(point.place_m[0], point.place_m[1], point.place_m[2]);
  return places;
}

inline std::vector<double> valuesOf(const std::vector<ReferencePoint>& points) {
  std::vector<double> values;
  for (const ReferencePoint& point : points) values.push_back(point.value);
  return values;
}

}  // namespace clerestory
