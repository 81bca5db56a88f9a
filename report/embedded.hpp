// SPDX-License-Identifier: GPL-3.0-or-later
// A file that is put into the program when it is built (cmake/embed.cmake).
#pragma once

#include <string_view>

namespace clerestory {

struct EmbeddedFile {
  std::string_view text;
  std::string_view sha256;  ///< of the text, in hexadecimal
};

}  // namespace clerestory
