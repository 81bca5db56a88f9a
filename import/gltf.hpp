// SPDX-License-Identifier: GPL-3.0-or-later
// glTF 2.0 models, .gltf and .glb.
#pragma once

#include <filesystem>

#include <import/scene.hpp>

namespace clerestory {

/// Reads the default scene of a glTF 2.0 file in its own axes (y up). A node with a mesh is an object. A mesh
/// with `extras.clerestory` becomes a cage. Throws InputError with the JSON pointer of what is wrong.
Scene readGltf(const std::filesystem::path& file);

}  // namespace clerestory
