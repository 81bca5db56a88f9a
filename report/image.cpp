// SPDX-License-Identifier: GPL-3.0-or-later
// Exposes pictures and writes them as files.
#include "image.hpp"

#include <algorithm>
#include <cmath>

#include <import/error.hpp>

namespace clerestory {
namespace {

constexpr double middleGrey = 0.18;
constexpr double greyAtEv0_cd_m2 = 0.125;  // ISO 100 and a meter's constant of 12.5
constexpr double largestHalf = 65504.0;

double luminance(const glm::vec3& c) {
  return 0.2126 * static_cast<double>(c.x) + 0.7152 * static_cast<double>(c.y) +
         0.0722 * static_cast<double>(c.z);
}

/// A picture's value made harmless: no negative light, no NaN, nothing that a half cannot hold.
float exposed(float value_cd_m2, double scale) {
  const double value = static_cast<double>(value_cd_m2) * scale;
  return value > 0.0 ? static_cast<float>(std::min(value, largestHalf)) : 0.0F;
}

std::vector<float> exposed(const LuminanceImage& image, double scale) {
  std::vector<float> values;
  values.reserve(image.pixels_cd_m2.size() * 3);
  for (const glm::vec3& pixel : image.pixels_cd_m2) {
    for (int c = 0; c < 3; ++c) values.push_back(exposed(pixel[c], scale));
  }
  return values;
}

std::vector<float> floats(const glm::dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

void throwIf(const std::filesystem::path& file, const std::string& problem) {
  if (!problem.empty())
    throw MachineError(file.filename().string() + ": the picture could not be written: " + problem);
}

/// Compressed in half the time of the usual level, for a tenth more bytes.
PictureFiles::Attributes pngAttributes() {
  return {{"oiio:ColorSpace", "sRGB"}, {"Software", "Clerestory"}, {"png:compressionLevel", 4}};
}

}  // namespace

DisplayImage::DisplayImage(int width_px, int height_px, const DisplayColour& colour)
    : width(width_px), height(height_px) {
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  bytes.reserve(3 * count);
  for (std::size_t i = 0; i < count; ++i) bytes.insert(bytes.end(), colour.begin(), colour.end());
}

void DisplayImage::fill(double x0, double y0, double x1, double y1, const DisplayColour& colour) {
  const auto within = [](double at, int size) {
    return static_cast<int>(std::clamp(std::ceil(at - 0.5), 0.0, static_cast<double>(size)));
  };
  const int right = within(x1, width);
  const int bottom = within(y1, height);
  for (int y = within(y0, height); y < bottom; ++y) {
    for (int x = within(x0, width); x < right; ++x) {
      const auto at = static_cast<std::ptrdiff_t>(y) * width + x;
      std::copy(colour.begin(), colour.end(), bytes.begin() + 3 * at);
    }
  }
}

double exposureScale(const LuminanceImage& image, std::optional<double> exposure_ev) {
  if (exposure_ev) return middleGrey / (greyAtEv0_cd_m2 * std::exp2(*exposure_ev));
  double sum = 0.0;
  double count = 0.0;
  for (const glm::vec3& pixel : image.pixels_cd_m2) {
    const double y = luminance(pixel);
    if (std::isfinite(y) && y > 0.0) sum += y;
    count += 1.0;
  }
  if (sum <= 0.0) return 1.0;
  // Black corners must not decide the exposure of the rest: what is far below the mean counts as that.
  const double floor = 1e-4 * sum / count;
  double logarithms = 0.0;
  for (const glm::vec3& pixel : image.pixels_cd_m2) {
    const double y = luminance(pixel);
    logarithms += std::log(std::isfinite(y) ? std::max(y, floor) : floor);
  }
  return middleGrey / std::exp(logarithms / count);
}

double exposureValue(double scale) {
  return std::log2(middleGrey / (greyAtEv0_cd_m2 * scale));
}

std::vector<float> displayValues(const LuminanceImage& image, double scale, const DisplayTransform& display) {
  std::vector<float> values = exposed(image, scale);
  display.apply(values, image.width, image.height);
  for (float& value : values) value = value > 0.0F ? std::min(value, 1.0F) : 0.0F;
  return values;
}

DisplayImage displayImage(const std::vector<float>& values, int width, int height) {
  DisplayImage result(width, height, {0, 0, 0});
  std::transform(values.begin(), values.end(), result.bytes.begin(),
                 [](float value) { return static_cast<std::uint8_t>(std::lround(255.0F * value)); });
  return result;
}

void writeExr(const std::filesystem::path& file, const LuminanceImage& image, const ViewSettings& view,
              double scale) {
  PictureFiles::Attributes attributes = {
      {"compression", "zip:2"},
      {"oiio:ColorSpace", "lin_srgb"},
      {"Software", "Clerestory"},
      {"DateTime", "2000:01:01 00:00:00"},  // else the time of writing, and no two files are the same
      {"chromaticities", std::vector<float>{0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F}},
      {"whiteLuminance", static_cast<float>(1.0 / scale)},  // the name that OpenEXR knows
      {"clerestory:luminanceScale", static_cast<float>(1.0 / scale)},
      {"clerestory:exposureEv", static_cast<float>(exposureValue(scale))},
      {"clerestory:projection", projectionKey(view.projection)},
      {"clerestory:eye_m", floats(view.eye_m)},
      {"clerestory:target_m", floats(view.target_m)},
      {"clerestory:up", floats(view.up)}};
  if (view.projection != Projection::panorama)
    attributes.emplace_back("clerestory:fieldOfView_deg", static_cast<float>(view.fieldOfView_deg));
  const PictureDepth depth = view.exrBits == 32 ? PictureDepth::single : PictureDepth::half;
  throwIf(file, pictureFiles().writeFloats(file, image.width, image.height, exposed(image, scale).data(),
                                           depth, attributes));
}

void writePng16(const std::filesystem::path& file, const std::vector<float>& values, int width, int height) {
  throwIf(file, pictureFiles().writeFloats(file, width, height, values.data(), PictureDepth::unsigned16,
                                           pngAttributes()));
}

void writePng(const std::filesystem::path& file, const DisplayImage& image, Shades shades) {
  PictureFiles::Attributes attributes = pngAttributes();
  // PNG_FILTER_NONE: differences of neighbours hide from the compression that they are the same.
  if (shades == Shades::flat) attributes.emplace_back("png:filter", 8);
  throwIf(file, pictureFiles().writeBytes(file, image.width, image.height, image.bytes.data(), attributes));
}

void drawText(DisplayImage& image, int x, int y, const std::string& text, int size_px,
              const DisplayColour& colour, TextAlign align) {
  std::string ascii;  // the renderer mangles anything else
  for (const char c : text) ascii += c >= ' ' && c <= '~' ? c : '?';
  const float values[3] = {static_cast<float>(colour[0]) / 255.0F, static_cast<float>(colour[1]) / 255.0F,
                           static_cast<float>(colour[2]) / 255.0F};
  pictureFiles().drawText(image.bytes.data(), image.width, image.height, x, y, ascii, size_px, values, align);
}

}  // namespace clerestory
