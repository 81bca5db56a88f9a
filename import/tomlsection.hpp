// SPDX-License-Identifier: GPL-3.0-or-later
// A table of a TOML file whose keys and values are checked, and whose errors carry file and line.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <toml++/toml.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <import/study.hpp>

namespace clerestory {

/// The numbers that a value may be.
struct Range {
  double low;
  double high;
  bool lowIsIn = true;
  bool highIsIn = true;

  [[nodiscard]] bool holds(double value) const;
  [[nodiscard]] std::string text() const;  ///< "from 0 to below 1"
};

/// A view of a table in a document that outlives it.
class TomlSection {
 public:
  /// `name` is how the file writes it: [sky], [materials."wall*"]; empty for the whole file.
  TomlSection(const toml::table& table, std::string name, const std::string& file)
      : table_(&table), name_(std::move(name)), file_(&file) {}

  /// Throws for the first key that is none of `known`, and names the nearest that is.
  void allowOnly(const std::vector<std::string>& known) const;
  /// Throws where one of `keys` is there: a later version may know it.
  void refuse(const std::vector<std::string>& keys) const;

  [[nodiscard]] bool has(const char* key) const { return table_->contains(key); }
  [[nodiscard]] bool isText(const char* key) const { return has(key) && table_->get(key)->is_string(); }
  [[nodiscard]] std::optional<double> number(const char* key, const Range& range) const;
  [[nodiscard]] std::optional<std::int64_t> integer(const char* key, std::int64_t low,
                                                    std::int64_t high) const;
  [[nodiscard]] std::optional<std::string> text(const char* key) const;
  [[nodiscard]] std::optional<bool> boolean(const char* key) const;
  /// A number for all three channels, or [r, g, b].
  [[nodiscard]] std::optional<glm::dvec3> color(const char* key, const Range& range) const;
  [[nodiscard]] std::optional<glm::dvec3> point(const char* key) const;                  ///< [x, y, z]
  [[nodiscard]] std::optional<std::array<std::int64_t, 2>> pair(const char* key) const;  ///< whole numbers
  [[nodiscard]] std::optional<glm::dvec2> plan(const char* key) const;                   ///< [x, y]
  [[nodiscard]] std::vector<glm::dvec2> polygon(const char* key) const;                  ///< [[x, y], …]
  [[nodiscard]] std::vector<glm::dvec3> outline(const char* key) const;                  ///< [[x, y, z], …]
  [[nodiscard]] std::optional<ClockTime> date(const char* key) const;                    ///< at noon
  [[nodiscard]] std::optional<ClockTime> time(const char* key) const;  ///< date and time, a zone if stated
  [[nodiscard]] std::vector<std::string> texts(const char* key) const;

  [[nodiscard]] std::optional<TomlSection> section(const char* key) const;  ///< a table
  [[nodiscard]] std::vector<TomlSection> list(const char* key) const;       ///< [[key]]

  /// A table under a name of the user's own.
  struct Named;
  [[nodiscard]] std::vector<Named> named(const char* key) const;  ///< [key."name"], in the file's order

  /// Throws InputError "file:line: [section] message" at `key`.
  [[noreturn]] void fail(std::string_view key, const std::string& message) const;

 private:
  void expectKnownYear(const toml::node& node, const char* key, int year) const;
  [[noreturn]] void failAtNode(const toml::node& node, const std::string& message) const;
  [[nodiscard]] double numberOf(const toml::node& node, std::string_view key, const Range& range) const;
  [[nodiscard]] std::vector<double> numbersOf(const toml::node& node, std::string_view key, std::size_t count,
                                              const Range& range) const;

  const toml::table* table_;
  std::string name_;
  const std::string* file_;
};

struct TomlSection::Named {
  std::string name;
  TomlSection section;
};

/// Parses a TOML file's text. Throws InputError with the line where it is not TOML.
toml::table parseToml(std::string_view text, const std::string& file);

}  // namespace clerestory
