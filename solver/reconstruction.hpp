// SPDX-License-Identifier: GPL-3.0-or-later
// Radiosity as smooth as the data allow: planes over the elements in place of constants.
#pragma once

#include "radiosity.hpp"

namespace clerestory {

/// Fills `radiosity.planes`. Each side keeps its power, and no value falls below zero.
///
/// A side begins with one plane. Where an element is divided, its halves depart from its plane as far as
/// their own means and their neighbours' tell, less what may be noise: `error_lm` is the error that the
/// oracle allowed one interaction, weighted as its threshold is. With 0 each leaf keeps its mean, and planes
/// are those of linear finite volumes (fitted by least squares and limited as by Barth and Jespersen, AIAA
/// 89-0366). Nothing is smoothed across what stands on a surface.
template <int K>
void reconstruct(const World& world, float error_lm, Radiosity<K>& radiosity);

}  // namespace clerestory
