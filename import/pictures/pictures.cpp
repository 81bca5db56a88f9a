// SPDX-License-Identifier: GPL-3.0-or-later
// The library behind pictureFiles(). The only place that knows OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <memory>
#include <stdexcept>

#include <import/picturefiles.hpp>

namespace clerestory {
namespace {

namespace oiio = OIIO;

constexpr std::size_t kMaxSide = 256;
constexpr std::uint64_t kMaxPixels = 1ULL << 28U;
constexpr std::uint64_t kMaxRatio = 2000;  // of values to bytes of the file: deflate's is 1032

[[noreturn]] void fail(const std::string& why) {
  throw std::runtime_error(why);
}

/// The kind that the first bytes say, whatever the file is named; empty where it is none that is read.
/// OpenImageIO's readers of BMP read beyond their arrays, and numbers in TIFF and OpenEXR take gigabytes and
/// minutes.
std::string kindOf(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG")) {
    return ".png";
  }
  if (bytes.starts_with("\xFF\xD8\xFF")) {
    return ".jpg";
  }
  if (bytes.size() > 12 && bytes.starts_with("RIFF") && bytes.substr(8, 4) == "WEBP") {
    return ".webp";
  }
  return "";
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

void checkSize(const oiio::ImageSpec& spec, std::size_t byteCount) {
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1 || spec.depth > 1) {
    fail("it has no pixels");
  }
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height);
  if (pixels > kMaxPixels || pixels * static_cast<std::uint64_t>(spec.nchannels) > kMaxRatio * byteCount) {
    fail(std::to_string(spec.width) + " x " + std::to_string(spec.height) + " pixels are more than its " +
         std::to_string(byteCount) + " bytes can hold");
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

Picture readAny(std::string_view bytes, const std::string& name, PictureEncoding encoding) {
  oiio::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  const std::string kind = kindOf(bytes);
  const std::unique_ptr<oiio::ImageInput> input =
      kind.empty() ? nullptr : oiio::ImageInput::create(kind, false, nullptr, &memory);
  if (!input || !input->supports("ioproxy")) {
    static_cast<void>(oiio::geterror());
    fail("it is none of PNG, JPEG and WebP");
  }
  input->set_ioproxy(&memory);
  oiio::ImageSpec spec;
  if (!input->open(name, spec)) {
    fail(input->geterror());
  }
  checkSize(spec, bytes.size());
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
      fail(input->geterror());
    }
    for (int row = 0; row < rows; ++row) {
      reduction.addRow(static_cast<std::size_t>(y + row),
                       &values[static_cast<std::size_t>(row) * width * channels], channels, decode);
    }
  }
  return reduction.finish();
}

oiio::ImageSpec specOf(int width, int height, oiio::TypeDesc type,
                       const PictureFiles::Attributes& attributes) {
  oiio::ImageSpec spec(width, height, 3, type);
  for (const auto& [name, value] : attributes) {
    if (const auto* text = std::get_if<std::string>(&value)) {
      spec.attribute(name, *text);
    } else if (const auto* whole = std::get_if<int>(&value)) {
      spec.attribute(name, *whole);
    } else if (const auto* number = std::get_if<float>(&value)) {
      spec.attribute(name, *number);
    } else {
      const auto& numbers = std::get<std::vector<float>>(value);
      spec.attribute(name, oiio::TypeDesc(oiio::TypeDesc::FLOAT, static_cast<int>(numbers.size())),
                     numbers.data());
    }
  }
  return spec;
}

std::string write(const std::filesystem::path& file, const oiio::ImageSpec& spec, oiio::TypeDesc type,
                  const void* pixels) {
  try {
    const std::unique_ptr<oiio::ImageOutput> out = oiio::ImageOutput::create(file.string());
    const bool isWritten =
        out && out->open(file.string(), spec) && out->write_image(type, pixels) && out->close();
    const std::string error = out ? out->geterror() : oiio::geterror();
    return isWritten ? "" : error.empty() ? "it cannot be written" : error;
  } catch (const std::exception& error) {
    return error.what();
  }
}

std::string read(std::string_view bytes, const std::string& name, PictureEncoding encoding,
                 Picture& picture) {
  try {
    picture = readAny(bytes, name, encoding);
    return "";
  } catch (const std::exception& error) {
    return *error.what() == '\0' ? "it is broken" : error.what();
  }
}

std::string writeFloats(const std::filesystem::path& file, int width, int height, const float* rgb,
                        PictureDepth depth, const PictureFiles::Attributes& attributes) {
  const oiio::TypeDesc type = depth == PictureDepth::half     ? oiio::TypeDesc::HALF
                              : depth == PictureDepth::single ? oiio::TypeDesc::FLOAT
                                                              : oiio::TypeDesc::UINT16;
  return write(file, specOf(width, height, type, attributes), oiio::TypeDesc::FLOAT, rgb);
}

std::string writeBytes(const std::filesystem::path& file, int width, int height, const std::uint8_t* rgb,
                       const PictureFiles::Attributes& attributes) {
  return write(file, specOf(width, height, oiio::TypeDesc::UINT8, attributes), oiio::TypeDesc::UINT8, rgb);
}

