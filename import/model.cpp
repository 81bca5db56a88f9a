// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a model of any known format and brings it into metres, z up, with its cages chosen.
#include <algorithm>
#include <cstdio>

#include "cage.hpp"
#include "gltf.hpp"
#include "obj.hpp"
#include "textfile.hpp"
#include "units.hpp"
#include "upaxis.hpp"

namespace clerestory {
namespace {

void checkOptions(const ModelOptions& options) {
  if (options.units && !metresOf(*options.units)) {
    throw InputError("unit \"" + *options.units + "\" is not known; use m, cm, mm, ft or in");
  }
  if (options.upAxis && *options.upAxis != "y" && *options.upAxis != "z") {
    throw InputError("up axis \"" + *options.upAxis + "\" is not known; use y or z");
  }
  for (const ModelOptions::Subdivide& rule : options.subdivide) {
    if (rule.scheme != "none" && !parseScheme(rule.scheme)) {
      throw InputError("subdivision scheme \"" + rule.scheme + "\" for \"" + rule.object +
                       "\" is not known; use catmark, loop, bilinear or none");
    }
  }
}

/// What a model has instead of faces, for a message.
std::string leftOutText(const Scene& scene) {
  std::string text;
  for (const Diagnosis& diagnosis : scene.diagnoses) {
    if (diagnosis.code == "C110" || diagnosis.code == "C111" || diagnosis.code == "C134") {
      text += (text.empty() ? ": " : ", ") + diagnosis.message + " (" + diagnosis.where + ")";
    }
  }
  return text;
}

std::string lengthText(double metres) {
  char text[32];
  std::snprintf(text, sizeof(text), metres < 100.0 ? "%.3g" : "%.0f", metres);
  return text;
}

std::string sizeText(const glm::dvec3& extent, double metres) {
  return lengthText(extent.x * metres) + " x " + lengthText(extent.y * metres) + " x " +
         lengthText(extent.z * metres) + " m";
}

/// Sets the model's unit: as asked, else metres, else the one unit that makes it a building.
void chooseUnit(const std::filesystem::path& file, bool isObj, const ModelOptions& options, Scene& scene) {
  if (options.units) {
    scene.axes.units = *options.units;
    return;
  }
  const SizeJudgement size = judgeSize(scene);
  scene.axes.unitsAreGuessed = isObj || !size.metresArePossible;
  if (size.metresArePossible) {
    return;
  }
  const std::string asMetres = sizeText(size.extent, 1.0);
  if (size.others.size() == 1) {
    const double metres = *metresOf(size.others[0]);
    addDiagnosis(scene.diagnoses, {"C101",
                                   "as metres the model would measure " + asMetres + ", so it was read in " +
                                       size.others[0] + " (" + sizeText(size.extent, metres) +
                                       "); --units or [model] units says it for certain",
                                   file.string()});
    scene.axes.units = size.others[0];
    return;
  }
  if (!isObj) {
    addDiagnosis(scene.diagnoses, {"C102",
                                   "glTF is in metres, but that makes the model " + asMetres +
                                       ", which is no building; --units or [model] units corrects it",
                                   file.string()});
    return;
  }
  throw InputError(file.string() + ": the model's unit is not clear: as metres it measures " + asMetres +
                   ", as cm " + sizeText(size.extent, 0.01) + ", as mm " + sizeText(size.extent, 0.001) +
                   ", as ft " + sizeText(size.extent, 0.3048) + "; state it with --units or [model] units");
}

/// Sets the model's vertical: as asked, else as glTF has it or an OBJ seems to have it.
void chooseUpAxis(const std::filesystem::path& file, bool isObj, const ModelOptions& options, Scene& scene) {
  if (options.upAxis || !isObj) {
    scene.axes.upAxis = options.upAxis.value_or("y");
    return;
  }
  const UpAxis up = judgeUpAxis(file, scene);
  scene.axes.upAxis = up.axis;
  scene.axes.upAxisIsGuessed = true;
  if (up.axis == "y" || up.isDoubtful) {
    addDiagnosis(scene.diagnoses, {"C103",
                                   up.axis + " was taken for up, because " + up.reason +
                                       (up.isDoubtful ? "; there are signs of the other axis too" : "") +
                                       "; --up or [model] up says it for certain",
                                   file.string()});
  }
}

void leaveOutMarkers(Scene& scene) {
  std::vector<bool> isMarker;
  for (const std::string& object : scene.objects) isMarker.push_back(object.starts_with(markerObject));
  if (std::find(isMarker.begin(), isMarker.end(), true) == isMarker.end()) return;
  PolygonList faces;
  std::size_t kept = 0;
  for (std::size_t face = 0; face < scene.faces.size(); ++face) {
    if (isMarker[scene.faceObject[face]]) continue;
    faces.add(scene.faces[face]);
    scene.faceMaterial[kept] = scene.faceMaterial[face];
    scene.faceObject[kept] = scene.faceObject[face];
    ++kept;
  }
  scene.faces = std::move(faces);
  scene.faceMaterial.resize(kept);
  scene.faceObject.resize(kept);
  const auto first = std::find(isMarker.begin(), isMarker.end(), true);
  addDiagnosis(scene.diagnoses,
               {"C115", "markers of an earlier inspection were left out",
                "object \"" + scene.objects[static_cast<std::size_t>(first - isMarker.begin())] + "\"",
                static_cast<std::size_t>(std::count(isMarker.begin(), isMarker.end(), true))});
}

void bringUpright(Scene& scene) {
  const double metres = *metresOf(scene.axes.units);
  const bool isYUp = scene.axes.upAxis == "y";
  const auto upright = [&](const glm::dvec3& v) { return isYUp ? glm::dvec3(v.x, -v.z, v.y) : v; };
  for (glm::dvec3& point : scene.points) {
    point = upright(point) * metres;
  }
  for (PunctualLight& light : scene.lights) {
    light.position_m = upright(light.position_m) * metres;
    light.direction = upright(light.direction);
  }
}

void setScheme(Scene& scene, Cage& cage, const ModelOptions::Subdivide& rule) {
  cage.scheme = parseScheme(rule.scheme).value_or(cage.scheme);
  cage.tolerance_m = rule.tolerance_m.value_or(cage.tolerance_m);
  checkCage(cage, scene);
}

/// Applies one rule; later ones stand over earlier ones.
void applySubdivision(Scene& scene, const ModelOptions::Subdivide& rule) {
  std::vector<bool> matches(scene.objects.size());
  std::transform(scene.objects.begin(), scene.objects.end(), matches.begin(),
                 [&](const std::string& name) { return globMatches(rule.object, name); });
  if (std::find(matches.begin(), matches.end(), true) == matches.end()) {
    addDiagnosis(scene.diagnoses,
                 {"C143", "subdivision asked for objects that are not there", "\"" + rule.object + "\""});
    return;
  }
  std::vector<bool> chosen;
  for (Cage& cage : scene.cages) {
    chosen.push_back(matches[cage.object]);
    if (matches[cage.object] && rule.scheme != "none") {
      setScheme(scene, cage, rule);
    }
  }
  if (rule.scheme == "none") {
    moveCagesToFaces(scene, chosen);
    return;
  }
  std::map<std::uint32_t, Cage> cages;
  for (std::uint32_t object = 0; object < matches.size(); ++object) {
    if (matches[object]) {
      cages[object].scheme = *parseScheme(rule.scheme);
      cages[object].tolerance_m = rule.tolerance_m.value_or(Cage{}.tolerance_m);
    }
  }
  moveFacesToCages(scene, cages);
}

}  // namespace

Scene readModel(const std::filesystem::path& file, const ModelOptions& options) {
  checkOptions(options);
  const std::string ending = lowerCase(file.extension().string());
  const bool isObj = ending == ".obj";
  if (!isObj && ending != ".gltf" && ending != ".glb") {
    throw InputError(file.string() +
                     ": a model's name ends in .obj, .gltf or .glb; export it as one of these");
  }
  Scene scene = isObj ? readObj(file) : readGltf(file);
  leaveOutMarkers(scene);
  if (scene.faces.size() == 0 && scene.cages.empty()) {
    throw InputError(file.string() + ": there is no face in the model" + leftOutText(scene) +
                     "; check that the export has geometry");
  }
  chooseUnit(file, isObj, options, scene);
  chooseUpAxis(file, isObj, options, scene);
  bringUpright(scene);
  for (const ModelOptions::Subdivide& rule : options.subdivide) {
    applySubdivision(scene, rule);
  }
  return scene;
}

bool globMatches(std::string_view glob, std::string_view name) {
  const std::string pattern = lowerCase(glob);
  const std::string text = lowerCase(name);
  std::size_t p = 0;
  std::size_t t = 0;
  std::size_t star = std::string::npos;  // the last * met, and how far its run reaches
  std::size_t run = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      run = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (star != std::string::npos) {
      p = star + 1;
      t = ++run;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string::npos;
}

}  // namespace clerestory
