// SPDX-License-Identifier: GPL-3.0-or-later
// Reads an OBJ's first comments and compares the areas that face each axis.
#include "upaxis.hpp"

#include <array>
#include <fstream>
#include <optional>

#include "extent.hpp"
#include "textfile.hpp"

namespace clerestory {
namespace {

/// The comments before the first statement, in lower case.
std::string commentsAtTheHead(const std::filesystem::path& file) {
  constexpr std::size_t most = 4096;
  std::string bytes(most, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(most));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  LineReader lines(bytes);
  std::string comments;
  while (lines.next()) {
    const std::string_view line = trimmed(lines.line());
    if (line.empty()) continue;
    if (line[0] != '#') break;
    comments += lowerCase(line.substr(1)) + '\n';
  }
  return comments;
}

bool isLetter(char c) {
  return c >= 'a' && c <= 'z';
}

/// Whether `text` says `words` and not as a part of longer words.
bool says(const std::string& text, std::string_view words) {
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) {
    const std::size_t end = at + words.size();
    if ((at == 0 || !isLetter(text[at - 1])) && (end == text.size() || !isLetter(text[end]))) return true;
  }
  return false;
}

std::optional<std::string> axisStated(const std::string& comments) {
  const auto isStated = [&](const std::string& axis) {
    return says(comments, axis + " up") || says(comments, axis + "-up") || says(comments, axis + " is up");
  };
  const bool y = isStated("y");
  const bool z = isStated("z");
  if (y == z) return std::nullopt;
  return y ? "y" : "z";
}

/// Whether the axis looks vertical: far more area faces it than both others, or about as much in a model that
/// is low along it.
bool looksVertical(const glm::dvec3& facing, const glm::dvec3& extent, int axis) {
  const int other = (axis + 1) % 3;
  const int third = (axis + 2) % 3;
  const bool low = extent[axis] < 0.6 * std::min(extent[other], extent[third]);
  return facing[axis] > (low ? 0.9 : 1.5) * std::max(facing[other], facing[third]);
}

std::optional<std::string> axisByGeometry(const Scene& scene) {
  glm::dvec3 facing(0.0);
  forEachPolygon(
      scene, [&](std::span<const std::uint32_t> polygon) { facing += glm::abs(areaVector(scene, polygon)); });
  const glm::dvec3 extent = boxOf(scene).extent();
  const bool y = looksVertical(facing, extent, 1);
  const bool z = looksVertical(facing, extent, 2);
  if (y == z) return std::nullopt;
  return y ? "y" : "z";
}

/// The axis that panes do not face, where they face one of the two: they stand in walls more than in roofs.
std::optional<std::string> axisByPanes(const Scene& scene) {
  glm::dvec3 facing(0.0);
  for (std::size_t face = 0; face < scene.faces.size(); ++face) {
    if (scene.materials[scene.faceMaterial[face]].glazing)
      facing += glm::abs(areaVector(scene, scene.faces[face]));
  }
  const double least = 0.2 * (facing.x + facing.y + facing.z);
  if (facing.z > least && facing.z > 4.0 * facing.y) return "y";
  if (facing.y > least && facing.y > 4.0 * facing.z) return "z";
  return std::nullopt;
}

/// The exporter named at the head that writes y up unless it is told otherwise.
std::optional<std::string> exporterWithYUp(const std::string& comments) {
  constexpr std::array<std::pair<const char*, const char*>, 4> exporters{{{"sweet home 3d", "Sweet Home 3D"},
                                                                          {"blender", "Blender"},
                                                                          {"rhino", "Rhino"},
                                                                          {"3ds max", "3ds Max"}}};
  for (const auto& [words, name] : exporters) {
    if (says(comments, words)) return name;
  }
  return std::nullopt;
}

}  // namespace

UpAxis judgeUpAxis(const std::filesystem::path& file, const Scene& scene) {
  const std::string comments = commentsAtTheHead(file);
  const std::optional<std::string> stated = axisStated(comments);
  const std::optional<std::string> geometry = axisByGeometry(scene);
  const std::optional<std::string> exporter = exporterWithYUp(comments);
  if (stated) {
    return {*stated, "the file's first comments say so", geometry && *geometry != *stated};
  }
  if (geometry) {
    return {*geometry, "floors and ceilings seem to lie across it", exporter && *geometry == "z"};
  }
  if (const auto panes = axisByPanes(scene)) {
    return {*panes, "panes would lie level otherwise", exporter && *panes == "z"};
  }
  if (exporter) {
    return {"y", "the file comes from " + *exporter + ", which writes it so unless told otherwise", false};
  }
  return {};
}

}  // namespace clerestory
