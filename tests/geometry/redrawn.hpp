// SPDX-License-Identifier: GPL-3.0-or-later
// Buildings drawn in other ways, and whether they are the same: rooms, panes and surfaces.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>

#include "../import/tempfolder.hpp"
#include "../scenes.hpp"

namespace clerestory::drawn {

/// Without its cages: their facets change with where they lie, within their tolerance.
inline Scene withoutCages(Scene scene) {
  scene.cages.clear();
  return scene;
}

inline Scene read(const std::filesystem::path& file, const ModelOptions& options = {}) {
  return withoutCages(readModel(file, options));
}

inline Scene moved(Scene scene, const std::function<glm::dvec3(const glm::dvec3&)>& map) {
  for (glm::dvec3& point : scene.points) point = map(point);
  return scene;
}

inline Scene turned(const Scene& scene, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return moved(scene,
               [&](const glm::dvec3& p) { return glm::dvec3(c * p.x - s * p.y, s * p.x + c * p.y, p.z); });
}

inline Scene mirrored(const Scene& scene) {
  return moved(scene, [](const glm::dvec3& p) { return glm::dvec3(-p.x, p.y, p.z); });
}

/// Every face looks the other way.
inline Scene reversed(Scene scene) {
  PolygonList faces;
  for (std::size_t face = 0; face < scene.faces.size(); ++face) {
    const auto corners = scene.faces[face];
    faces.add(std::vector<std::uint32_t>(corners.rbegin(), corners.rend()));
  }
  scene.faces = std::move(faces);
  return scene;
}

/// The scene's points and materials with other faces; `divide` adds what becomes of one.
template <class Divide>
Scene withFaces(const Scene& scene, const Divide& divide) {
  Scene result = scene;
  result.faces = PolygonList();
  result.faceMaterial.clear();
  result.faceObject.clear();
  for (std::size_t face = 0; face < scene.faces.size(); ++face) {
    divide(result, scene.faces[face], [&](const std::vector<std::uint32_t>& corners) {
      result.faces.add(corners);
      result.faceMaterial.push_back(scene.faceMaterial[face]);
      result.faceObject.push_back(scene.faceObject[face]);
    });
  }
  return result;
}

/// Rectangles come in `columns` x `rows`, each with points of its own.
inline Scene divided(const Scene& scene, int columns, int rows) {
  return withFaces(scene, [&](Scene& result, std::span<const std::uint32_t> c, const auto& add) {
    const auto at = [&](std::size_t i) { return result.points[c[i]]; };
    const bool isRectangle =
        c.size() == 4 && glm::length(at(0) - at(1) + at(2) - at(3)) < 1e-9 * glm::length(at(2) - at(0));
    if (!isRectangle) {
      add({c.begin(), c.end()});
      return;
    }
    const glm::dvec3 origin = at(0);
    const glm::dvec3 u = (at(1) - origin) / static_cast<double>(columns);
    const glm::dvec3 v = (at(3) - origin) / static_cast<double>(rows);
    const std::array<std::uint32_t, 4> corner{c[0], c[1], c[2], c[3]};
    const auto first = static_cast<std::uint32_t>(result.points.size());
    const auto point = [&](int i, int j) {
      if ((i == 0 || i == columns) && (j == 0 || j == rows))
        return corner[j == 0 ? (i == 0 ? 0 : 1) : (i == 0 ? 3 : 2)];
      return first + static_cast<std::uint32_t>(j * (columns + 1) + i);
    };
    for (int j = 0; j <= rows; ++j) {
      for (int i = 0; i <= columns; ++i)
        result.points.push_back(origin + static_cast<double>(i) * u + static_cast<double>(j) * v);
    }
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i)
        add({point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)});
    }
  });
}

/// Triangles come in `parts` x `parts`, each with points of its own, in 32 bits.
inline Scene tessellated(const Scene& scene, int parts) {
  return withFaces(scene, [&](Scene& result, std::span<const std::uint32_t> c, const auto& add) {
    const glm::dvec3 origin = result.points[c[0]];
    const glm::dvec3 u = (result.points[c[1]] - origin) / static_cast<double>(parts);
    const glm::dvec3 v = (result.points[c[2]] - origin) / static_cast<double>(parts);
    const auto point = [&](int i, int j) {
      result.points.emplace_back(glm::vec3(origin + static_cast<double>(i) * u + static_cast<double>(j) * v));
      return static_cast<std::uint32_t>(result.points.size() - 1);
    };
    for (int i = 0; i < parts; ++i) {
      for (int j = 0; i + j < parts; ++j) {
        add({point(i, j), point(i + 1, j), point(i, j + 1)});
        if (i + j + 1 < parts) add({point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)});
      }
    }
  });
}

