// SPDX-License-Identifier: GPL-3.0-or-later
// How every part of the program says that something is wrong: two exceptions, and diagnoses that do not stop
// it.
#pragma once

#include <glm/vec3.hpp>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace clerestory {

/// The input is wrong; the program ends with exit code 1.
/// The text says what is wrong, where (file and line, JSON pointer, material or surface name) and what to do.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The machine failed (disk, memory); the program ends with exit code 3.
struct MachineError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Something that was noticed and dealt with, or could not be; shown once and listed in the report.
struct Diagnosis {
  std::string code;       ///< stable: C1xx import, G2xx geometry, S3xx solver
  std::string message;    ///< what, and what was done about it
  std::string where;      ///< file and line, JSON pointer, material or object name; may be empty
  std::size_t count = 1;  ///< how often it was met
  std::optional<glm::dvec3> place_m{};  ///< of one that has a place: where it is worst
};

/// Where a diagnosis was met, worst of all if it knows: object "Wall" at (1.20, 3.40, 0.00); may be empty.
std::string whereText(const Diagnosis& diagnosis);

/// Adds one more of what `diagnosis` says: raises the count where the list has the code and message already.
void addDiagnosis(std::vector<Diagnosis>& list, Diagnosis diagnosis);

}  // namespace clerestory
