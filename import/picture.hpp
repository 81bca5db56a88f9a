// SPDX-License-Identifier: GPL-3.0-or-later
// Picture files as small grids of mean colours: all that a texture means for the light in a room.
#pragma once

#include <glm/vec4.hpp>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
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

/// Reads PNG, JPEG, TIFF, WebP, OpenEXR and what else OpenImageIO knows. `name` is for its ending and for
/// messages. Throws InputError where the bytes are no whole picture.
Picture readPicture(std::string_view bytes, const std::string& name, PictureEncoding encoding);

}  // namespace clerestory
