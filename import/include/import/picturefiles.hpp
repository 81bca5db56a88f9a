// SPDX-License-Identifier: GPL-3.0-or-later
// Picture files, read and written by OpenImageIO. It brings 260 shared libraries, which take a quarter of a
// second to load, so it stands behind a library of its own that is loaded when the first picture is met.
#pragma once

#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace clerestory {

/// How the numbers of a picture file are meant. Files of floating-point numbers are linear in either case.
enum class PictureEncoding { sRgb, linear };

/// A picture of at most 256 x 256 texels, rows from the top: linear red, green, blue, and alpha (1 where the
/// file has none). Each texel is the mean of those of the file that it covers.
struct Picture {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<glm::vec4> texels;  ///< width * height

  [[nodiscard]] const glm::vec4& at(std::size_t x, std::size_t y) const { return texels[y * width + x]; }
};

/// What a file holds of a value: a float of 16 or 32 bits, or 16 bits for 0 to 1.
enum class PictureDepth { half, single, unsigned16 };

enum class TextAlign { left, centre, right };

/// The library's functions. No exception crosses its border: a text says what went wrong, empty where nothing
/// did.
struct PictureFiles {
  /// Metadata of a file: its name and value, as OpenImageIO knows them.
  using Attributes =
      std::vector<std::pair<std::string, std::variant<std::string, int, float, std::vector<float>>>>;

  /// PNG, JPEG, WebP, BMP, TGA and HDR; `name` is for its ending and for
  /// messages.
  std::string (*read)(std::string_view bytes, const std::string& name, PictureEncoding encoding,
                      Picture& picture);
  /// `rgb` holds 3 * width * height values, rows from the top.
  std::string (*writeFloats)(const std::filesystem::path& file, int width, int height, const float* rgb,
                             PictureDepth depth, const Attributes& attributes);
  /// Bytes, likewise.
  std::string (*writeBytes)(const std::filesystem::path& file, int width, int height, const std::uint8_t* rgb,
                            const Attributes& attributes);
  /// Writes ASCII text around the baseline y into a picture like that of writeBytes; `colour` is red, green,
  /// blue, each 0 to 1. On a machine without fonts only numbers and units are written, in coarse dots.
  void (*drawText)(std::uint8_t* rgb, int width, int height, int x, int y, const std::string& text,
                   int size_px, const float* colour, TextAlign align);
};

/// Loads the library at the first call. Throws MachineError where it is not there.
const PictureFiles& pictureFiles();

}  // namespace clerestory
