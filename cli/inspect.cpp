// SPDX-License-Identifier: GPL-3.0-or-later
// Reads and cleans a model as a study would, and tells what was found instead of solving its light.
#include "inspect.hpp"

#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <memory>
#include <numeric>
#include <set>
#include <sstream>
#include <system_error>

#include <geometry/faults.hpp>
#include <report/modelfile.hpp>
#include <report/storeyplan.hpp>

#include "input.hpp"
#include "machine.hpp"
#include "progress.hpp"
#include "texttable.hpp"

namespace clerestory {

namespace {

using Json = nlohmann::ordered_json;

/// What `inspect` tells of a building beside what is stored in it.
struct Totals {
  glm::dvec3 lowest{0.0}, highest{0.0};
  std::vector<double> materialArea_m2;  ///< #materials, one side of each piece
  double portalArea_m2 = 0.0;
  double otherGlazing_m2 = 0.0;  ///< that is no window
};

Totals totalsOf(const Building& building) {
  const Pieces& pieces = building.model.pieces;
  Totals totals;
  if (!pieces.points.empty()) {
    totals.lowest = totals.highest = pieces.points.front();
  }
  for (const glm::dvec3& point : pieces.points) {
    totals.lowest = glm::min(totals.lowest, point);
    totals.highest = glm::max(totals.highest, point);
  }
  totals.materialArea_m2.resize(building.model.materials.size());
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    totals.materialArea_m2[pieces.material[piece]] += pieces.area_m2[piece];
  }
  for (const Portal& portal : building.portals) {
    totals.portalArea_m2 += pieces.area_m2[portal.piece];
  }
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    if (building.innerGlass[piece]) totals.otherGlazing_m2 += pieces.area_m2[piece];
  }
  return totals;
}

/// What each step took.
class Steps {
 public:
  struct Step {
    std::string name;
    double seconds = 0.0;
    std::size_t peakMemoryBytes = 0;  ///< of the process up to the step's end
  };

  void begin(const std::string& name) {
    end();
    steps_.push_back({name, 0.0, 0});
    begun_ = std::chrono::steady_clock::now();
  }
  void end() {
    if (steps_.empty() || steps_.back().peakMemoryBytes > 0) return;
    steps_.back().seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
    steps_.back().peakMemoryBytes = peakMemoryBytes();
  }
  [[nodiscard]] const std::vector<Step>& list() const { return steps_; }

 private:
  std::vector<Step> steps_;
  std::chrono::steady_clock::time_point begun_;
};

/// A count: its key in JSON and its words.
struct CountRow {
  const char* key;
  const char* words;
  std::size_t count;
};

std::vector<CountRow> cleanupRows(const CleanupCounts& counts) {
  return {{"points_read", "points read", counts.pointsRead},
          {"faces_read", "faces read", counts.facesRead},
          {"cages", "subdivision cages", counts.cages},
          {"cage_facets", "facets of cages", counts.cageFacets},
          {"points_welded", "points welded", counts.pointsWelded},
          {"degenerate_faces", "degenerate faces removed", counts.degenerateFaces},
          {"duplicate_faces", "duplicate faces removed", counts.duplicateFaces},
          {"non_planar_faces", "faces that were not planar", counts.nonPlanarFaces},
          {"pane_sheets_dropped", "further sheets of panes removed", counts.paneSheetsDropped},
          {"polygons", "planar polygons after merging", counts.polygons},
          {"pieces", "convex pieces of these", counts.pieces}};
}

std::vector<CountRow> faultRows(const DrawnFaults& faults) {
  return {{"repeated_points", "points drawn again", faults.repeatedPoints},
          {"faces_without_area", "faces without area", faults.facesWithoutArea},
          {"repeated_faces", "faces drawn again", faults.repeatedFaces},
          {"non_manifold_edges", "edges of more than two faces", faults.nonManifoldEdges},
          {"edges_wound_apart", "edges of two faces that look to different sides", faults.edgesWoundApart},
          {"t_junctions", "points within an edge of another face (T-junctions)", faults.tJunctions}};
}

