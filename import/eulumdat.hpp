// SPDX-License-Identifier: GPL-3.0-or-later
// EULUMDAT (Stockmar 1990) and what of EULUMDAT/2 (1998) concerns light.
#pragma once

#include <import/photometry.hpp>

namespace clerestory {

/// Reads the bytes of `file`. Throws InputError with file and line.
Photometry readEulumdat(const std::string& bytes, const std::filesystem::path& file);

}  // namespace clerestory
