// SPDX-License-Identifier: GPL-3.0-or-later
// Reads EULUMDAT: one value a line, in a fixed order (Stockmar 1990; absolute photometry by a negative number
// of lamps, Ashdown and DIAL).
#include "eulumdat.hpp"

#include <algorithm>
#include <cmath>

#include "photometrygrid.hpp"
#include "textfile.hpp"

namespace clerestory {
namespace {

constexpr double kMillimetre_m = 0.001;
constexpr double kFluxTolerance = 0.05;  // planes far apart and rounding make a few per cent

/// The lines of a file, taken one by one.
class LdtLines {
 public:
  LdtLines(std::string_view text, std::string file) : place_{std::move(file), 0} {
    text = text.substr(0, text.find('\x1A'));  // the end of a text under DOS
    while (!text.empty()) {
      const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
      lines_.push_back(trimmed(text.substr(0, end)));
      text.remove_prefix(std::min(end + (text.substr(end).starts_with("\r\n") ? 2 : 1), text.size()));
    }
  }

  [[nodiscard]] const Place& place() const { return place_; }
  /// The line so many after the next, or nothing.
  [[nodiscard]] std::string_view ahead(std::size_t lines) const {
    return place_.line + lines < lines_.size() ? lines_[place_.line + lines] : std::string_view();
  }
  void skip(std::size_t lines) { place_.line += lines; }

  std::string_view line(const std::string& what) {
    if (place_.line >= lines_.size()) {
      failAt({place_.file, lines_.size()}, "the file ends where " + what + " should stand");
    }
    return lines_[place_.line++];
  }

  double number(const std::string& what) {
    const std::string_view text = line(what);
    const auto value = numberOf(text);
    if (!value) failAt(place_, "\"" + cleanName(text) + "\" should be " + what + ", a number");
    return *value;
  }

  std::int64_t whole(const std::string& what, std::int64_t low, std::int64_t high) {
    const double value = number(what);
    if (value != std::floor(value) || value < static_cast<double>(low) || value > static_cast<double>(high)) {
      failAt(place_, what + " is " + numberText(value) + "; it has to be a whole number from " +
                         std::to_string(low) + " to " + std::to_string(high));
    }
    return static_cast<std::int64_t>(value);
  }

  std::vector<double> numbers(std::int64_t count, const std::string& what) {
    std::vector<double> values;
    for (std::int64_t i = 1; i <= count; ++i)
      values.push_back(number(what + " " + std::to_string(i) + " of " + std::to_string(count)));
    return values;
  }

  void expectEnd() {
    for (; place_.line < lines_.size(); ++place_.line) {
      if (lines_[place_.line].empty()) continue;
      failAt({place_.file, place_.line + 1},
             "\"" + cleanName(lines_[place_.line]) +
                 "\" is left over after the last intensity; symmetry and numbers of angles do not fit");
    }
  }

  /// Some programs write a comma before the decimals.
  static std::optional<double> numberOf(std::string_view text) {
    std::string point(text);
    std::replace(point.begin(), point.end(), ',', '.');
    return parseNumber(point);
  }

