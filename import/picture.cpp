// SPDX-License-Identifier: GPL-3.0-or-later
// Reads pictures, those that were cut off excepted.
#include "picture.hpp"

#include <import/error.hpp>

namespace clerestory {
namespace {

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

}  // namespace

Picture readPicture(std::string_view bytes, const std::string& name, PictureEncoding encoding) {
  Picture picture;
  const std::string problem =
      isCutOff(bytes) ? "the file is cut off" : pictureFiles().read(bytes, name, encoding, picture);
  if (!problem.empty()) {
    throw InputError(name + ": the picture cannot be read: " + problem);
  }
  return picture;
}

}  // namespace clerestory
