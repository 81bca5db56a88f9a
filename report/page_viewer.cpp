// SPDX-License-Identifier: GPL-3.0-or-later
// The page's section with the building in 3D, its scripts, and the policy that lets these alone run.
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include "colormap.hpp"
#include "escape.hpp"
#include "metrics.hpp"
#include "numbers.hpp"
#include "page_parts.hpp"
#include "scripts.hpp"
#include "viewermesh.hpp"

namespace clerestory {
namespace {

/// More would make a page that is hard to mail.
constexpr std::size_t mostElements = 600'000;

/// A script's checksum as a content security policy names it.
std::string policyHash(const EmbeddedFile& script) {
  const std::string hex(script.sha256);
  std::string bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    bytes.push_back(static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  }
  return "'sha256-" + base64(bytes) + "'";
}

/// What brings the mean of the surfaces inside, by area and logarithm, to middle grey.
double exposureOf(const ReportInput& input) {
  double area_m2 = 0.0;
  double logarithms = 0.0;
  for (const SurfaceValue& row : input.solution.surfaces) {
    const double exitance = luminousY(row.exitanceMean_lm_m2);
    if (row.room < 0 || !(exitance > 0.0)) continue;
    area_m2 += row.area_m2;
    logarithms += row.area_m2 * std::log(exitance);
  }
  return area_m2 > 0.0 ? 0.25 / std::exp(logarithms / area_m2) : 1.0;
}

/// Where a walk begins, relative to `low_m`: over the middle of the largest floor piece of the largest room.
glm::dvec3 walkStart(const Building& building, const PackedMesh& packed) {
  const Room* largest = nullptr;
  for (const Room& room : building.rooms) {
    if (!room.floorPieces.empty() && (largest == nullptr || room.floorArea_m2 > largest->floorArea_m2)) {
      largest = &room;
    }
  }
  if (largest == nullptr) return 0.5 * packed.size_m;
  const Pieces& pieces = building.model.pieces;
  const std::uint32_t piece = *std::max_element(
      largest->floorPieces.begin(), largest->floorPieces.end(),
      [&](std::uint32_t a, std::uint32_t b) { return pieces.area_m2[a] < pieces.area_m2[b]; });
  glm::dvec3 sum(0.0);
  for (const std::uint32_t corner : pieces.polygons[piece]) sum += pieces.points[corner];
  return sum / static_cast<double>(pieces.polygons[piece].size()) - packed.low_m;
}

/// The box round the elements inside rooms, relative to `low_m`: what the viewer looks at. A model may bring
/// a ground or neighbours that are far larger. Where no element is in a room it is the box of all.
std::pair<glm::dvec3, glm::dvec3> insideBox(const Solution& solution, const PackedMesh& packed) {
  const ElementMesh& mesh = solution.mesh;
  glm::dvec3 low_m = packed.size_m;
  glm::dvec3 high_m(0.0);
  for (std::size_t e = 0; e < mesh.size(); ++e) {
    if (solution.surfaces.at(mesh.surfaceRow[e]).room < 0) continue;
    for (std::uint32_t c = mesh.firstCorner[e]; c < mesh.firstCorner[e + 1]; ++c) {
      const glm::dvec3 corner_m = mesh.origin_m + glm::dvec3(mesh.corners_m[c]) - packed.low_m;
      low_m = glm::min(low_m, corner_m);
      high_m = glm::max(high_m, corner_m);
    }
  }
  if (glm::any(glm::greaterThan(low_m, high_m))) return {glm::dvec3(0.0), packed.size_m};
  return {low_m, high_m};
}

std::string meshInfo(const ReportInput& input, const PlanScale& scale, const PackedMesh& packed) {
  const auto list = [](const glm::dvec3& v) { return nlohmann::json::array({v.x, v.y, v.z}); };
  const auto [insideLow_m, insideHigh_m] = insideBox(input.solution, packed);
  nlohmann::json info = {{"elements", input.solution.mesh.size()},
                         {"corners", input.solution.mesh.corners_m.size()},
                         {"step_m", packed.step_m},
                         {"origin_m", list(packed.low_m)},
                         {"size_m", list(packed.size_m)},
                         {"inside_low_m", list(insideLow_m)},
                         {"inside_high_m", list(insideHigh_m)},
                         {"walk_m", list(walkStart(input.building, packed))},
                         {"low_lx", scale.low_lx},
                         {"high_lx", scale.high_lx},
                         {"exposure", exposureOf(input)},
                         {"colours", nlohmann::json::array()},
                         {"glass", nlohmann::json::array()}};
  for (int i = 0; i < 64; ++i) info["colours"].push_back(hexColour(falseColour(i / 63.0)));
  const CleanModel& model = input.building.model;
  for (std::size_t row = 0; row < input.solution.surfaces.size(); ++row) {
    const Surface& surface = model.surfaces.at(input.solution.surfaces[row].surface);
    if (model.materials.at(surface.material).glazing) info["glass"].push_back(row);
  }
  return info.dump();  // numbers and colours alone: nothing in it can end the script element
}

std::string option(const char* value, const char* text) {
  return std::string("<option value=\"") + value + "\">" + text + "</option>";
}

std::string legendHtml(const PlanScale& scale) {
  std::string stops;
  for (int i = 0; i <= 12; ++i) stops += (i > 0 ? "," : "") + hexColour(falseColour(i / 12.0));
  std::string html =
      "<div class=\"legend3d\" hidden><div class=\"bar\" style=\"background:linear-gradient(90deg," + stops +
      ")\"></div><div class=\"ticks\">";
  double free = -1.0;
  for (const double tick_lx : scale.ticks_lx) {
    const double at = 100.0 * scale.fraction(tick_lx);
    if (at < free) continue;
    free = at + 9.0;
    html += "<span style=\"left:" + shortNumber(at) + "%\">" +
            (tick_lx >= 10.0 ? fixedNumber(tick_lx, 0) : roundedNumber(tick_lx, 1)) + "</span>";
  }
  return html + "</div><div class=\"unit\">Illuminance in lx</div></div>\n";
}

std::string controlsHtml() {
  return "<div class=\"controls\">\n<label>Colours <select data-viewer=\"colours\">" +
         option("display", "as lit") + option("illuminance", "illuminance") +
         "</select></label>\n<label>Move <select data-viewer=\"motion\">" +
         option("orbit", "turn around it") + option("walk", "walk through it") +
         "</select></label>\n<label>Cut across <select data-viewer=\"axis\">" + option("z", "height") +
         option("x", "width") + option("y", "depth") +
         "</select></label>\n<label>at <input type=\"range\" data-viewer=\"section\" min=\"0\" max=\"200\" "
         "value=\"200\"> <output data-viewer=\"section-text\">whole</output></label>\n<label>Exposure <input "
         "type=\"range\" data-viewer=\"exposure\" min=\"-5\" max=\"5\" step=\"0.25\" value=\"0\"></label>\n"
         "<button type=\"button\" data-viewer=\"reset\">Start view</button>\n</div>\n";
}

}  // namespace

bool hasViewer(const ReportInput& input) {
  return !viewerScript.text.empty() && input.solution.mesh.size() > 0 &&
         input.solution.mesh.size() <= mostElements;
}

std::string scriptPolicy(const ReportInput& input) {
  return "script-src " + policyHash(pageScript) + (hasViewer(input) ? " " + policyHash(viewerScript) : "");
}

std::string scriptsHtml(const ReportInput& input) {
  std::string html = "<script>" + std::string(pageScript.text) + "</script>\n";
  if (hasViewer(input)) html += "<script>" + std::string(viewerScript.text) + "</script>\n";
  return html;
}

std::string viewerSection(const ReportInput& input, const PlanScale& scale) {
  std::string html = sectionOpening("model", "The building in 3D", "screen");
  if (!hasViewer(input)) {
    const char* reason =
        viewerScript.text.empty()
            ? "The program that wrote this page was built without its 3D viewer (npm was missing)."
        : input.solution.mesh.size() == 0 ? "There is nothing lit to show."
                                          : "The solution has too many elements for a page.";
    return html + "<p class=\"note\">" + reason + " Everything else is here.</p>\n</section>\n";
  }
  const PackedMesh packed = packMesh(input.solution.mesh);
  html +=
      "<p class=\"note\" id=\"viewer-note\" hidden></p>\n<noscript><p class=\"note\">The building in 3D "
      "needs "
      "scripts.</p></noscript>\n<div id=\"viewer\" hidden>\n" +
      controlsHtml() +
      "<div class=\"stage\"><canvas tabindex=\"0\" role=\"application\" aria-label=\"The building in 3D: "
      "drag or arrow keys turn it, wheel or plus and minus come closer, a click asks a surface, Enter the "
      "one "
      "in the middle; when walking, arrow keys go\"></canvas></div>\n" +
      legendHtml(scale) +
      "<div class=\"picked\" aria-live=\"polite\">Click a surface to see its figures. Walls are seen from "
      "the "
      "side that is lit.</div>\n</div>\n";
  html += "<script type=\"application/json\" id=\"mesh-info\">" + meshInfo(input, scale, packed) +
          "</script>\n<script type=\"text/plain\" id=\"mesh-data\">" + base64(packed.bytes) + "</script>\n";
  return html + "</section>\n";
}

}  // namespace clerestory
