// SPDX-License-Identifier: GPL-3.0-or-later
// What a run says on standard error while it works: a bar on a terminal, plain lines elsewhere, nothing if
// quiet.
#pragma once

#include <chrono>
#include <string>

namespace clerestory {

/// `text` on one line: control characters, which a hostile model could put into a name to reach the terminal,
/// become spaces.
std::string printable(const std::string& text);

class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress() { clearBar(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Says what is being done and the fraction of it that is done, [0, 1]. Cheap enough to be called often.
  void update(const std::string& stage, double fraction);

  /// Prints one line, above the bar where there is one.
  void line(const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] std::string remaining(double fraction) const;
  void drawBar(double fraction);
  void clearBar();

  bool quiet_;
  bool terminal_;
  std::string stage_;
  double fraction_ = 0.0;
  Clock::time_point begin_ = Clock::now();  ///< when the fraction that is counted now began, at …
  double beginFraction_ = 0.0;              ///< … this
  Clock::time_point shown_{};               ///< when something was last shown
  std::size_t barLength_ = 0;               ///< characters of the bar that stands on the terminal now
};

}  // namespace clerestory
