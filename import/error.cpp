// SPDX-License-Identifier: GPL-3.0-or-later
// Collects diagnoses so that each is told once, with how often it was met.
#include <algorithm>
#include <cstdio>

#include <import/error.hpp>

namespace clerestory {

std::string whereText(const Diagnosis& diagnosis) {
  if (!diagnosis.place_m) return diagnosis.where;
  const glm::dvec3& place_m = *diagnosis.place_m;
  char text[100];
  std::snprintf(text, sizeof text, "at (%.2f, %.2f, %.2f)", place_m.x, place_m.y, place_m.z);
  return diagnosis.where.empty() ? text : diagnosis.where + ' ' + text;
}

void addDiagnosis(std::vector<Diagnosis>& list, Diagnosis diagnosis) {
  const auto same = std::find_if(list.begin(), list.end(), [&](const Diagnosis& other) {
    return other.code == diagnosis.code && other.message == diagnosis.message;
  });
  if (same == list.end()) {
    list.push_back(std::move(diagnosis));
  } else {
    same->count += diagnosis.count;
  }
}

}  // namespace clerestory
