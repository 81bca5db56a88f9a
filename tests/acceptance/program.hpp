// SPDX-License-Identifier: GPL-3.0-or-later
// Studies run with the built program in a folder that goes with the test, and their tables.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "../import/tempfolder.hpp"
#include "../reference.hpp"

namespace clerestory {

inline std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  EXPECT_TRUE(stream) << file << " cannot be read";
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A table of RFC 4180 by its header's names.
class CsvTable {
 public:
  explicit CsvTable(const std::filesystem::path& file) {
    std::vector<std::vector<std::string>> rows{{""}};
    bool quoted = false;
    for (const char c : bytesOf(file)) {
      if (c == '"') {
        quoted = !quoted;  // a doubled quote closes and opens again
        if (quoted && !rows.back().back().empty()) rows.back().back() += '"';
      } else if (c == ',' && !quoted) {
        rows.back().emplace_back();
      } else if (c == '\n' && !quoted) {
        rows.push_back({""});
      } else if (c != '\r' || quoted) {
        rows.back().back() += c;
      }
    }
    EXPECT_FALSE(quoted) << file << " ends within quotes";
    EXPECT_EQ(rows.back(), std::vector<std::string>{""}) << file << " does not end with a line";
    rows.pop_back();
    EXPECT_GE(rows.size(), 2U) << file << " has no rows";
    for (std::size_t column = 0; column < rows.at(0).size(); ++column) columns_[rows[0][column]] = column;
    for (std::size_t row = 1; row < rows.size(); ++row) {
      EXPECT_EQ(rows[row].size(), columns_.size()) << file << " row " << row;
      rows_.push_back(rows[row]);
    }
  }

  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] const std::string& text(std::size_t row, const std::string& column) const {
    return rows_.at(row).at(columns_.at(column));
  }
  [[nodiscard]] double number(std::size_t row, const std::string& column) const {
    std::size_t read = 0;
    const double value = std::stod(text(row, column), &read);
    EXPECT_EQ(read, text(row, column).size()) << text(row, column) << " is no number";
    return value;
  }
  [[nodiscard]] std::vector<double> numbers(const std::string& column) const {
    std::vector<double> values;
    for (std::size_t row = 0; row < size(); ++row) values.push_back(number(row, column));
    return values;
  }

 private:
  std::map<std::string, std::size_t> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// The program in an empty folder that is its working directory.
class Workplace {
 public:
  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }
  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
  void copy(const std::filesystem::path& file) const {
    std::filesystem::copy_file(file, path() / file.filename());
  }
  /// Writes the sensors of a reference as a points file.
  void writePoints(const std::string& name, const std::vector<ReferencePoint>& points) const {
    std::ofstream stream(path() / name);
    stream.precision(9);
    stream << "x_m,y_m,z_m,nx,ny,nz\n";
    for (const ReferencePoint& point : points) {
      stream << point.place_m[0] << ',' << point.place_m[1] << ',' << point.place_m[2] << ",0,0,1\n";
    }
  }

  /// Runs a study without pictures into the folder `report`, which it returns; the test fails where the study
  /// does.
  [[nodiscard]] std::filesystem::path study(const std::string& arguments,
                                            const std::string& report = "report") const {
    const std::string command = "cd '" + path().string() + "' && '" CLERESTORY_PROGRAM "' study " +
                                arguments + " --no-pictures -o " + report +
                                " >output.txt 2>messages.txt </dev/null";
    const int status = std::system(command.c_str());
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << arguments << '\n'
                                                               << bytesOf(path() / "messages.txt");
    return path() / report;
  }

 private:
  TempFolder folder_;
};

/// A study of a model in the test's folder, to be followed by further sections.
inline std::string studyOf(const std::string& model) {
  return "[model]\nfile = \"" + model + "\"\n";
}

}  // namespace clerestory
