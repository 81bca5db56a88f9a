// SPDX-License-Identifier: GPL-3.0-or-later
// Pane units: Fresnel's formulae at a face, the adding method for a sheet and for sheets behind one another.
//
// Fresnel, A.: Memoire sur la loi des modifications que la reflexion imprime a la lumiere polarisee, 1823.
// Stokes, G. G.: On the intensity of the light reflected from or transmitted through a pile of plates, 1862.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include <solver/glass.hpp>

namespace clerestory {
namespace {

constexpr std::size_t kTableSize = 1024;

/// What passes and what returns, of one polarisation or of their mean.
struct Pane {
  double transmittance, reflectance;
};

/// A layer in front of another, both the same from either side; so is the sum only if they are equal.
Pane add(const Pane& pile, const Pane& sheet) {
  const double between = 1.0 / (1.0 - pile.reflectance * sheet.reflectance);
  return {pile.transmittance * sheet.transmittance * between,
          pile.reflectance + pile.transmittance * pile.transmittance * sheet.reflectance * between};
}

/// `passed` is the internal transmittance along the refracted path, `face` the reflectance of a face.
Pane pileOfSheets(double face, double passed, int sheets) {
  const double transmittance = passed * (1.0 - face) * (1.0 - face) / (1.0 - face * face * passed * passed);
  const Pane sheet{transmittance, face * (1.0 + passed * transmittance)};
  Pane pile = sheet;
  for (int i = 1; i < sheets; ++i) pile = add(pile, sheet);
  return pile;
}

/// internal is the transmittance of a sheet's bulk at normal incidence, cosIncidence in [0, 1].
Pane paneUnit(double cosIncidence, double internal, int sheets, double index) {
  if (cosIncidence <= 0.0) return {0.0, 1.0};
  const double sinInside2 = (1.0 - cosIncidence * cosIncidence) / (index * index);
  const double cosInside = std::sqrt(1.0 - sinInside2);
  const double s = (cosIncidence - index * cosInside) / (cosIncidence + index * cosInside);
  const double p = (index * cosIncidence - cosInside) / (index * cosIncidence + cosInside);
  const double passed = std::pow(internal, 1.0 / cosInside);
  const Pane across = pileOfSheets(s * s, passed, sheets), along = pileOfSheets(p * p, passed, sheets);
  return {0.5 * (across.transmittance + along.transmittance), 0.5 * (across.reflectance + along.reflectance)};
}

/// The sheets' internal transmittance with which the unit passes what is stated; 1 where none does.
double fitInternal(double normalTransmittance, int sheets, double index) {
  double low = 0.0, high = 1.0;
  if (paneUnit(1.0, high, sheets, index).transmittance <= normalTransmittance) return high;
  while (true) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) return middle;
    (paneUnit(1.0, middle, sheets, index).transmittance < normalTransmittance ? low : high) = middle;
  }
}

/// The cosine-weighted mean of a function given linearly between the entries of a table.
glm::dvec2 cosineMean(const std::vector<glm::vec2>& table) {
  const double step = 1.0 / static_cast<double>(table.size() - 1);
  glm::dvec2 sum(0.0);
  for (std::size_t i = 0; i + 1 < table.size(); ++i) {
    const double from = static_cast<double>(i) * step, to = from + step;
    const glm::dvec2 atFrom(table[i]), atTo(table[i + 1]);
    sum += step / 3.0 * ((2.0 * from + to) * atFrom + (from + 2.0 * to) * atTo);
  }
  return sum;
}

glm::vec2 lookUp(const std::vector<glm::vec2>& table, float cosIncidence) {
  const float place = std::min(std::abs(cosIncidence), 1.0F) * static_cast<float>(kTableSize - 1);
  const std::size_t index = std::min(static_cast<std::size_t>(place), kTableSize - 2);
  return table[index] + (place - static_cast<float>(index)) * (table[index + 1] - table[index]);
}

}  // namespace

Glass::Glass(double normalTransmittance, int sheets, double refractiveIndex) : table_(kTableSize) {
  if (!(normalTransmittance >= 0.0 && normalTransmittance <= 1.0) || sheets < 1 || !(refractiveIndex >= 1.0))
    throw std::invalid_argument(
        "a pane needs a transmittance in [0, 1], a sheet or more and an index of 1 or more");
  const double internal = fitInternal(normalTransmittance, sheets, refractiveIndex);
  const double clearest = paneUnit(1.0, internal, sheets, refractiveIndex).transmittance;
  const bool scaled = internal == 1.0 && normalTransmittance > clearest;
  for (std::size_t i = 0; i < kTableSize; ++i) {
    const double cosIncidence = static_cast<double>(i) / static_cast<double>(kTableSize - 1);
    Pane pane = paneUnit(cosIncidence, internal, sheets, refractiveIndex);
    if (scaled) pane.transmittance *= normalTransmittance / clearest;
    if (scaled) pane.reflectance = 1.0 - pane.transmittance;
    if (normalTransmittance == 1.0) pane = {1.0, 0.0};
    table_[i] = glm::vec2(static_cast<float>(pane.transmittance), static_cast<float>(pane.reflectance));
  }
  hemispherical_ = cosineMean(table_);
}

Glass Glass::cie171Clear() {
  const auto polynomial = [](double c) {
    return -0.028378 + c * (3.156075 + c * (-3.058376 + c * (-1.428919 + c * (4.014235 - 1.775827 * c))));
  };
  Glass glass(polynomial(1.0));
  for (std::size_t i = 0; i < kTableSize; ++i) {
    const double cosIncidence = static_cast<double>(i) / static_cast<double>(kTableSize - 1);
    const auto transmittance = static_cast<float>(std::clamp(polynomial(cosIncidence), 0.0, 1.0));
    glass.table_[i] = {transmittance, std::min(glass.table_[i].y, 1.0F - transmittance)};
  }
  glass.hemispherical_ = cosineMean(glass.table_);
  return glass;
}

float Glass::transmittance(float cosIncidence) const {
  return lookUp(table_, cosIncidence).x;
}
float Glass::reflectance(float cosIncidence) const {
  return lookUp(table_, cosIncidence).y;
}
double Glass::transmittance(double cosIncidence) const {
  return static_cast<double>(transmittance(static_cast<float>(cosIncidence)));
}
double Glass::reflectance(double cosIncidence) const {
  return static_cast<double>(reflectance(static_cast<float>(cosIncidence)));
}

}  // namespace clerestory
