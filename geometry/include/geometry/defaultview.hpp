// SPDX-License-Identifier: GPL-3.0-or-later
// A view for a study that asks for none.
#pragma once

#include <optional>

#include <geometry/building.hpp>
#include <import/study.hpp>

namespace clerestory {

/// Looks into the largest room with windows (else the largest that is lit) from where most of it is seen, at
/// eye height. Empty where no grid lies in a lit room, or there is no place to stand.
std::optional<ViewSettings> defaultView(const Building& building);

}  // namespace clerestory
