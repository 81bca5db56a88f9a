// SPDX-License-Identifier: GPL-3.0-or-later
// Tables and numbers as text for a terminal.
#pragma once

#include <string>
#include <vector>

namespace clerestory {

/// A table of text whose columns are as wide as what stands in them; all but the first and the last are
/// numbers.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> header) { rows_.push_back(std::move(header)); }
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  [[nodiscard]] std::string text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

std::string number(double value, int digits);

}  // namespace clerestory