/// Those that are not zero.
std::string countsText(const std::vector<CountRow>& rows) {
  std::ostringstream text;
  for (const CountRow& row : rows) {
    if (row.count > 0) text << std::setw(12) << row.count << "  " << row.words << '\n';
  }
  return text.str().empty() ? "  none\n" : text.str();
}

/// Panes that light a room from outside.
struct RoomWindows {
  std::size_t panes = 0;
  double area_m2 = 0.0;
};

RoomWindows windowsOf(const Building& building, std::int32_t room) {
  RoomWindows windows;
  for (const Portal& portal : building.portals) {
    if (portal.room != room) continue;
    ++windows.panes;
    windows.area_m2 += building.model.pieces.area_m2[portal.piece];
  }
  return windows;
}

/// Sizes after each step, and at last of the building that light is computed in.
std::vector<StepSize> sizesOf(const Building& building) {
  std::vector<StepSize> sizes = building.model.counts.sizes;
  const PolygonList& pieces = building.model.pieces.polygons;
  sizes.push_back(
      {"cut at panes, doorways and partitions", pieces.size(), pieces.corners.size() - 2 * pieces.size()});
  return sizes;
}

Json vectorJson(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

Json inspectionJson(const Building& building, const DrawnFaults& faults, const Totals& totals,
                    const std::vector<Diagnosis>& diagnoses, const Steps& steps) {
  Json json;
  const FileAxes& axes = building.model.axes;
  json["units"] = axes.units;
  json["units_are_guessed"] = axes.unitsAreGuessed;
  json["up"] = axes.upAxis;
  json["up_is_guessed"] = axes.upAxisIsGuessed;
  json["extent_m"] = {{"lowest", vectorJson(totals.lowest)}, {"highest", vectorJson(totals.highest)}};
  for (const CountRow& row : cleanupRows(building.model.counts)) {
    json["cleanup"][row.key] = row.count;
  }
  for (const CountRow& row : faultRows(faults)) json["faults_as_drawn"][row.key] = row.count;
  json["sizes"] = Json::array();
  for (const StepSize& size : sizesOf(building)) {
    json["sizes"].push_back(
        {{"step", size.step}, {"polygons", size.polygons}, {"triangles", size.triangles}});
  }
  json["materials"] = Json::array();
  for (std::size_t i = 0; i < building.model.materials.size(); ++i) {
    const Material& material = building.model.materials[i];
    Json row = {
        {"name", material.name}, {"area_m2", totals.materialArea_m2[i]}, {"glazing", material.glazing}};
    row["reflectance"] = vectorJson(material.reflectance);
    if (material.glazing) {
      row["transmittance"] = vectorJson(material.transmittance);
      row["transmittance_is_assumed"] = material.transmittanceIsAssumed;
      row["panes"] = material.panes;
    }
    row["exitance_lm_m2"] = vectorJson(material.exitance_lm_m2);
    row["mirrors_as_matt"] = material.mirrorsAsMatt;
    json["materials"].push_back(std::move(row));
  }
  json["domains"] = Json::array();
  for (const Domain& domain : building.domains) {
    json["domains"].push_back({{"open", domain.open}, {"lit", domain.lit}, {"area_m2", domain.area_m2}});
  }
  json["portals"] = {{"count", building.portals.size()},
                     {"area_m2", totals.portalArea_m2},
                     {"other_glazing_m2", totals.otherGlazing_m2}};
  json["rooms"] = Json::array();
  for (std::size_t i = 0; i < building.rooms.size(); ++i) {
    const Room& room = building.rooms[i];
    const RoomWindows windows = windowsOf(building, static_cast<std::int32_t>(i));
    json["rooms"].push_back({{"name", room.name},
                             {"domain", room.domain},
                             {"floor_area_m2", room.floorArea_m2},
                             {"volume_m3", room.volume_m3},
                             {"floor_m", room.floor_m},
                             {"ceiling_m", room.ceiling_m},
                             {"panes", windows.panes},
                             {"panes_m2", windows.area_m2}});
  }
  json["openings"] = Json::array();
  for (const RoomBorder& border : building.borders) {
    Json line = Json::array();
    for (const glm::dvec3& place : border.line_m) line.push_back(vectorJson(place));
    json["openings"].push_back({{"rooms", {border.rooms[0], border.rooms[1]}},
                                {"line_m", std::move(line)},
                                {"height_m", border.height_m}});
  }
  json["diagnoses"] = Json::array();
  for (const Diagnosis& diagnosis : diagnoses) {
    Json row = {{"code", diagnosis.code},
                {"message", diagnosis.message},
                {"where", diagnosis.where},
                {"count", diagnosis.count}};
    if (diagnosis.place_m) row["place_m"] = vectorJson(*diagnosis.place_m);
    json["diagnoses"].push_back(std::move(row));
  }
  json["steps"] = Json::array();
  for (const Steps::Step& step : steps.list()) {
    json["steps"].push_back(
        {{"name", step.name}, {"seconds", step.seconds}, {"peak_memory_bytes", step.peakMemoryBytes}});
  }
  return json;
}

// A colour as one number where it is grey, else as three.
std::string colourText(const glm::dvec3& colour, int digits) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << colour.x;
  if (colour.x != colour.y || colour.y != colour.z) {
    text << ' ' << colour.y << ' ' << colour.z;
  }
  return text.str();
}

