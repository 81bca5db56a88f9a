// SPDX-License-Identifier: GPL-3.0-or-later
// The solution as a model for any viewer: glTF 2.0 in one binary file.
#pragma once

#include <string>

#include <report/report.hpp>

namespace clerestory {

/// The elements as triangles, a node for each surface in each room, y up, in metres, from the model's own
/// origin. COLOR_0, shown unlit, is radiosity in linear Rec.709, exposed as a picture would be and cut
/// off at 1: the scene's extras hold the lm/m² of 1. _ILLUMINANCE is lux at each corner. Throws
/// std::length_error where glTF's 4 GB would not hold it.
std::string sceneGlb(const ReportInput& input);

}  // namespace clerestory
