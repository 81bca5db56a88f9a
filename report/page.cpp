// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the page: what was computed, room by room, what was assumed, how accurate it is, how to do it again.
#include "page.hpp"

#include <algorithm>
#include <numbers>

#include <solver/daylight.hpp>

#include "escape.hpp"
#include "json.hpp"
#include "luminairerows.hpp"
#include "metrics.hpp"
#include "norms.hpp"
#include "numbers.hpp"
#include "page_first.hpp"
#include "page_parts.hpp"
#include "page_style.hpp"
#include "plan.hpp"
#include "sha256.hpp"

namespace clerestory {
namespace {

constexpr std::size_t mostSurfaceRows = 12;  // of a room's table before the reader asks for more

/// What all sections need, made once.
struct Page {
  const ReportInput& input;
  const PagePictures& pictures;
  PlanScale scale;
  std::vector<std::string> surfaceNames;
};

std::string skyText(const Study& study) {
  const int type = study.sky.cieType;
  const Daylight daylight = daylightOf(study);
  std::string sky = study.sky.isPerez        ? "Perez all-weather sky"
                    : type == 16             ? "CIE traditional overcast sky (type 16)"
                    : type == 1              ? "CIE overcast sky (type 1)"
                    : type == 12             ? "CIE clear sky (type 12)"
                    : type == 0 || type == 5 ? "uniform sky (CIE type 5)"
                                             : "CIE sky type " + std::to_string(type);
  sky += ", " + fixedNumber(daylight.sky.horizontalIlluminance_lx(), 0) + " lx on unobstructed ground";
  if (daylight.sun_deg) {
    sky += ", sun at " + fixedNumber(daylight.sun_deg->x, 1) + "° altitude and " +
           fixedNumber(daylight.sun_deg->y, 1) + "° azimuth";
    if (study.sky.time) {
      const std::string time = clockTimeText(*study.sky.time);  // YYYY-MM-DDThh:mm:ss
      sky += " (" + time.substr(0, 10) + " " + time.substr(11, 5) + ")";
    }
    sky += daylight.directNormal_lx > 0.0
               ? ", its beam " + fixedNumber(daylight.directNormal_lx, 0) + " lx square to it"
               : ", its beam left out";
  }
  return sky;
}

std::string headHtml(const ReportInput& input, const std::string& title) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
         "style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'; " +
         scriptPolicy(input) +
         "\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta name=\"referrer\" content=\"no-referrer\">\n<title>" +
         title + " – daylight study</title>\n<style>" + pageStyle + "</style>\n</head>\n<body>\n";
}

std::string contentsHtml(const Page& page) {
  std::string html = "<nav aria-label=\"Contents\"><ul>\n";
  for (std::size_t r = 0; r < page.input.building.rooms.size(); ++r) {
    html += "<li><a href=\"#room-" + std::to_string(r) + "\">" +
            escapeHtml(page.input.building.rooms[r].name) + "</a></li>\n";
  }
  html +=
      "<li><a href=\"#model\">3D</a></li>\n<li><a href=\"#assumptions\">Assumptions</a></li>\n<li><a "
      "href=\"#accuracy\">Accuracy</a></li>\n"
      "<li><a href=\"#materials\">Materials</a></li>\n<li><a href=\"#again\">Reproduce</a></li>\n";
  return html + "</ul></nav>\n";
}

std::string headerHtml(const Page& page) {
  const Building& building = page.input.building;
  const std::string model = modelName(page.input.study);
  double floor_m2 = 0.0;
  for (const Room& room : building.rooms) floor_m2 += room.floorArea_m2;
  const std::size_t rooms = building.rooms.size();
  std::string html = "<header>\n<p class=\"over\">Daylight study</p>\n<h1>" +
                     nameHtml(model.substr(0, model.find_last_of('.'))) + "</h1>\n<p class=\"lead\">" +
                     (rooms == 1 ? "One room" : std::to_string(rooms) + " rooms") + " with " +
                     fixedNumber(floor_m2, 1) + " m² of floor, under a " + skyText(page.input.study) +
                     ".</p>\n";
  return html + contentsHtml(page) + "</header>\n";
}

std::string overviewSection(const Page& page) {
  const ReportInput& input = page.input;
  std::vector<std::vector<std::string>> rows;
  const bool withFactor = hasDaylightFactor(input.study.sky);
  bool withNames = false;  // where a room's name alone does not tell which grid
  for (std::size_t r = 0; r < input.building.rooms.size(); ++r)
    withNames = withNames || gridsOfRoom(input.building, static_cast<std::int32_t>(r)).size() > 1;
  withNames = withNames || !gridsOfRoom(input.building, -1).empty();
  for (std::size_t g = 0; g < input.building.grids.size(); ++g) {
    const SensorGrid& grid = input.building.grids[g];
    const GridMetrics m = metricsOf(input.solution.grids.at(g), input.study.sky);
    std::vector<std::string> row = {nameHtml(roomName(input.building, grid.room))};
    if (withNames) row.push_back(nameHtml(grid.name));
    row.insert(row.end(), {illuminanceText(m.illuminance_lx.mean), illuminanceText(m.illuminance_lx.median),
                           illuminanceText(m.illuminance_lx.min), fixedNumber(m.uniformity, 2)});
    if (withFactor) {
      row.push_back(factorText(m.daylightFactor_pct->mean));
      row.push_back(factorText(m.daylightFactor_pct->median));
      row.push_back(fixedNumber(m.shareAbove2_pct, 0));
    }
    row.push_back(errorText(m));
    if (withFactor) row.push_back(en17037Verdict(input.solution.grids.at(g), input.study));
    rows.push_back(row);
  }
  if (rows.size() < 2) return {};  // one grid's figures follow at once
  std::vector<Column> columns = {{"Room", "", false}};
  if (withNames) columns.push_back({"Grid", "", false});
  columns.insert(columns.end(), {{"Mean", "lx"}, {"Median", "lx"}, {"Minimum", "lx"}, {"Uniformity", ""}});
  if (withFactor) {
    columns.insert(
        columns.end(),
        {{"Mean DF", "%"}, {"Median DF", "%"}, {"DF\u00a0≥\u00a02\u00a0%", "%\u00a0of\u00a0area"}});
  }
  columns.push_back({"Error", "%"});
  if (withFactor) columns.push_back({"EN 17037", "", false});
  return sectionOpening("overview", "Overview") + tableHtml("Rooms and their grids", columns, rows) +
         "</section>\n";
}

std::string gridFigures(const GridMetrics& m) {
  const Distribution& lx = m.illuminance_lx;
  std::string html = "<dl class=\"figures\">\n" +
                     figureHtml("Mean illuminance", illuminanceText(lx.mean), "lx") +
                     figureHtml("Median illuminance", illuminanceText(lx.median), "lx") +
                     figureHtml("Minimum illuminance", illuminanceText(lx.min), "lx") +
                     figureHtml("Uniformity, min ÷ mean", fixedNumber(m.uniformity, 2), "");
  if (m.daylightFactor_pct) {
    html += figureHtml("Mean daylight factor", factorText(m.daylightFactor_pct->mean), "%") +
            figureHtml("Median daylight factor", factorText(m.daylightFactor_pct->median), "%") +
            figureHtml("Minimum daylight factor", factorText(m.daylightFactor_pct->min), "%") +
            figureHtml("Area with 2 % or more", fixedNumber(m.shareAbove2_pct, 0), "%");
  }
  return html + "</dl>\n";
}

std::string planFigure(const Page& page, std::size_t g) {
  const SensorGrid& grid = page.input.building.grids[g];
  std::string html = "<figure>\n";
  if (page.pictures.plans.at(g).empty()) {
    html += planSvg(page.input, g, page.scale);
  } else {
    html += "<img src=\"data:image/png;base64," + base64(page.pictures.plans.at(g)) +
            "\" alt=\"Illuminance plan of " + escapeHtml(grid.name) + "\">\n";
  }
  return html + "<figcaption>Illuminance on “" + escapeHtml(grid.name) + "”, " +
         fixedNumber(static_cast<double>(grid.points.size()), 0) +
         " sensors. The scale is the same on every plan.</figcaption></figure>\n";
}

std::string norm(const Page& page, std::size_t g) {
  const auto en = en17037Of(page.input.solution.grids.at(g), page.input.study);
  if (!en) return {};
  std::vector<std::vector<std::string>> rows;
  for (const En17037::Level& level : en->levels) {
    rows.push_back({level.name, factorText(level.target_pct), fixedNumber(level.shareTarget_pct, 0),
                    factorText(level.minimum_pct), fixedNumber(level.shareMinimum_pct, 0),
                    level.met ? "<span class=\"yes\">met</span>" : "<span class=\"no\">not met</span>"});
  }
  return tableHtml("EN 17037, daylight factor method, for " +
                       fixedNumber(page.input.study.site.externalDiffuse_lx, 0) +
                       " lx median external diffuse",
                   {{"Level", "", false},
                    {"Target DF", "%"},
                    {"Area with it", "%, 50 asked"},
                    {"Minimum DF", "%"},
                    {"Area with it", "%, 95 asked"},
                    {"Verdict", "", false}},
                   rows);
}

std::string gridHtml(const Page& page, std::size_t g) {
  const GridMetrics m = metricsOf(page.input.solution.grids.at(g), page.input.study.sky);
  return "<h3>" + escapeHtml(page.input.building.grids[g].name) + "</h3>\n" + gridFigures(m) +
         planFigure(page, g) + sectionChart(page.input, g, page.scale) + norm(page, g);
}

/// The surfaces of a room, the largest first.
std::string surfaceTable(const Page& page, std::int32_t room) {
  const Solution& solution = page.input.solution;
  const CleanModel& model = page.input.building.model;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < solution.surfaces.size(); ++i) {
    if (knownRoom(page.input.building, solution.surfaces[i].room) == room) order.push_back(i);
  }
  if (order.empty()) return {};
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return solution.surfaces[a].area_m2 > solution.surfaces[b].area_m2;
  });
  std::vector<std::string> ids;
  std::vector<std::vector<std::string>> rows;
  for (const std::size_t i : order) {
    const SurfaceValue& v = solution.surfaces[i];
    const Material& material = model.materials.at(model.surfaces[v.surface].material);
    ids.push_back("surface-" + std::to_string(i));
    rows.push_back({nameHtml(page.surfaceNames[i]),
                    swatchHtml(material.reflectance) + nameHtml(material.name), fixedNumber(v.area_m2, 1),
                    fixedNumber(luminousY(material.reflectance), 2), illuminanceText(v.illuminanceMean_lx),
                    illuminanceText(v.illuminanceMin_lx), illuminanceText(v.illuminanceMax_lx),
                    roundedNumber(luminousY(v.exitanceMean_lm_m2) / std::numbers::pi)});
  }
  return tableHtml("Surfaces",
                   {{"Surface", "", false},
                    {"Material", "", false},
                    {"Area", "m²"},
                    {"Reflectance", ""},
                    {"Mean", "lx"},
                    {"Minimum", "lx"},
                    {"Maximum", "lx"},
                    {"Luminance", "cd/m²"}},
                   rows, ids, mostSurfaceRows);
}

