// SPDX-License-Identifier: GPL-3.0-or-later
// Reads subdivision tags of OBJ models: creases, corners, holes and the boundary rule.
#include "objtag.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace clerestory {
namespace {

/// The values of one tag, counted as its head says.
struct TagValues {
  std::vector<std::uint32_t> integers;
  std::vector<float> floats;
};

/// `n/m/k`: how many integers, floats and strings follow.
std::array<std::size_t, 3> tagCounts(std::string_view word, const Place& place) {
  std::array<std::size_t, 3> counts{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t slash = word.find('/');
    const auto count = parseInteger(word.substr(0, slash));
    if (!count || *count < 0 || *count > std::numeric_limits<std::int32_t>::max() ||
        (slash == std::string_view::npos) != (i == 2)) {
      failAt(place, "a tag states its counts as integers/floats/strings, for instance 2/1/0");
    }
    counts[i] = static_cast<std::size_t>(*count);
    word.remove_prefix(i == 2 ? word.size() : slash + 1);
  }
  return counts;
}

TagValues tagValues(std::span<const std::string_view> words, const Place& place) {
  const auto counts = tagCounts(words[2], place);
  if (words.size() - 3 != counts[0] + counts[1] + counts[2]) {
    failAt(place, "the tag's counts announce " + std::to_string(counts[0] + counts[1] + counts[2]) +
                      " values, but " + std::to_string(words.size() - 3) + " follow");
  }
  TagValues values;
  for (const std::string_view word : words.subspan(3, counts[0])) {
    const auto value = parseInteger(word);
    if (!value || *value < 0 || *value > std::numeric_limits<std::uint32_t>::max()) {
      failAt(place, "\"" + cleanName(word) + "\" is not an index (0, 1, 2 …)");
    }
    values.integers.push_back(static_cast<std::uint32_t>(*value));
  }
  for (const std::string_view word : words.subspan(3 + counts[0], counts[1])) {
    const auto value = parseNumber(word);
    if (!value || *value < 0.0) {
      failAt(place, "\"" + cleanName(word) + "\" is not a sharpness (0 or more)");
    }
    values.floats.push_back(static_cast<float>(std::min(*value, 10.0)));
  }
  return values;
}

void checkPoints(const TagValues& values, std::size_t points, const Place& place) {
  for (const std::uint32_t point : values.integers) {
    if (point >= points) {
      failAt(place, "a tag names vertex " + std::to_string(point) + ", but the last given so far is " +
                        std::to_string(static_cast<std::int64_t>(points) - 1) + " (tags count from 0)");
    }
  }
}

/// A chain of points with one sharpness for all its edges, or one for each.
void addCrease(const TagValues& values, std::size_t points, const Place& place, Cage& cage) {
  const std::size_t edges = values.integers.empty() ? 0 : values.integers.size() - 1;
  if (edges == 0 || (values.floats.size() != 1 && values.floats.size() != edges)) {
    failAt(place, "a crease has two or more vertices and one sharpness, or one for each edge");
  }
  checkPoints(values, points, place);
  for (std::size_t i = 0; i < edges; ++i) {
    cage.creases.push_back(
        {values.integers[i], values.integers[i + 1], values.floats[values.floats.size() == 1 ? 0 : i]});
  }
}

void addCorners(const TagValues& values, std::size_t points, const Place& place, Cage& cage) {
  if (values.integers.empty() ||
      (values.floats.size() != 1 && values.floats.size() != values.integers.size())) {
    failAt(place, "a corner tag has vertices and one sharpness, or one for each vertex");
  }
  checkPoints(values, points, place);
  for (std::size_t i = 0; i < values.integers.size(); ++i) {
    cage.corners.push_back({values.integers[i], values.floats[values.floats.size() == 1 ? 0 : i]});
  }
}

void setBoundary(const TagValues& values, const Place& place, Cage& cage) {
  if (values.integers.size() != 1 || values.integers[0] > 2) {
    failAt(place, "interpolateboundary is 0 (none), 1 (edges and corners) or 2 (edges)");
  }
  cage.boundary = std::array{Cage::Boundary::none, Cage::Boundary::edgeAndCorner,
                             Cage::Boundary::edgeOnly}[values.integers[0]];
}

}  // namespace

bool readObjTag(std::span<const std::string_view> words, std::size_t points, const Place& place, Cage& cage) {
  if (words.size() < 3) {
    failAt(place, "a tag has a name and counts, for instance t crease 2/1/0 0 1 2.0");
  }
  const std::string_view name = words[1];
  if (name == "crease") {
    addCrease(tagValues(words, place), points, place, cage);
  } else if (name == "corner") {
    addCorners(tagValues(words, place), points, place, cage);
  } else if (name == "interpolateboundary") {
    setBoundary(tagValues(words, place), place, cage);
  } else if (name == "hole") {
    const TagValues values = tagValues(words, place);
    cage.holes.insert(cage.holes.end(), values.integers.begin(), values.integers.end());
  } else {
    return false;
  }
  return true;
}

}  // namespace clerestory
