// SPDX-License-Identifier: GPL-3.0-or-later
// Material libraries of OBJ models.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "material.hpp"

namespace clerestory {

/// Materials by name, as their files state them.
using MaterialLibrary = std::map<std::string, DisplayMaterial>;

/// Adds the materials of an MTL file to `library`; a name that is there already keeps its first meaning.
/// Nothing in it stops the program: what cannot be read is a diagnosis.
void readMtl(const std::filesystem::path& file, MaterialLibrary& library, std::vector<Diagnosis>& diagnoses);

}  // namespace clerestory
