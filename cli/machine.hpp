// SPDX-License-Identifier: GPL-3.0-or-later
// What is asked of the operating system: the only header whose source differs between systems.
#pragma once

#include <cstddef>

namespace clerestory {

/// Whether somebody reads standard error on a terminal.
bool standardErrorIsTerminal();

/// The most memory this process has had, in bytes; 0 where the system does not say.
std::size_t peakMemoryBytes();

/// Hardware threads that this process may use, at least 1.
int processorCount();

}  // namespace clerestory
