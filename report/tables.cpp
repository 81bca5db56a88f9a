// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the tables. Measured values have a float's precision, coordinates and what is summed a double's.
#include "tables.hpp"

#include <initializer_list>
#include <numbers>
#include <optional>

#include "escape.hpp"
#include "metrics.hpp"
#include "numbers.hpp"

namespace clerestory {
namespace {

void addRow(std::string& table, std::initializer_list<std::string> fields) {
  bool first = true;
  for (const std::string& field : fields) {
    if (!first) table += ',';
    table += field;
    first = false;
  }
  table += "\r\n";
}

std::string optionalFloat(const std::optional<double>& value) {
  return value ? shortestFloat(*value) : "";
}

void addRoomRow(std::string& table, const ReportInput& input, std::int32_t room,
                std::optional<std::size_t> grid) {
  const bool isRoom = room >= 0;
  const Room* const known = isRoom ? &input.building.rooms.at(static_cast<std::size_t>(room)) : nullptr;
  const std::string name = csvText(roomName(input.building, room));
  const std::string floorArea = known ? shortestFloat(known->floorArea_m2) : "";
  const std::string volume = known ? shortestFloat(known->volume_m3) : "";
  const bool isMeasured = isRoom && static_cast<std::size_t>(room) < input.solution.rooms.size();
  const RoomValue* const value = isMeasured ? &input.solution.rooms[static_cast<std::size_t>(room)] : nullptr;
  const std::string formula = value ? shortestFloat(value->averageDaylightFactor_pct) : "";
  const std::string sunlight = value ? shortestFloat(value->sunlight_h) : "";
  if (!grid) {
    addRow(table, {name, floorArea, volume, "", "0", "", "", "", "", "", "", "", "", "", formula, sunlight});
    return;
  }
  const GridMetrics m = metricsOf(input.solution.grids.at(*grid), input.study.sky);
  const Distribution& lx = m.illuminance_lx;
  const Distribution df = m.daylightFactor_pct.value_or(Distribution{});
  const auto factor = [&](double value) {
    return m.daylightFactor_pct ? shortestFloat(value) : std::string();
  };
  addRow(table,
         {name, floorArea, volume, csvText(input.building.grids[*grid].name), std::to_string(m.sensors),
          shortestFloat(lx.mean), shortestFloat(lx.median), shortestFloat(lx.min),
          shortestFloat(m.uniformity), factor(df.mean), factor(df.median), factor(df.min),
          factor(m.shareAbove2_pct), shortestFloat(m.share300To3000_pct), formula, sunlight});
}

}  // namespace

std::string pointsCsv(const std::vector<std::array<double, 6>>& points) {
  std::string table = "x_m,y_m,z_m,nx,ny,nz\r\n";
  for (const std::array<double, 6>& p : points) {
    addRow(table, {shortestDouble(p[0]), shortestDouble(p[1]), shortestDouble(p[2]), shortestDouble(p[3]),
                   shortestDouble(p[4]), shortestDouble(p[5])});
  }
  return table;
}

std::string sensorsCsv(const ReportInput& input) {
  std::string table =
      "grid,room,x_m,y_m,z_m,nx,ny,nz,illuminance_lx,direct_lx,reflected_lx,sky_lx,sun_lx,electric_lx,"
      "daylight_factor_pct,error_lx\r\n";
  for (std::size_t g = 0; g < input.building.grids.size(); ++g) {
    const SensorGrid& grid = input.building.grids[g];
    const std::string name = csvText(grid.name);
    const std::string room = csvText(roomName(input.building, grid.room));
    for (std::size_t s = 0; s < grid.points.size(); ++s) {
      const glm::dvec3& p = grid.points[s];
      const glm::dvec3& n = grid.normals.at(s);
      const SensorValue& v = input.solution.grids.at(g).sensors.at(s);
      addRow(table, {name, room, coordinate(p.x), coordinate(p.y), coordinate(p.z), shortestFloat(n.x),
                     shortestFloat(n.y), shortestFloat(n.z), shortestFloat(v.illuminance_lx),
                     shortestFloat(v.direct_lx), shortestFloat(v.reflected_lx), shortestFloat(v.sky_lx),
                     shortestFloat(v.sun_lx), shortestFloat(v.electric_lx),
                     optionalFloat(daylightFactor_pct(input.study.sky, v)), shortestFloat(v.error_lx)});
    }
  }
  return table;
}

std::string surfacesCsv(const ReportInput& input) {
  std::string table =
      "surface,room,material,area_m2,reflectance,illuminance_mean_lx,illuminance_min_lx,illuminance_max_lx,"
      "exitance_mean_lm_m2,luminance_mean_cd_m2,error_lx,elements\r\n";
  const std::vector<std::string> names = surfaceRowNames(input);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const SurfaceValue& v = input.solution.surfaces[i];
    const Material& material =
        input.building.model.materials.at(input.building.model.surfaces[v.surface].material);
    const double exitance_lm_m2 = luminousY(v.exitanceMean_lm_m2);
    addRow(table, {csvText(names[i]), csvText(roomName(input.building, v.room)), csvText(material.name),
                   shortestFloat(v.area_m2), shortestFloat(luminousY(material.reflectance)),
                   shortestFloat(v.illuminanceMean_lx), shortestFloat(v.illuminanceMin_lx),
                   shortestFloat(v.illuminanceMax_lx), shortestFloat(exitance_lm_m2),
                   shortestFloat(exitance_lm_m2 / std::numbers::pi), shortestFloat(v.error_lx),
                   std::to_string(v.elements)});
  }
  return table;
}

std::string roomsCsv(const ReportInput& input) {
  std::string table =
      "room,floor_area_m2,volume_m3,grid,sensors,illuminance_mean_lx,illuminance_median_lx,illuminance_min_"
      "lx,"
      "uniformity,daylight_factor_mean_pct,daylight_factor_median_pct,daylight_factor_min_pct,daylight_"
      "factor_above_2_"
      "pct,illuminance_300_3000_pct,average_daylight_factor_formula_pct,sunlight_h\r\n";
  const auto rooms = static_cast<std::int32_t>(input.building.rooms.size());
  for (std::int32_t room = 0; room < rooms; ++room) {
    const std::vector<std::size_t> grids = gridsOfRoom(input.building, room);
    if (grids.empty()) addRoomRow(table, input, room, std::nullopt);
    for (const std::size_t grid : grids) addRoomRow(table, input, room, grid);
  }
  for (const std::size_t grid : gridsOfRoom(input.building, -1)) addRoomRow(table, input, -1, grid);
  return table;
}

std::string iterationsCsv(const ReportInput& input) {
  std::string table =
      "domain,iteration,links_required,links_cached,links_reused,visibility_tests,unshot_power_lm,elements,"
      "seconds\r\n";
  for (const IterationStatistics& step : input.solution.iterations) {
    addRow(table,
           {std::to_string(step.domain), std::to_string(step.iteration), std::to_string(step.linksRequired),
            std::to_string(step.linksCached), std::to_string(step.linksReused),
            std::to_string(step.visibilityTests), shortestDouble(step.unshotPower_lm),
            std::to_string(step.elements), shortestFloat(step.seconds)});
  }
  return table;
}

}  // namespace clerestory
