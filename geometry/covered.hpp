// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces that another one lies on: a floor under a rug or a plinth, a wall behind a picture, a ceiling in
// whose plane a lamp is drawn.
#pragma once

#include <geometry/building.hpp>

namespace clerestory {

/// Cuts opaque pieces where a smaller one lies on them in one plane, and takes what is covered out of the
/// light: the lower one's side, and the upper one's that lies on it. The lower one gives way by the width of
/// a ray's offset, so that no ray meets it first. Domains and rooms have to be known; floors stay, domains'
/// areas follow. Faces of different surfaces in one plane, drawn for one side, are told as G221: that the
/// smaller one is seen is a guess.
void darkenCovered(Building& building);

}  // namespace clerestory
