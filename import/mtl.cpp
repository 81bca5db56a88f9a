// SPDX-License-Identifier: GPL-3.0-or-later
// Reads material libraries of OBJ models: Kd Ke Tf d Tr illum; other statements do not concern light here.
#include "mtl.hpp"

#include <optional>

#include "textfile.hpp"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxMtlBytes = 64U << 20U;

/// One `newmtl`, as it stands in the file.
struct Statements {
  DisplayMaterial material;
  std::optional<glm::dvec3> filter;    // Tf
  std::optional<double> dissolve;      // d: 1 is opaque
  std::optional<double> transparency;  // Tr: the reverse
  std::optional<std::int64_t> illumination;
  bool textured = false;
};

bool passesLight(std::int64_t illumination) {
  return illumination == 4 || illumination == 6 || illumination == 7 || illumination == 9;
}

class MtlReader {
 public:
  MtlReader(const std::filesystem::path& file, MaterialLibrary& library, std::vector<Diagnosis>& diagnoses)
      : place_{file.string()}, library_(library), diagnoses_(diagnoses) {}

  void read(std::string_view text) {
    LineReader lines(text);
    while (lines.next()) {
      place_.line = lines.number();
      splitWords(lines.line(), words_);
      if (words_.empty()) {
        continue;
      }
      if (lowerCase(words_[0]) == "newmtl") {
        finish();
        begin(lines.line().substr(lines.line().find(words_[0]) + words_[0].size()));
      } else if (current_) {
        statement(lowerCase(words_[0]));
      }
    }
    finish();
  }

 private:
  void begin(std::string_view name) {
    current_.emplace();
    current_->material.name = cleanName(name);
    current_->material.where = place_.text();
  }

  void statement(const std::string& keyword) {
    if (keyword == "kd") {
      current_->material.color = color();
    } else if (keyword == "ke") {
      current_->material.luminance_cd_m2 = color().value_or(glm::dvec3(0.0));
    } else if (keyword == "tf") {
      current_->filter = color();
    } else if (keyword == "d") {
      current_->dissolve = scalar();
    } else if (keyword == "tr") {
      current_->transparency = scalar();
    } else if (keyword == "illum") {
      current_->illumination = words_.size() > 1 ? parseInteger(words_[1]) : std::nullopt;
    } else if (keyword == "map_kd" || keyword == "map_ke" || keyword == "map_d") {
      texture(keyword);
    }
  }

  void texture(const std::string& keyword) {
    current_->textured = current_->textured || keyword == "map_kd";
    addDiagnosis(diagnoses_,
                 {"C126", "textures are not read: the material's colour stands for them", place_.text()});
  }

  /// Three numbers, or one for all; `spectral` and `xyz` colours are not known.
  std::optional<glm::dvec3> color() {
    glm::dvec3 value(0.0);
    const std::size_t count = words_.size() - 1;
    for (int i = 0; i < 3 && count > 0; ++i) {
      const std::size_t word = count >= 3 ? static_cast<std::size_t>(i) + 1 : 1;
      const std::optional<double> number = parseNumber(words_[word]);
      if (!number) {
        return broken();
      }
      value[i] = *number;
    }
    return count > 0 ? std::optional(value) : broken();
  }

  std::optional<double> scalar() {
    const std::optional<double> number = parseNumber(words_.back());
    if (!number || words_.size() < 2) {
      broken();
    }
    return number;
  }

  std::nullopt_t broken() {
    addDiagnosis(diagnoses_,
                 {"C127", "material statements that cannot be read were left out", place_.text()});
    return std::nullopt;
  }

  /// `d` stands over `Tr`. `Tr 1` alone is what some programs write for opaque: it counts as nothing said.
  std::optional<double> opacity() const {
    if (current_->dissolve) {
      return current_->dissolve;
    }
    if (current_->transparency && *current_->transparency < 1.0) {
      return 1.0 - *current_->transparency;
    }
    return std::nullopt;
  }

  void finish() {
    if (!current_) {
      return;
    }
    DisplayMaterial& material = current_->material;
    const std::optional<double> opaque = opacity();
    const bool lit = current_->illumination && passesLight(*current_->illumination);
    material.statedOpaque = opaque && *opaque >= 1.0;
    material.transparent = (opaque && *opaque < 1.0) || (lit && !opaque);
    if (current_->filter && (material.transparent || lit)) {
      material.transmittance = current_->filter;
    }
    if (current_->textured && material.color == glm::dvec3(0.0)) {
      material.color.reset();  // black is what some programs write where a picture gives the colour
    }
    if (!library_.emplace(material.name, material).second) {
      addDiagnosis(diagnoses_,
                   {"C128", "a material defined twice keeps its first definition", material.where});
    }
    current_.reset();
  }

  Place place_;
  MaterialLibrary& library_;
  std::vector<Diagnosis>& diagnoses_;
  std::vector<std::string_view> words_;
  std::optional<Statements> current_;
};

}  // namespace

void readMtl(const std::filesystem::path& file, MaterialLibrary& library, std::vector<Diagnosis>& diagnoses) {
  try {
    const std::string bytes = readWholeFile(file, "material", kMaxMtlBytes);
    MtlReader(file, library, diagnoses).read(plainText(bytes, file.string()));
  } catch (const InputError& error) {
    addDiagnosis(diagnoses,
                 {"C129", "material library left out: " + std::string(error.what()), file.string()});
  }
}

}  // namespace clerestory
