// SPDX-License-Identifier: GPL-3.0-or-later
// Threads through oneTBB. Nothing here adds up numbers, so no result depends on the number of threads.
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <geometry/parallel.hpp>

namespace clerestory {

void withThreads(int threads, const std::function<void()>& work) {
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] { work(); });
}

void forEachIndex(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
  });
}

void inParallel(const std::function<void()>& a, const std::function<void()>& b) {
  tbb::parallel_invoke(a, b);
}

}  // namespace clerestory
