// SPDX-License-Identifier: GPL-3.0-or-later
// Which norms a study asks for, and whether its grids and rooms pass; definitions in docs/measures.md.
#pragma once

#include <optional>
#include <string>

#include <report/report.hpp>

namespace clerestory {

/// Whether a study names a norm in `[report] norms`.
bool isAsked(const Study& study, const std::string& norm);

/// Why EN 17037 cannot be judged under a study's sky; empty where it can.
std::string whyNoEn17037(const Study& study);

/// The highest level of EN 17037 that a grid reaches, "none" or, where it cannot be judged, nothing.
std::optional<std::string> en17037Level(const GridValues& grid, const Study& study);

/// The page's verdict by that level; empty where the norm cannot be judged.
std::string en17037Verdict(const GridValues& grid, const Study& study);

/// LEED's daylight option 2 for the one hour that a study has: the share of sensors from 300 to 3,000 lx and
/// the points that it would earn, were the other hour as good.
struct LeedHour {
  double share_pct = 0.0;
  int pointsV4 = 0, pointsV41 = 0;
};
/// Why a study is no hour of LEED's; empty where it is.
std::string whyNoLeedHour(const Study& study);
std::optional<LeedHour> leedHourOf(const GridValues& grid, const Study& study);

/// EN 17037's level for hours of sunlight on a study's day: "minimum" from 1.5 h, "medium" from 3 h, "high"
/// from 4 h; or "none". The norm takes a day from 1 February to 21 March: "not judged" on others.
std::string sunlightLevel(const Study& study, double hours);

/// A room's checks for the page: the average daylight factor by formula beside the computed one, hours of
/// sunlight, LEED where it is asked for.
std::string roomChecksHtml(const ReportInput& input, std::size_t room);

/// What the norms say of a study, for the page's first screen: each verdict and what it asks, or why there is
/// none.
std::string glanceNormsHtml(const ReportInput& input);

}  // namespace clerestory
