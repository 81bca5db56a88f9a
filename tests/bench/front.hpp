// SPDX-License-Identifier: GPL-3.0-or-later
// The front of a method: the least time that reaches an error, over all of its settings.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace clerestory {

struct TimedError {
  double seconds, error;
};

/// What no other setting beats in both, quickest first.
inline std::vector<TimedError> frontOf(std::vector<TimedError> runs) {
  std::sort(runs.begin(), runs.end(), [](const TimedError& a, const TimedError& b) {
    return a.seconds < b.seconds || (a.seconds == b.seconds && a.error < b.error);
  });
  std::vector<TimedError> front;
  for (const TimedError& run : runs) {
    if (front.empty() || run.error < front.back().error) front.push_back(run);
  }
  return front;
}

/// Seconds to an error: along the front straight in logarithms, between measured points only. The quickest
/// run's own time where it is good enough, infinity where none is.
inline double secondsTo(double error, const std::vector<TimedError>& front) {
  const auto reaches =
      std::find_if(front.begin(), front.end(), [&](const TimedError& run) { return run.error <= error; });
  if (reaches == front.end()) return std::numeric_limits<double>::infinity();
  if (reaches == front.begin()) return reaches->seconds;
  const TimedError& slow = *reaches;
  const TimedError& quick = *(reaches - 1);
  if (slow.error <= 0.0) return slow.seconds;
  const double share = std::log(quick.error / error) / std::log(quick.error / slow.error);
  return quick.seconds * std::pow(slow.seconds / quick.seconds, share);
}

}  // namespace clerestory
