// SPDX-License-Identifier: GPL-3.0-or-later
// A JSON value that knows where it stands, so that what is wrong with it can be said with its pointer.
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clerestory {

/// Parses JSON text. Throws InputError where it is not JSON or nested deeper than 200 levels.
nlohmann::json parseJson(std::string_view text, const std::string& file);

/// A view of a value in a document that outlives it. What is read is checked: every mismatch throws
/// InputError "file: pointer: message".
class JsonNode {
 public:
  JsonNode(const nlohmann::json& value, const std::string& file) : value_(&value), file_(&file) {}

  [[nodiscard]] const std::string& pointer() const { return pointer_; }
  [[nodiscard]] bool isObject() const { return value_->is_object(); }
  [[nodiscard]] bool isTrue() const { return value_->is_boolean() && value_->get<bool>(); }
  [[noreturn]] void fail(const std::string& message) const;

  [[nodiscard]] std::optional<JsonNode> find(const char* key) const;  ///< of an object; empty: not there
  [[nodiscard]] std::optional<JsonNode> extension(const char* name) const;  ///< of a glTF object; likewise
  [[nodiscard]] JsonNode at(const char* key) const;                         ///< of an object; has to be there
  [[nodiscard]] std::size_t size() const;                                   ///< of an array
  [[nodiscard]] JsonNode operator[](std::size_t index) const;               ///< of an array, index < size()
  [[nodiscard]] std::vector<JsonNode> elements(const char* key) const;  ///< of the array `key`; none: empty

  [[nodiscard]] double number() const;
  [[nodiscard]] std::size_t count() const;  ///< a whole number from 0 to 2^53
  [[nodiscard]] std::string text() const;
  [[nodiscard]] std::vector<double> numbers(std::size_t expected) const;      ///< an array of that many
  [[nodiscard]] std::vector<std::uint32_t> indices(std::size_t bound) const;  ///< an array of numbers < bound

  /// The number `key`, below `bound` (the count of `what`); empty where the key is not there.
  [[nodiscard]] std::optional<std::size_t> index(const char* key, std::size_t bound, const char* what) const;
  [[nodiscard]] std::size_t countOr(const char* key, std::size_t otherwise) const;
  [[nodiscard]] double numberOr(const char* key, double otherwise) const;
  [[nodiscard]] std::string textOr(const char* key, const std::string& otherwise) const;

 private:
  [[nodiscard]] JsonNode child(const nlohmann::json& value, const std::string& step) const;

  const nlohmann::json* value_;
  const std::string* file_;
  std::string pointer_;
};

}  // namespace clerestory
