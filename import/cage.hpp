// SPDX-License-Identifier: GPL-3.0-or-later
// Control cages: from tagged or chosen objects, checked before OpenSubdiv sees them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <import/scene.hpp>

namespace clerestory {

std::optional<Cage::Scheme> parseScheme(std::string_view text);      ///< catmark loop bilinear
std::optional<Cage::Boundary> parseBoundary(std::string_view text);  ///< none edge-only edge-and-corner

/// Takes the faces of each object in `tags` out of the scene and makes them the faces of the cage that is
/// given for it there (its tags filled in, its faces empty), then checks that cage. An object without faces
/// gives none.
void moveFacesToCages(Scene& scene, const std::map<std::uint32_t, Cage>& tags);

/// Gives the faces of all cages that `chosen` marks back to the scene as plain polygons, without its holes.
void moveCagesToFaces(Scene& scene, const std::vector<bool>& chosen);

/// Leaves out of `cage` what OpenSubdiv must not see (repeated corners of a face, creases that are no edges,
/// corners that are no points of it), each with a diagnosis. Throws InputError where Loop's scheme meets a
/// face that is no triangle, or an index is out of range.
void checkCage(Cage& cage, Scene& scene);

}  // namespace clerestory