/// Metres in a unit of length.
inline double metresIn(const std::string& unit) {
  const std::map<std::string, double> metres{
      {"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"ft", 0.3048}, {"in", 0.0254}};
  return metres.at(unit);
}

/// An OBJ, whose unit and axis are known, with its points in another unit.
inline Scene inUnit(const std::filesystem::path& file, const FileAxes& axes, const std::string& unit) {
  const double ratio = metresIn(axes.units) / metresIn(unit);
  std::ifstream stream(file);
  std::string text;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("v ")) {
      std::istringstream numbers(line.substr(2));
      line = "v";
      for (double value = 0.0; numbers >> value;) {
        char number[40];
        line += ' ' + std::string(number, std::to_chars(number, number + 40, value * ratio).ptr);
      }
    }
    text += line + '\n';
  }
  const TempFolder folder;
  for (const auto& other : std::filesystem::directory_iterator(file.parent_path())) {
    if (other.path().extension() == ".mtl")
      std::filesystem::copy(other.path(), folder.path() / other.path().filename());
  }
  ModelOptions options;
  options.units = unit;
  options.upAxis = axes.upAxis;
  return read(folder.write("model.obj", text), options);
}

/// By object and material. [m²]
using Surfaces = std::map<std::pair<std::string, std::string>, double>;

inline Surfaces surfacesOf(const CleanModel& model) {
  Surfaces surfaces_m2;
  for (std::size_t piece = 0; piece < model.pieces.size(); ++piece) {
    const Surface& surface = model.surfaces[model.pieces.surface[piece]];
    surfaces_m2[{surface.name, model.materials[surface.material].name}] += model.pieces.area_m2[piece];
  }
  return surfaces_m2;
}

/// A room: area of its floor, number and area of its panes, volume.
using RoomFigures = std::array<double, 4>;

inline std::vector<RoomFigures> roomsOf(const Building& building) {
  std::vector<RoomFigures> rooms;
  for (const Room& room : building.rooms) rooms.push_back({room.floorArea_m2, 0.0, 0.0, room.volume_m3});
  for (const Portal& portal : building.portals) {
    RoomFigures& room = rooms.at(static_cast<std::size_t>(portal.room));
    room[1] += 1.0;
    room[2] += building.model.pieces.area_m2[portal.piece];
  }
  const auto rounded = [](const RoomFigures& room) {
    return std::array{std::lround(1e4 * room[0]), std::lround(1e4 * room[2]), std::lround(1e2 * room[3])};
  };
  std::sort(rooms.begin(), rooms.end(),
            [&](const RoomFigures& a, const RoomFigures& b) { return rounded(a) < rounded(b); });
  return rooms;
}

inline void expectSameSurfaces(const Surfaces& found_m2, const Surfaces& expected_m2, double tolerance) {
  EXPECT_EQ(found_m2.size(), expected_m2.size());
  for (const auto& [surface, area_m2] : expected_m2) {
    ASSERT_TRUE(found_m2.contains(surface)) << surface.first << ' ' << surface.second;
    EXPECT_NEAR(found_m2.at(surface) / area_m2, 1.0, tolerance) << surface.first << ' ' << surface.second;
  }
}

/// To a millionth.
inline void expectSameFloorsAndPanes(const Building& found, const Building& expected) {
  constexpr double same = 1e-6;
  const std::vector<RoomFigures> rooms = roomsOf(found);
  const std::vector<RoomFigures> expectedRooms = roomsOf(expected);
  ASSERT_EQ(rooms.size(), expectedRooms.size());
  for (std::size_t room = 0; room < rooms.size(); ++room) {
    EXPECT_NEAR(rooms[room][0] / expectedRooms[room][0], 1.0, same) << "floor of room " << room;
    EXPECT_EQ(rooms[room][1], expectedRooms[room][1]);
    EXPECT_NEAR(rooms[room][2], expectedRooms[room][2], same * expectedRooms[room][2]);
  }
}

inline void expectSame(const Building& found, const Building& expected) {
  constexpr double same = 1e-6;
  expectSameSurfaces(surfacesOf(found.model), surfacesOf(expected.model), same);
  expectSameFloorsAndPanes(found, expected);
  const std::vector<RoomFigures> rooms = roomsOf(found);
  const std::vector<RoomFigures> expectedRooms = roomsOf(expected);
  for (std::size_t room = 0; room < std::min(rooms.size(), expectedRooms.size()); ++room)
    EXPECT_NEAR(rooms[room][3] / expectedRooms[room][3], 1.0, same) << "volume of room " << room;
}

inline void expectSame(const Scene& other, const Building& expected) {
  expectSame(buildingOf(other), expected);
}

}  // namespace clerestory::drawn