/// The font where it was when the program was built, then what machines are likely to have.
constexpr const char* kFonts[] = {CLERESTORY_FONT,    "DejaVuSans", "LiberationSans-Regular",
                                  "NotoSans-Regular", "Arial",      "Helvetica"};

/// Digits and what units are made of, 5 by 7 dots, rows from the top, for machines without any font.
struct Glyph {
  char character;
  std::array<std::uint8_t, 7> rows;
};
constexpr Glyph kGlyphs[] = {{'0', {14, 17, 19, 21, 25, 17, 14}}, {'1', {4, 12, 4, 4, 4, 4, 14}},
                             {'2', {14, 17, 1, 2, 4, 8, 31}},     {'3', {31, 2, 4, 2, 1, 17, 14}},
                             {'4', {2, 6, 10, 18, 31, 2, 2}},     {'5', {31, 16, 30, 1, 1, 17, 14}},
                             {'6', {6, 8, 16, 30, 17, 17, 14}},   {'7', {31, 1, 2, 4, 8, 8, 8}},
                             {'8', {14, 17, 17, 14, 17, 17, 14}}, {'9', {14, 17, 17, 15, 1, 2, 12}},
                             {'.', {0, 0, 0, 0, 0, 12, 12}},      {'-', {0, 0, 0, 31, 0, 0, 0}},
                             {'/', {1, 1, 2, 4, 8, 16, 16}},      {'l', {12, 4, 4, 4, 4, 4, 14}},
                             {'x', {0, 0, 17, 10, 4, 10, 17}},    {'c', {0, 0, 14, 16, 16, 17, 14}},
                             {'d', {1, 1, 13, 19, 17, 17, 15}},   {'m', {0, 0, 26, 21, 21, 21, 21}}};

/// Sets the dots of a text whose baseline is `y`; characters without dots are gaps.
void drawDots(std::uint8_t* rgb, int width, int height, int x, int y, const std::string& text, int size_px,
              const float* colour, TextAlign align) {
  const int dot = std::max(1, size_px / 9);
  const int length = static_cast<int>(text.size()) * 6 * dot;
  int left = align == TextAlign::left ? x : align == TextAlign::centre ? x - length / 2 : x - length;
  for (const char character : text) {
    const auto* glyph = std::find_if(std::begin(kGlyphs), std::end(kGlyphs), [character](const Glyph& known) {
      return known.character == character;
    });
    for (int i = 0; glyph != std::end(kGlyphs) && i < 35 * dot * dot; ++i) {
      const int column = i % (5 * dot);
      const int row = i / (5 * dot);
      const int px = left + column;
      const int py = y - 7 * dot + row;
      const bool isSet = (glyph->rows.at(static_cast<std::size_t>(row / dot)) >> (4 - column / dot) & 1) != 0;
      if (!isSet || px < 0 || py < 0 || px >= width || py >= height) {
        continue;
      }
      for (int c = 0; c < 3; ++c) {
        rgb[3 * (static_cast<std::ptrdiff_t>(py) * width + px) + c] =
            static_cast<std::uint8_t>(std::lround(255.0F * colour[c]));
      }
    }
    left += 6 * dot;
  }
}

void drawText(std::uint8_t* rgb, int width, int height, int x, int y, const std::string& text, int size_px,
              const float* colour, TextAlign align) {
  using oiio::ImageBufAlgo::TextAlignX;
  const TextAlignX alignX = align == TextAlign::left     ? TextAlignX::Left
                            : align == TextAlign::centre ? TextAlignX::Center
                                                         : TextAlignX::Right;
  oiio::ImageBuf buffer(oiio::ImageSpec(width, height, 3, oiio::TypeDesc::UINT8), rgb);
  for (const char* font : kFonts) {
    if (oiio::ImageBufAlgo::render_text(buffer, x, y, text, size_px, font, oiio::cspan<float>(colour, 3),
                                        alignX, oiio::ImageBufAlgo::TextAlignY::Baseline, 0, {}, 1)) {
      return;
    }
    static_cast<void>(buffer.geterror());  // it is not on this machine
  }
  drawDots(rgb, width, height, x, y, text, size_px, colour, align);
}

}  // namespace
}  // namespace clerestory

#ifdef _WIN32
#define CLERESTORY_EXPORT __declspec(dllexport)
#else
#define CLERESTORY_EXPORT __attribute__((visibility("default")))
#endif

extern "C" CLERESTORY_EXPORT const clerestory::PictureFiles* clerestoryPictureFiles() {
  // Once: files are written by several threads, and a pool may be resized by one alone.
  static const clerestory::PictureFiles files = [] {
    // Its pools of threads gain nothing on pictures of our size, and end the program where no thread is to be
    // had.
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", -1);
    return clerestory::PictureFiles{clerestory::read, clerestory::writeFloats, clerestory::writeBytes,
                                    clerestory::drawText};
  }();
  return &files;
}
