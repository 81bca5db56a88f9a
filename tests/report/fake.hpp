// SPDX-License-Identifier: GPL-3.0-or-later
// A made-up building of two rooms with made-up light, so that reports can be tested without a solver.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <report/report.hpp>

namespace clerestory::fake {

struct Case {
  Study study;
  Building building;
  Solution solution;
  std::vector<Diagnosis> diagnoses;

  [[nodiscard]] ReportInput input() const {
    return {study,
            building,
            solution,
            diagnoses,
            {"0.1.0",
             "clerestory study office.obj",
             2,
             std::size_t{16} << 20,
             {{"import", 0.02}, {"solve", 1.5}},
             std::size_t{90} << 20}};
  }
};

/// An L-shaped office with a window to the south and a rectangular store beside it; one view of 32 × 18
/// pixels.
Case office();

/// A folder of its own for one test, removed afterwards.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Names of everything in the folder itself, sorted.
  [[nodiscard]] std::vector<std::string> entries() const;

 private:
  std::filesystem::path path_;
};

inline std::string contentOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace clerestory::fake
