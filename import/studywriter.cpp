// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a study as study.toml, complete, so that it can be run again.
#include <cmath>

#include <import/study.hpp>

#include "studytext.hpp"
#include "textfile.hpp"

namespace clerestory {
namespace {

/// A TOML basic string.
std::string inQuotes(const std::string& text) {
  constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string escaped = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      escaped += '\\';
      escaped += c;
    } else if (byte < 0x20 || byte == 0x7F) {
      escaped += "\\u00";
      escaped += kHex[byte >> 4U];
      escaped += kHex[byte & 0xFU];
    } else {
      escaped += c;
    }
  }
  return escaped + "\"";
}

std::string list(const glm::dvec3& v) {
  return "[" + numberText(v.x) + ", " + numberText(v.y) + ", " + numberText(v.z) + "]";
}

/// One number where the channels agree.
std::string color(const glm::dvec3& c) {
  return c.r == c.g && c.g == c.b ? numberText(c.r) : list(c);
}

/// Collects lines `key = value`.
class Writer {
 public:
  void section(const std::string& header) { text_ += "\n" + header + "\n"; }
  void line(const std::string& key, const std::string& value) { text_ += key + " = " + value + "\n"; }
  void line(const std::string& key, double value) { line(key, numberText(value)); }
  void comment(const std::string& text) { text_ += "# " + cleanName(text) + "\n"; }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

void writeModel(const Study& study, Writer& out) {
  out.section("[model]");
  out.line("file", inQuotes(study.modelFileAsWritten));
  if (study.model.units) {
    out.line("units", inQuotes(*study.model.units));
  }
  if (study.model.upAxis) {
    out.line("up", inQuotes(*study.model.upAxis));
  }
  for (const ModelOptions::Subdivide& rule : study.model.subdivide) {
    out.section("[model.subdivide." + inQuotes(rule.object) + "]");
    out.line("scheme", inQuotes(rule.scheme));
    if (rule.tolerance_m) {
      out.line("tolerance_m", *rule.tolerance_m);
    }
  }
}

void writeSite(const Site& site, Writer& out) {
  out.section("[site]");
  out.line("latitude", site.latitude_deg);
  out.line("longitude", site.longitude_deg);
  out.line("time_zone", site.timeZone_h);
  out.line("north", site.north_deg);
  out.line("external_diffuse_lx", site.externalDiffuse_lx);
}

void writeMaterials(const Study& study, Writer& out) {
  for (const MaterialRule& rule : study.materials) {
    out.section("[materials." + inQuotes(rule.glob) + "]");
    if (rule.reflectance) {
      out.line("reflectance", color(*rule.reflectance));
    }
    if (rule.transmittance) {
      out.line("transmittance", color(*rule.transmittance));
    }
    if (rule.glass) {
      out.line("glass", inQuotes(glassPresetName(*rule.glass)));
    }
    if (rule.diffusing) {
      out.line("diffusing", std::string(*rule.diffusing ? "true" : "false"));
    }
    if (rule.panes) {
      out.line("panes", std::to_string(*rule.panes));
    }
    if (rule.exitance_lm_m2) {
      out.line("exitance", color(*rule.exitance_lm_m2));
    }
  }
}

void writeSky(const Study& study, Writer& out) {
  out.section("[sky]");
  out.line("type", inQuotes(skyTypeName(study.sky)));
  if (study.sky.irradiance) {
    out.line("direct_normal_w_m2", study.sky.irradiance->directNormal_W_m2);
    out.line("diffuse_horizontal_w_m2", study.sky.irradiance->diffuseHorizontal_W_m2);
  } else {
    out.line("diffuse_horizontal_lx", study.sky.diffuseHorizontal_lx);
    out.line("direct_normal_lx", study.sky.directNormal_lx);
  }
  if (study.sky.time) {
    out.line("time", clockTimeText(*study.sky.time));
  }
  if (study.sky.sun_deg) {
    out.line("sun", "{ altitude = " + numberText(study.sky.sun_deg->x) +
                        ", azimuth = " + numberText(study.sky.sun_deg->y) + " }");
  }
  out.section("[sunlight]");
  out.line("date", dateText(study.sunlight.date));
  out.line("altitude_min", study.sunlight.leastAltitude_deg);
  out.section("[ground]");
  out.line("reflectance", study.groundReflectance);
  out.line("model", inQuotes(study.groundIsShaded ? "shaded" : "uniform"));
  out.section("[glazing]");
  out.line("dirt", study.dirtFactor);
  out.line("frame", study.frameFactor);
}

void writeLuminaire(const LuminaireSettings& luminaire, Writer& out) {
  out.section("[[luminaire]]");
  out.line("name", inQuotes(luminaire.name));
  if (luminaire.file.empty()) {
    out.line("intensity_cd", luminaire.intensity_cd);
    out.line("lambertian", luminaire.lambertian ? "true" : "false");
  } else {
    out.line("file", inQuotes(luminaire.file));
  }
  out.line("position", list(luminaire.position_m));
  out.line("aim", list(luminaire.aim));
  out.line("rotation", luminaire.rotation_deg);
  out.line("flux_factor", luminaire.fluxFactor);
  out.line("array", "{ count = [" + std::to_string(luminaire.count[0]) + ", " +
                        std::to_string(luminaire.count[1]) + "], step = [" + numberText(luminaire.step_m.x) +
                        ", " + numberText(luminaire.step_m.y) + "] }");
}

void writeGrid(const GridSettings& grid, Writer& out) {
  out.section("[[grid]]");
  out.line("name", inQuotes(grid.name));
  if (grid.room) {
    out.line("room", inQuotes(*grid.room));
  }
  if (!grid.polygon_m.empty()) {
    std::string corners;
    for (const glm::dvec2& corner : grid.polygon_m) {
      corners += (corners.empty() ? "[" : ", [") + numberText(corner.x) + ", " + numberText(corner.y) + "]";
    }
    out.line("polygon", "[" + corners + "]");
  }
  if (grid.surface) {
    out.line("surface", inQuotes(*grid.surface));
  }
  if (!grid.pointsFile.empty()) {
    out.line("points", inQuotes(grid.pointsFile));
  }
  out.line("height", grid.height_m);
  out.line("spacing", grid.spacing_m);
  out.line("inset", grid.inset_m);
}

void writeView(const ViewSettings& view, Writer& out) {
  out.section("[[view]]");
  out.line("name", inQuotes(view.name));
  if (view.projection != Projection::perspective) {
    out.line("projection", inQuotes(projectionKey(view.projection)));
  }
  out.line("eye", list(view.eye_m));
  out.line("target", list(view.target_m));
  out.line("up", list(view.up));
  if (view.projection != Projection::panorama) {
    out.line("field_of_view", view.fieldOfView_deg);
  }
  out.line("size", "[" + std::to_string(view.size_px[0]) + ", " + std::to_string(view.size_px[1]) + "]");
  out.line("exposure_ev", view.exposure_ev ? numberText(*view.exposure_ev) : inQuotes("auto"));
  if (view.exrBits != ViewSettings{}.exrBits) {
    out.line("exr_bits", std::to_string(view.exrBits));
  }
  if (view.pngBits != ViewSettings{}.pngBits) {
    out.line("png_bits", std::to_string(view.pngBits));
  }
}

/// The per cent that reads back to the same fraction, in as few digits as that takes.
std::string accuracyText(double accuracy) {
  const double rounded = std::round(accuracy * 1e8) / 1e6;
  const double percent = rounded / 100.0 == accuracy ? rounded : accuracy * 100.0;
  return numberText(percent) + "%";
}

}  // namespace

