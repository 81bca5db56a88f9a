// SPDX-License-Identifier: GPL-3.0-or-later
// `clerestory compare`: how far one study or table of sensors lies from another.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace clerestory {

/// Adds the command to `program`. Where it is the one that a command line asks for, parsing sets `run` to it.
void addCompareCommand(CLI::App& program, std::function<void()>& run);

}  // namespace clerestory
