// SPDX-License-Identifier: GPL-3.0-or-later
// Material libraries of OBJ models.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "material.hpp"
#include "texture.hpp"

namespace clerestory {

/// `map_Kd` or `map_Ke`: a picture, how it lies, and how its values count.
struct MtlTexture {
  std::string name;  ///< as written, seen from the library's folder
  std::string where;
  TextureMapping mapping;
  double base = 0.0;  ///< a value counts as base + gain * value
  double gain = 1.0;
};

struct MtlMaterial {
  DisplayMaterial display;
  std::filesystem::path folder;  ///< of its library
  std::optional<MtlTexture> color;
  std::optional<MtlTexture> luminance;
};

/// Materials by name, as their files state them.
using MaterialLibrary = std::map<std::string, MtlMaterial>;

/// Adds the materials of an MTL file to `library`; a name that is there already keeps its first meaning.
/// Nothing in it stops the program: what cannot be read is a diagnosis.
void readMtl(const std::filesystem::path& file, MaterialLibrary& library, std::vector<Diagnosis>& diagnoses);

}  // namespace clerestory
