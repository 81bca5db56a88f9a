// SPDX-License-Identifier: GPL-3.0-or-later
// What a model file holds, as it was drawn: a polygon soup, subdivision cages, materials and names.
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <import/error.hpp>
#include <import/luminaire.hpp>

namespace clerestory {

/// A Lambertian surface, or glass. Colours are linear Rec.709.
/// How glazing transmits by angle.
enum class GlassKind {
  fresnel,     ///< equal clear sheets, absorption fitted to the stated transmittance
  cie171Clear  ///< the 6 mm clear glass of CIE 171:2006, case 5.5
};

struct Material {
  std::string name;
  glm::dvec3 reflectance{0.5};  ///< diffuse, [0, 1)
  glm::dvec3 exitance_lm_m2{0.0};
  bool mirrorsAsMatt = false;  ///< drawn as a metal or a mirror: what it reflects counts as diffuse
  bool glazing = false;
  glm::dvec3 transmittance{0.7};        ///< glazing: visible, normal incidence, of the whole pane unit [0, 1]
  bool transmittanceIsAssumed = false;  ///< nothing stated it
  int panes = 1;                        ///< glazing: sheets of glass in the unit, for its behaviour by angle
  GlassKind glass = GlassKind::fresnel;
  bool diffusing = false;  ///< glazing: scatters what it lets through evenly (opal)
};

/// Polygons as corner lists in one array: polygon f has the points corners[begin[f]] … corners[begin[f + 1] -
/// 1].
struct PolygonList {
  std::vector<std::uint32_t> begin{0};  ///< #polygons + 1
  std::vector<std::uint32_t> corners;   ///< indices of points

  [[nodiscard]] std::size_t size() const { return begin.size() - 1; }
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t polygon) const {
    return std::span(corners).subspan(begin[polygon], begin[polygon + 1] - begin[polygon]);
  }
  void add(std::span<const std::uint32_t> polygon) {
    corners.insert(corners.end(), polygon.begin(), polygon.end());
    begin.push_back(static_cast<std::uint32_t>(corners.size()));
  }
};

/// A subdivision surface's control cage, in the terms of OpenSubdiv. Indices are those of Scene::points.
struct Cage {
  enum class Scheme { catmark, loop, bilinear };
  enum class Boundary { none, edgeOnly, edgeAndCorner };
  struct Crease {
    std::uint32_t a, b;
    float sharpness;  ///< [0, 10], 10 is infinitely sharp
  };
  struct Corner {
    std::uint32_t point;
    float sharpness;
  };

  std::uint32_t object = 0;
  std::uint32_t material = 0;
  Scheme scheme = Scheme::catmark;
  Boundary boundary = Boundary::edgeAndCorner;
  PolygonList faces;
  std::vector<std::uint32_t> holes;  ///< indices of faces
  std::vector<Crease> creases;
  std::vector<Corner> corners;
  double tolerance_m = 0.005;  ///< chord error of the tessellation
};

/// A lamp without extent that a model holds (KHR_lights_punctual), placed.
struct PunctualLight {
  enum class Kind { point, spot, directional };
  std::string name;
  Kind kind = Kind::point;
  glm::dvec3 position_m{0.0};            ///< of point and spot
  glm::dvec3 direction{0.0, 0.0, -1.0};  ///< unit vector along which spot and directional shine
  /// Linear Rec.709: candela of point and spot (of a spot along its axis), lux across the beam of
  /// directional.
  glm::dvec3 intensity{1.0};
  double innerCone_rad = 0.0;  ///< spot: full intensity up to this angle from the axis,
  double outerCone_rad = 0.0;  ///< none from this one on
};

/// Point and spot lights as luminaires without extent. Those that are dark are left out.
std::vector<Luminaire> luminairesOf(const std::vector<PunctualLight>& lights);

/// How a file's numbers were understood.
struct FileAxes {
  std::string units = "m";  ///< m cm mm ft in
  std::string upAxis = "z";
  bool unitsAreGuessed = false;  ///< neither stated nor given by the format
  bool upAxisIsGuessed = false;  ///< likewise
};

/// One model. Coordinates are metres, z up, from the model's own origin.
struct Scene {
  std::vector<glm::dvec3> points;
  PolygonList faces;                        ///< at least three corners each, indices within points
  std::vector<std::uint32_t> faceMaterial;  ///< #faces
  std::vector<std::uint32_t> faceObject;    ///< #faces
  std::vector<Cage> cages;
  std::vector<Material> materials;
  std::vector<std::string> objects;  ///< object or group names
  std::vector<PunctualLight> lights;
  FileAxes axes;
  std::vector<Diagnosis> diagnoses;
};

/// How a model is to be understood where the file does not say.
struct ModelOptions {
  std::optional<std::string>
      units;  ///< m cm mm ft in; empty: metres unless that makes an impossible building
  std::optional<std::string>
      upAxis;  ///< y or z; empty: y for glTF, judged by the file's head and geometry for OBJ
  struct Subdivide {
    std::string object;  ///< glob over object names
    std::string scheme;  ///< catmark loop bilinear none
    std::optional<double> tolerance_m;
  };
  std::vector<Subdivide> subdivide;
};

/// Objects whose names begin so are markers of an earlier inspection (`clerestory inspect -o`), which are
/// left out.
inline constexpr std::string_view markerObject = "diagnosis G2";

/// Reads `file` by its ending (.obj, .gltf, .glb). Throws InputError where it cannot be understood.
Scene readModel(const std::filesystem::path& file, const ModelOptions& options);

/// Whether `name` matches the glob (`*` any run, `?` any character), ASCII case ignored.
bool globMatches(std::string_view glob, std::string_view name);

}  // namespace clerestory
