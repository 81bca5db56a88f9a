// SPDX-License-Identifier: GPL-3.0-or-later
// Reads text and bytes from files that nobody vouches for.
#include "textfile.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <system_error>

#include <import/error.hpp>

namespace clerestory {

std::string Place::text() const {
  return line == 0 ? file : file + ":" + std::to_string(line);
}

void failAt(const Place& place, const std::string& message) {
  throw InputError(place.text() + ": " + message);
}

std::string readWholeFile(const std::filesystem::path& file, const std::string& kind,
                          std::uintmax_t maxBytes) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) {
    throw InputError(kind + " file not found: " + file.string() + "; check the path and its spelling");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw InputError(file.string() + ": is not a file; name the " + kind + " file itself");
  }
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) {
    throw InputError(file.string() + ": cannot be read: " + error.message());
  }
  if (size > maxBytes) {
    throw InputError(file.string() + ": has " + std::to_string(size >> 20U) + " MiB, more than the " +
                     std::to_string(maxBytes >> 20U) + " MiB that a " + kind + " file may have");
  }
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!stream || !stream.read(bytes.data(), static_cast<std::streamsize>(size))) {
    throw InputError(file.string() + ": cannot be read; check its permissions");
  }
  return bytes;
}

namespace {

void appendUtf8(std::string& text, std::uint32_t code) {
  const auto add = [&text](std::uint32_t byte) { text += static_cast<char>(byte); };
  if (code < 0x80) {
    add(code);
  } else if (code < 0x800) {
    add(0xC0U | (code >> 6U));
    add(0x80U | (code & 0x3FU));
  } else if (code < 0x10000) {
    add(0xE0U | (code >> 12U));
    add(0x80U | ((code >> 6U) & 0x3FU));
    add(0x80U | (code & 0x3FU));
  } else {
    add(0xF0U | (code >> 18U));
    add(0x80U | ((code >> 12U) & 0x3FU));
    add(0x80U | ((code >> 6U) & 0x3FU));
    add(0x80U | (code & 0x3FU));
  }
}

/// UTF-16 behind its byte order mark; half a surrogate pair becomes U+FFFD.
std::string fromUtf16(std::string_view bytes) {
  const bool lowFirst = bytes[0] == '\xFF';
  const auto unit = [&](std::size_t at) {
    const auto first = static_cast<unsigned char>(bytes[at]);
    const auto second = static_cast<unsigned char>(bytes[at + 1]);
    return static_cast<std::uint32_t>(lowFirst ? first | second << 8U : first << 8U | second);
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t at = 2; at + 1 < bytes.size(); at += 2) {
    std::uint32_t code = unit(at);
    if ((code & 0xF800U) == 0xD800U) {
      const bool isPair = code < 0xDC00U && at + 3 < bytes.size() && (unit(at + 2) & 0xFC00U) == 0xDC00U;
      code = isPair ? 0x10000U + ((code & 0x3FFU) << 10U) + (unit(at + 2) & 0x3FFU) : 0xFFFDU;
      at += isPair ? 2 : 0;
    }
    appendUtf8(text, code);
  }
  return text;
}

}  // namespace

std::string_view plainText(std::string_view bytes, const std::string& file) {
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) {
    throw InputError(file + ": is UTF-16 text; save it as UTF-8");
  }
  if (bytes.starts_with("\xEF\xBB\xBF")) {
    bytes.remove_prefix(3);
  }
  if (bytes.find('\0') != std::string_view::npos) {
    throw InputError(file + ": holds zero bytes, so it is not a text file; check that its ending is right");
  }
  return bytes;
}

std::string decodedText(std::string bytes, const std::string& file) {
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) {
    bytes = fromUtf16(bytes);
  }
  const std::string_view text = plainText(bytes, file);
  bytes.erase(0, bytes.size() - text.size());
  return bytes;
}

std::string_view LineReader::takePhysicalLine() {
  ++physical_;
  const std::size_t end = rest_.find_first_of("\r\n");
  const std::string_view line = rest_.substr(0, end);
  if (end == std::string_view::npos) {
    rest_ = {};
  } else {
    rest_.remove_prefix(rest_.substr(end).starts_with("\r\n") ? end + 2 : end + 1);
  }
  return line;
}

bool LineReader::next() {
  if (rest_.empty()) {
    return false;
  }
  line_ = takePhysicalLine();
  number_ = physical_;
  if (!line_.ends_with('\\')) {
    return true;
  }
  joined_.assign(line_.substr(0, line_.size() - 1));
  for (bool more = true; more && !rest_.empty();) {
    std::string_view part = takePhysicalLine();
    more = part.ends_with('\\');
    if (more) {
      part.remove_suffix(1);
    }
    joined_.append(" ").append(part);
  }
  line_ = joined_;
  return true;
}

void splitWords(std::string_view line, std::vector<std::string_view>& words) {
  constexpr std::string_view kBlanks = " \t\v\f";
  words.clear();
  for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos && line[at] != '#';) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlanks, end);
  }
}