const char* projectionKey(Projection projection) {
  return projection == Projection::perspective ? "perspective"
         : projection == Projection::fisheye   ? "fisheye"
                                               : "panorama";
}

std::string studyToml(const Study& study) {
  Writer out;
  out.comment(
      "A study for Clerestory. Everything that shapes the results is stated, so that it can be run again.");
  for (const std::string& assumption : study.assumptions) {
    out.comment("Assumed: " + assumption);
  }
  writeModel(study, out);
  writeSite(study.site, out);
  writeMaterials(study, out);
  writeSky(study, out);
  for (const std::vector<glm::dvec3>& outline : study.openings) {
    std::string corners;
    for (const glm::dvec3& corner : outline) corners += (corners.empty() ? "" : ", ") + list(corner);
    out.section("[[opening]]");
    out.line("polygon", "[" + corners + "]");
  }
  for (const LuminaireSettings& luminaire : study.luminaires) {
    writeLuminaire(luminaire, out);
  }
  for (const GridSettings& grid : study.grids) {
    writeGrid(grid, out);
  }
  for (const ViewSettings& view : study.views) {
    writeView(view, out);
  }
  out.section("[accuracy]");
  out.line("target", inQuotes(accuracyText(study.accuracy)));
  if (study.falseColoursAreLinear || !study.norms.empty()) {
    out.section("[report]");
  }
  if (study.falseColoursAreLinear) {
    out.line("false_colours", inQuotes("linear"));
  }
  if (!study.norms.empty()) {
    std::string norms;
    for (const std::string& norm : study.norms) norms += (norms.empty() ? "" : ", ") + inQuotes(norm);
    out.line("norms", "[" + norms + "]");
  }
  return out.take();
}

}  // namespace clerestory
