// SPDX-License-Identifier: GPL-3.0-or-later
// Reads JSON values with a check on each and the pointer of what is wrong.
#include "jsonnode.hpp"

#include <cmath>
#include <cstdint>

#include <import/error.hpp>

#include "textfile.hpp"

namespace clerestory {
namespace {

constexpr int kMaxDepth = 200;

/// Deepest nesting of brackets outside strings.
int depthOf(std::string_view text) {
  int depth = 0;
  int deepest = 0;
  bool inString = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (inString) {
      i += c == '\\' ? 1 : 0;
      inString = c != '"';
    } else if (c == '"') {
      inString = true;
    } else if (c == '[' || c == '{') {
      deepest = std::max(deepest, ++depth);
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return deepest;
}

}  // namespace

nlohmann::json parseJson(std::string_view text, const std::string& file) {
  if (depthOf(text) > kMaxDepth) {
    throw InputError(file + ": the JSON is nested deeper than " + std::to_string(kMaxDepth) +
                     " levels, which no model needs");
  }
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    const std::string what = error.what();
    const std::size_t from = what.find("] ");
    throw InputError(
        file + ": is not valid JSON: " + cleanName(what.substr(from == std::string::npos ? 0 : from + 2)));
  }
}

void JsonNode::fail(const std::string& message) const {
  throw InputError(*file_ + ": " + (pointer_.empty() ? "/" : pointer_) + ": " + message);
}

JsonNode JsonNode::child(const nlohmann::json& value, const std::string& step) const {
  JsonNode node(value, *file_);
  node.pointer_ = pointer_ + "/" + step;
  return node;
}

std::optional<JsonNode> JsonNode::find(const char* key) const {
  if (!value_->is_object()) {
    fail("has to be an object");
  }
  const auto found = value_->find(key);
  return found == value_->end() ? std::nullopt : std::optional(child(*found, key));
}

std::optional<JsonNode> JsonNode::extension(const char* name) const {
  const std::optional<JsonNode> extensions = find("extensions");
  return extensions ? extensions->find(name) : std::nullopt;
}

JsonNode JsonNode::at(const char* key) const {
  const std::optional<JsonNode> node = find(key);
  if (!node) {
    fail(std::string("\"") + key + "\" is missing");
  }
  return *node;
}

std::size_t JsonNode::size() const {
  if (!value_->is_array()) {
    fail("has to be an array");
  }
  return value_->size();
}

JsonNode JsonNode::operator[](std::size_t index) const {
  return child((*value_)[index], std::to_string(index));
}

std::vector<JsonNode> JsonNode::elements(const char* key) const {
  std::vector<JsonNode> nodes;
  if (const std::optional<JsonNode> array = find(key)) {
    nodes.reserve(array->size());
    for (std::size_t i = 0; i < array->size(); ++i) {
      nodes.push_back((*array)[i]);
    }
  }
  return nodes;
}

double JsonNode::number() const {
  const double number = value_->is_number() ? value_->get<double>() : std::nan("");
  if (!std::isfinite(number)) {
    fail("has to be a finite number");
  }
  return number;
}

std::size_t JsonNode::count() const {
  constexpr double kLimit = 9007199254740992.0;
  const double value = number();
  if (value < 0.0 || value > kLimit || value != std::floor(value)) {
    fail("has to be a whole number, 0 or more");
  }
  return static_cast<std::size_t>(value);
}

std::string JsonNode::text() const {
  if (!value_->is_string()) {
    fail("has to be a string");
  }
  return value_->get<std::string>();
}

std::vector<double> JsonNode::numbers(std::size_t expected) const {
  if (size() != expected) {
    fail("has to have " + std::to_string(expected) + " numbers, has " + std::to_string(size()));
  }
  std::vector<double> values(expected);
  for (std::size_t i = 0; i < expected; ++i) {
    values[i] = (*this)[i].number();
  }
  return values;
}

std::vector<std::uint32_t> JsonNode::indices(std::size_t bound) const {
  std::vector<std::uint32_t> values(size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const nlohmann::json& element = (*value_)[i];
    const std::size_t value = element.is_number_unsigned() ? element.get<std::size_t>() : (*this)[i].count();
    if (value >= bound || value > UINT32_MAX) {
      (*this)[i].fail(std::to_string(value) + " is out of range: there are " + std::to_string(bound));
    }
    values[i] = static_cast<std::uint32_t>(value);
  }
  return values;
}

std::optional<std::size_t> JsonNode::index(const char* key, std::size_t bound, const char* what) const {
  const std::optional<JsonNode> node = find(key);
  if (!node) {
    return std::nullopt;
  }
  const std::size_t index = node->count();
  if (index >= bound) {
    node->fail("names " + std::string(what) + " " + std::to_string(index) + ", but there are " +
               std::to_string(bound));
  }
  return index;
}

std::size_t JsonNode::countOr(const char* key, std::size_t otherwise) const {
  const std::optional<JsonNode> node = find(key);
  return node ? node->count() : otherwise;
}

double JsonNode::numberOr(const char* key, double otherwise) const {
  const std::optional<JsonNode> node = find(key);
  return node ? node->number() : otherwise;
}

std::string JsonNode::textOr(const char* key, const std::string& otherwise) const {
  const std::optional<JsonNode> node = find(key);
  return node ? node->text() : otherwise;
}

}  // namespace clerestory