/// Glazing first, then by falling area: what decides about the light is at the top. Last, in one row, those
/// that cover less than is shown.
std::string materialsText(const Building& building, const Totals& totals) {
  constexpr double leastShown_m2 = 0.005;
  const std::vector<Material>& materials = building.model.materials;
  std::vector<std::size_t> order(materials.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (materials[a].glazing != materials[b].glazing) return materials[a].glazing;
    return totals.materialArea_m2[a] > totals.materialArea_m2[b];
  });
  TextTable table({"material", "area m2", "reflectance", "transmittance", "exitance lm/m2", ""});
  std::size_t others = 0;
  for (const std::size_t i : order) {
    const Material& material = materials[i];
    const bool emits = material.exitance_lm_m2 != glm::dvec3(0.0);
    if (totals.materialArea_m2[i] < leastShown_m2) {
      ++others;
      continue;
    }
    table.add({printable(material.name), number(totals.materialArea_m2[i], 2),
               material.glazing ? "" : colourText(material.reflectance, 3),
               material.glazing ? colourText(material.transmittance, 3) : "",
               emits ? colourText(material.exitance_lm_m2, 1) : "",
               material.glazing && material.transmittanceIsAssumed ? "transmittance assumed"
               : material.mirrorsAsMatt                            ? "metal or mirror, taken as matt"
                                                                   : ""});
  }
  if (others > 0) table.add({std::to_string(others) + " more, on next to nothing", "0.00", "", "", "", ""});
  return table.text();
}

/// Rooms that a room opens to, each once.
std::set<std::int32_t> neighboursOf(const Building& building, std::int32_t room) {
  std::set<std::int32_t> neighbours;
  for (const RoomBorder& border : building.borders) {
    if (border.rooms[0] == room) neighbours.insert(border.rooms[1]);
    if (border.rooms[1] == room) neighbours.insert(border.rooms[0]);
  }
  return neighbours;
}

std::string roomsText(const Building& building) {
  TextTable table(
      {"room", "floor m2", "volume m3", "floor at m", "ceiling at m", "panes", "panes m2", "opens to"});
  for (std::size_t i = 0; i < building.rooms.size(); ++i) {
    const Room& room = building.rooms[i];
    const RoomWindows windows = windowsOf(building, static_cast<std::int32_t>(i));
    std::string opensTo;
    for (const std::int32_t other : neighboursOf(building, static_cast<std::int32_t>(i))) {
      opensTo +=
          (opensTo.empty() ? "" : ", ") + printable(building.rooms[static_cast<std::size_t>(other)].name);
    }
    table.add({printable(room.name), number(room.floorArea_m2, 2), number(room.volume_m3, 2),
               number(room.floor_m, 2), number(room.ceiling_m, 2), std::to_string(windows.panes),
               number(windows.area_m2, 2), opensTo});
  }
  return table.text();
}

/// Names of the rooms in a domain.
std::string roomsIn(const Building& building, std::size_t domain) {
  std::string names;
  for (const Room& room : building.rooms) {
    if (room.domain != static_cast<std::int32_t>(domain)) continue;
    names += (names.empty() ? "" : ", ") + printable(room.name);
  }
  return names;
}

