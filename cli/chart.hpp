// SPDX-License-Identifier: GPL-3.0-or-later
// clerestory chart: error against time of a study, over methods and settings.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace clerestory {

/// Adds the command to `program`; when it is chosen, `run` becomes what it does.
void addChartCommand(CLI::App& program, std::function<void()>& run);

}  // namespace clerestory
