// SPDX-License-Identifier: GPL-3.0-or-later
// Checks that both photometric formats ask for, and how their planes are mirrored to all around.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <import/photometry.hpp>

#include "textfile.hpp"

namespace clerestory {

/// Angles that a file lists have to rise and lie in [low, high]. Throws InputError at `place`.
void checkAngles(const std::vector<double>& angles_deg, double low, double high, const std::string& what,
                 const Place& place);

/// Intensities have to be finite and not negative; what measurement noise puts below 0 becomes 0.
/// Throws InputError at `place` where none is above 0.
void checkIntensities(std::vector<double>& intensity_cd, const Place& place);

/// Adds the mirror images of planes about the longitude of the last (`atLast`) or the first.
/// `planes` (#longitudes × #each) and `longitude_deg` grow.
void mirrorPlanes(std::vector<double>& longitude_deg, std::vector<double>& planes, bool atLast);

/// Closes the circle with the first plane where no more lacks than the widest step between planes. Throws
/// InputError at `place` where more does.
void closeCircle(std::vector<double>& longitude_deg, std::vector<double>& planes, const Place& place);

}  // namespace clerestory