std::string airText(const Building& building) {
  TextTable table({"air", "surface m2", "rooms in it"});
  std::size_t hollows = 0;
  double hollows_m2 = 0.0;
  for (std::size_t i = 0; i < building.domains.size(); ++i) {
    const Domain& domain = building.domains[i];
    const std::string rooms = roomsIn(building, i);
    const bool hasPane =
        std::any_of(building.portals.begin(), building.portals.end(),
                    [&](const Portal& pane) { return pane.inside == static_cast<std::int32_t>(i); });
    if (!domain.open && !hasPane && rooms.empty()) {
      ++hollows;
      hollows_m2 += domain.area_m2;
      continue;
    }
    table.add({domain.open  ? "open to the sky"
               : domain.lit ? "closed, lit"
                            : "closed, dark",
               number(domain.area_m2, 2), rooms});
  }
  // Those of walls, ceilings and furniture come by the hundred.
  if (hollows > 0) {
    table.add({std::to_string(hollows) + (hollows == 1 ? " hollow" : " hollows") + " without room or pane",
               number(hollows_m2, 2), ""});
  }
  return table.text();
}

std::string sizesText(const Building& building) {
  TextTable table({"after each step", "polygons", "triangles", ""});
  for (const StepSize& size : sizesOf(building)) {
    table.add({size.step, std::to_string(size.polygons), std::to_string(size.triangles), ""});
  }
  return table.text();
}

std::string stepsText(const Steps& steps) {
  TextTable table({"step", "seconds", "peak MB", ""});
  for (const Steps::Step& step : steps.list()) {
    table.add({step.name, number(step.seconds, 2),
               number(static_cast<double>(step.peakMemoryBytes) * 1e-6, 0), ""});
  }
  return table.text();
}

/// By code: what concerns the whole model comes before single faces.
std::string warningsText(std::vector<Diagnosis> diagnoses) {
  if (diagnoses.empty()) return "\nNothing to warn of.\n";
  std::stable_sort(diagnoses.begin(), diagnoses.end(),
                   [](const Diagnosis& a, const Diagnosis& b) { return a.code < b.code; });
  std::string text = "\nWarnings (docs/diagnoses.md says what to do about each)\n";
  for (const Diagnosis& diagnosis : diagnoses) text += "  " + printable(warningText(diagnosis)) + "\n";
  return text;
}

std::string inspectionText(const Study& study, const Building& building, const DrawnFaults& faults,
                           const Totals& totals, const std::vector<Diagnosis>& diagnoses,
                           const Steps& steps) {
  const glm::dvec3 size = totals.highest - totals.lowest;
  std::string text = printable(study.modelFile.string()) + ": " + number(size.x, 2) + " x " +
                     number(size.y, 2) + " x " + number(size.z, 2) + " m, from (" +
                     number(totals.lowest.x, 2) + ", " + number(totals.lowest.y, 2) + ", " +
                     number(totals.lowest.z, 2) + ")\n";
  const FileAxes& axes = building.model.axes;
  text += "Units: " + axes.units + (axes.unitsAreGuessed ? " (guessed; --units states it)" : "") +
          "; up: " + axes.upAxis + (axes.upAxisIsGuessed ? " (guessed; --up states it)" : "") + '\n';
  text += "\nRooms\n" + roomsText(building);
  text += "\nWindows: " + std::to_string(building.portals.size()) +
          (building.portals.size() == 1 ? " pane, " : " panes, ") + number(totals.portalArea_m2, 2) + " m2";
  constexpr double leastTold_m2 = 0.01;
  if (totals.otherGlazing_m2 >= leastTold_m2) {
    text += "; glazing that is no window (within the building, outdoors or covered): " +
            number(totals.otherGlazing_m2, 2) + " m2";
  }
  text += '\n';
  text += warningsText(diagnoses);
  text += "\nMaterials\n" + materialsText(building, totals);
  text += "\nAir that is connected without crossing glass\n" + airText(building);
  text += "\nFaults of the mesh as drawn\n" + countsText(faultRows(faults));
  text += "\nWhat was read, and what became of it\n" + countsText(cleanupRows(building.model.counts));
  text += "\nSize\n" + sizesText(building);
  text += "\nTime and memory\n" + stepsText(steps);
  return text;
}

