// SPDX-License-Identifier: GPL-3.0-or-later
// Reads glTF's container: the JSON and binary chunks of .glb, the buffers of .gltf, data URIs.
#include "gltfdocument.hpp"

#include <algorithm>
#include <cstring>

#include <import/error.hpp>

#include "gltfcompression.hpp"
#include "textfile.hpp"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxFileBytes = 4ULL << 30U;
constexpr std::size_t kMaxJsonBytes = 256ULL << 20U;
constexpr std::size_t kMaxExpansion = 64;  // of the whole file by compressed views
constexpr const char* kMeshopt = "EXT_meshopt_compression";
constexpr std::uint32_t kGlbMagic = 0x46546C67;   // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN"

/// `offset` + 4 <= bytes.size(). glTF is little-endian, and so is every processor that this is built for.
std::uint32_t readU32(std::string_view bytes, std::size_t offset) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  return value;
}

int base64Value(char c) {
  if (c >= 'A' && c <= 'Z') {
    return c - 'A';
  }
  if (c >= 'a' && c <= 'z') {
    return c - 'a' + 26;
  }
  if (c >= '0' && c <= '9') {
    return c - '0' + 52;
  }
  return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

std::string decodeBase64(std::string_view text, const JsonNode& where) {
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  while (text.ends_with('=')) {
    text.remove_suffix(1);
  }
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    const int value = base64Value(c);
    if (value < 0) {
      where.fail("the data URI is not base64");
    }
    bits = (bits << 6U) | static_cast<unsigned>(value);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes += static_cast<char>((bits >> static_cast<unsigned>(count)) & 0xFFU);
    }
  }
  return bytes;
}

int hexValue(char c) {
  const std::string_view digits = "0123456789abcdef";
  const std::size_t at = digits.find(lowerCase(std::string_view(&c, 1)));
  return at == std::string_view::npos ? -1 : static_cast<int>(at);
}

/// `%20` and the like as the bytes they mean.
std::string decodePercent(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escape = text[i] == '%' && i + 2 < text.size();
    const int high = escape ? hexValue(text[i + 1]) : -1;
    const int low = escape ? hexValue(text[i + 2]) : -1;
    if (high >= 0 && low >= 0) {
      decoded += static_cast<char>(high * 16 + low);
      i += 2;
    } else {
      decoded += text[i];
    }
  }
  return decoded;
}

}  // namespace

GltfDocument::GltfDocument(const std::filesystem::path& file)
    : folder_(file.parent_path()), file_(file.string()) {
  std::string bytes = readWholeFile(file, "model", kMaxFileBytes);
  byteCount_ = bytes.size();
  if (bytes.size() >= 4 && readU32(bytes, 0) == kGlbMagic) {
    readGlb(bytes);
  } else {
    const std::string text = decodedText(std::move(bytes), file_);
    if (text.size() > kMaxJsonBytes) {
      throw InputError(file_ + ": more than 256 MiB of JSON; save it as .glb");
    }
    json_ = parseJson(text, file_);
  }
  const JsonNode version = root().at("asset").at("version");
  if (!version.text().starts_with("2.")) {
    version.fail("glTF " + cleanName(version.text()) + " is not read; export it as glTF 2.0");
  }
  readBuffers();
  decodeViews();
}