/// Whether all sensors of a room are in the dark: a closed store, or one behind a door.
bool isDark(const Page& page, const std::vector<std::size_t>& grids) {
  const auto isGridDark = [&](std::size_t g) {
    const std::vector<SensorValue>& sensors = page.input.solution.grids.at(g).sensors;
    return std::all_of(sensors.begin(), sensors.end(),
                       [](const SensorValue& value) { return value.illuminance_lx == 0.0; });
  };
  return !grids.empty() && std::all_of(grids.begin(), grids.end(), isGridDark);
}

/// A section for each room that light reaches, one for all others, and one for what is outside.
std::string roomSections(const Page& page) {
  std::string html;
  std::vector<std::string> darkIds;
  std::vector<std::vector<std::string>> darkRows;
  const Building& building = page.input.building;
  for (std::size_t r = 0; r < building.rooms.size(); ++r) {
    const Room& room = building.rooms[r];
    const auto index = static_cast<std::int32_t>(r);
    const std::string id = "room-" + std::to_string(r);
    if (isDark(page, gridsOfRoom(building, index))) {
      darkIds.push_back(id);
      darkRows.push_back(
          {nameHtml(room.name), fixedNumber(room.floorArea_m2, 1), fixedNumber(room.volume_m3, 1)});
      continue;
    }
    html += sectionOpening(id, escapeHtml(room.name), "room");
    html += "<p class=\"lead\">" + fixedNumber(room.floorArea_m2, 1) + " m² of floor, " +
            fixedNumber(room.volume_m3, 1) + " m³ of air.</p>\n";
    for (const std::size_t g : gridsOfRoom(building, index)) html += gridHtml(page, g);
    html += roomChecksHtml(page.input, r) + surfaceTable(page, index) + "</section>\n";
  }
  if (!darkRows.empty()) {
    html += sectionOpening("dark", "Rooms without light") +
            tableHtml("No light reaches these", {{"Room", "", false}, {"Floor", "m²"}, {"Air", "m³"}},
                      darkRows, darkIds) +
            "</section>\n";
  }
  const std::vector<std::size_t> outside = gridsOfRoom(building, -1);
  const std::string surfaces = surfaceTable(page, -1);
  if (outside.empty() && surfaces.empty()) return html;
  html += sectionOpening("outside", "Outside");
  for (const std::size_t g : outside) html += gridHtml(page, g);
  return html + surfaces + "</section>\n";
}

