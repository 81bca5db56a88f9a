// SPDX-License-Identifier: GPL-3.0-or-later
// Text and bytes from files that nobody vouches for: lines, words, numbers, names and paths.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clerestory {

/// A line of a text file, for messages.
struct Place {
  std::string file;
  std::size_t line = 0;  ///< from 1; 0: the file as a whole

  [[nodiscard]] std::string text() const;
};

/// Throws InputError: "file:line: message".
[[noreturn]] void failAt(const Place& place, const std::string& message);

/// The whole of `file`. Throws InputError "`kind` file not found: …" or says why it cannot be read.
std::string readWholeFile(const std::filesystem::path& file, const std::string& kind,
                          std::uintmax_t maxBytes);

/// `bytes` without a UTF-8 byte order mark. Throws InputError for UTF-16 and for bytes that are no text.
std::string_view plainText(std::string_view bytes, const std::string& file);
/// The same, but UTF-16 behind its byte order mark becomes UTF-8.
std::string decodedText(std::string bytes, const std::string& file);

/// Logical lines of a text with LF, CRLF or CR ends; a line that ends in a backslash goes on in the next.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(text) {}

  bool next();  ///< moves to the next line, the first one at first; false after the last
  [[nodiscard]] std::string_view line() const { return line_; }  ///< without its end; valid until next()
  [[nodiscard]] std::size_t number() const { return number_; }   ///< where it begins, from 1

 private:
  std::string_view takePhysicalLine();

  std::string_view rest_;
  std::string_view line_;
  std::string joined_;
  std::size_t number_ = 0;
  std::size_t physical_ = 0;
};

/// Appends to `words` (cleared first) what blanks separate in `line`; a word that begins with # ends it.
void splitWords(std::string_view line, std::vector<std::string_view>& words);

/// The fields of a line of CSV, quotes and blanks around them taken off.
std::vector<std::string> csvFields(std::string_view line);

std::string_view trimmed(std::string_view text);
std::string lowerCase(std::string_view text);  ///< ASCII only

/// The whole of `word` as a finite number with a decimal point, whatever the locale; a leading + is allowed.
/// What is too small for a double is 0.
std::optional<double> parseNumber(std::string_view word);
/// The same for a number with a decimal comma, as programs write it that follow their user's language.
std::optional<double> parseCommaNumber(std::string_view word);
std::optional<std::int64_t> parseInteger(std::string_view word);

/// Shortest decimal text that reads back to the same double.
std::string numberText(double value);

/// A name that any output can carry: valid UTF-8 (other bytes are read as Latin-1), no control characters,
/// runs of blanks as one, at most 1,000 bytes.
std::string cleanName(std::string_view bytes);

/// The file that `name` means beside a file in `folder`; empty where it is absolute, climbs with `..`,
/// or is a link that leads out. It need not exist.
std::optional<std::filesystem::path> fileInside(const std::filesystem::path& folder, std::string_view name);

/// The one of `known` that is nearest to `name` by edits, the first of equals; empty where `known` is.
std::string nearestName(std::string_view name, const std::vector<std::string>& known);

}  // namespace clerestory
