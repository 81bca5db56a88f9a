// SPDX-License-Identifier: GPL-3.0-or-later
// The result of a study: illuminance at sensors and on surfaces, rooms' figures, statistics of the solver.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <geometry/building.hpp>

namespace clerestory {

/// Illuminance of a sensor in its parts. direct + reflected = sky + sun + electric = illuminance.
struct SensorValue {
  double illuminance_lx = 0.0;
  double direct_lx = 0.0, reflected_lx = 0.0;
  double sky_lx = 0.0, sun_lx = 0.0, electric_lx = 0.0;
  double error_lx = 0.0;  ///< 95 % bound on the numerical error
};

struct GridValues {
  std::vector<SensorValue> sensors;  ///< in the order of the SensorGrid's points
};

/// One row of surfaces.csv: one surface in one room (or outside).
struct SurfaceValue {
  std::uint32_t surface;   ///< index into CleanModel::surfaces
  std::int32_t room = -1;  ///< -1: outside any room
  double area_m2 = 0.0;
  double illuminanceMean_lx = 0.0, illuminanceMin_lx = 0.0, illuminanceMax_lx = 0.0;
  glm::dvec3 exitanceMean_lm_m2{0.0};  ///< linear Rec.709
  double error_lx = 0.0;
  std::uint32_t elements = 0;
};

/// Checks of a room beside its sensors (docs/measures.md). Zero in a room that is open to the outside.
struct RoomValue {
  double averageDaylightFactor_pct = 0.0;  ///< by Crisp and Littlefair's formula
  double sunlight_h = 0.0;                 ///< on the study's day, at the best of its panes
};

/// One row of iterations.csv; the columns are those of the paper's Tables 1 and 2.
struct IterationStatistics {
  std::int32_t domain = 0;
  int iteration = 0;
  std::uint64_t linksRequired = 0, linksCached = 0, linksReused = 0, visibilityTests = 0;
  double unshotPower_lm = 0.0;
  std::uint64_t elements = 0;
  double seconds = 0.0;
};

/// Where the light of a domain went, in lumens; emitted = absorbed + escaped but for numerical error.
struct EnergyBalance {
  std::int32_t domain = 0;
  double emitted_lm = 0.0, absorbed_lm = 0.0, escaped_lm = 0.0;
  double unscaledDefect =
      0.0;  ///< share of all power shot that the links missed or overdid, before it is mended
};

/// A picture in luminance, and the illuminance of the surfaces in it.
struct LuminanceImage {
  int width = 0, height = 0;
  std::vector<glm::vec3> pixels_cd_m2;  ///< rows from the top, linear Rec.709
  std::vector<float> illuminance_lx;    ///< likewise; NaN where sky, glass or a lamp is seen
};

/// The leaves of all solved domains as they are drawn: convex planar polygons, counterclockwise seen from the
/// air that lights them, with the light at each corner.
struct ElementMesh {
  glm::dvec3 origin_m{0.0};                      ///< corners are relative to it, world axes
  std::vector<std::uint32_t> firstCorner = {0};  ///< #elements + 1, into the arrays below
  std::vector<std::uint32_t> surfaceRow;         ///< #elements, index into Solution::surfaces
  std::vector<glm::vec3> corners_m;              ///< #corners
  std::vector<float> illuminance_lx;             ///< #corners
  std::vector<glm::vec3> exitance_lm_m2;         ///< #corners, linear Rec.709, own emission included

  [[nodiscard]] std::size_t size() const { return surfaceRow.size(); }
};

struct Solution {
  std::vector<GridValues> grids;  ///< in the order of Building::grids
  std::vector<SurfaceValue> surfaces;
  std::vector<RoomValue> rooms;  ///< in the order of Building::rooms
  ElementMesh mesh;
  std::vector<IterationStatistics> iterations;
  std::vector<EnergyBalance> balances;
  std::vector<LuminanceImage> views;  ///< in the order of Study::views; empty without pictures
  std::uint64_t elements = 0;
  int columns = 1;  ///< radiosity values per element
  bool grey = true;
  std::size_t hierarchyBytes = 0;
  std::vector<Diagnosis> diagnoses;
};

/// How the radiosity between surfaces is found. Studies shoot; the others are there to be charted against.
enum class Method {
  shooting,   ///< shooting hierarchical radiosity
  gathering,  ///< the same by Jacobi steps over stored links
  plain       ///< uniform elements, cosine rays, Jacobi steps; knows neither the sun's beam nor luminaires
};

/// What shapes a solve beside the study. Results do not depend on threads and linkCacheBytes.
struct SolveOptions {
  Method method = Method::shooting;
  std::optional<float> epsilon;             ///< instead of the threshold that the accuracy sets
  std::optional<std::uint32_t> sensorRays;  ///< of every sensor, instead of as many as the accuracy needs
  int threads = 0;                          ///< 0: all
  std::size_t linkCacheBytes = std::size_t{16} << 20;
  std::size_t memoryBytes = std::size_t{4} << 30;
  bool pictures = true;
  /// Called now and then from the calling thread with what is being done and the fraction done, [0, 1].
  std::function<void(const std::string& stage, double fraction)> progress;
};

/// Solves the light of a building. Throws InputError where the study cannot be solved.
Solution solve(const Building& building, const Study& study, const SolveOptions& options);

}  // namespace clerestory
