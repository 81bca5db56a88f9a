// SPDX-License-Identifier: GPL-3.0-or-later
// The figures of a grid of sensors, and names that tables, study.json and the page share.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <report/report.hpp>

namespace clerestory {

inline constexpr const char* outsideName = "outside";

/// Y of a colour in linear Rec.709.
double luminousY(const glm::dvec3& colour);

/// Whether the study's sky is overcast or uniform: the skies that daylight factors are defined under.
bool hasDaylightFactor(const SkySettings& sky);

/// The sky's share of the outdoor diffuse illuminance. [%]
std::optional<double> daylightFactor_pct(const SkySettings& sky, const SensorValue& sensor);

/// Mean, median (of an even number: between the two in the middle) and least of some sensors.
struct Distribution {
  double mean = 0.0, median = 0.0, min = 0.0, max = 0.0;
};
Distribution distributionOf(std::vector<double> values);

struct GridMetrics {
  std::size_t sensors = 0;
  Distribution illuminance_lx;
  double uniformity = 0.0;                         ///< least over mean
  std::optional<Distribution> daylightFactor_pct;  ///< empty under a sky without one
  double share300To3000_pct = 0.0;                 ///< sensors from 300 to 3,000 lx
  double shareAbove2_pct = 0.0;                    ///< sensors whose daylight factor is 2 % or more
  double meanErrorEstimate_pct = 0.0;              ///< of error_lx over max(value, 5 % of the mean)
  double p95ErrorEstimate_pct = 0.0;
};
GridMetrics metricsOf(const GridValues& grid, const SkySettings& sky);

/// EN 17037's daylight factor method: the factors that its levels ask of half and of nearly all of the area.
struct En17037 {
  struct Level {
    const char* name;
    double target_pct, minimum_pct;            ///< daylight factors asked for
    double shareTarget_pct, shareMinimum_pct;  ///< sensors that reach them: 50 % and 95 % are asked
    bool met;
  };
  std::vector<Level> levels;  ///< minimum, medium, high
};
std::optional<En17037> en17037Of(const GridValues& grid, const Study& study);

/// The grids of a room, or with -1 those outside any, in the building's order.
std::vector<std::size_t> gridsOfRoom(const Building& building, std::int32_t room);

/// `room` where the building has it, else -1.
std::int32_t knownRoom(const Building& building, std::int32_t room);

std::string roomName(const Building& building, std::int32_t room);

/// A name for every row of surfaces.csv; a second of one name in one room is "name#2".
std::vector<std::string> surfaceRowNames(const ReportInput& input);

/// The study's model without its folder, so that results do not tell where they were computed.
std::string modelName(const Study& study);

}  // namespace clerestory
