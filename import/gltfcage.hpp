// SPDX-License-Identifier: GPL-3.0-or-later
// Subdivision cages in glTF models: `extras.clerestory` of a mesh.
#pragma once

#include <cstdint>

#include <import/scene.hpp>

#include "jsonnode.hpp"

namespace clerestory {

/// The cage that `tags` describes. Its indices count the POSITIONs of the mesh's first primitive, `count` of
/// them, which begin at `first` in the scene's points. Object and material are left to the caller.
Cage readGltfCage(const JsonNode& tags, std::uint32_t first, std::size_t count);

}  // namespace clerestory
