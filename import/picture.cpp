// SPDX-License-Identifier: GPL-3.0-or-later
// Reads picture files through OpenImageIO and reduces them to grids of mean colours.
#include "picture.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

#include <import/error.hpp>

namespace clerestory {
namespace {

namespace oiio = OIIO;

constexpr std::size_t kMaxSide = 256;
constexpr std::uint64_t kMaxPixels = 1ULL << 28U;
constexpr std::uint64_t kMaxRatio = 2000;  // of values to bytes of the file: deflate's is 1032

[[noreturn]] void fail(const std::string& name, const std::string& why) {
  throw InputError(name + ": the picture cannot be read: " + why);
}

/// The ending that the first bytes call for, whatever the file is named.
std::string endingOf(std::string_view bytes, const std::string& name) {
  if (bytes.starts_with("\x89PNG")) {
    return ".png";
  }
  if (bytes.starts_with("\xFF\xD8\xFF")) {
    return ".jpg";
  }
  if (bytes.size() > 12 && bytes.starts_with("RIFF") && bytes.substr(8, 4) == "WEBP") {
    return ".webp";
  }
  return std::filesystem::path(name).extension().string();
}

/// The number of `count` bytes at `at`, highest first.
std::size_t bigEndian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::size_t value = 0;
  for (const char byte : bytes.substr(at, count)) {
    value = value << 8U | static_cast<unsigned char>(byte);
  }
  return value;
}

/// A JPEG that was cut off reads without an error, its rest grey: its end mark has to be there.
bool isCutOffJpeg(std::string_view bytes) {
  std::size_t at = 2;
  while (at + 4 <= bytes.size() && bytes[at] == '\xFF' && bytes[at + 1] != '\xDA') {
    at += 2 + bigEndian(bytes, at + 2, 2);
  }
  return at >= bytes.size() || bytes.find("\xFF\xD9", at) == std::string_view::npos;
}

/// libpng would complain of it on standard error.
bool isCutOffPng(std::string_view bytes) {
  std::size_t at = 8;
  while (at + 12 <= bytes.size() && bytes.substr(at + 4, 4) != "IEND") {
    at += 12 + bigEndian(bytes, at, 4);
  }
  return at + 12 > bytes.size();
}

bool isCutOff(std::string_view bytes) {
  return (bytes.starts_with("\xFF\xD8\xFF") && isCutOffJpeg(bytes)) ||
         (bytes.starts_with("\x89PNG") && isCutOffPng(bytes));
}

double decoded(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);  // IEC 61966-2-1
}

/// Decodes sRGB by a table where the file has 8 bits, which nearly all have.
class Decoder {
 public:
  Decoder(bool isEncoded, bool isByte) : isEncoded_(isEncoded), isByte_(isByte) {
    for (std::size_t i = 0; i < table_.size(); ++i) {
      table_[i] = static_cast<float>(decoded(static_cast<double>(i) / 255.0));
    }
  }
  float operator()(float value) const {
    if (!std::isfinite(value)) {
      return 0.0F;
    }
    if (!isEncoded_) {
      return std::clamp(value, 0.0F, 1e6F);
    }
    const float held = std::clamp(value, 0.0F, 1.0F);
    return isByte_ ? table_[static_cast<std::size_t>(std::lround(held * 255.0F))]
                   : static_cast<float>(decoded(static_cast<double>(held)));
  }

 private:
  bool isEncoded_;
  bool isByte_;
  std::array<float, 256> table_{};
};

glm::vec4 texelOf(const float* values, std::size_t channels, const Decoder& decode) {
  const bool isGrey = channels < 3;
  const float red = decode(values[0]);
  const float alpha = channels == 2 ? values[1] : channels >= 4 ? values[3] : 1.0F;
  return {red, isGrey ? red : decode(values[1]), isGrey ? red : decode(values[2]),
          std::isfinite(alpha) ? std::clamp(alpha, 0.0F, 1.0F) : 1.0F};
}

void checkSize(const oiio::ImageSpec& spec, std::size_t byteCount, const std::string& name) {
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1 || spec.depth > 1) {
    fail(name, "it has no pixels");
  }
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height);
  if (pixels > kMaxPixels || pixels * static_cast<std::uint64_t>(spec.nchannels) > kMaxRatio * byteCount) {
    fail(name, std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                   " pixels are more than its " + std::to_string(byteCount) + " bytes can hold");
  }
}

/// Means of the file's pixels, read in strips so that a large picture never stands in memory as a whole.
class Reduction {
 public:
  Reduction(std::size_t width, std::size_t height)
      : fullWidth_(width),
        stepX_((width + kMaxSide - 1) / kMaxSide),
        stepY_((height + kMaxSide - 1) / kMaxSide) {
    picture_.width = (width + stepX_ - 1) / stepX_;
    picture_.height = (height + stepY_ - 1) / stepY_;
    picture_.texels.assign(picture_.width * picture_.height, glm::vec4(0.0F));
    counts_.assign(picture_.texels.size(), 0.0F);
  }
  void addRow(std::size_t y, const float* values, std::size_t channels, const Decoder& decode) {
    const std::size_t row = y / stepY_ * picture_.width;
    for (std::size_t x = 0; x < fullWidth_; ++x) {
      picture_.texels[row + x / stepX_] += texelOf(values + x * channels, channels, decode);
      counts_[row + x / stepX_] += 1.0F;
    }
  }
  Picture finish() {
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      picture_.texels[i] /= counts_[i];
    }
    return std::move(picture_);
  }

 private:
  std::size_t fullWidth_, stepX_, stepY_;
  Picture picture_;
  std::vector<float> counts_;
};

}  // namespace

Picture readPicture(std::string_view bytes, const std::string& name, PictureEncoding encoding) {
  if (isCutOff(bytes)) {
    fail(name, "the file is cut off");
  }
  oiio::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  const std::unique_ptr<oiio::ImageInput> input =
      oiio::ImageInput::create(endingOf(bytes, name), false, nullptr, &memory);
  if (!input || !input->supports("ioproxy")) {
    static_cast<void>(oiio::geterror());
    fail(name, "it is of no kind that is known; use PNG or JPEG");
  }
  input->set_ioproxy(&memory);
  oiio::ImageSpec spec;
  if (!input->open(name, spec)) {
    fail(name, input->geterror());
  }
  checkSize(spec, bytes.size(), name);
  const auto width = static_cast<std::size_t>(spec.width);
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  const bool isFloat = spec.format.is_floating_point();
  const Decoder decode(encoding == PictureEncoding::sRgb && !isFloat, spec.format == oiio::TypeDesc::UINT8);
  Reduction reduction(width, static_cast<std::size_t>(spec.height));
  const int strip = spec.tile_width > 0 ? spec.height : 64;
  std::vector<float> values;
  for (int y = 0; y < spec.height; y += strip) {
    const int rows = std::min(strip, spec.height - y);
    values.resize(width * channels * static_cast<std::size_t>(rows));
    const bool isRead = spec.tile_width > 0
                            ? input->read_image(0, 0, 0, spec.nchannels, oiio::TypeDesc::FLOAT, values.data())
                            : input->read_scanlines(0, 0, spec.y + y, spec.y + y + rows, 0, 0, spec.nchannels,
                                                    oiio::TypeDesc::FLOAT, values.data());
    if (!isRead) {
      fail(name, input->geterror());
    }
    for (int row = 0; row < rows; ++row) {
      reduction.addRow(static_cast<std::size_t>(y + row),
                       &values[static_cast<std::size_t>(row) * width * channels], channels, decode);
    }
  }
  return reduction.finish();
}

}  // namespace clerestory
