// SPDX-License-Identifier: GPL-3.0-or-later
// Collects what the steps of the clean-up notice, with the places where they notice it.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <geometry/building.hpp>

namespace clerestory {

class Findings {
 public:
  /// `objects`: their names by index; they have to outlive this.
  explicit Findings(std::span<const std::string> objects) : objects_(objects) {}

  /// What `code` speaks of: a face, polygon or cage of `object`, which counts `count` times. Of all that are
  /// noted the one with the largest `badness`, of equals the first by place and name, is named as the worst.
  void note(std::string_view code, std::span<const glm::dvec3> points, std::span<const std::uint32_t> corners,
            std::uint32_t object, double badness, std::size_t count = 1);

  /// Says in `message` what was noted under `code` so far and done about it; nothing if nothing was.
  void tell(std::string_view code, const std::string& message);

  [[nodiscard]] std::size_t count(std::string_view code) const;
  [[nodiscard]] const std::vector<Diagnosis>& diagnoses() const { return diagnoses_; }
  [[nodiscard]] const std::vector<Mark>& marks() const { return marks_; }

 private:
  struct Tally {
    std::size_t count = 0;
    double badness = 0.0;
    glm::dvec3 place_m{0.0};
    std::uint32_t object = 0;
  };
  std::span<const std::string> objects_;
  std::map<std::string, Tally, std::less<>> tallies_;
  std::vector<Diagnosis> diagnoses_;
  std::vector<Mark> marks_;
};

}  // namespace clerestory
