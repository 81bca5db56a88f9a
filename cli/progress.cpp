// SPDX-License-Identifier: GPL-3.0-or-later
// Draws the bar and guesses how long the rest will take.
#include "progress.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>

#include "machine.hpp"

namespace clerestory {

namespace {

using std::chrono::duration;

constexpr auto kBarEvery = std::chrono::milliseconds(100);
constexpr auto kLineEvery = std::chrono::seconds(10);
constexpr std::size_t kBarWidth = 24;
constexpr std::size_t kLineWidth = 78;  // a terminal of 80 columns does not wrap

}  // namespace

std::string printable(const std::string& text) {
  std::string clean = text;
  for (std::size_t i = 0; i < clean.size(); ++i) {
    const auto byte = static_cast<unsigned char>(clean[i]);
    const auto next = i + 1 < clean.size() ? static_cast<unsigned char>(clean[i + 1]) : 0U;
    if (byte < 0x20 || byte == 0x7f) {
      clean[i] = ' ';
    } else if (byte == 0xc2 && next >= 0x80 && next < 0xa0) {  // U+0080 … U+009F in UTF-8
      clean[i] = clean[i + 1] = ' ';
    }
  }
  return clean;
}

Progress::Progress(bool quiet) : quiet_(quiet), terminal_(standardErrorIsTerminal()) {}

void Progress::update(const std::string& stage, double fraction) {
  if (quiet_) {
    return;
  }
  fraction = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  const auto now = Clock::now();
  const bool newStage = stage != stage_;

  // A fraction that falls back belongs to another piece of work, and so does the time that it took.
  if (fraction < fraction_ || (newStage && fraction == 0.0)) {
    begin_ = now;
    beginFraction_ = fraction;
  }
  stage_ = stage;
  fraction_ = fraction;

  if (terminal_) {
    if (newStage || now - shown_ >= kBarEvery) {
      shown_ = now;
      drawBar(fraction);
    }
  } else if (newStage) {
    shown_ = now;
    line(stage);
  } else if (now - shown_ >= kLineEvery) {
    shown_ = now;
    line(stage + ", " + std::to_string(std::lround(100.0 * fraction)) + " %" + remaining(fraction));
  }
}

void Progress::line(const std::string& text) {
  if (quiet_) {
    return;
  }
  clearBar();
  std::cerr << "clerestory: " << printable(text) << '\n';
}

std::string Progress::remaining(double fraction) const {
  const double elapsed_s = duration<double>(Clock::now() - begin_).count();
  const double done = fraction - beginFraction_;
  if (elapsed_s < 1.0 || done < 0.02) {
    return {};  // too early to tell
  }
  const double left_s = elapsed_s * (1.0 - fraction) / done;
  std::ostringstream text;
  if (left_s < 90.0) {
    text << ", about " << std::lround(left_s) << " s left";
  } else {
    text << ", about " << std::lround(left_s / 60.0) << " min left";
  }
  return text.str();
}

void Progress::drawBar(double fraction) {
  const auto filled = static_cast<std::size_t>(std::lround(fraction * static_cast<double>(kBarWidth)));
  const std::string percent = std::to_string(std::lround(100.0 * fraction));
  std::string bar = "[" + std::string(filled, '#') + std::string(kBarWidth - filled, '.') + "] " +
                    std::string(3 - std::min<std::size_t>(3, percent.size()), ' ') + percent + " %  " +
                    printable(stage_) + remaining(fraction);
  bar.resize(std::min(bar.size(), kLineWidth));

  const std::size_t length = bar.size();
  bar.resize(std::max(length, barLength_), ' ');  // over what stood there
  std::cerr << '\r' << bar << std::flush;
  barLength_ = length;
}

void Progress::clearBar() {
  if (barLength_ > 0) {
    std::cerr << '\r' << std::string(barLength_, ' ') << '\r' << std::flush;
    barLength_ = 0;
  }
}

}  // namespace clerestory
