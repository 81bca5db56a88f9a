// SPDX-License-Identifier: GPL-3.0-or-later
// The input that every command starts from: a study or a model alone, read and made into a building.
#pragma once

#include <CLI/CLI.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <geometry/building.hpp>
#include <import/study.hpp>

namespace clerestory {

/// What a command line says about its input.
struct InputArguments {
  std::filesystem::path file;  ///< a study or a model
  std::optional<std::string> units;
  std::optional<std::string> upAxis;
};

/// Whether the file is a study; else it is a model alone.
bool isStudyFile(const std::filesystem::path& file);

/// Adds the input and what may be said about it to `command`; they are stored in `arguments`.
void addInputArguments(CLI::App& command, InputArguments& arguments);

/// The study in the named file, or that of the named model alone; the command line stands over both.
Study readInput(const InputArguments& arguments);

/// Reads the study's model with its materials and surroundings. `begin` and `diagnoses` as below.
Scene readScene(const Study& study, std::vector<Diagnosis>& diagnoses,
                const std::function<void(const std::string& step)>& begin);

/// Cleans it likewise.
CleanModel cleanModel(const Scene& scene, std::vector<Diagnosis>& diagnoses,
                      const std::function<void(const std::string& step)>& begin);

/// Reads and cleans the study's model and finds its rooms. `begin` is told of each step before it begins;
/// what the steps have to say is added to `diagnoses`.
Building readBuilding(const Study& study, std::vector<Diagnosis>& diagnoses,
                      const std::function<void(const std::string& step)>& begin);

/// A diagnosis in one line.
std::string warningText(const Diagnosis& diagnosis);

/// Prints `text` on standard output. Throws MachineError where it cannot be written.
void printResult(const std::string& text);

}  // namespace clerestory
