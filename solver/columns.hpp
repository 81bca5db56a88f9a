// SPDX-License-Identifier: GPL-3.0-or-later
// The columns of radiosity that one solve carries: a channel or three for each kind of light in the study.
#pragma once

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

#include <geometry/building.hpp>

/// Every width that a study may be solved in, as instantiate(K); ends a file of templates over K.
#define CLERESTORY_STUDY_WIDTHS(instantiate) \
  instantiate(1) instantiate(2) instantiate(4) instantiate(8) instantiate(12)

/// The widths of what shootingHR needs. CLERESTORY_WIDE_COLUMNS, set for a benchmark alone, adds 16 and the
/// 145 patches of a sky rounded up.
#ifdef CLERESTORY_WIDE_COLUMNS
#define CLERESTORY_TRANSPORT_WIDTHS(instantiate) \
  CLERESTORY_STUDY_WIDTHS(instantiate) instantiate(16) instantiate(152)
#else
#define CLERESTORY_TRANSPORT_WIDTHS(instantiate) CLERESTORY_STUDY_WIDTHS(instantiate)
#endif

namespace clerestory {

/// One value in every column. K is 1, 2, 4, 8 or 12; what a study does not use of it stays zero.
template <int K>
struct Columns {
  std::array<float, K> value{};

  float& operator[](int column) { return value[static_cast<std::size_t>(column)]; }
  float operator[](int column) const { return value[static_cast<std::size_t>(column)]; }
  Columns& operator+=(const Columns& other) {
    for (int c = 0; c < K; ++c) (*this)[c] += other[c];
    return *this;
  }
  Columns& operator*=(const Columns& other) {
    for (int c = 0; c < K; ++c) (*this)[c] *= other[c];
    return *this;
  }
  friend Columns operator*(float factor, Columns columns) {
    for (int c = 0; c < K; ++c) columns[c] *= factor;
    return columns;
  }
  friend Columns operator*(Columns a, const Columns& b) { return a *= b; }
  friend Columns operator+(Columns a, const Columns& b) { return a += b; }
  friend Columns operator-(Columns a, const Columns& b) {
    for (int c = 0; c < K; ++c) a[c] -= b[c];
    return a;
  }
};

/// Relative luminance of linear Rec.709.
inline double luminanceOf(const glm::dvec3& colour) {
  return 0.2126 * colour.r + 0.7152 * colour.g + 0.0722 * colour.b;
}

/// Which column is which.
struct ColumnLayout {
  bool grey = true;
  bool sky = false, sun = false, electric = false;

  [[nodiscard]] int channels() const { return grey ? 1 : 3; }
  [[nodiscard]] int used() const { return channels() * (int{sky} + int{sun} + int{electric}); }
  [[nodiscard]] int skyColumn() const { return sky ? 0 : -1; }
  [[nodiscard]] int sunColumn() const { return sun ? channels() * int{sky} : -1; }
  [[nodiscard]] int electricColumn() const { return electric ? channels() * (int{sky} + int{sun}) : -1; }

  /// A surface's property (reflectance, transmittance), the same for every kind of light.
  template <int K>
  [[nodiscard]] Columns<K> property(const glm::dvec3& colour) const {
    Columns<K> columns;
    if (sky) place(columns, skyColumn(), colour);
    if (sun) place(columns, sunColumn(), colour);
    if (electric) place(columns, electricColumn(), colour);
    return columns;
  }
  /// Light of one kind, whose columns begin at `first` (-1: not carried).
  template <int K>
  [[nodiscard]] Columns<K> light(int first, const glm::dvec3& colour) const {
    Columns<K> columns;
    if (first >= 0) place(columns, first, colour);
    return columns;
  }
  /// Colour of one kind of light; its first column is `first` (-1 gives black).
  template <int K>
  [[nodiscard]] glm::dvec3 colourOf(const Columns<K>& columns, int first) const {
    if (first < 0) return glm::dvec3(0.0);
    if constexpr (K >= 4) {  // fewer columns are grey always
      if (!grey) return {columns[first], columns[first + 1], columns[first + 2]};
    }
    return glm::dvec3(static_cast<double>(columns[greyColumn<K>(first)]));
  }
  template <int K>
  [[nodiscard]] glm::dvec3 totalColour(const Columns<K>& columns) const {
    return colourOf(columns, skyColumn()) + colourOf(columns, sunColumn()) +
           colourOf(columns, electricColumn());
  }
  /// What the oracle looks at: the strongest kind of light, by its luminance.
  template <int K>
  [[nodiscard]] float strength(const Columns<K>& columns) const {
    return static_cast<float>(
        std::max({luminanceOf(colourOf(columns, skyColumn())), luminanceOf(colourOf(columns, sunColumn())),
                  luminanceOf(colourOf(columns, electricColumn()))}));
  }

 private:
  template <int K>
  void place(Columns<K>& columns, int first, const glm::dvec3& colour) const {
    if constexpr (K >= 4) {
      if (!grey) {
        for (int c = 0; c < 3; ++c) columns[first + c] = static_cast<float>(colour[c]);
        return;
      }
    }
    columns[greyColumn<K>(first)] = static_cast<float>(luminanceOf(colour));
  }
  // Says nothing new (a first column is below K), but lets the compiler see it.
  template <int K>
  static int greyColumn(int first) {
    return std::min(first, K - 1);
  }
};

/// The columns that a building's materials and its light need: grey surfaces run one channel.
ColumnLayout columnsFor(const Building& building, bool skyIsBright, bool sunShines);

}  // namespace clerestory
