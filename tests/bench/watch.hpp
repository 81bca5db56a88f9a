// SPDX-License-Identifier: GPL-3.0-or-later
// CPU and wall time of what a benchmark measures.
#pragma once

#include <chrono>
#include <ctime>

namespace clerestory {

struct Seconds {
  double cpu = 0.0;  ///< of all threads
  double wall = 0.0;
};

/// Seconds since it was made.
class Watch {
 public:
  [[nodiscard]] Seconds elapsed() const {
    return {static_cast<double>(std::clock() - cpu_) / CLOCKS_PER_SEC,
            std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count()};
  }

 private:
  std::clock_t cpu_ = std::clock();
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
};

}  // namespace clerestory
