// SPDX-License-Identifier: GPL-3.0-or-later
// Puts a finished folder in its place in one step, so that nobody ever sees half a report.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace clerestory {

/// study.json names this as its generator; it is what tells our folder from any other.
inline constexpr std::string_view generatorMark = "clerestory-report";

/// Calls `write` with an empty folder beside `folder` and then renames that into place; an older report goes
/// only once the new one is whole. If anything fails, the older report stays and nothing else is left behind.
/// Throws InputError where `folder` cannot take a report, MachineError where the disk fails, and what `write`
/// throws.
void writeBeside(const std::filesystem::path& folder,
                 const std::function<void(const std::filesystem::path&)>& write);

/// Writes one file whole. Throws MachineError.
void writeFile(const std::filesystem::path& file, std::string_view bytes);

/// Reads one file whole. Throws MachineError.
std::string readFile(const std::filesystem::path& file);

}  // namespace clerestory
