// SPDX-License-Identifier: GPL-3.0-or-later
// False colours: even steps of lightness, readable without red-green vision and in grey print.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace clerestory {

/// sRGB, 8 bits each.
using DisplayColour = std::array<std::uint8_t, 3>;

/// The colour at `fraction` of the scale, dark to light. Outside [0, 1] the ends hold; NaN is the dark end.
DisplayColour falseColour(double fraction);

/// Whether black is easier to read on a colour than white is: either has a contrast of 4.58 : 1 at least.
bool wantsBlackText(const DisplayColour& ground);

/// "#rrggbb"
std::string hexColour(const DisplayColour& colour);

/// The sRGB encoding of a linear value, both [0, 1]; values beyond are clamped.
std::uint8_t srgbByte(double linear);

}  // namespace clerestory
