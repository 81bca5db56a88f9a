// SPDX-License-Identifier: GPL-3.0-or-later
// Reads checked values from TOML tables.
#include "tomlsection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <import/error.hpp>

#include "textfile.hpp"

namespace clerestory {
namespace {

constexpr Range kAnyNumber{-1e9, 1e9};

std::string inQuotes(std::string_view text) {
  return "\"" + cleanName(text) + "\"";
}

}  // namespace

bool Range::holds(double value) const {
  return std::isfinite(value) && (lowIsIn ? value >= low : value > low) &&
         (highIsIn ? value <= high : value < high);
}

std::string Range::text() const {
  return (lowIsIn ? "from " : "above ") + numberText(low) + (highIsIn ? " to " : " to below ") +
         numberText(high);
}

toml::table parseToml(std::string_view text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    failAt({file, error.source().begin.line}, "is not valid TOML: " + cleanName(error.description()));
  }
}

void TomlSection::fail(std::string_view key, const std::string& message) const {
  Place place{*file_, table_->source().begin.line};
  for (const auto& [name, node] : *table_) {
    if (name.str() == key) {
      place.line = name.source().begin.line;
    }
  }
  failAt(place, name_.empty() ? message : name_ + " " + message);
}

void TomlSection::failAtNode(const toml::node& node, const std::string& message) const {
  failAt({*file_, node.source().begin.line}, name_.empty() ? message : name_ + " " + message);
}

void TomlSection::allowOnly(const std::vector<std::string>& known) const {
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    if (std::find(known.begin(), known.end(), name) != known.end()) {
      continue;
    }
    fail(name, "has no key " + inQuotes(name) + "; did you mean \"" + nearestName(name, known) + "\"?");
  }
}

void TomlSection::refuse(const std::vector<std::string>& keys) const {
  for (const std::string& key : keys) {
    if (table_->contains(key)) {
      fail(key, key + " is not supported by this version; take it out");
    }
  }
}

double TomlSection::numberOf(const toml::node& node, std::string_view key, const Range& range) const {
  const std::optional<double> value = node.is_number() ? node.value<double>() : std::nullopt;
  if (!value) {
    failAtNode(node, std::string(key) + " has to be a number");
  }
  if (!range.holds(*value)) {
    failAtNode(node,
               std::string(key) + " " + numberText(*value) + " is out of range; it goes " + range.text());
  }
  return *value;
}

std::vector<double> TomlSection::numbersOf(const toml::node& node, std::string_view key, std::size_t count,
                                           const Range& range) const {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != count) {
    failAtNode(node, std::string(key) + " has to be a list of " + std::to_string(count) + " numbers");
  }
  std::vector<double> values;
  for (const toml::node& element : *array) {
    values.push_back(numberOf(element, key, range));
  }
  return values;
}

std::optional<double> TomlSection::number(const char* key, const Range& range) const {
  const toml::node* node = table_->get(key);
  return node == nullptr ? std::nullopt : std::optional(numberOf(*node, key, range));
}

std::optional<std::int64_t> TomlSection::integer(const char* key, std::int64_t low, std::int64_t high) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) {
    return std::nullopt;
  }
  const auto value = node->is_integer() ? node->value<std::int64_t>() : std::nullopt;
  if (!value || *value < low || *value > high) {
    failAtNode(*node, std::string(key) + " has to be a whole number from " + std::to_string(low) + " to " +
                          std::to_string(high));
  }
  return value;
}

std::optional<std::string> TomlSection::text(const char* key) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) {
    return std::nullopt;
  }
  const auto value = node->is_string() ? node->value<std::string>() : std::nullopt;
  if (!value) {
    failAtNode(*node, std::string(key) + " has to be a text in quotes");
  }
  return value;
}

std::optional<bool> TomlSection::boolean(const char* key) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) {
    return std::nullopt;
  }
  if (!node->is_boolean()) {
    failAtNode(*node, std::string(key) + " has to be true or false");
  }
  return node->value<bool>();
}

std::optional<glm::dvec3> TomlSection::color(const char* key, const Range& range) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) {
    return std::nullopt;
  }
  if (node->is_number()) {
    return glm::dvec3(numberOf(*node, key, range));
  }
  if (!node->is_array()) {
    failAtNode(*node, std::string(key) + " has to be a number, or three as [r, g, b]");
  }
  const std::vector<double> values = numbersOf(*node, key, 3, range);
  return glm::dvec3(values[0], values[1], values[2]);
}

std::optional<glm::dvec3> TomlSection::point(const char* key) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) {
    return std::nullopt;
  }
  const std::vector<double> values = numbersOf(*node, key, 3, kAnyNumber);
  return glm::dvec3(values[0], values[1], values[2]);
}

std::optional<glm::dvec2> TomlSection::plan(const char* key) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) {
    return std::nullopt;
  }
  const std::vector<double> values = numbersOf(*node, key, 2, kAnyNumber);
  return glm::dvec2(values[0], values[1]);
}

std::optional<std::array<std::int64_t, 2>> TomlSection::pair(const char* key) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) {
    return std::nullopt;
  }
  const std::vector<double> values = numbersOf(*node, key, 2, kAnyNumber);
  if (values[0] != std::floor(values[0]) || values[1] != std::floor(values[1])) {
    failAtNode(*node, std::string(key) + " has to be two whole numbers");
  }
  return std::array{static_cast<std::int64_t>(values[0]), static_cast<std::int64_t>(values[1])};
}

