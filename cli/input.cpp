// SPDX-License-Identifier: GPL-3.0-or-later
// Reads what the command line names, by its ending.
#include "input.hpp"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <iostream>

namespace clerestory {

namespace {

// Refuses all but `known` in words that list them.
CLI::Validator oneOf(std::initializer_list<std::string> known) {
  const std::vector<std::string> values(known);
  return {[values](const std::string& text) -> std::string {
            if (std::find(values.begin(), values.end(), text) != values.end()) {
              return {};
            }
            std::string message = "\"" + text + "\" is none of";
            for (const std::string& value : values) {
              message += " " + value;
            }
            return message;
          },
          ""};
}

void addAll(const std::vector<Diagnosis>& more, std::vector<Diagnosis>& diagnoses) {
  for (const Diagnosis& diagnosis : more) addDiagnosis(diagnoses, diagnosis);
}

}  // namespace

bool isStudyFile(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending == ".toml";
}

void addInputArguments(CLI::App& command, InputArguments& arguments) {
  command.add_option("STUDY.toml|MODEL", arguments.file, "a study, or a model alone: .obj .gltf .glb")
      ->required()
      ->option_text(" ");
  command
      .add_option("--units", arguments.units,
                  "what the model's numbers are: m cm mm ft in (m where that is possible)")
      ->option_text("UNIT")
      ->check(oneOf({"m", "cm", "mm", "ft", "in"}));
  command.add_option("--up", arguments.upAxis, "the model's vertical axis: y or z (OBJ: guessed, glTF: y)")
      ->option_text("AXIS")
      ->check(oneOf({"y", "z"}));
}

Study readInput(const InputArguments& arguments) {
  Study study = isStudyFile(arguments.file) ? readStudy(arguments.file) : studyOfModel(arguments.file);
  if (arguments.units) {
    study.model.units = arguments.units;
  }
  if (arguments.upAxis) {
    study.model.upAxis = arguments.upAxis;
  }
  return study;
}

Scene readScene(const Study& study, std::vector<Diagnosis>& diagnoses,
                const std::function<void(const std::string& step)>& begin) {
  begin("reading the model");
  Scene scene = readModel(study.modelFile, study.model);
  applyMaterialRules(study, scene);
  addSurroundings(study, scene);
  addAll(scene.diagnoses, diagnoses);
  return scene;
}

CleanModel cleanModel(const Scene& scene, std::vector<Diagnosis>& diagnoses,
                      const std::function<void(const std::string& step)>& begin) {
  begin("cleaning the model");
  CleanModel model = cleanScene(scene);
  addAll(model.diagnoses, diagnoses);
  return model;
}

Building readBuilding(const Study& study, std::vector<Diagnosis>& diagnoses,
                      const std::function<void(const std::string& step)>& begin) {
  CleanModel model = cleanModel(readScene(study, diagnoses, begin), diagnoses, begin);
  begin("finding rooms");
  Building building = makeBuilding(std::move(model), study);
  addAll(building.diagnoses, diagnoses);
  return building;
}

std::string warningText(const Diagnosis& diagnosis) {
  std::string text = diagnosis.code + " " + diagnosis.message;
  const std::string where = whereText(diagnosis);
  if (!where.empty()) text += " (" + where + (diagnosis.count > 1 ? " and elsewhere" : "") + ")";
  if (diagnosis.count > 1) {
    text += ", " + std::to_string(diagnosis.count) + " times";
  }
  return text;
}

void printResult(const std::string& text) {
  std::cout << text << std::flush;
  if (!std::cout) {
    throw MachineError("standard output cannot be written");
  }
}

}  // namespace clerestory
