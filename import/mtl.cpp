// SPDX-License-Identifier: GPL-3.0-or-later
// Reads material libraries of OBJ models: Kd Ke Tf d Tr illum map_Kd map_Ke; other statements do not concern
// light here.
#include "mtl.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "textfile.hpp"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxMtlBytes = 64U << 20U;

/// One `newmtl`, as it stands in the file.
struct Statements {
  MtlMaterial material;
  std::optional<glm::dvec3> filter;    // Tf
  std::optional<double> dissolve;      // d: 1 is opaque
  std::optional<double> transparency;  // Tr: the reverse
  std::optional<std::int64_t> illumination;
};

bool passesLight(std::int64_t illumination) {
  return illumination == 4 || illumination == 6 || illumination == 7 || illumination == 9;
}
bool mirrors(std::int64_t illumination) {
  return illumination == 3 || illumination == 5 || illumination == 8;
}

/// Options of `map_…` and the most values that follow each.
constexpr std::array<std::pair<std::string_view, std::size_t>, 12> kTextureOptions{{{"-blendu", 1},
                                                                                    {"-blendv", 1},
                                                                                    {"-bm", 1},
                                                                                    {"-boost", 1},
                                                                                    {"-cc", 1},
                                                                                    {"-clamp", 1},
                                                                                    {"-imfchan", 1},
                                                                                    {"-mm", 2},
                                                                                    {"-o", 3},
                                                                                    {"-s", 3},
                                                                                    {"-t", 3},
                                                                                    {"-texres", 1}}};

class MtlReader {
 public:
  MtlReader(const std::filesystem::path& file, MaterialLibrary& library, std::vector<Diagnosis>& diagnoses)
      : folder_(file.parent_path()), place_{file.string()}, library_(library), diagnoses_(diagnoses) {}

  void read(std::string_view text) {
    LineReader lines(text);
    while (lines.next()) {
      place_.line = lines.number();
      splitWords(lines.line(), words_);
      if (words_.empty()) {
        continue;
      }
      rest_ = lines.line().substr(lines.line().find(words_[0]) + words_[0].size());
      if (lowerCase(words_[0]) == "newmtl") {
        finish();
        begin(rest_);
      } else if (current_) {
        statement(lowerCase(words_[0]));
      }
    }
    finish();
  }

 private:
  void begin(std::string_view name) {
    current_.emplace();
    current_->material.folder = folder_;
    current_->material.display.name = cleanName(name);
    current_->material.display.where = place_.text();
  }

  void statement(const std::string& keyword) {
    if (keyword == "kd") {
      current_->material.display.color = color();
    } else if (keyword == "ke") {
      current_->material.display.luminance_cd_m2 = color().value_or(glm::dvec3(0.0));
    } else if (keyword == "tf") {
      current_->filter = color();
    } else if (keyword == "d") {
      current_->dissolve = scalar();
    } else if (keyword == "tr") {
      current_->transparency = scalar();
    } else if (keyword == "illum") {
      current_->illumination = words_.size() > 1 ? parseInteger(words_[1]) : std::nullopt;
    } else if (keyword == "map_kd") {
      current_->material.color = texture();
    } else if (keyword == "map_ke") {
      current_->material.luminance = texture();
    }
  }

  /// `map_Kd -s 2 2 -clamp on my wood.png`: options, then a name that may hold blanks.
  std::optional<MtlTexture> texture() {
    MtlTexture texture;
    texture.where = place_.text();
    texture.mapping.transform = {1.0, 0.0, 0.0, -1.0, 0.0, 1.0};  // v counts from the bottom
    std::size_t word = 1;
    while (word < words_.size() && words_[word].starts_with('-')) {
      const std::string option = lowerCase(words_[word]);
      const auto known = std::find_if(kTextureOptions.begin(), kTextureOptions.end(),
                                      [&](const auto& candidate) { return candidate.first == option; });
      if (known == kTextureOptions.end()) {
        break;  // a file's name
      }
      ++word;
      const std::size_t first = word;
      while (word < words_.size() && word - first < known->second &&
             (known->second == 1 || parseNumber(words_[word]))) {
        ++word;
      }
      apply(option, std::span(words_).subspan(first, word - first), texture);
    }
    if (word >= words_.size()) {
      return broken();
    }
    texture.name = std::string(trimmed(rest_.substr(rest_.find(words_[word], optionsEnd(word)))));
    return texture;
  }

