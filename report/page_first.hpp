// SPDX-License-Identifier: GPL-3.0-or-later
// The page's first screen: the views, and beside the first of them what a reader wants to know first.
#pragma once

#include <string>
#include <vector>

#include "page.hpp"

namespace clerestory {

/// The first view with each room's figures and verdicts beside it, then the further views, then all of them
/// in false colours, folded away. Without views the figures alone.
std::string firstScreenHtml(const ReportInput& input, const std::vector<PageView>& views);

}  // namespace clerestory
