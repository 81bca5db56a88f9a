// SPDX-License-Identifier: GPL-3.0-or-later
// Collects diagnoses so that each is told once, with how often it was met.
#include <algorithm>

#include <import/error.hpp>

namespace clerestory {

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
