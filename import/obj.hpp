// SPDX-License-Identifier: GPL-3.0-or-later
// Wavefront OBJ models.
#pragma once

#include <filesystem>

#include <import/scene.hpp>

namespace clerestory {

/// Reads an OBJ file and its material libraries, in the file's own units and axes. Polygons stay polygons.
/// An object with `t` tags (as OpenSubdiv writes them) becomes a cage. Throws InputError with file and line.
Scene readObj(const std::filesystem::path& file);

}  // namespace clerestory
