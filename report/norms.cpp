// SPDX-License-Identifier: GPL-3.0-or-later
// Judges grids and rooms by the thresholds of norms. Nothing is measured here.
#include "norms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <solver/daylight.hpp>

#include "escape.hpp"
#include "metrics.hpp"
#include "numbers.hpp"
#include "page_parts.hpp"

namespace clerestory {
namespace {

constexpr double equinoxMost_days = 15.0;
constexpr double hourMost_h = 0.25;

/// Days from 21 March or 21 September, whichever is nearer, in a year of 365 days.
int daysFromEquinox(const ClockTime& time) {
  static constexpr std::array<int, 12> before = {0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};
  const int day = before.at(static_cast<std::size_t>(time.month - 1)) + time.day;
  return std::min(std::abs(day - (59 + 21)), std::abs(day - (243 + 21)));
}

std::string verdictHtml(bool isMet, const std::string& text) {
  return std::string("<span class=\"") + (isMet ? "yes" : "no") + "\">" + text + "</span>";
}

}  // namespace

bool isAsked(const Study& study, const std::string& norm) {
  return std::find(study.norms.begin(), study.norms.end(), norm) != study.norms.end();
}

std::string whyNoEn17037(const Study& study) {
  const bool isOvercast = !study.sky.isPerez && (study.sky.cieType == 1 || study.sky.cieType == 16);
  if (!isOvercast) return "its daylight factors are those of an overcast sky, \"cie-overcast\" or \"cie-1\"";
  if (!(study.sky.diffuseHorizontal_lx > 0.0)) return "the sky is dark";
  if (!(study.site.externalDiffuse_lx > 0.0)) return "site.external_diffuse_lx is not stated";
  return {};
}

std::optional<std::string> en17037Level(const GridValues& grid, const Study& study) {
  const auto en = en17037Of(grid, study);
  if (!en) return std::nullopt;
  std::string best = "none";
  for (const En17037::Level& level : en->levels) {
    if (level.met) best = level.name;
  }
  return best;
}

std::string en17037Verdict(const GridValues& grid, const Study& study) {
  const auto best = en17037Level(grid, study);
  if (!best) return {};
  return *best == "none" ? verdictHtml(false, "not met") : verdictHtml(true, "met, " + *best);
}

std::string whyNoLeedHour(const Study& study) {
  if (!study.sky.isPerez && study.sky.cieType != 12)
    return "its option 2 is asked under a clear sky, \"cie-clear\" or \"perez\"";
  if (!(daylightOf(study).directNormal_lx > 0.0)) return "its option 2 is asked with the sun's beam";
  if (!study.sky.time) return "the sky states no time, such as 2026-03-21T09:00:00";
  const double hour_h = study.sky.time->hour_h;
  if (std::abs(hour_h - 9.0) > hourMost_h && std::abs(hour_h - 15.0) > hourMost_h)
    return "its option 2 is asked at 9:00 and at 15:00";
  if (daysFromEquinox(*study.sky.time) > equinoxMost_days)
    return "its option 2 is asked within 15 days of an equinox";
  return {};
}

std::optional<LeedHour> leedHourOf(const GridValues& grid, const Study& study) {
  if (!whyNoLeedHour(study).empty()) return std::nullopt;
  LeedHour hour;
  hour.share_pct = metricsOf(grid, study.sky).share300To3000_pct;
  const auto points = [&](std::initializer_list<double> thresholds_pct) {
    return static_cast<int>(std::count_if(thresholds_pct.begin(), thresholds_pct.end(),
                                          [&](double least) { return hour.share_pct >= least; }));
  };
  hour.pointsV4 = points({75.0, 90.0});
  hour.pointsV41 = points({55.0, 75.0, 90.0});
  return hour;
}

std::string sunlightLevel(const Study& study, double hours) {
  const ClockTime& date = study.sunlight.date;
  if (date.month != 2 && (date.month != 3 || date.day > 21)) return "not judged";
  if (hours >= 4.0) return "high";
  if (hours >= 3.0) return "medium";
  return hours >= 1.5 ? "minimum" : "none";
}

std::string roomChecksHtml(const ReportInput& input, std::size_t room) {
  if (room >= input.solution.rooms.size()) return {};
  const RoomValue& value = input.solution.rooms[room];
  const Study& study = input.study;
  std::vector<std::vector<std::string>> rows;
  for (const std::size_t g : gridsOfRoom(input.building, static_cast<std::int32_t>(room))) {
    const GridValues& grid = input.solution.grids.at(g);
    const std::string name = escapeHtml(input.building.grids[g].name);
    const GridMetrics metrics = metricsOf(grid, study.sky);
    if (metrics.daylightFactor_pct && value.averageDaylightFactor_pct > 0.0) {
      rows.push_back({"Average daylight factor, " + name, factorText(metrics.daylightFactor_pct->mean) + " %",
                      "by formula " + factorText(value.averageDaylightFactor_pct) + " %"});
    }
    const auto leed = isAsked(study, "leed") ? leedHourOf(grid, study) : std::nullopt;
    if (leed) {
      rows.push_back(
          {"LEED daylight option 2, this hour, " + name,
           fixedNumber(leed->share_pct, 0) + " % from 300 to 3,000 lx",
           verdictHtml(leed->pointsV4 > 0, "v4: " + std::to_string(leed->pointsV4) + " of 2 points") + ", " +
               verdictHtml(leed->pointsV41 > 0, "v4.1: " + std::to_string(leed->pointsV41) + " of 3 points") +
               " if the other hour is as good"});
    }
  }
  if (isAsked(study, "en17037")) {
    const std::string level = sunlightLevel(study, value.sunlight_h);
    rows.push_back({"EN 17037, exposure to sunlight on " + dateText(study.sunlight.date),
                    fixedNumber(value.sunlight_h, 1) + " h",
                    level == "not judged"
                        ? "asked for a day from 1 February to 21 March"
                        : verdictHtml(level != "none", level == "none" ? "not met" : "met, " + level)});
  }
  if (rows.empty()) return {};
  return tableHtml("Checks", {{"Check", "", false}, {"Computed", "", false}, {"Result", "", false}}, rows);
}

namespace {

/// What EN 17037 asks at the level that a single grid meets, or at its least one, and what the grid has.
std::string en17037Glance(const ReportInput& input) {
  const auto en = en17037Of(input.solution.grids.at(0), input.study);
  const bool isOne = input.solution.grids.size() == 1;
  const En17037::Level* level = &en->levels.front();
  for (const En17037::Level& other : en->levels) {
    if (isOne && other.met) level = &other;
  }
  const auto here = [&](double share_pct) {
    return isOne ? " (here on " + fixedNumber(share_pct, 0) + "\u00a0%)" : std::string();
  };
  return "its " + std::string(level->name) + " level asks a daylight factor of " +
         factorText(level->target_pct) + "\u00a0% on half of the area" + here(level->shareTarget_pct) +
         " and of " + factorText(level->minimum_pct) + "\u00a0% on 95\u00a0% of it" +
         here(level->shareMinimum_pct) + ".";
}

}  // namespace

std::string glanceNormsHtml(const ReportInput& input) {
  const Study& study = input.study;
  const GridValues& first = input.solution.grids.at(0);
  const bool isOne = input.solution.grids.size() == 1;
  std::string html;
  const std::string why = whyNoEn17037(study);
  if (why.empty()) {
    html += isOne ? "<p>EN 17037 " + en17037Verdict(first, study) +
                        "<span class=\"note\">: " + en17037Glance(input) + "</span></p>\n"
                  : "<p class=\"note\">EN 17037: " + en17037Glance(input) + "</p>\n";
  } else {
    html += "<p class=\"note\">EN 17037’s daylight provision is not judged: " + escapeHtml(why) + ".</p>\n";
  }
  const auto leed = isOne && isAsked(study, "leed") ? leedHourOf(first, study) : std::nullopt;
  if (leed) {
    html += "<p>LEED " + verdictHtml(leed->pointsV4 > 0, std::to_string(leed->pointsV4) + " of 2 points") +
            "<span class=\"note\">, version 4, option 2, this hour: " + fixedNumber(leed->share_pct, 0) +
            " % of the area has 300 to 3000 lx; 75 % are asked.</span></p>\n";
  }
  return html;
}

}  // namespace clerestory
