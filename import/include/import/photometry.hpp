// SPDX-License-Identifier: GPL-3.0-or-later
// Light of a luminaire by direction, as a photometric file states it, and the opening that it leaves by.
//
// A luminaire has axes of its own: x towards C0, y towards C90, z against the nadir, so C turns from x to y
// (counterclockwise from above) and gamma counts from the nadir. ANSI/IES LM-63-2002, section 3; CIE
// 121:1996.
#pragma once

#include <glm/vec3.hpp>

#include <filesystem>
#include <string>
#include <vector>

#include <import/error.hpp>

namespace clerestory {

/// Luminous intensities over a grid of angles, linear between them, 0 beyond them.
struct IntensityDistribution {
  /// Which way the poles of the grid lie. Type C: the nadir. B: horizontal, the axis C90-C270. A: vertical.
  enum class Type { a, b, c };

  Type type = Type::c;
  /// Ascending, over 360 at most; one alone stands for all. Types C and A: horizontal angles, C from C0 to
  /// C90, A from C0 to C270. Type B: vertical angles, from the nadir to C0.
  std::vector<double> longitude_deg;
  /// Ascending, from -90 to 90. Type C: gamma - 90. A: vertical angles. B: horizontal ones, towards C270.
  std::vector<double> latitude_deg;
  std::vector<double> intensity_cd;  ///< #longitudes × #latitudes: all latitudes of one longitude together

  /// In a unit direction, in the luminaire's axes. [cd]
  [[nodiscard]] double intensity(const glm::dvec3& direction) const;
  /// Where latitude 90 lies, in the luminaire's axes.
  [[nodiscard]] glm::dvec3 pole() const;
  /// Of a unit direction, whichever of the grid's latitudes are listed. [degrees]
  [[nodiscard]] double latitudeOf(const glm::dvec3& direction) const;
  /// Integral over all directions, exact for what lies between the angles. [lm]
  [[nodiscard]] double flux_lm() const;
};

/// The surface that light leaves by, centred at the luminaire's position. Without extent it is a point.
struct LuminousOpening {
  enum class Form {
    box,               ///< flat: a rectangle; with one extent alone: a line
    verticalCylinder,  ///< flat: a disc
    cylinderAlongC0,   ///< flat: a disc that stands square to C0
    cylinderAlongC90,
    ellipsoid
  };
  Form form = Form::box;
  glm::dvec3 extent_m{0.0};  ///< along the luminaire's axes
};

/// How the flux of a lamp changes as it is tilted (LM-63's TILT).
struct LampTilt {
  enum class Lamp {
    vertical = 1,
    alongC0 = 2,
    alongC90 = 3
  };  ///< of a luminaire that is aimed straight down

  Lamp lamp = Lamp::vertical;
  std::vector<double> angle_deg;  ///< ascending; empty: no change
  std::vector<double> factor;     ///< #angles

  /// For a lamp that is tilted by so much against its place in a luminaire aimed straight down.
  [[nodiscard]] double at(double tilt_deg) const;
};

struct Photometry {
  std::string format;                  ///< "LM-63-2002", "EULUMDAT"
  std::string name;                    ///< of the luminaire, as the file states it
  IntensityDistribution distribution;  ///< with all multipliers and ballast factors of the file
  LuminousOpening opening;
  LampTilt tilt;
  double lampFlux_lm = 0.0;  ///< of the bare lamps; 0: not stated, as in absolute photometry
  double power_w = 0.0;      ///< input of the luminaire; 0: not stated
  std::string text;          ///< of the file, whole by itself
  std::vector<Diagnosis> diagnoses;
};

/// Reads an IES LM-63 (.ies, 1986 to 2019) or EULUMDAT (.ldt) file by its ending. Throws InputError with line
/// and reason where it is malformed.
Photometry readPhotometry(const std::filesystem::path& file);
/// The same of bytes that are the file's.
Photometry photometryFrom(const std::string& bytes, const std::filesystem::path& file);

/// A point source: the same intensity everywhere, or one that falls with the cosine to 0 at gamma = 90.
Photometry uniformPhotometry(double intensity_cd);
Photometry lambertianPhotometry(double intensity_cd);
/// One that keeps its intensity within a cone about the nadir and falls to 0 at an outer one, by the square
/// of a linear function of the cosine (KHR_lights_punctual). 0 <= inner < outer <= 90 degrees.
Photometry spotPhotometry(double intensity_cd, double inner_deg, double outer_deg);

}  // namespace clerestory
