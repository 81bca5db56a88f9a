// SPDX-License-Identifier: GPL-3.0-or-later
// SHA-256, to say in a report which file was computed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace clerestory {

/// The checksum of `bytes` in 64 hexadecimal digits.
std::string sha256(std::string_view bytes);

/// The checksum of a file's content; empty where it cannot be read.
std::optional<std::string> sha256OfFile(const std::filesystem::path& file);

}  // namespace clerestory
