// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures: exposure and files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <import/picturefiles.hpp>
#include <solver/solution.hpp>

#include "colormap.hpp"
#include "colour.hpp"

namespace clerestory {

/// Rows from the top, sRGB, 3 bytes a pixel.
struct DisplayImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> bytes;

  DisplayImage(int width_px, int height_px, const DisplayColour& colour);
  /// Fills the pixels whose centres lie in [x0, x1) × [y0, y1); what lies outside the picture is left out.
  void fill(double x0, double y0, double x1, double y1, const DisplayColour& colour);
  /// Sets one pixel, counted along rows.
  void set(std::size_t pixel, const DisplayColour& colour) {
    for (std::size_t c = 0; c < 3; ++c) bytes[3 * pixel + c] = colour[c];
  }
};

/// What a luminance of 1 cd/m² becomes in the picture's scene-linear values, where 0.18 is a middle grey.
/// Automatic: the mean of the logarithm of luminance becomes 0.18. `exposure_ev` is the photographer's
/// exposure value at ISO 100: a luminance of 0.125 × 2^EV cd/m² becomes 0.18.
double exposureScale(const LuminanceImage& image, std::optional<double> exposure_ev);

/// The exposure value at ISO 100 of such a scale.
double exposureValue(double scale);

/// The picture exposed and turned into the display's values, 3 a pixel, each 0 to 1.
std::vector<float> displayValues(const LuminanceImage& image, double scale, const DisplayTransform& display);

DisplayImage displayImage(const std::vector<float>& values, int width, int height);

/// Scene-linear Rec.709 as half or single floats, luminance times `scale`. The attributes
/// clerestory:luminanceScale and whiteLuminance hold the cd/m² of 1.0; others the camera and the exposure.
/// Throws MachineError.
void writeExr(const std::filesystem::path& file, const LuminanceImage& image, const ViewSettings& view,
              double scale);

/// Display values with 16 bits each. Throws MachineError.
void writePng16(const std::filesystem::path& file, const std::vector<float>& values, int width, int height);

/// What a picture is made of, for its compression: shades that run into each other, or few colours.
enum class Shades { smooth, flat };

/// Throws MachineError.
void writePng(const std::filesystem::path& file, const DisplayImage& image, Shades shades);

/// Writes ASCII text around the baseline y.
void drawText(DisplayImage& image, int x, int y, const std::string& text, int size_px,
              const DisplayColour& colour, TextAlign align);

}  // namespace clerestory
