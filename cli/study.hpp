// SPDX-License-Identifier: GPL-3.0-or-later
// `clerestory study`: from a model to a report.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>
#include <string>

namespace clerestory {

/// Adds the command to `program`. Where it is the one that a command line asks for, parsing sets `run` to it.
/// `commandLine` is told in the report.
void addStudyCommand(CLI::App& program, const std::string& commandLine, std::function<void()>& run);

}  // namespace clerestory
