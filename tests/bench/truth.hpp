// SPDX-License-Identifier: GPL-3.0-or-later
// The truth of a stage: surfaces by paths, places by a gather over converged runs of the rival; kept in a
// file so that it is made only once. The rival's own surfaces would not do: where two are near each other,
// its elements mix what is open with what is covered.
#pragma once

#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <string>

#include "paths.hpp"
#include "plain.hpp"
#include "stage.hpp"

namespace clerestory {

struct Truth {
  Measured mean;
  double surfacesError = 0.0, placesError = 0.0;  ///< standard errors, as fractions
};

struct TruthSettings {
  PlainSettings rival;
  std::uint32_t gatherRays = 4096;  ///< of a place
  std::size_t paths = 2000000;      ///< of all surfaces
  int runs = 2;                     ///< with seeds of their own, that differ from those of what is compared
};

/// Writes and reads runs of the rival by name; what was made with other settings or of another scene is not
/// taken.
class TruthFile {
 public:
  TruthFile(std::filesystem::path file, std::string head) : file_(std::move(file)), head_(std::move(head)) {}

  bool read(std::vector<Measured>& runs) const {
    std::ifstream stream(file_);
    std::string line;
    if (!std::getline(stream, line) || line != head_) return false;
    std::getline(stream, line);  // columns
    for (char comma = ','; std::getline(stream, line);) {
      std::istringstream fields(line);
      std::size_t run = 0;
      std::string kind;
      double area_m2 = 0.0;
      double value_lx = 0.0;
      fields >> run >> comma;
      std::getline(fields, kind, ',');
      fields >> area_m2 >> comma >> value_lx;
      if (!fields || run > runs.size()) return false;
      if (run == runs.size()) runs.emplace_back();
      if (kind == "surface") {
        runs[run].area_m2.push_back(area_m2);
        runs[run].surface_lx.push_back(value_lx);
      } else {
        runs[run].place_lx.push_back(value_lx);
      }
    }
    return !runs.empty();
  }

  void write(const std::vector<Measured>& runs) const {
    std::ofstream stream(file_);
    stream << head_ << "\nrun,kind,area_m2,illuminance_lx\n" << std::setprecision(9);
    for (std::size_t run = 0; run < runs.size(); ++run) {
      for (std::size_t i = 0; i < runs[run].area_m2.size(); ++i)
        stream << run << ",surface," << runs[run].area_m2[i] << ',' << runs[run].surface_lx[i] << '\n';
      for (const double value_lx : runs[run].place_lx) stream << run << ",place,0," << value_lx << '\n';
    }
  }

 private:
  std::filesystem::path file_;
  std::string head_;
};

/// The mean of `runs` and its standard error: the RMS over surfaces or places of their own.
inline Truth truthOf(const std::vector<Measured>& runs) {
  const auto count = static_cast<double>(runs.size());
  Truth truth;
  truth.mean = runs[0];
  const auto meanOf = [&](std::vector<double> Measured::*values) {
    std::vector<double>& mean = truth.mean.*values;
    for (std::size_t i = 0; i < mean.size(); ++i) {
      mean[i] = 0.0;
      for (const Measured& run : runs) mean[i] += (run.*values)[i] / count;
    }
  };
  meanOf(&Measured::surface_lx);
  meanOf(&Measured::place_lx);
  for (const Measured& run : runs) {
    const Errors own = errorsOf(run, truth.mean);
    truth.surfacesError += own.surfaces * own.surfaces / (count * std::max(count - 1.0, 1.0));
    truth.placesError += own.places * own.places / (count * std::max(count - 1.0, 1.0));
  }
  truth.surfacesError = std::sqrt(truth.surfacesError);
  truth.placesError = std::sqrt(truth.placesError);
  return truth;
}

template <int K>
Measured convergedRun(const Stage<K>& stage, const TruthSettings& settings, std::uint64_t seed) {
  SolvedLight<K> light = stage.outside;
  std::vector<Radiosity<K>> rooms;
  for (std::size_t i = 0; i < stage.domains.size(); ++i) {
    PlainSolution<K> solution =
        plainRadiosity(stage.outside, stage.domains[i], seededTree(stage, i, seed), settings.rival);
    std::cerr << "  " << solution.elements << " elements, " << solution.rays << " rays, leaks "
              << 100.0 * solution.leakedShare << " %\n";
    rooms.push_back(solution.radiosity);
    light.add(stage.domains[i], std::move(solution.radiosity));
  }
  Measured measured = measure(stage, std::move(rooms));
  // A surface that stands in or on others is not compared: what is covered of it has no light of its own.
  constexpr double shutMost = 0.05;
  std::size_t row = 0;
  for (const PathSurface& surface : surfacesByPaths(stage, settings.paths, mixKey(seed))) {
    if (surface.area_m2 <= smallestSurface_m2) continue;
    measured.surface_lx[row] = surface.illuminance_lx;
    if (surface.shut > shutMost) measured.area_m2[row] = 0.0;
    ++row;
  }
  if (row != measured.surface_lx.size()) throw std::runtime_error("surfaces by paths are others");
  forEachIndex(stage.places.size(), 1, [&](std::size_t i) {
    measured.place_lx[i] = gatherAt(light, stage, stage.places[i], settings.gatherRays, mixKeys(seed, i));
  });
  return measured;
}

template <int K>
Truth makeTruth(const Stage<K>& stage, const std::string& scene, const std::filesystem::path& folder,
                const TruthSettings& settings) {
  std::ostringstream head;
  head << "# " << scene << ": " << stage.world().pieces().size() << " pieces; elements of "
       << settings.rival.elementSize_m << " m, " << settings.rival.raysPerElement << " rays, "
       << settings.rival.directPoints << " points; " << settings.gatherRays << " rays at "
       << stage.places.size() << " places; " << settings.paths << " paths, one ray to each pane; "
       << settings.runs << " runs";
  const TruthFile file(folder / ("truth_" + scene + ".csv"), head.str());
  std::vector<Measured> runs;
  if (!file.read(runs)) {
    runs.clear();
    for (int run = 0; run < settings.runs; ++run)
      runs.push_back(convergedRun(stage, settings, 0x7121u + static_cast<std::uint64_t>(run)));
    file.write(runs);
  }
  return truthOf(runs);
}

}  // namespace clerestory
