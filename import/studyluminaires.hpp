// SPDX-License-Identifier: GPL-3.0-or-later
// [[luminaire]] of study.toml.
#pragma once

#include <import/study.hpp>

#include "tomlsection.hpp"

namespace clerestory {

/// Reads the luminaires of a study and their photometric files, which lie in the study's folder.
void readLuminaires(const TomlSection& file, const std::filesystem::path& folder, Study& study);

}  // namespace clerestory