 private:
  std::vector<std::string_view> lines_;
  Place place_;
};

/// The first set of lamps; others are alternatives to it.
struct LampSet {
  double count = 0.0, flux_lm = 0.0, power_w = 0.0;
};

/// Six lines for each set. Most programs write set after set, some each line for all sets.
LampSet readLampSets(LdtLines& lines, std::int64_t sets) {
  const auto count = static_cast<std::size_t>(sets);
  const bool bySet = sets == 1 || (LdtLines::numberOf(lines.ahead(2)) && LdtLines::numberOf(lines.ahead(6)) &&
                                   LdtLines::numberOf(lines.ahead(8)));
  const std::size_t step = bySet ? 1 : count;
  LampSet first;
  first.count = lines.number("the number of lamps");
  lines.skip(2 * step - 1);
  first.flux_lm = lines.number("the luminous flux of the lamps");
  if (!(first.flux_lm > 0.0)) failAt(lines.place(), "the luminous flux of the lamps has to be above 0");
  lines.skip(3 * step - 1);
  first.power_w = std::max(LdtLines::numberOf(lines.line("the wattage")).value_or(0.0), 0.0);
  lines.skip(bySet ? 6 * (count - 1) : count - 1);
  return first;
}

/// Planes that the file lists, by its symmetry: the first, and how many.
struct Listed {
  std::int64_t first, count;
};

Listed listedPlanes(std::int64_t symmetry, std::int64_t planes) {
  switch (symmetry) {
    case 1:
      return {0, 1};
    case 2:
      return {0, planes / 2 + 1};
    case 3:
      return {3 * planes / 4, planes / 2 + 1};
    case 4:
      return {0, planes / 4 + 1};
    default:
      return {0, planes};
  }
}

/// Mirrors need planes in their own planes of symmetry.
void checkEnds(std::int64_t symmetry, const std::vector<double>& listed_deg, const Place& place) {
  if (symmetry < 2) return;
  const double first_deg = symmetry == 3 ? 270.0 : 0.0;
  const double last_deg = symmetry == 2 ? 180.0 : symmetry == 3 ? 450.0 : 90.0;
  if (std::abs(listed_deg.front() - first_deg) > 1e-3 || std::abs(listed_deg.back() - last_deg) > 1e-3) {
    failAt(place, "symmetry " + std::to_string(symmetry) + " needs planes from C" + numberText(first_deg) +
                      " to C" + numberText(std::fmod(last_deg, 360.0)) + ", but they go from C" +
                      numberText(listed_deg.front()) + " to C" +
                      numberText(std::fmod(listed_deg.back(), 360.0)));
  }
}

/// The listed planes all around the nadir.
IntensityDistribution distributionOf(std::int64_t symmetry, const Listed& listed,
                                     const std::vector<double>& c_deg, std::vector<double> gamma_deg,
                                     std::vector<double> intensity_cd, const Place& place) {
  IntensityDistribution distribution;
  for (std::int64_t i = 0; i < listed.count; ++i) {
    const std::int64_t index = listed.first + i;
    const auto planes = static_cast<std::int64_t>(c_deg.size());
    distribution.longitude_deg.push_back(c_deg[static_cast<std::size_t>(index % planes)] +
                                         (index >= planes ? 360.0 : 0.0));
  }
  checkEnds(symmetry, distribution.longitude_deg, place);
  for (double& gamma : gamma_deg) gamma -= 90.0;
  distribution.latitude_deg = std::move(gamma_deg);
  distribution.intensity_cd = std::move(intensity_cd);
  if (symmetry == 4) mirrorPlanes(distribution.longitude_deg, distribution.intensity_cd, true);
  if (symmetry >= 2) mirrorPlanes(distribution.longitude_deg, distribution.intensity_cd, true);
  closeCircle(distribution.longitude_deg, distribution.intensity_cd, place);
  return distribution;
}

/// Length lies along C90, width along C0; a width of 0 is round. Of four heights the greatest counts.
LuminousOpening readOpening(LdtLines& lines) {
  const std::vector<double> sizes_mm = lines.numbers(6, "size of the luminous area");
  for (const double size_mm : sizes_mm) {
    if (size_mm < 0.0 || size_mm > 100'000.0) {
      failAt(lines.place(), "the luminous area's sizes have to be from 0 to 100,000 mm");
    }
  }
  const double length_m = sizes_mm[0] * kMillimetre_m;
  const double width_m = sizes_mm[1] * kMillimetre_m;
  const double height_m = *std::max_element(sizes_mm.begin() + 2, sizes_mm.end()) * kMillimetre_m;
  if (width_m == 0.0)
    return {LuminousOpening::Form::verticalCylinder, {length_m, length_m, length_m > 0.0 ? height_m : 0.0}};
  return {LuminousOpening::Form::box, {width_m, length_m, height_m}};
}

}  // namespace

Photometry readEulumdat(const std::string& bytes, const std::filesystem::path& file) {
  const std::string name = file.string();
  LdtLines lines(plainText(bytes, name), name);
  Photometry photometry;
  photometry.format = "EULUMDAT";
  photometry.text = plainText(bytes, name);

  lines.line("the company");
  lines.whole("the type indicator", 0, 3);
  const std::int64_t symmetry = lines.whole("the symmetry indicator", 0, 4);
  const std::int64_t planes = lines.whole("the number of C-planes", 1, 720);
  if ((symmetry >= 2 && planes % 2 != 0) || (symmetry >= 3 && planes % 4 != 0)) {
    failAt(lines.place(),
           "symmetry " + std::to_string(symmetry) + " cannot have " + std::to_string(planes) + " C-planes");
  }
  lines.number("the distance between C-planes");
  const std::int64_t gammas = lines.whole("the number of intensities in a C-plane", 2, 3600);
  lines.number("the distance between intensities");
  lines.line("the report's number");
  photometry.name = cleanName(lines.line("the luminaire's name"));
  lines.line("the luminaire's number");
  lines.line("the file's name");
  lines.line("the date");
  if (photometry.name.empty()) photometry.name = cleanName(file.stem().string());
  lines.numbers(3, "size of the luminaire");
  photometry.opening = readOpening(lines);
  lines.number("the downward flux fraction");
  const double outputRatio_pct = lines.number("the light output ratio");
  const double conversion = lines.number("the conversion factor");
  if (!(conversion > 0.0)) failAt(lines.place(), "the conversion factor has to be above 0");
  lines.number("the tilt during measurement");
  const std::int64_t sets = lines.whole("the number of sets of lamps", 1, 20);
  if (sets > 1) {
    photometry.diagnoses.push_back(
        {"C161", "a photometric file has several sets of lamps; the first was taken", name});
  }
  const LampSet lamps = readLampSets(lines, sets);
  lines.numbers(10, "direct ratio");

  const std::vector<double> c_deg = lines.numbers(planes, "C-angle");
  checkAngles(c_deg, 0.0, 360.0, "C-angle", lines.place());
  const std::vector<double> gamma_deg = lines.numbers(gammas, "gamma");
  checkAngles(gamma_deg, 0.0, 180.0, "gamma", lines.place());
  const Place anglePlace = lines.place();
  const Listed listed = listedPlanes(symmetry, planes);
  std::vector<double> intensity_cd = lines.numbers(listed.count * gammas, "intensity");
  checkIntensities(intensity_cd, lines.place());
  lines.expectEnd();
  for (double& intensity : intensity_cd) intensity *= conversion * lamps.flux_lm / 1000.0;  // from cd/klm
  photometry.distribution =
      distributionOf(symmetry, listed, c_deg, gamma_deg, std::move(intensity_cd), anglePlace);
  photometry.lampFlux_lm = lamps.count < 0.0 ? 0.0 : lamps.flux_lm;
  photometry.power_w = lamps.power_w;
  const double stated_lm = lamps.flux_lm * (lamps.count < 0.0 ? 1.0 : outputRatio_pct / 100.0);
  if (std::abs(photometry.distribution.flux_lm() - stated_lm) > kFluxTolerance * stated_lm) {
    photometry.diagnoses.push_back(
        {"C162", "the intensities of a photometric file do not add up to the flux it states; they count",
         name});
  }
  return photometry;
}

}  // namespace clerestory