/// Norms that are asked for and cannot be judged, each with the reason.
std::string unjudgedNorms(const Study& study) {
  std::string html;
  const auto add = [&](const std::string& norm, const std::string& name, const std::string& reason) {
    if (isAsked(study, norm) && !reason.empty())
      html += "<li>" + name + " is not judged: " + escapeHtml(reason) + ".</li>\n";
  };
  add("en17037", "EN 17037's daylight provision", whyNoEn17037(study));
  add("leed", "LEED", whyNoLeedHour(study));
  return html;
}

/// What is taken off the glass' transmittance.
std::string allowancesText(const Study& study) {
  const auto factor = [](double value, const char* name) {
    return value == 1.0 ? std::string() : shortNumber(value) + " for " + name;
  };
  const std::string dirt = factor(study.dirtFactor, "dirt");
  const std::string frames = factor(study.frameFactor, "frames");
  if (dirt.empty() && frames.empty())
    return "Panes are clean, and no frames are reckoned with but those of the model.";
  return "Transmittances are multiplied by " + dirt + (dirt.empty() || frames.empty() ? "" : " and by ") +
         frames + ".";
}

std::string assumptionsSection(const Page& page) {
  const Study& study = page.input.study;
  std::string html = sectionOpening("assumptions", "Assumptions and diagnoses");
  html += "<ul class=\"list\">\n";
  for (const std::string& text : study.assumptions) {
    html += "<li>" + escapeHtml(withoutFolders(study, text)) + "</li>\n";
  }
  html += "<li>The ground reflects " + shortNumber(100.0 * study.groundReflectance) +
          " % where the model draws none, and is of uniform luminance.</li>\n<li>" + allowancesText(study) +
          "</li>\n" + unjudgedNorms(study) + "</ul>\n";
  if (page.input.diagnoses.empty()) {
    return html + "<p>Nothing in the model needed repair or attention.</p>\n</section>\n";
  }
  std::vector<std::vector<std::string>> rows;
  for (const Diagnosis& diagnosis : page.input.diagnoses) {
    rows.push_back({escapeHtml(diagnosis.code), escapeHtml(withoutFolders(study, diagnosis.message)),
                    nameHtml(withoutFolders(study, whereText(diagnosis))),
                    fixedNumber(static_cast<double>(diagnosis.count), 0)});
  }
  html +=
      tableHtml("What was noticed",
                {{"Code", "", false}, {"Diagnosis", "", false}, {"Where", "", false}, {"Times", ""}}, rows);
  return html + "</section>\n";
}