std::vector<std::string> csvFields(std::string_view line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      const bool doubled = quoted && i + 1 < line.size() && line[i + 1] == '"';
      if (doubled) {
        fields.back() += '"';
        ++i;
      } else {
        quoted = !quoted;
      }
    } else if (line[i] == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  for (std::string& field : fields) {
    field = std::string(trimmed(field));
  }
  return fields;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\v\f\r\n";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') {
      c = static_cast<char>(c - 'A' + 'a');
    }
  }
  return lower;
}

namespace {

/// Without the leading + that std::from_chars does not know.
std::string_view withoutPlus(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-' && word[1] != '+') {
    word.remove_prefix(1);
  }
  return word;
}

template <typename Value>
std::optional<Value> parseWhole(std::string_view word) {
  word = withoutPlus(word);
  Value value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool isTiny = error == std::errc::result_out_of_range && word.size() < 64 &&
                      word.find("e-") != std::string_view::npos;
  if ((error != std::errc() && !isTiny) || end != word.data() + word.size()) {
    return std::nullopt;
  }
  return value;  // 0 where it is too small for a double
}

}  // namespace

std::optional<double> parseNumber(std::string_view word) {
  const std::optional<double> value = parseWhole<double>(word);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<double> parseCommaNumber(std::string_view word) {
  const std::size_t comma = word.find(',');
  if (comma == std::string_view::npos || word.find_first_of(".,", comma + 1) != std::string_view::npos) {
    return std::nullopt;
  }
  std::string dotted(word);
  dotted[comma] = '.';
  return parseNumber(dotted);
}

std::optional<std::int64_t> parseInteger(std::string_view word) {
  return parseWhole<std::int64_t>(word);
}

std::string numberText(double value) {
  char text[32];
  const auto result = std::to_chars(text, text + sizeof(text), value);
  return std::string(text, result.ptr);
}

namespace {

/// Bytes of the UTF-8 sequence at the start of `bytes`; 0 where it is none.
std::size_t utf8Length(std::string_view bytes) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const unsigned lead = byte(0);
  const std::size_t length = lead < 0x80                   ? 1
                             : lead >= 0xC2 && lead < 0xE0 ? 2
                             : (lead & 0xF0U) == 0xE0      ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  if (length == 0 || length > bytes.size()) {
    return 0;
  }
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) {
      return 0;
    }
  }
  const bool overlong = (lead == 0xE0 && byte(1) < 0xA0) || (lead == 0xF0 && byte(1) < 0x90);
  const bool beyond = (lead == 0xED && byte(1) >= 0xA0) || (lead == 0xF4 && byte(1) >= 0x90);
  return overlong || beyond ? 0 : length;
}

}  // namespace

std::string cleanName(std::string_view bytes) {
  constexpr std::size_t kMaxBytes = 1000;
  std::string name;
  bytes = trimmed(bytes);
  while (!bytes.empty() && name.size() < kMaxBytes) {
    const auto byte = static_cast<unsigned char>(bytes[0]);
    const std::size_t length = utf8Length(bytes);
    if (byte <= 0x20 || byte == 0x7F) {
      if (!name.ends_with(' ')) {
        name += ' ';
      }
    } else if (length == 0) {
      name += static_cast<char>(0xC0U | (byte >> 6U));
      name += static_cast<char>(0x80U | (byte & 0x3FU));
    } else {
      name += bytes.substr(0, length);
    }
    bytes.remove_prefix(std::max<std::size_t>(length, 1));
  }
  if (name.ends_with(' ')) {
    name.pop_back();
  }
  return name;
}

std::optional<std::filesystem::path> fileInside(const std::filesystem::path& folder, std::string_view name) {
  std::string slashed(name);
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  const std::filesystem::path relative(slashed);
  const bool hasDrive = slashed.size() > 1 && slashed[1] == ':';
  if (relative.empty() || relative.is_absolute() || hasDrive || slashed.find('\0') != std::string::npos) {
    return std::nullopt;
  }
  if (std::find(relative.begin(), relative.end(), std::filesystem::path("..")) != relative.end()) {
    return std::nullopt;
  }
  std::error_code error;
  const auto base = std::filesystem::weakly_canonical(folder.empty() ? "." : folder, error);
  if (error) {
    return std::nullopt;
  }
  const auto target = std::filesystem::weakly_canonical(base / relative, error);
  if (error) {
    return std::nullopt;
  }
  const auto inside = target.lexically_relative(base);
  if (inside.empty() || *inside.begin() == "..") {
    return std::nullopt;
  }
  return folder / relative;
}

namespace {

/// Levenshtein's distance.
std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) {
    row[j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string nearestName(std::string_view name, const std::vector<std::string>& known) {
  const std::string wanted = lowerCase(name.substr(0, 100));
  std::string nearest;
  std::size_t least = std::string::npos;
  for (const std::string& candidate : known) {
    const std::size_t distance = editDistance(wanted, lowerCase(candidate));
    if (distance < least) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace clerestory
