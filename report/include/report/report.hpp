// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a study's results into a folder: tables, pictures, study.json and the page that shows them.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <geometry/building.hpp>
#include <import/study.hpp>
#include <solver/solution.hpp>

namespace clerestory {

/// What belongs to this run alone; written to run.json only, so that the results stay the same bytes.
struct RunInfo {
  std::string version;
  std::string commandLine;
  int threads = 1;
  std::size_t linkCacheBytes = 0;
  std::vector<std::pair<std::string, double>> stageSeconds;  ///< in order
  std::size_t peakMemoryBytes = 0;
};

struct ReportInput {
  const Study& study;
  const Building& building;
  const Solution& solution;
  std::vector<Diagnosis> diagnoses;  ///< of all stages
  RunInfo run;
  bool pictures = true;  ///< whether views and plans are written as files of their own
};

/// Writes the whole report beside `folder` and then puts it in its place, so that an older report there stays
/// whole until the new one is. Throws InputError where `folder` holds something else than a report or cannot
/// be written, MachineError where the disk fails.
void writeReport(const std::filesystem::path& folder, const ReportInput& input);

/// Checks, before any work is done, that a report can be put at `folder`. Throws InputError.
void checkReportFolder(const std::filesystem::path& folder);

/// Checks, before any work is done, that pictures can be turned into a display's colours. Throws InputError
/// where the environment variable OCIO names a config of OpenColorIO that cannot be used.
void checkDisplay();

/// Removes what an unfinished writeReport has written so far and lets none finish any more, for a thread that
/// is about to end the program. An older report stays as it is.
void abandonReport();

/// study.json's text.
std::string studyJson(const ReportInput& input);

}  // namespace clerestory
