// SPDX-License-Identifier: GPL-3.0-or-later
// What is asked of a model: study.toml as a structure, read, defaulted and written back.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <import/luminaire.hpp>
#include <import/scene.hpp>

namespace clerestory {

struct Site {
  double latitude_deg = 47.37;  ///< north
  double longitude_deg = 8.54;  ///< east
  double timeZone_h = 1.0;      ///< east of UTC
  double north_deg = 0.0;       ///< direction of north in plan, clockwise from +y
  double externalDiffuse_lx = 16000.0;
};

/// `[materials."glob"]`: what stands over the model's own words.
struct MaterialRule {
  std::string glob;
  std::optional<glm::dvec3> reflectance;    ///< [0, 1)
  std::optional<glm::dvec3> transmittance;  ///< [0, 1], normal incidence
  std::optional<int> panes;
  std::optional<glm::dvec3> exitance_lm_m2;
  std::optional<GlassKind> glass{};  ///< a preset, which states the transmittance too
  std::optional<bool> diffusing{};
};

/// A moment as a clock on the wall shows it.
struct ClockTime {
  int year = 2026, month = 3, day = 21;
  double hour_h = 12.0;          ///< since midnight
  std::optional<double> zone_h;  ///< east of UTC; empty: the site's
};

/// What a weather file or a pyranometer states. [W/m²]
struct Irradiance {
  double directNormal_W_m2 = 0.0, diffuseHorizontal_W_m2 = 0.0;
};

/// `[sunlight]`: the day on which a room's hours of sunlight are counted.
struct SunlightSettings {
  ClockTime date{};                ///< its hour does not matter
  double leastAltitude_deg = 0.0;  ///< below it the sun does not count
};

struct SkySettings {
  int cieType = 16;      ///< 1 … 15 as CIE S 011, 16 the traditional overcast sky; 0: uniform (same as 5)
  bool isPerez = false;  ///< Perez all-weather sky in place of a CIE type
  double diffuseHorizontal_lx = 10000.0;
  double directNormal_lx = 0.0;          ///< the sun's beam; 0 leaves it out
  std::optional<Irradiance> irradiance;  ///< in place of both illuminances; for Perez
  std::optional<glm::dvec2> sun_deg;     ///< altitude, azimuth from north over east; or …
  std::optional<ClockTime> time;         ///< … the time that gives them
};

struct GridSettings {
  std::string name;
  std::optional<std::string> room;            ///< glob over room names; with none of the others: every room
  std::vector<glm::dvec2> polygon_m;          ///< plan outline
  std::vector<std::array<double, 6>> points;  ///< x y z nx ny nz, read from the named file
  std::string pointsFile;
  std::optional<std::string> surface;  ///< glob over objects: points on their faces, looking along the normal
  double height_m = 0.85;              ///< above the floor, or from the surface
  double spacing_m = 0.25;
  double inset_m = 0.0;
};

/// `[[luminaire]]`: one luminaire, or an array of equal ones.
struct LuminaireSettings {
  std::string name;
  std::string file;           ///< photometric, as the study names it; empty: an intensity is stated
  double intensity_cd = 0.0;  ///< of a point source, everywhere or …
  bool lambertian = false;    ///< … as the cosine has it
  std::shared_ptr<const Photometry> photometry;
  glm::dvec3 position_m{0.0};      ///< of the first in the array
  glm::dvec3 aim{0.0, 0.0, -1.0};  ///< where its nadir points, of any length
  double rotation_deg = 0.0;       ///< of C0, from +x towards +y
  double fluxFactor = 1.0;         ///< ballast and maintenance
  std::array<int, 2> count{1, 1};  ///< along x and y
  glm::dvec2 step_m{0.0};
};

enum class Projection {
  perspective,
  fisheye,   ///< equidistant: as far from the centre as the angle to the view; a circle over the height
  panorama,  ///< equirectangular: all round, upright along `up`, the target's azimuth in the middle
};

/// As a study writes it.
const char* projectionKey(Projection projection);

struct ViewSettings {
  std::string name;
  Projection projection = Projection::perspective;
  glm::dvec3 eye_m{0.0};
  glm::dvec3 target_m{0.0, 1.0, 0.0};
  glm::dvec3 up{0.0, 0.0, 1.0};
  double fieldOfView_deg = 70.0;  ///< over the picture's height; a panorama has none
  std::array<int, 2> size_px{1280, 720};
  std::optional<double> exposure_ev;  ///< empty: automatic
  int exrBits = 16, pngBits = 8;      ///< of a value in the files
};

/// A whole study. Everything has a default, so a model alone is a study too.
struct Study {
  std::filesystem::path modelFile;  ///< as found from the working directory
  std::string modelFileAsWritten;   ///< as the study or the command line names it
  ModelOptions model;
  Site site;
  std::vector<MaterialRule> materials;  ///< in the file's order: later ones win
  SkySettings sky;
  double groundReflectance = 0.2;
  bool groundIsShaded = false;  ///< a surface below the model that it shades; else of uniform luminance
  std::vector<std::vector<glm::dvec3>> openings;  ///< outlines of holes in the envelope, without glass
  double dirtFactor = 1.0;                        ///< on every portal's transmittance
  double frameFactor = 1.0;                       ///< likewise; 1 where the model draws its frames
  SunlightSettings sunlight;
  std::vector<LuminaireSettings> luminaires;
  std::vector<GridSettings> grids;
  std::vector<ViewSettings> views;
  bool falseColoursAreLinear = false;  ///< of the views, else logarithmic
  double accuracy = 0.05;              ///< asked 95th percentile of the sensors' relative errors
  double timeLimit_s = 0.0;
  std::vector<std::string> norms;        ///< "en17037", "leed": which pass or fail is shown
  std::vector<std::string> assumptions;  ///< what was taken for granted, in sentences for the report
};

/// "2026-03-21T10:00:00", with the zone where the time has one of its own.
std::string clockTimeText(const ClockTime& time);

/// Its day alone, "2026-03-21".
std::string dateText(const ClockTime& time);

/// Reads a study. Unknown keys are an error that names the nearest known one; keys of later versions
/// are an error that says so. Throws InputError with file and line.
Study readStudy(const std::filesystem::path& file);

/// The study of a model alone: overcast sky of 10,000 lx, a grid 0.85 m above each floor.
Study studyOfModel(const std::filesystem::path& modelFile);

/// The luminaires of a study in their places, arrays laid out.
std::vector<Luminaire> luminairesOf(const Study& study);

/// "5%", "draft", "standard" or "fine" as a fraction; empty where it is none of them.
std::optional<double> parseAccuracy(const std::string& text);

/// Applies the study's material rules to `scene` and checks what is stated. A rule that matches nothing is
/// a diagnosis. Throws InputError naming the material.
void applyMaterialRules(const Study& study, Scene& scene);

/// Adds to a model what a study states beside it: openings as panes that let all light through, and a ground
/// that the model shades, 2 cm below its lowest point.
void addSurroundings(const Study& study, Scene& scene);

/// study.toml text that gives `study` again, with comments for what was assumed.
std::string studyToml(const Study& study);

}  // namespace clerestory
