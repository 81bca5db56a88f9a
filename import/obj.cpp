// SPDX-License-Identifier: GPL-3.0-or-later
// Reads Wavefront OBJ: polygons, names, materials, and the tags that make an object a subdivision cage.
#include "obj.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>

#include "cage.hpp"
#include "mtl.hpp"
#include "objtag.hpp"
#include "objtexture.hpp"
#include "textfile.hpp"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxObjBytes = 4ULL << 30U;
constexpr std::size_t kMaxPoints = 1ULL << 30U;
constexpr double kMaxCoordinate = 1e12;
constexpr double kUndefinedReflectance = 0.5;

constexpr auto kIgnored = std::to_array<std::string_view>(
    {"vn",        "vp",     "s",      "mg",    "bevel", "c_interp", "d_interp", "lod",  "shadow_obj",
     "trace_obj", "usemap", "maplib", "ctech", "stech", "cstype",   "deg",      "bmat", "step",
     "parm",      "trim",   "hole",   "scrv",  "sp",    "end",      "con",      "off"});
constexpr auto kNotFaces = std::to_array<std::string_view>({"p", "l", "curv", "curv2", "surf"});

template <typename Words>
bool holds(const Words& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

class ObjReader {
 public:
  explicit ObjReader(const std::filesystem::path& file)
      : folder_(file.parent_path()), place_{file.string()}, name_(cleanName(file.stem().string())) {}

  Scene read(std::string_view text) {
    LineReader lines(text);
    while (lines.next()) {
      place_.line = lines.number();
      splitWords(lines.line(), words_);
      if (!words_.empty()) {
        rest_ = lines.line().substr(static_cast<std::size_t>(words_[0].data() - lines.line().data()) +
                                    words_[0].size());
        statement(words_[0]);
      }
    }
    resolveMaterials();
    moveFacesToCages(scene_, tags_);
    return std::move(scene_);
  }

 private:
  void statement(std::string_view keyword) {
    if (keyword == "v") {
      vertex();
    } else if (keyword == "vt") {
      textureCoordinate();
    } else if (keyword == "f" || keyword == "fo") {
      face();
    } else if (keyword == "o" || keyword == "g") {
      beginObject(keyword == "o");
    } else if (keyword == "usemtl") {
      useMaterial();
    } else if (keyword == "mtllib") {
      materialLibraries();
    } else if (keyword == "t") {
      tag();
    } else if (holds(kNotFaces, keyword)) {
      diagnose("C111", "points, lines, curves and free-form surfaces were left out");
    } else if (!holds(kIgnored, keyword)) {
      diagnose("C112", "statements that OBJ does not know were left out");
    }
  }

  void diagnose(const char* code, const std::string& message) {
    addDiagnosis(scene_.diagnoses, {code, message, place_.text()});
  }

  double number(std::string_view word) {
    std::optional<double> value = parseNumber(word);
    if (!value) {
      value = parseCommaNumber(word);
      if (value) {
        diagnose("C114", "numbers with a decimal comma were read as such");
      }
    }
    if (!value || std::abs(*value) > kMaxCoordinate) {
      failAt(place_, "\"" + cleanName(word) + "\" is not a coordinate; write numbers like 0.5, within 1e12");
    }
    return *value;
  }

  /// `v x y z`, perhaps with a weight or a colour behind, which must be numbers too.
  void vertex() {
    if (words_.size() < 4) {
      failAt(place_, "a vertex has three coordinates, here are " + std::to_string(words_.size() - 1));
    }
    if (scene_.points.size() >= kMaxPoints) {
      failAt(place_, "more than 2^30 vertices; split the model");
    }
    for (std::size_t i = 4; i < words_.size(); ++i) {
      static_cast<void>(number(words_[i]));
    }
    scene_.points.emplace_back(number(words_[1]), number(words_[2]), number(words_[3]));
  }

  /// Only pictures need it: what is no number counts as 0.
  void textureCoordinate() {
    const auto value = [&](std::size_t i) {
      const double number = i < words_.size() ? parseNumber(words_[i]).value_or(0.0) : 0.0;
      return static_cast<float>(std::clamp(number, -1e9, 1e9));
    };
    if (coordinates_.values.size() < kMaxPoints) {
      coordinates_.values.emplace_back(value(1), value(2));
    }
  }

  /// The corner's `vt` for its place in the scene; what is out of range counts as none.
  void addTextureCorner(std::string_view word) {
    const auto size = static_cast<std::int64_t>(coordinates_.values.size());
    const std::int64_t index = word.empty() ? 0 : parseInteger(word).value_or(0);
    const bool isThere = index != 0 && index <= size && index >= -size;
    textureCorners_.push_back(isThere ? static_cast<std::uint32_t>(index > 0 ? index - 1 : size + index)
                                      : TextureCoordinates::kNone);
  }

  /// The point that a corner `v`, `v/vt`, `v//vn` or `v/vt/vn` names; negative ones count from the last.
  std::uint32_t corner(std::string_view word) {
    std::array<std::string_view, 3> parts;
    std::size_t count = 0;
    for (std::string_view rest = word; count < 3; ++count) {
      const std::size_t slash = rest.find('/');
      parts[count] = rest.substr(0, slash);
      if (slash == std::string_view::npos) {
        ++count;
        break;
      }
      rest.remove_prefix(slash + 1);
      if (count == 2) {
        failAt(place_, "\"" + cleanName(word) + "\" has more than three parts; a corner is v/vt/vn");
      }
    }
    const std::optional<std::int64_t> index = parseInteger(parts[0]);
    const bool restIsFine =
        (parts[1].empty() || parseInteger(parts[1])) && (parts[2].empty() || parseInteger(parts[2]));
    if (!index || !restIsFine) {
      failAt(place_, "\"" + cleanName(word) + "\" is not a face's corner; write v, v/vt, v//vn or v/vt/vn");
    }
    const auto size = static_cast<std::int64_t>(scene_.points.size());
    if (*index == 0 || *index > size || *index < -size) {
      failAt(place_, "a face names vertex " + std::to_string(*index) + ", but " + std::to_string(size) +
                         " are given so far; indices begin at 1, or at -1 for the last");
    }
    addTextureCorner(parts[1]);
    return static_cast<std::uint32_t>(*index > 0 ? *index - 1 : size + *index);
  }

  void face() {
    corners_.clear();
    textureCorners_.clear();
    for (std::size_t i = 1; i < words_.size(); ++i) {
      corners_.push_back(corner(words_[i]));
    }
    if (corners_.size() < 3) {
      diagnose("C110", "faces with fewer than three corners were left out");
      return;
    }
    if (scene_.faces.corners.size() + corners_.size() > std::numeric_limits<std::uint32_t>::max()) {
      failAt(place_, "more than 2^32 corners of faces; split the model");
    }
    if (!coordinates_.values.empty()) {
      coordinates_.corners.resize(scene_.faces.corners.size(), TextureCoordinates::kNone);
      coordinates_.corners.insert(coordinates_.corners.end(), textureCorners_.begin(), textureCorners_.end());
    }
    scene_.faces.add(corners_);
    scene_.faceObject.push_back(object());
    scene_.faceMaterial.push_back(materialNumber());
  }

  /// `o` always begins an object; `g` only where the name changes (some programs repeat it for each face).
  void beginObject(bool isObject) {
    std::string name = cleanName(rest_);
    if (name.empty()) {
      name = "default";
    }
    if (!isObject && name == name_) {
      return;
    }
    name_ = std::move(name);
    object_.reset();
  }

  /// The current object, made when its first face or tag comes.
  std::uint32_t object() {
    if (!object_) {
      object_ = static_cast<std::uint32_t>(scene_.objects.size());
      scene_.objects.push_back(name_);
    }
    return *object_;
  }

  void useMaterial() {
    materialName_ = cleanName(rest_);
    material_.reset();
  }

  /// The current material, numbered in the order of first use.
  std::uint32_t materialNumber() {
    if (!material_) {
      const auto next = static_cast<std::uint32_t>(materialNames_.size());
      const auto [found, isNew] = materialByName_.try_emplace(materialName_, next);
      if (isNew) {
        materialNames_.push_back(materialName_);
      }
      material_ = found->second;
    }
    return *material_;
  }

  /// Several files, or one whose name has blanks.
  void materialLibraries() {
    const std::string whole(trimmed(rest_));
    const auto single = fileInside(folder_, whole);
    std::error_code error;
    if (single && std::filesystem::is_regular_file(*single, error)) {
      readMtl(*single, library_, scene_.diagnoses);
      return;
    }
    for (std::size_t i = 1; i < words_.size(); ++i) {
      const auto file = fileInside(folder_, words_[i]);
      if (!file) {
        diagnose("C130", "material library outside the model's folder is not read: " + cleanName(words_[i]));
      } else {
        readMtl(*file, library_, scene_.diagnoses);
      }
    }
  }

  void tag() {
    const std::uint32_t current = object();
    if (!readObjTag(words_, scene_.points.size(), place_, tags_[current])) {
      diagnose("C113", "tags that OpenSubdiv's OBJ does not know were left out");
    }
  }

  void resolveMaterials() {
    std::vector<MtlMaterial> materials;
    for (const std::string& name : materialNames_) {
      auto found = library_.find(name);
      if (found == library_.end()) {
        found = library_.find(cleanName(name.substr(0, name.find(" #"))));
      }
      MtlMaterial material;
      if (found != library_.end()) {
        material = found->second;
      } else if (!name.empty()) {
        addDiagnosis(scene_.diagnoses,
                     {"C131", "materials that no library defines: reflectance 0.5, or glass by their name",
                      "material \"" + name + "\""});
        material.display.color = glm::dvec3(kUndefinedReflectance);
      }
      material.display.name = name.empty() ? "default" : name;
      materials.push_back(std::move(material));
    }
    applyTextures(materials, coordinates_, scene_);
    for (const MtlMaterial& material : materials) {
      scene_.materials.push_back(materialOf(material.display, scene_.diagnoses));
    }
  }

  std::filesystem::path folder_;
  Place place_;
  std::vector<std::string_view> words_;
  std::string_view rest_;                      // of the line, behind the keyword
  std::vector<std::uint32_t> corners_;         // of the face at hand
  std::vector<std::uint32_t> textureCorners_;  // likewise

  Scene scene_;
  TextureCoordinates coordinates_;
  std::string name_;
  std::optional<std::uint32_t> object_;
  std::map<std::uint32_t, Cage> tags_;  // by object

  MaterialLibrary library_;
  std::string materialName_;
  std::optional<std::uint32_t> material_;
  std::vector<std::string> materialNames_;
  std::unordered_map<std::string, std::uint32_t> materialByName_;
};

}  // namespace

Scene readObj(const std::filesystem::path& file) {
  const std::string text = decodedText(readWholeFile(file, "model", kMaxObjBytes), file.string());
  return ObjReader(file).read(text);
}

}  // namespace clerestory
