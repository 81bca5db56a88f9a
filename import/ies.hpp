// SPDX-License-Identifier: GPL-3.0-or-later
// IES LM-63, the editions of 1986, 1991, 1995, 2002 and 2019.
#pragma once

#include <import/photometry.hpp>

namespace clerestory {

/// Reads the bytes of `file` and, where it names one, the file of TILT data beside it. Throws InputError with
/// file and line.
Photometry readIes(const std::string& bytes, const std::filesystem::path& file);

}  // namespace clerestory
