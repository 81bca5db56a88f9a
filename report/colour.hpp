// SPDX-License-Identifier: GPL-3.0-or-later
// What a screen shows of scene-linear Rec.709. The only place that knows OpenColorIO.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "embedded.hpp"

namespace clerestory {

/// The config of OpenColorIO that comes with the program, as text: report/config.ocio.
extern const EmbeddedFile shippedConfig;

/// The way from scene-linear Rec.709 to a display, by the config that the environment variable OCIO names or,
/// where it is not set, by the shipped one: its default display and that display's default view.
class DisplayTransform {
 public:
  /// Throws InputError where OCIO's config cannot be used.
  DisplayTransform();
  ~DisplayTransform();
  DisplayTransform(const DisplayTransform&) = delete;
  DisplayTransform& operator=(const DisplayTransform&) = delete;

  /// Turns `rgb`, 3 values a pixel, into the display's, mostly 0 to 1. Throws MachineError.
  void apply(std::vector<float>& rgb, int width, int height) const;

  [[nodiscard]] bool isShipped() const { return isShipped_; }
  [[nodiscard]] const std::string& display() const { return display_; }
  [[nodiscard]] const std::string& view() const { return view_; }

 private:
  struct Processor;
  std::unique_ptr<Processor> processor_;
  bool isShipped_ = true;
  std::string display_, view_;
};

}  // namespace clerestory
