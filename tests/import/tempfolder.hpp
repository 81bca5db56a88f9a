// SPDX-License-Identifier: GPL-3.0-or-later
// A folder for one test's files, and what the tests say about errors and diagnoses.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <import/error.hpp>

namespace clerestory {

/// An empty folder that goes when the object goes.
class TempFolder {
 public:
  TempFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string("clerestory-") + test->test_suite_name() + "-" + test->name() + "-" +
                       std::to_string(getpid());
    std::replace(name.begin(), name.end(), '/', '-');
    path_ = std::filesystem::temp_directory_path() / name;
    std::filesystem::create_directories(path_);
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  /// Writes `text` to the file `name` and returns its path.
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    const auto file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The message of the InputError that `action` throws; empty where it throws none.
template <typename Action>
std::string inputErrorOf(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

inline std::size_t countOf(const std::vector<Diagnosis>& list, const std::string& code) {
  std::size_t count = 0;
  for (const Diagnosis& diagnosis : list) {
    count += diagnosis.code == code ? diagnosis.count : 0;
  }
  return count;
}

}  // namespace clerestory
