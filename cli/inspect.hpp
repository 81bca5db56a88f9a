// SPDX-License-Identifier: GPL-3.0-or-later
// `clerestory inspect`: what is in a model, what was repaired and what was not.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace clerestory {

/// Adds the command to `program`. Where it is the one that a command line asks for, parsing sets `run` to it.
void addInspectCommand(CLI::App& program, std::function<void()>& run);

}  // namespace clerestory