  /// Where in rest_ the words before `word` end.
  std::size_t optionsEnd(std::size_t word) const {
    return word == 1
               ? 0
               : static_cast<std::size_t>(words_[word - 1].data() - rest_.data()) + words_[word - 1].size();
  }

  static void apply(const std::string& option, std::span<const std::string_view> values,
                    MtlTexture& texture) {
    const auto number = [&](std::size_t i, double otherwise) {
      return i < values.size() ? parseNumber(values[i]).value_or(otherwise) : otherwise;
    };
    glm::dmat3x2& transform = texture.mapping.transform;
    if (option == "-s") {
      transform[0][0] = number(0, 1.0);
      transform[1][1] = -number(1, 1.0);
    } else if (option == "-o") {
      transform[2] = {number(0, 0.0), 1.0 - number(1, 0.0)};
    } else if (option == "-mm") {
      texture.base = number(0, 0.0);
      texture.gain = number(1, 1.0);
    } else if (option == "-clamp" && !values.empty() && lowerCase(values[0]) == "on") {
      texture.mapping.wrapU = texture.mapping.wrapV = TextureWrap::clamp;
    }
  }

  /// Three numbers, or one for all; `spectral` and `xyz` colours are not known.
  std::optional<glm::dvec3> color() {
    glm::dvec3 value(0.0);
    const std::size_t count = words_.size() - 1;
    for (int i = 0; i < 3 && count > 0; ++i) {
      const std::size_t word = count >= 3 ? static_cast<std::size_t>(i) + 1 : 1;
      const std::optional<double> number = numberOf(words_[word]);
      if (!number) {
        return broken();
      }
      value[i] = *number;
    }
    return count > 0 ? std::optional(value) : broken();
  }

  std::optional<double> scalar() {
    const std::optional<double> number = numberOf(words_.back());
    if (!number || words_.size() < 2) {
      broken();
    }
    return number;
  }

  std::optional<double> numberOf(std::string_view word) {
    const std::optional<double> number = parseNumber(word);
    const std::optional<double> withComma = number ? std::nullopt : parseCommaNumber(word);
    if (withComma) {
      addDiagnosis(diagnoses_, {"C114", "numbers with a decimal comma were read as such", place_.text()});
    }
    return number ? number : withComma;
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
    DisplayMaterial& material = current_->material.display;
    const std::optional<double> opaque = opacity();
    const bool lit = current_->illumination && passesLight(*current_->illumination);
    material.statedOpaque = opaque && *opaque >= 1.0;
    material.transparent = (opaque && *opaque < 1.0) || (lit && !opaque);
    if (current_->filter && (material.transparent || lit)) {
      material.transmittance = current_->filter;
    }
    material.mirrors = current_->illumination && mirrors(*current_->illumination);
    const std::string where = material.where;
    if (!library_.emplace(material.name, std::move(current_->material)).second) {
      addDiagnosis(diagnoses_, {"C128", "a material defined twice keeps its first definition", where});
    }
    current_.reset();
  }

  std::filesystem::path folder_;
  Place place_;
  MaterialLibrary& library_;
  std::vector<Diagnosis>& diagnoses_;
  std::vector<std::string_view> words_;
  std::string_view rest_;  // of the line, behind the keyword
  std::optional<Statements> current_;
};

}  // namespace

void readMtl(const std::filesystem::path& file, MaterialLibrary& library, std::vector<Diagnosis>& diagnoses) {
  try {
    const std::string text = decodedText(readWholeFile(file, "material", kMaxMtlBytes), file.string());
    MtlReader(file, library, diagnoses).read(text);
  } catch (const InputError& error) {
    addDiagnosis(diagnoses,
                 {"C129", "material library left out: " + std::string(error.what()), file.string()});
  }
}

}  // namespace clerestory
