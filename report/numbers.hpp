// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers as text: exact ones for tables that programs read, rounded ones for people. Nothing else rounds.
#pragma once

#include <string>

namespace clerestory {

/// The shortest decimal that gives the same float again; empty where `value` is not finite.
std::string shortestFloat(double value);

/// The shortest decimal that gives the same double again; empty where `value` is not finite.
std::string shortestDouble(double value);

/// A coordinate to the micrometre: sums like 0.1 + 0.2 print as drawn, national grids keep their millimetres.
std::string coordinate(double metres);

/// The double that the shortest decimal of `value` as a float stands for; NaN stays NaN.
double asWritten(double value);

/// For people: fixed decimals, thousands apart by narrow no-break spaces, a true minus; an en dash if not
/// finite.
std::string fixedNumber(double value, int decimals);

/// For people: `figures` significant figures, at least whole numbers.
std::string roundedNumber(double value, int figures = 3);

/// For people: an illuminance in lux, whole from 10 on, three figures at most.
std::string illuminanceText(double lx);

/// For people: a daylight factor in percent, with two decimals below 1.
std::string factorText(double pct);

/// For SVG and CSS: at most two decimals, '.' as point.
std::string shortNumber(double value);

}  // namespace clerestory
