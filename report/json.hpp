// SPDX-License-Identifier: GPL-3.0-or-later
// study.json (declared in report.hpp) and run.json.
#pragma once

#include <string>

#include <report/report.hpp>

namespace clerestory {

/// What belongs to one run alone: times, threads, cache, memory.
std::string runJson(const ReportInput& input);

/// `text` without the folders that the model was read from.
std::string withoutFolders(const Study& study, std::string text);

}  // namespace clerestory
