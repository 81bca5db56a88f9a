// SPDX-License-Identifier: GPL-3.0-or-later
// Writes study.json, the same bytes for the same input, and run.json, which holds all that differs between
// runs.
#include "json.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

#include <solver/daylight.hpp>

#include "escape.hpp"
#include "folder.hpp"
#include "image.hpp"
#include "luminairerows.hpp"
#include "metrics.hpp"
#include "norms.hpp"
#include "numbers.hpp"
#include "sha256.hpp"
#include "tables.hpp"

namespace clerestory {
namespace {

using Json = nlohmann::ordered_json;  // in the order written here, so that a reader finds the head first

constexpr int formatNumber = 1;  ///< raised when a key changes its meaning

/// A measured value as the tables print it; null where it is not finite.
Json number(double value) {
  const double written = asWritten(value);
  return std::isfinite(written) ? Json(written) : Json(nullptr);
}

/// Three numbers: red, green and blue, or x, y and z.
Json triple(const glm::dvec3& value) {
  return Json::array({number(value.x), number(value.y), number(value.z)});
}

Json distribution(const Distribution& values) {
  return {{"mean", number(values.mean)},
          {"median", number(values.median)},
          {"min", number(values.min)},
          {"max", number(values.max)}};
}

Json inputs(const ReportInput& input) {
  const std::optional<std::string> model = sha256OfFile(input.study.modelFile);
  Study named = input.study;
  named.modelFileAsWritten = modelName(input.study);  // the same study from whichever folder it was asked for
  Json points = Json::array();                        // as they were read, whatever the file's format
  for (const GridSettings& grid : input.study.grids) {
    if (grid.pointsFile.empty()) continue;
    points.push_back({{"file", validUtf8(grid.pointsFile)}, {"sha256", sha256(pointsCsv(grid.points))}});
  }
  return {{"model", {{"file", modelName(input.study)}, {"sha256", model ? Json(*model) : Json(nullptr)}}},
          {"study", {{"sha256", sha256(studyToml(named))}}},
          {"points", points}};
}

Json options(const Study& study) {
  const Daylight daylight = daylightOf(study);
  Json sky = {{"model", study.sky.isPerez ? "perez" : "cie"},
              {"cie_type", study.sky.isPerez ? Json(nullptr) : Json(study.sky.cieType)},
              {"diffuse_horizontal_lx", number(daylight.sky.horizontalIlluminance_lx())},
              {"direct_normal_lx", number(daylight.directNormal_lx)}};
  if (study.sky.time) sky["time"] = clockTimeText(*study.sky.time);
  if (daylight.sun_deg) {
    sky["sun_altitude_deg"] = number(daylight.sun_deg->x);
    sky["sun_azimuth_deg"] = number(daylight.sun_deg->y);
  }
  return {{"accuracy", number(study.accuracy)},
          {"time_limit_s", number(study.timeLimit_s)},
          {"site",
           {{"latitude_deg_north", number(study.site.latitude_deg)},
            {"longitude_deg_east", number(study.site.longitude_deg)},
            {"time_zone_h_east", number(study.site.timeZone_h)},
            {"north_deg", number(study.site.north_deg)},
            {"external_diffuse_lx", number(study.site.externalDiffuse_lx)}}},
          {"sky", sky},
          {"ground_reflectance", number(study.groundReflectance)},
          {"dirt_factor", number(study.dirtFactor)},
          {"frame_factor", number(study.frameFactor)}};
}

Json cleanup(const CleanupCounts& counts) {
  return {{"points_read", counts.pointsRead},
          {"faces_read", counts.facesRead},
          {"cages", counts.cages},
          {"cage_facets", counts.cageFacets},
          {"points_welded", counts.pointsWelded},
          {"degenerate_faces", counts.degenerateFaces},
          {"duplicate_faces", counts.duplicateFaces},
          {"non_planar_faces", counts.nonPlanarFaces},
          {"pane_sheets_dropped", counts.paneSheetsDropped},
          {"polygons", counts.polygons},
          {"pieces", counts.pieces}};
}

/// What the norms that the study asks for say to a grid; a reason where they cannot be judged.
Json normsJson(const ReportInput& input, std::size_t g) {
  const GridValues& grid = input.solution.grids.at(g);
  Json norms = Json::object();
  if (isAsked(input.study, "en17037")) {
    const auto level = en17037Level(grid, input.study);
    norms["en17037"] = level ? Json{{"level", *level}, {"passes", *level != "none"}}
                             : Json{{"not_judged", whyNoEn17037(input.study)}};
  }
  if (isAsked(input.study, "leed")) {
    const auto hour = leedHourOf(grid, input.study);
    norms["leed_option_2"] = hour ? Json{{"share_300_to_3000_lx_pct", number(hour->share_pct)},
                                         {"points_v4_if_other_hour_alike", hour->pointsV4},
                                         {"points_v4_1_if_other_hour_alike", hour->pointsV41}}
                                  : Json{{"not_judged", whyNoLeedHour(input.study)}};
  }
  return norms;
}

Json luminairesJson(const ReportInput& input) {
  Json list = Json::array();
  for (const LuminaireRow& row : luminaireRows(input)) {
    list.push_back({{"name", validUtf8(row.name)},
                    {"file", row.file.empty() ? Json(nullptr) : Json(validUtf8(row.file))},
                    {"sha256", row.sha256.empty() ? Json(nullptr) : Json(row.sha256)},
                    {"count", row.count},
                    {"flux_each_lm", number(row.flux_lm)},
                    {"power_each_w", row.power_w > 0.0 ? number(row.power_w) : Json(nullptr)},
                    {"factor", number(row.factor)}});
  }
  return list;
}

Json gridJson(const ReportInput& input, std::size_t g) {
  const GridMetrics m = metricsOf(input.solution.grids.at(g), input.study.sky);
  Json grid = {{"name", validUtf8(input.building.grids[g].name)},
               {"sensors", m.sensors},
               {"spacing_m", number(input.building.grids[g].spacing_m)},
               {"illuminance_lx", distribution(m.illuminance_lx)},
               {"uniformity", number(m.uniformity)},
               {"share_of_sensors_300_to_3000_lx_pct", number(m.share300To3000_pct)}};
  if (m.daylightFactor_pct) {
    grid["daylight_factor_pct"] = distribution(*m.daylightFactor_pct);
    grid["share_of_sensors_above_2_pct"] = number(m.shareAbove2_pct);
  }
  if (!input.study.norms.empty()) grid["norms"] = normsJson(input, g);
  grid["error_estimate_mean_pct"] = number(m.meanErrorEstimate_pct);
  grid["error_estimate_95th_pct"] = number(m.p95ErrorEstimate_pct);
  return grid;
}

Json gridsJson(const ReportInput& input, std::int32_t room) {
  Json grids = Json::array();
  for (const std::size_t g : gridsOfRoom(input.building, room)) grids.push_back(gridJson(input, g));
  return grids;
}

Json rooms(const ReportInput& input) {
  Json list = Json::array();
  for (std::size_t r = 0; r < input.building.rooms.size(); ++r) {
    const Room& room = input.building.rooms[r];
    Json entry = {{"name", validUtf8(room.name)},
                  {"domain", room.domain},
                  {"floor_area_m2", number(room.floorArea_m2)},
                  {"volume_m3", number(room.volume_m3)},
                  {"floor_m", number(room.floor_m)}};
    if (r < input.solution.rooms.size()) {
      entry["average_daylight_factor_formula_pct"] =
          number(input.solution.rooms[r].averageDaylightFactor_pct);
      entry["sunlight_date"] = dateText(input.study.sunlight.date);
      entry["sunlight_h"] = number(input.solution.rooms[r].sunlight_h);
      if (isAsked(input.study, "en17037"))
        entry["sunlight_level_en17037"] = sunlightLevel(input.study, input.solution.rooms[r].sunlight_h);
    }
    entry["grids"] = gridsJson(input, static_cast<std::int32_t>(r));
    list.push_back(entry);
  }
  return list;
}

Json surfaces(const ReportInput& input) {
  Json list = Json::array();
  const std::vector<std::string> names = surfaceRowNames(input);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const SurfaceValue& v = input.solution.surfaces[i];
    const Material& material =
        input.building.model.materials.at(input.building.model.surfaces[v.surface].material);
    list.push_back({{"name", validUtf8(names[i])},
                    {"room", validUtf8(roomName(input.building, v.room))},
                    {"material", validUtf8(material.name)},
                    {"area_m2", number(v.area_m2)},
                    {"illuminance_lx",
                     {{"mean", number(v.illuminanceMean_lx)},
                      {"min", number(v.illuminanceMin_lx)},
                      {"max", number(v.illuminanceMax_lx)}}},
                    {"exitance_mean_lm_m2", triple(v.exitanceMean_lm_m2)},
                    {"error_lx", number(v.error_lx)},
                    {"elements", v.elements}});
  }
  return list;
}

Json materials(const CleanModel& model) {
  Json list = Json::array();
  for (const Material& material : model.materials) {
    Json entry = {{"name", validUtf8(material.name)},
                  {"reflectance", triple(material.reflectance)},
                  {"exitance_lm_m2", triple(material.exitance_lm_m2)},
                  {"mirrors_as_matt", material.mirrorsAsMatt},
                  {"glazing", material.glazing}};
    if (material.glazing) {
      entry["transmittance"] = triple(material.transmittance);
      entry["transmittance_is_assumed"] = material.transmittanceIsAssumed;
      entry["panes"] = material.panes;
    }
    list.push_back(entry);
  }
  return list;
}

Json views(const ReportInput& input) {
  Json list = Json::array();
  for (std::size_t v = 0; v < input.solution.views.size(); ++v) {
    const ViewSettings& view = input.study.views.at(v);
    const double scale = exposureScale(input.solution.views[v], view.exposure_ev);
    Json entry = {{"name", validUtf8(view.name)},
                  {"projection", projectionKey(view.projection)},
                  {"eye_m", triple(view.eye_m)},
                  {"target_m", triple(view.target_m)},
                  {"up", triple(view.up)}};
    if (view.projection != Projection::panorama) entry["field_of_view_deg"] = number(view.fieldOfView_deg);
    entry["size_px"] = view.size_px;
    entry["exposure_ev"] = number(exposureValue(scale));
    entry["luminance_of_1_cd_m2"] = number(1.0 / scale);
    list.push_back(entry);
  }
  return list;
}

Json energy(const Solution& solution) {
  Json list = Json::array();
  for (const EnergyBalance& balance : solution.balances) {
    list.push_back({{"domain", balance.domain},
                    {"emitted_lm", number(balance.emitted_lm)},
                    {"absorbed_lm", number(balance.absorbed_lm)},
                    {"escaped_lm", number(balance.escaped_lm)},
                    {"unscaled_defect", number(balance.unscaledDefect)}});
  }
  return list;
}

Json diagnoses(const ReportInput& input) {
  Json list = Json::array();
  for (const Diagnosis& diagnosis : input.diagnoses) {
    Json row = {{"code", validUtf8(diagnosis.code)},
                {"message", validUtf8(withoutFolders(input.study, diagnosis.message))},
                {"where", validUtf8(withoutFolders(input.study, diagnosis.where))},
                {"count", diagnosis.count}};
    if (diagnosis.place_m)
      row["place_m"] = {diagnosis.place_m->x, diagnosis.place_m->y, diagnosis.place_m->z};
    list.push_back(std::move(row));
  }
  return list;
}

Json texts(const std::vector<std::string>& list, const Study& study) {
  Json array = Json::array();
  for (const std::string& text : list) array.push_back(validUtf8(withoutFolders(study, text)));
  return array;
}

std::string dumped(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string withoutFolders(const Study& study, std::string text) {
  if (!study.modelFile.is_absolute()) return text;
  const std::string folder = study.modelFile.parent_path().string() + "/";
  if (folder.size() < 3) return text;  // "/" alone divides more than folders
  for (std::size_t at; (at = text.find(folder)) != std::string::npos;) text.erase(at, folder.size());
  return text;
}

std::string studyJson(const ReportInput& input) {
  const Building& building = input.building;
  const Json json = {{"generator", generatorMark},
                     {"format", formatNumber},
                     {"version", input.run.version},
                     {"inputs", inputs(input)},
                     {"options", options(input.study)},
                     {"assumptions", texts(input.study.assumptions, input.study)},
                     {"cleanup", cleanup(building.model.counts)},
                     {"rooms", rooms(input)},
                     {"grids_outside_rooms", gridsJson(input, -1)},
                     {"surfaces", surfaces(input)},
                     {"materials", materials(building.model)},
                     {"luminaires", luminairesJson(input)},
                     {"light_domains", building.domains.size()},
                     {"portals", building.portals.size()},
                     {"solution",
                      {{"elements", input.solution.elements},
                       {"columns", input.solution.columns},
                       {"grey", input.solution.grey}}},
                     {"views", views(input)},
                     {"energy_balance", energy(input.solution)},
                     {"diagnoses", diagnoses(input)}};
  return dumped(json);
}

std::string runJson(const ReportInput& input) {
  Json stages = Json::object();
  double total_s = 0.0;
  for (const auto& [stage, seconds] : input.run.stageSeconds) {
    stages[validUtf8(stage)] = number(seconds);
    total_s += seconds;
  }
  const Json json = {{"version", input.run.version},
                     {"command_line", validUtf8(input.run.commandLine)},
                     {"threads", input.run.threads},
                     {"link_cache_bytes", input.run.linkCacheBytes},
                     {"peak_memory_bytes", input.run.peakMemoryBytes},
                     {"hierarchy_bytes", input.solution.hierarchyBytes},
                     {"stage_seconds", stages},
                     {"total_seconds", number(total_s)}};
  return dumped(json);
}

}  // namespace clerestory
