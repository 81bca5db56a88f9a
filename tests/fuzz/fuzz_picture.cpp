// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures.
#include <picture.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

#include <import/error.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    clerestory::readPicture(bytes, "a picture", clerestory::PictureEncoding::sRgb);
  } catch (const clerestory::InputError&) {
  }
  return 0;
}
