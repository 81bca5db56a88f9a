// SPDX-License-Identifier: GPL-3.0-or-later
// Exposes pictures, converts them for the display through OpenColorIO and writes them as files.
#include "image.hpp"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include <import/error.hpp>

namespace clerestory {
namespace {

namespace ocio = OCIO_NAMESPACE;

constexpr double middleGrey = 0.18;
constexpr double shoulder = 0.5;
constexpr double largestHalf = 65504.0;
constexpr const char* sceneSpace = "Linear Rec.709 (D65)";
constexpr const char* displayName = "sRGB - Display";
constexpr const char* viewName = "Colorimetric";

double luminance(const glm::vec3& c) {
  return 0.2126 * static_cast<double>(c.x) + 0.7152 * static_cast<double>(c.y) +
         0.0722 * static_cast<double>(c.z);
}

/// A picture's value made harmless: no negative light, no NaN, nothing that a half cannot hold.
float exposed(float value_cd_m2, double scale) {
  const double value = static_cast<double>(value_cd_m2) * scale;
  return value > 0.0 ? static_cast<float>(std::min(value, largestHalf)) : 0.0F;
}

ocio::ColorSpaceRcPtr colourSpace(ocio::ReferenceSpaceType type, const char* name) {
  ocio::ColorSpaceRcPtr space = ocio::ColorSpace::Create(type);
  space->setName(name);
  return space;
}

/// Scene-linear Rec.709 is the reference itself; one matrix leads to the display reference, CIE XYZ of D65.
ocio::ConstConfigRcPtr makeConfig() {
  ocio::ConfigRcPtr config = ocio::Config::Create();
  config->setVersion(2, 0);
  config->addColorSpace(colourSpace(ocio::REFERENCE_SPACE_SCENE, sceneSpace));
  ocio::ColorSpaceRcPtr raw = colourSpace(ocio::REFERENCE_SPACE_SCENE, "Raw");
  raw->setIsData(true);
  config->addColorSpace(raw);

  ocio::ColorSpaceRcPtr display = colourSpace(ocio::REFERENCE_SPACE_DISPLAY, displayName);
  ocio::BuiltinTransformRcPtr encoding = ocio::BuiltinTransform::Create();
  encoding->setStyle("DISPLAY - CIE-XYZ-D65_to_sRGB");
  display->setTransform(encoding, ocio::COLORSPACE_DIR_FROM_REFERENCE);
  config->addColorSpace(display);

  ocio::MatrixTransformRcPtr toXyz = ocio::MatrixTransform::Create();
  const double matrix[16] = {0.412390799265959,
                             0.357584339383878,
                             0.180480788401834,
                             0,
                             0.212639005871510,
                             0.715168678767756,
                             0.072192315360734,
                             0,
                             0.019330818715592,
                             0.119194779794626,
                             0.950532152249661,
                             0,
                             0,
                             0,
                             0,
                             1};
  toXyz->setMatrix(matrix);
  ocio::ViewTransformRcPtr view = ocio::ViewTransform::Create(ocio::REFERENCE_SPACE_SCENE);
  view->setName(viewName);
  view->setTransform(toXyz, ocio::VIEWTRANSFORM_DIR_FROM_REFERENCE);
  config->addViewTransform(view);
  config->setDefaultViewTransformName(viewName);
  config->addDisplayView(displayName, viewName, viewName, displayName, "", "", "");

  config->setRole(ocio::ROLE_SCENE_LINEAR, sceneSpace);
  config->setRole(ocio::ROLE_DEFAULT, "Raw");
  config->validate();
  return config;
}

ocio::ConstCPUProcessorRcPtr displayProcessor() {
  ocio::DisplayViewTransformRcPtr transform = ocio::DisplayViewTransform::Create();
  transform->setSrc(sceneSpace);
  transform->setDisplay(displayName);
  transform->setView(viewName);
  // Lossless: the faster curves of the default differ by up to one code value.
  return makeConfig()->getProcessor(transform)->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
}

void throwIf(const std::filesystem::path& file, const std::string& problem) {
  if (!problem.empty())
    throw MachineError(file.filename().string() + ": the picture could not be written: " + problem);
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
  if (exposure_ev) return middleGrey / (0.125 * std::exp2(*exposure_ev));
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

double toneCurve(double value) {
  if (!(value > shoulder)) return value > 0.0 ? value : 0.0;
  return shoulder + (1.0 - shoulder) * (1.0 - std::exp(-(value - shoulder) / (1.0 - shoulder)));
}

DisplayImage displayImage(const LuminanceImage& image, double scale) {
  DisplayImage result(image.width, image.height, {0, 0, 0});
  std::vector<float> values;
  values.reserve(result.bytes.size());
  for (const glm::vec3& pixel : image.pixels_cd_m2) {
    for (int c = 0; c < 3; ++c) {
      values.push_back(static_cast<float>(toneCurve(static_cast<double>(exposed(pixel[c], scale)))));
    }
  }
  if (values.size() != result.bytes.size())
    throw std::logic_error("a picture has more or fewer pixels than its size");
  if (values.empty()) return result;
  try {
    ocio::PackedImageDesc description(values.data(), image.width, image.height, 3);
    displayProcessor()->apply(description);
  } catch (const ocio::Exception& error) {
    throw MachineError(std::string("colours could not be converted for the display: ") + error.what());
  }
  std::transform(values.begin(), values.end(), result.bytes.begin(), [](float value) {
    return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F)));
  });
  return result;
}

void writeExr(const std::filesystem::path& file, const LuminanceImage& image, double scale) {
  const PictureFiles::Attributes attributes = {
      {"compression", "zip"},
      {"oiio:ColorSpace", "lin_srgb"},
      {"Software", "Clerestory"},
      {"DateTime", "2000:01:01 00:00:00"},  // else the time of writing, and no two files are the same
      {"chromaticities", std::vector<float>{0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F}},
      {"whiteLuminance", static_cast<float>(1.0 / scale)},  // the name that OpenEXR knows
      {"clerestory:luminanceScale", static_cast<float>(1.0 / scale)}};
  std::vector<float> values;
  values.reserve(image.pixels_cd_m2.size() * 3);
  for (const glm::vec3& pixel : image.pixels_cd_m2) {
    for (int c = 0; c < 3; ++c) values.push_back(exposed(pixel[c], scale));
  }
  throwIf(file, pictureFiles().writeHalf(file, image.width, image.height, values.data(), attributes));
}

void writePng(const std::filesystem::path& file, const DisplayImage& image) {
  throwIf(file, pictureFiles().writeBytes(file, image.width, image.height, image.bytes.data(),
                                          {{"oiio:ColorSpace", "sRGB"}, {"Software", "Clerestory"}}));
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
