// SPDX-License-Identifier: GPL-3.0-or-later
// Materials of glTF models.
#pragma once

#include "jsonnode.hpp"
#include "material.hpp"

namespace clerestory {

/// What the element `material` of /materials says about light.
DisplayMaterial gltfMaterial(const JsonNode& material, std::vector<Diagnosis>& diagnoses);

}  // namespace clerestory
