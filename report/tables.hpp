// SPDX-License-Identifier: GPL-3.0-or-later
// The report's tables as CSV (RFC 4180, UTF-8).
#pragma once

#include <array>
#include <string>
#include <vector>

#include <report/report.hpp>

namespace clerestory {

/// Points and normals alone, as a study reads them.
std::string pointsCsv(const std::vector<std::array<double, 6>>& points);

std::string sensorsCsv(const ReportInput& input);
std::string surfacesCsv(const ReportInput& input);
std::string roomsCsv(const ReportInput& input);
std::string iterationsCsv(const ReportInput& input);

}  // namespace clerestory
