// SPDX-License-Identifier: GPL-3.0-or-later
// A glTF file's JSON and buffers, and the numbers in its accessors, every one within bounds.
#pragma once

#include <glm/vec3.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "jsonnode.hpp"

namespace clerestory {

/// JSON and bytes of a model. Buffers are as long as the file says they are.
class GltfDocument {
 public:
  /// Reads `file`, its JSON and its buffers, which are inside it, data URIs or files in its folder.
  explicit GltfDocument(const std::filesystem::path& file);
  GltfDocument(const GltfDocument&) = delete;
  GltfDocument& operator=(const GltfDocument&) = delete;

  [[nodiscard]] JsonNode root() const { return {json_, file_}; }
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] std::size_t byteCount() const { return byteCount_; }  ///< of everything that was read
  [[nodiscard]] std::size_t countOf(const char* array) const;         ///< elements of a top-level array

  /// The numbers of accessor `index`, `components` for each element of its `type` (VEC3 has 3), all finite;
  /// integers that it calls normalized as fractions.
  [[nodiscard]] std::vector<double> numbers(std::size_t index, const char* type,
                                            std::size_t components) const;
  /// The VEC3s of accessor `index`, all finite.
  [[nodiscard]] std::vector<glm::dvec3> positions(std::size_t index) const;
  /// The unsigned SCALARs of accessor `index`.
  [[nodiscard]] std::vector<std::uint32_t> indices(std::size_t index) const;
  /// The bytes of the buffer view that `user` names.
  [[nodiscard]] std::string_view viewBytes(const JsonNode& user) const;
  /// The bytes that `uri` stands for: base64 data, or a file in the model's folder of at most `maxBytes`.
  /// `kind` is for messages.
  [[nodiscard]] std::string uriBytes(const JsonNode& uri, const std::string& kind,
                                     std::uintmax_t maxBytes) const;

 private:
  /// Elements in a buffer: element i begins at data + i * stride.
  struct Elements {
    const char* data = nullptr;  // null: all zero
    std::size_t count = 0;
    std::size_t stride = 0;
    std::size_t componentType = 0;
  };

  void readGlb(std::string_view bytes);
  void readBuffers();
  [[nodiscard]] std::string readBuffer(const JsonNode& buffer, std::size_t index) const;
  void decodeViews();
  [[nodiscard]] std::string_view view(const JsonNode& user, std::size_t& stride) const;
  [[nodiscard]] std::string_view bufferBytes(const JsonNode& node) const;
  [[nodiscard]] Elements elements(const JsonNode& accessor, std::size_t count, std::size_t componentType,
                                  std::size_t components) const;
  [[nodiscard]] Elements accessorElements(const JsonNode& accessor, const char* type,
                                          std::size_t components) const;
  template <typename Replace>
  void forEachSparse(const JsonNode& accessor, const Elements& whole, std::size_t components,
                     const Replace& replace) const;
  [[nodiscard]] JsonNode accessorNode(std::size_t index) const;

  std::filesystem::path folder_;
  std::string file_;
  nlohmann::json json_;
  std::string binaryChunk_;
  bool hasBinaryChunk_ = false;
  std::vector<std::string> buffers_;
  std::map<std::size_t, std::string> decodedViews_;  // those that are compressed, by their index
  std::size_t byteCount_ = 0;
};

}  // namespace clerestory
