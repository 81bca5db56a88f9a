// SPDX-License-Identifier: GPL-3.0-or-later
// PNG files of a few pixels, written without a library so that what reads them is checked by something else.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace clerestory {

inline void appendBig(std::string& bytes, std::uint32_t value) {
  for (unsigned shift = 32; shift > 0; shift -= 8) {
    bytes += static_cast<char>((value >> (shift - 8)) & 0xFFU);
  }
}

inline std::uint32_t crc32(const std::string& bytes) {
  std::uint32_t crc = ~0U;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    }
  }
  return ~crc;
}

inline std::string pngChunk(const std::string& type, const std::string& data) {
  std::string chunk;
  appendBig(chunk, static_cast<std::uint32_t>(data.size()));
  chunk += type + data;
  appendBig(chunk, crc32(type + data));
  return chunk;
}

/// 8 bits a channel, red green blue alpha; `pixels` from the top left, less than 64 kB of them.
inline std::string png(std::uint32_t width, std::uint32_t height,
                       const std::vector<std::array<int, 4>>& pixels) {
  std::string rows;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (i % width == 0) {
      rows += '\0';  // no filter
    }
    for (const int value : pixels[i]) {
      rows += static_cast<char>(value);
    }
  }
  std::uint32_t a = 1;
  std::uint32_t b = 0;
  for (const char c : rows) {
    a = (a + static_cast<unsigned char>(c)) % 65521U;
    b = (b + a) % 65521U;
  }
  std::string zlib("\x78\x01\x01", 3);  // one stored block
  const auto size = static_cast<unsigned>(rows.size());
  for (const unsigned value : {size & 0xFFU, size >> 8U, ~size & 0xFFU, (~size >> 8U) & 0xFFU}) {
    zlib += static_cast<char>(value);
  }
  zlib += rows;
  appendBig(zlib, b << 16U | a);
  std::string header;
  appendBig(header, width);
  appendBig(header, height);
  header += std::string("\x08\x06\x00\x00\x00", 5);
  return "\x89PNG\r\n\x1A\n" + pngChunk("IHDR", header) + pngChunk("IDAT", zlib) + pngChunk("IEND", "");
}

}  // namespace clerestory