std::string materialsSection(const Page& page) {
  std::vector<std::vector<std::string>> rows;
  for (const Material& m : page.input.building.model.materials) {
    std::string transmittance;
    if (m.glazing) {
      transmittance =
          fixedNumber(luminousY(m.transmittance), 2) + (m.transmittanceIsAssumed ? " assumed" : "");
    }
    const double exitance_lm_m2 = luminousY(m.exitance_lm_m2);
    const std::string reflectance = fixedNumber(luminousY(m.reflectance), 2) +
                                    (m.mirrorsAsMatt ? " matt (drawn as metal or mirror)" : "");
    rows.push_back({swatchHtml(m.reflectance) + nameHtml(m.name), reflectance, transmittance,
                    m.glazing ? std::to_string(m.panes) : "",
                    exitance_lm_m2 > 0.0 ? roundedNumber(exitance_lm_m2) : ""});
  }
  return sectionOpening("materials", "Materials") +
         tableHtml("What light meets",
                   {{"Material", "", false},
                    {"Reflectance", ""},
                    {"Transmittance", "normal incidence"},
                    {"Panes", ""},
                    {"Exitance", "lm/m²"}},
                   rows) +
         "</section>\n";
}

std::string againSection(const Page& page) {
  const ReportInput& input = page.input;
  const auto checksum = sha256OfFile(input.study.modelFile);
  double seconds = 0.0;
  for (const auto& stage : input.run.stageSeconds) seconds += stage.second;
  std::string html = sectionOpening("again", "Reproduce");
  html +=
      "<p>Clerestory " + escapeHtml(input.run.version) +
      " computed this report. The <code>study.toml</code> beside this page, with the model, gives the same "
      "figures again, to the last digit, on any number of threads:</p>\n<pre>clerestory study "
      "study.toml</pre>\n";
  if (checksum) {
    html += "<p class=\"note hash\">" + escapeHtml(modelName(input.study)) + ", SHA-256 <code>" + *checksum +
            "</code></p>\n";
  }
  html += "<p class=\"note\">This run took " + roundedNumber(seconds, 2) + " s on " +
          std::to_string(input.run.threads) + (input.run.threads == 1 ? " thread" : " threads") + " with " +
          roundedNumber(static_cast<double>(input.run.linkCacheBytes) / 1048576.0) +
          " MiB for links and at most " +
          roundedNumber(static_cast<double>(input.run.peakMemoryBytes) / 1048576.0) + " MiB of memory.</p>\n";
  html +=
      "<p>The tables are in full precision in <code>rooms.csv</code>, <code>surfaces.csv</code>, "
      "<code>sensors.csv</code> and <code>iterations.csv</code>, all settings in "
      "<code>study.json</code>.</p>\n";
  return html + "</section>\n";
}

}  // namespace

std::string pageHtml(const ReportInput& input, const PagePictures& pictures) {
  const Page page{input, pictures, planScale(input.solution), surfaceRowNames(input)};
  return headHtml(input, escapeHtml(modelName(input.study))) + headerHtml(page) + "<main>\n" +
         firstScreenHtml(input, pictures.views) + overviewSection(page) + roomSections(page) +
         viewerSection(page.input, page.scale) + assumptionsSection(page) + accuracySection(page.input) +
         materialsSection(page) + luminairesSection(page.input) + againSection(page) +
         "</main>\n<footer>Clerestory " + escapeHtml(input.run.version) + "</footer>\n" + scriptsHtml(input) +
         "</body>\n</html>\n";
}

}  // namespace clerestory
