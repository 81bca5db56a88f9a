// SPDX-License-Identifier: GPL-3.0-or-later
// Subdivision tags in OBJ models, as OpenSubdiv's own shapes carry them.
#pragma once

#include <span>
#include <string_view>

#include <import/scene.hpp>

#include "textfile.hpp"

namespace clerestory {

/// Reads one line `t NAME integers/floats/strings VALUES…` into `cage`: crease, corner, hole and
/// interpolateboundary. Points are counted from 0 over the whole file, `points` of them so far.
/// False where the tag is not known. Throws InputError with the place where it is malformed.
bool readObjTag(std::span<const std::string_view> words, std::size_t points, const Place& place, Cage& cage);

}  // namespace clerestory