/// Writes the plan of each storey as plan-1.svg and so on, the lowest first.
void writePlans(const std::filesystem::path& folder, const Building& building) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw InputError("the folder " + folder.string() + " cannot be made: " + failed.message());
  int number = 0;
  for (const StoreyPlan& plan : storeyPlans(building)) {
    const std::filesystem::path file = folder / ("plan-" + std::to_string(++number) + ".svg");
    std::ofstream stream(file, std::ios::binary);
    stream << plan.svg << std::flush;
    if (!stream) throw MachineError(file.string() + " cannot be written");
  }
}

/// Writes plans, or the repaired model as it was before it was cut at panes and doorways.
void writeOutput(const std::filesystem::path& output, const Study& study, const CleanModel& repaired,
                 const Building& building) {
  if (!isModelFile(output)) {
    writePlans(output, building);
    return;
  }
  std::error_code failed;
  if (std::filesystem::equivalent(output, study.modelFile, failed)) {
    throw InputError(output.string() + " is the model itself: write the repaired one under another name");
  }
  std::vector<Mark> marks = repaired.marks;
  marks.insert(marks.end(), building.marks.begin(), building.marks.end());
  writeModel(output, repaired, marks);
}

void runInspect(const InputArguments& arguments, bool json,
                const std::vector<std::filesystem::path>& outputs) {
  Study study = readInput(arguments);
  study.grids.clear();  // a grid that finds no room would end the inspection that is to tell why
  std::vector<Diagnosis> diagnoses;
  Steps steps;
  const auto begin = [&steps](const std::string& step) { steps.begin(step); };
  const Scene scene = readScene(study, diagnoses, begin);
  steps.begin("counting faults");
  const DrawnFaults faults = countFaults(scene);
  CleanModel model = cleanModel(scene, diagnoses, begin);
  const bool isWritten = std::any_of(outputs.begin(), outputs.end(), isModelFile);
  const CleanModel repaired = isWritten ? model : CleanModel{};
  steps.begin("finding rooms");
  const Building building = makeBuilding(std::move(model), study);
  steps.end();
  for (const Diagnosis& diagnosis : building.diagnoses) addDiagnosis(diagnoses, diagnosis);
  const Totals totals = totalsOf(building);
  for (const std::filesystem::path& output : outputs) writeOutput(output, study, repaired, building);
  if (json) {
    // Names come from outside and may be no UTF-8.
    printResult(inspectionJson(building, faults, totals, diagnoses, steps)
                    .dump(2, ' ', false, Json::error_handler_t::replace) +
                "\n");
  } else {
    printResult(inspectionText(study, building, faults, totals, diagnoses, steps));
  }
}

}  // namespace

void addInspectCommand(CLI::App& program, std::function<void()>& run) {
  struct Arguments {
    InputArguments input;
    bool json = false;
    std::vector<std::filesystem::path> outputs;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      *program.add_subcommand("inspect", "Tell what is in a model, what was repaired and what could not be.");
  addInputArguments(command, arguments->input);
  command.add_flag("--json", arguments->json, "print it as JSON");
  command
      .add_option("-o,--output", arguments->outputs,
                  "a name that ends in .glb or .obj: the repaired model, with a coloured marker wherever a "
                  "warning speaks of a place; else a folder for a plan of each storey (SVG). May be repeated")
      ->option_text("FILE|DIR")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.footer(
      "Prints rooms and windows, every warning that a study would give, materials with reflectance and "
      "area,\n"
      "the bodies of air, and counts before and after the clean-up. It solves nothing.\n\n"
      "Examples:\n"
      "  clerestory inspect office.glb\n"
      "  clerestory inspect plan.obj --units mm --up y\n"
      "  clerestory inspect study.toml        the same with the study's materials\n"
      "  clerestory inspect house.obj -o cleaned.glb -o plans");
  command.callback([arguments, &run] {
    run = [arguments] { runInspect(arguments->input, arguments->json, arguments->outputs); };
  });
}

}  // namespace clerestory
