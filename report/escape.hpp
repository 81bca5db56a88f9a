// SPDX-License-Identifier: GPL-3.0-or-later
// Names come out of models that anybody may have written: what makes them harmless in a page, a table and a
// file name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace clerestory {

/// `text` with every byte that is not valid UTF-8, and every control character but tab and newline, as
/// U+FFFD.
std::string validUtf8(std::string_view text);

/// `text` for HTML and SVG, between tags as well as inside a quoted attribute.
std::string escapeHtml(std::string_view text);

/// `text` as one CSV field of RFC 4180. What a spreadsheet would run as a formula gets a leading apostrophe.
std::string csvText(std::string_view text);

/// File names for `names`, in their order: only [A-Za-z0-9_-], not empty, and different even where case is
/// ignored.
std::vector<std::string> safeFileNames(const std::vector<std::string>& names);

/// `bytes` in base64, for data URLs.
std::string base64(std::string_view bytes);

}  // namespace clerestory