void GltfDocument::readGlb(std::string_view bytes) {
  const auto fail = [&](const std::string& message) {
    throw InputError(file_ + ": " + message + "; export the model again");
  };
  if (bytes.size() < 20) {
    fail("the GLB file is cut off");
  }
  if (readU32(bytes, 4) != 2) {
    fail("the GLB file is of version " + std::to_string(readU32(bytes, 4)) + ", not 2");
  }
  const std::size_t length = readU32(bytes, 8);
  if (length > bytes.size() || length < 20) {
    fail("the GLB file is cut off: it announces " + std::to_string(length) + " bytes and has " +
         std::to_string(bytes.size()));
  }
  bytes = bytes.substr(0, length);
  bool hasJson = false;
  for (std::size_t at = 12; bytes.size() - at >= 8;) {
    const std::size_t size = readU32(bytes, at);
    const std::uint32_t type = readU32(bytes, at + 4);
    at += 8;
    if (size > bytes.size() - at) {
      fail("a chunk of the GLB file reaches beyond its end");
    }
    const std::string_view chunk = bytes.substr(at, size);
    if (type == kJsonChunk && !hasJson) {
      if (size > kMaxJsonBytes) {
        fail("more than 256 MiB of JSON");
      }
      json_ = parseJson(chunk, file_);
      hasJson = true;
    } else if (type == kBinChunk && !hasBinaryChunk_) {
      binaryChunk_ = chunk;
      hasBinaryChunk_ = true;
    }
    at += size;
  }
  if (!hasJson) {
    fail("the GLB file has no JSON chunk");
  }
}

std::size_t GltfDocument::countOf(const char* array) const {
  const auto node = root().find(array);
  return node ? node->size() : 0;
}

void GltfDocument::readBuffers() {
  const std::vector<JsonNode> nodes = root().elements("buffers");
  const std::vector<JsonNode> views = root().elements("bufferViews");
  const bool isCompressed = std::any_of(
      views.begin(), views.end(), [](const JsonNode& view) { return view.extension(kMeshopt).has_value(); });
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    // What only compressed views refer to, for readers that do not know their compression, may hold nothing.
    const auto fallback = nodes[i].extension(kMeshopt);
    const bool hasBytes = nodes[i].find("uri") || (i == 0 && hasBinaryChunk_);
    if ((fallback && fallback->find("fallback")) || (isCompressed && !hasBytes)) {
      buffers_.emplace_back();
      continue;
    }
    std::string bytes = readBuffer(nodes[i], i);
    const std::size_t length = nodes[i].at("byteLength").count();
    if (bytes.size() < length) {
      nodes[i].fail("the buffer is cut off: it announces " + std::to_string(length) + " bytes and has " +
                    std::to_string(bytes.size()));
    }
    bytes.resize(length);
    byteCount_ += length;
    if (byteCount_ > kMaxFileBytes) {
      nodes[i].fail("the model's buffers have more than 4 GiB");
    }
    buffers_.push_back(std::move(bytes));
  }
}

std::string GltfDocument::readBuffer(const JsonNode& buffer, std::size_t index) const {
  const auto uri = buffer.find("uri");
  if (!uri) {
    if (index != 0 || !hasBinaryChunk_) {
      buffer.fail("the buffer has neither a uri nor a binary chunk");
    }
    return binaryChunk_;
  }
  return uriBytes(*uri, "buffer", kMaxFileBytes);
}

std::string GltfDocument::uriBytes(const JsonNode& uri, const std::string& kind,
                                   std::uintmax_t maxBytes) const {
  const std::string text = uri.text();
  if (text.starts_with("data:")) {
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos || text.substr(0, comma).find(";base64") == std::string::npos) {
      uri.fail("a data URI has to be base64");
    }
    return decodeBase64(std::string_view(text).substr(comma + 1), uri);
  }
  const auto file = fileInside(folder_, decodePercent(text));
  if (!file || text.find("://") != std::string::npos) {
    uri.fail("a " + kind + " has to lie in the model's folder, this one does not: " + cleanName(text));
  }
  return readWholeFile(*file, kind, maxBytes);
}

void GltfDocument::decodeViews() {
  const std::vector<JsonNode> views = root().elements("bufferViews");
  const std::size_t budget = kMaxExpansion * byteCount_;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (const auto extension = views[i].extension(kMeshopt)) {
      decodedViews_[i] = decodeMeshopt(*extension, bufferBytes(*extension));
      byteCount_ += decodedViews_[i].size();
      if (byteCount_ > std::min<std::size_t>(budget, kMaxFileBytes)) {
        extension->fail("the model's compressed data has more than its size allows");
      }
    }
  }
}

}  // namespace clerestory