std::vector<glm::dvec2> TomlSection::polygon(const char* key) const {
  std::vector<glm::dvec2> corners;
  const toml::node* node = table_->get(key);
  if (node == nullptr) {
    return corners;
  }
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() < 3) {
    failAtNode(*node, std::string(key) + " has to be a list of three or more [x, y]");
  }
  for (const toml::node& element : *array) {
    const std::vector<double> values = numbersOf(element, key, 2, kAnyNumber);
    corners.emplace_back(values[0], values[1]);
  }
  return corners;
}

std::vector<glm::dvec3> TomlSection::outline(const char* key) const {
  const toml::node* node = table_->get(key);
  const toml::array* array = node == nullptr ? nullptr : node->as_array();
  if (array == nullptr || array->size() < 3) {
    fail(key, std::string(key) + " has to be a list of three or more [x, y, z], in metres");
  }
  std::vector<glm::dvec3> corners;
  for (const toml::node& element : *array) {
    const std::vector<double> values = numbersOf(element, key, 3, kAnyNumber);
    corners.emplace_back(values[0], values[1], values[2]);
  }
  return corners;
}

std::optional<ClockTime> TomlSection::date(const char* key) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) {
    return std::nullopt;
  }
  const auto value = node->value<toml::date>();
  if (!value) {
    failAtNode(*node, std::string(key) + " has to be a date, without quotes: 2026-03-21");
  }
  ClockTime time;
  time.year = value->year;
  time.month = value->month;
  time.day = value->day;
  expectKnownYear(*node, key, time.year);
  return time;
}

std::optional<ClockTime> TomlSection::time(const char* key) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) {
    return std::nullopt;
  }
  const auto value = node->value<toml::date_time>();
  if (!value) {
    failAtNode(*node, std::string(key) + " has to be a date and a time, without quotes: 2026-03-21T10:00:00");
  }
  ClockTime time;
  time.year = value->date.year;
  time.month = value->date.month;
  time.day = value->date.day;
  time.hour_h = value->time.hour + value->time.minute / 60.0 + value->time.second / 3600.0;
  if (value->offset) {
    time.zone_h = value->offset->minutes / 60.0;
  }
  expectKnownYear(*node, key, time.year);
  return time;
}

void TomlSection::expectKnownYear(const toml::node& node, const char* key, int year) const {
  if (year < 1950 || year > 2100) {
    failAtNode(node, std::string(key) +
                         " lies outside the years 1950 to 2100, for which the sun's place is "
                         "known well enough");
  }
}

std::vector<std::string> TomlSection::texts(const char* key) const {
  std::vector<std::string> values;
  const toml::node* node = table_->get(key);
  if (node == nullptr) {
    return values;
  }
  if (!node->is_array()) {
    failAtNode(*node, std::string(key) + " has to be a list of texts in quotes");
  }
  for (const toml::node& element : *node->as_array()) {
    const auto value = element.is_string() ? element.value<std::string>() : std::nullopt;
    if (!value) {
      failAtNode(element, std::string(key) + " has to be a list of texts in quotes");
    }
    values.push_back(*value);
  }
  return values;
}

std::optional<TomlSection> TomlSection::section(const char* key) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) {
    return std::nullopt;
  }
  const std::string name = name_.empty() ? "[" + std::string(key) + "]" : name_ + " " + key;
  if (!node->is_table()) {
    failAtNode(*node, std::string(key) + " has to be a table");
  }
  return TomlSection(*node->as_table(), name, *file_);
}

std::vector<TomlSection> TomlSection::list(const char* key) const {
  std::vector<TomlSection> sections;
  const toml::node* node = table_->get(key);
  if (node == nullptr) {
    return sections;
  }
  const toml::array* array = node->as_array();
  if (array == nullptr || !array->is_array_of_tables()) {
    failAtNode(*node, std::string(key) + " has to be a list of tables; write [[" + key + "]]");
  }
  for (const toml::node& element : *array) {
    sections.emplace_back(*element.as_table(), "[[" + std::string(key) + "]]", *file_);
  }
  return sections;
}

/// toml++ keeps keys sorted by name; the file's order is that of their places.
std::vector<TomlSection::Named> TomlSection::named(const char* key) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) {
    return {};
  }
  if (!node->is_table()) {
    failAtNode(*node, std::string(key) + " has to be a table of tables");
  }
  const std::string parent = name_.empty() ? key : name_.substr(1, name_.size() - 2) + "." + key;
  std::vector<std::pair<std::pair<std::size_t, std::size_t>, Named>> found;
  for (const auto& [name, child] : *node->as_table()) {
    const std::string text(name.str());
    const std::string header = "[" + parent + "." + inQuotes(text) + "]";
    const auto place = name.source().begin;
    if (!child.is_table()) {
      failAt({*file_, place.line}, header + " has to be a table, of what is stated of " + inQuotes(text));
    }
    found.push_back({{place.line, place.column}, {text, TomlSection(*child.as_table(), header, *file_)}});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Named> sections;
  for (auto& [place, section] : found) {
    sections.push_back(std::move(section));
  }
  return sections;
}

}  // namespace clerestory
