// SPDX-License-Identifier: GPL-3.0-or-later
// The cleaned model that light is computed in: convex pieces with two sides, air domains, portals, rooms,
// grids.
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <import/scene.hpp>
#include <import/study.hpp>

namespace clerestory {

/// A row of the surfaces table: what one object draws in one material.
struct Surface {
  std::string name;  ///< object or group; "#2" follows a second of the same name in the same room
  std::uint32_t material;
};

/// Welded, planar, convex polygons in a canonical order that does not depend on the file's.
/// Piece i has two sides: side 2i, its front, looks along normal[i], side 2i + 1 against it. Which is which
/// does not depend on how the piece was drawn.
struct Pieces {
  std::vector<glm::dvec3> points;
  PolygonList polygons;            ///< counterclockwise seen from the front; convex
  std::vector<glm::dvec3> normal;  ///< unit
  std::vector<double> area_m2;
  std::vector<std::uint32_t> polygon;   ///< number of the planar polygon that it is a part of
  std::vector<std::uint32_t> surface;   ///< index into surfaces
  std::vector<std::uint32_t> material;  ///< index into the scene's materials
  std::vector<bool> isDrawnForBack;     ///< drawn counterclockwise as seen from the back

  [[nodiscard]] std::size_t size() const { return polygons.size(); }
};

/// A place that a diagnosis speaks of, for who looks for it in the model.
struct Mark {
  std::string code;    ///< the diagnosis'
  std::string object;  ///< or luminaire; may be empty
  glm::dvec3 place_m;
};

/// How large the model is after a step of the clean-up.
struct StepSize {
  std::string step;
  std::size_t polygons = 0;
  std::size_t triangles = 0;  ///< that these polygons would make
};

/// What the clean-up did, for the report and `inspect`.
struct CleanupCounts {
  std::size_t pointsRead = 0, facesRead = 0, cages = 0, cageFacets = 0;
  std::size_t pointsWelded = 0, degenerateFaces = 0, duplicateFaces = 0, nonPlanarFaces = 0;
  std::size_t paneSheetsDropped = 0;  ///< further sheets and rims of panes drawn as solids
  std::size_t polygons = 0;           ///< maximal planar polygons after merging
  std::size_t pieces = 0;             ///< convex pieces of these
  std::vector<StepSize> sizes;        ///< after each step, in their order
};

/// Cleans a scene: tessellates cages, welds, removes degenerate and duplicate faces, merges coplanar
/// neighbours of one surface into planar polygons with holes and divides these into convex pieces.
struct CleanModel {
  Pieces pieces;
  std::vector<Surface> surfaces;
  std::vector<Material> materials;
  std::vector<Luminaire> luminaires;  ///< that the model holds
  FileAxes axes;                      ///< how its file was understood
  CleanupCounts counts;
  std::vector<Diagnosis> diagnoses;
  std::vector<Mark> marks;  ///< of these diagnoses
};
CleanModel cleanScene(const Scene& scene);

/// Air that is connected without crossing glass, or the outside.
struct Domain {
  bool open = false;       ///< the sky is seen without glass from somewhere in it; at most one domain is
  bool lit = false;        ///< light reaches it: it is open, or has a portal, an emitter or a luminaire
  double area_m2 = 0.0;    ///< of all its sides
  double escape_m2 = 0.0;  ///< of that, the share that sees no piece
};

/// A pane between the outside and a closed domain.
struct Portal {
  std::uint32_t piece;
  bool frontIsInside;
  std::int32_t inside;     ///< domain
  std::int32_t outside;    ///< domain
  std::int32_t room = -1;  ///< that it serves
};

struct Room {
  std::string name;
  std::int32_t domain;
  double floorArea_m2 = 0.0;
  double volume_m3 = 0.0;
  double floor_m = 0.0;    ///< height of its floor
  double ceiling_m = 0.0;  ///< height of most of its ceiling; the mean one where that slopes
  std::vector<std::uint32_t> floorPieces;
};

/// An opening through which two rooms share their air: a door that stands open, or none. What lies between
/// belongs to neither and both; light passes freely.
struct RoomBorder {
  std::array<std::int32_t, 2> rooms;
  std::vector<glm::dvec3> line_m;  ///< at the floor: its ends, and corners where floors alone tell
  double height_m;
};

struct SensorGrid {
  std::string name;
  std::int32_t room = -1;  ///< -1: outside any room
  std::vector<glm::dvec3> points;
  std::vector<glm::dvec3> normals;
  double spacing_m = 0.25;
};

/// Everything the solver needs to know of a building.
struct Building {
  CleanModel model;
  std::vector<std::int32_t> sideDomain;  ///< 2 × pieces: domain, or -1 where no light can reach
  std::vector<Domain> domains;
  std::vector<Portal> portals;
  std::vector<bool> innerGlass;  ///< per piece: glass within one domain, lets light through
  std::vector<Room> rooms;
  std::vector<std::int32_t> sideRoom;  ///< 2 × pieces: room, or -1
  std::vector<RoomBorder> borders;
  std::vector<SensorGrid> grids;
  std::vector<Luminaire> luminaires;          ///< the model's and the study's
  std::vector<std::int32_t> luminaireDomain;  ///< #luminaires: domain, or -1 within something solid
  std::vector<Diagnosis> diagnoses;
  std::vector<Mark> marks;  ///< of these diagnoses
};

/// Finds domains, portals and rooms in a clean model, places luminaires and lays the study's sensor grids.
Building makeBuilding(CleanModel model, const Study& study);

}  // namespace clerestory
