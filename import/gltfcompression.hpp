// SPDX-License-Identifier: GPL-3.0-or-later
// Compressed parts of a glTF: buffer views by meshoptimizer, meshes by Draco.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "jsonnode.hpp"

namespace clerestory {

/// The bytes that the compressed `bytes` of a buffer view stand for. `extension` is its
/// EXT_meshopt_compression. Throws InputError where they do not decode.
std::string decodeMeshopt(const JsonNode& extension, std::string_view bytes);

/// A mesh as Draco holds it.
struct DracoMesh {
  std::vector<glm::dvec3> positions;
  std::vector<glm::dvec2> coordinates;  ///< of a texture, as many as positions; empty: none were asked for
  std::vector<std::uint32_t> corners;   ///< three for each triangle, within positions
};

/// Decodes a primitive's KHR_draco_mesh_compression; `coordinateSet` is the TEXCOORD to read with it. Throws
/// InputError where the bytes do not decode.
DracoMesh decodeDraco(const JsonNode& extension, std::string_view bytes,
                      std::optional<std::size_t> coordinateSet);

}  // namespace clerestory
