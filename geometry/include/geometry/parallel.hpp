// SPDX-License-Identifier: GPL-3.0-or-later
// All that the program knows of threads; parallel.cpp alone knows oneTBB.
#pragma once

#include <cstddef>
#include <functional>

namespace clerestory {

/// Runs `work` with at most `threads` threads (0: all there are).
void withThreads(int threads, const std::function<void()>& work);

/// Calls body(i) for 0 <= i < count, in any order and on any thread. `grain` calls stay together.
void forEachIndex(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& body);

/// Runs both, perhaps at the same time, and returns when both are done.
void inParallel(const std::function<void()>& a, const std::function<void()>& b);

}  // namespace clerestory
