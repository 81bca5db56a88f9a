// SPDX-License-Identifier: GPL-3.0-or-later
// Collects what the steps of the clean-up notice, with the places where they notice it.
#include "findings.hpp"

#include <glm/common.hpp>

#include "soup.hpp"

namespace clerestory {

void Findings::note(std::string_view code, std::span<const glm::dvec3> points,
                    std::span<const std::uint32_t> corners, std::uint32_t object, double badness,
                    std::size_t count) {
  glm::dvec3 middle(0.0);
  for (const std::uint32_t corner : corners) middle += points[corner];
  if (!corners.empty()) middle /= static_cast<double>(corners.size());
  const auto [found, isNew] = tallies_.try_emplace(std::string(code));
  Tally& tally = found->second;
  tally.count += count;
  const auto isBefore = [&] {
    return lexicographicallyLess(middle, tally.place_m) ||
           (middle == tally.place_m && objects_[object] < objects_[tally.object]);
  };
  if (isNew || badness > tally.badness || (badness == tally.badness && isBefore())) {
    tally.badness = badness;
    tally.place_m = middle;
    tally.object = object;
  }
  Mark mark{std::string(code), objects_[object], middle};
  const bool isAgain = !marks_.empty() && marks_.back().code == mark.code &&
                       marks_.back().object == mark.object && marks_.back().place_m == mark.place_m;
  if (!isAgain) marks_.push_back(std::move(mark));
}

void Findings::tell(std::string_view code, const std::string& message) {
  const auto found = tallies_.find(code);
  if (found == tallies_.end()) return;
  const Tally& tally = found->second;
  std::erase_if(diagnoses_, [&](const Diagnosis& earlier) { return earlier.code == code; });
  diagnoses_.push_back(
      {std::string(code), message, "object \"" + objects_[tally.object] + "\"", tally.count, tally.place_m});
}

std::size_t Findings::count(std::string_view code) const {
  const auto found = tallies_.find(code);
  return found == tallies_.end() ? 0 : found->second.count;
}

}  // namespace clerestory
