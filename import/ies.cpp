// SPDX-License-Identifier: GPL-3.0-or-later
// Reads LM-63: a header of lines up to TILT=, then numbers parted by blanks, commas and line ends.
#include "ies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "photometrygrid.hpp"
#include "textfile.hpp"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMostTiltBytes = 1U << 20U;
constexpr std::int64_t kMostAngles = 20'000;
constexpr double kFoot_m = 0.3048;

/// Takes lines, and after the header numbers, off a text.
class IesText {
 public:
  IesText(std::string_view text, std::string file) : rest_(text), place_{std::move(file), 0} {
    rest_ = rest_.substr(0, rest_.find('\x1A'));  // the end of a text under DOS
  }

  [[nodiscard]] const Place& place() const { return place_; }
  [[nodiscard]] std::string_view rest() const { return rest_; }

  bool nextLine(std::string_view& line) {
    if (rest_.empty()) return false;
    ++place_.line;
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + (rest_.substr(end).starts_with("\r\n") ? 2 : 1), rest_.size()));
    return true;
  }

  double number(const std::string& what) {
    const std::string_view word = nextWord();
    if (word.empty()) failAt(place_, "the file ends where " + what + " should stand");
    const auto value = parseNumber(word);
    if (!value) failAt(place_, "\"" + cleanName(word) + "\" should be " + what + ", a number");
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
    for (std::int64_t i = 1; i <= count; ++i) {
      values.push_back(number(what + " " + std::to_string(i) + " of " + std::to_string(count)));
    }
    return values;
  }

  void expectEnd() {
    const std::string_view word = nextWord();
    if (!word.empty()) {
      failAt(place_, "\"" + cleanName(word) +
                         "\" is left over after the last intensity; the numbers of angles do not fit");
    }
  }

 private:
  std::string_view nextWord() {
    while (true) {
      const std::size_t first = line_.find_first_not_of(" \t\v\f,");
      if (first != std::string_view::npos) {
        line_.remove_prefix(first);
        const std::string_view word = line_.substr(0, line_.find_first_of(" \t\v\f,"));
        line_.remove_prefix(word.size());
        return word;
      }
      if (!nextLine(line_)) return {};
    }
  }

  std::string_view rest_;
  std::string_view line_;
  Place place_;
};

/// What the line up to TILT= say.
struct Header {
  int edition = 1986;
  std::string name;
  std::string tilt;                     ///< what follows TILT=
  std::size_t tiltAt = 0, tiltEnd = 0;  ///< of the file's text: that line
};

/// 1986 had no line for the edition; later ones begin with IESNA91, IESNA:LM-63-2002, IES:LM-63-2019.
int editionOf(std::string_view line, const Place& place) {
  const std::string text = lowerCase(trimmed(line));
  if (!text.starts_with("ies")) return 1986;
  constexpr std::array<int, 5> kEditions = {1986, 1991, 1995, 2002, 2019};
  for (const int edition : kEditions) {
    const std::string year = std::to_string(edition);
    if (text.ends_with(year) || text == "iesna" + year.substr(2)) return edition;
  }
  failAt(place, "\"" + cleanName(line) +
                    "\" is none of the editions that are read: LM-63-1986, 1991, 1995, 2002 and 2019");
}

/// The value of `line` if it is that of a keyword, [LUMCAT] value.
std::optional<std::string> valueOf(std::string_view line, std::string_view keyword) {
  const std::string_view text = trimmed(line);
  if (!lowerCase(text.substr(0, keyword.size())).starts_with(lowerCase(keyword))) return std::nullopt;
  return cleanName(trimmed(text.substr(keyword.size())));
}

Header readHeader(IesText& text, std::size_t size) {
  Header header;
  std::string catalogue;
  std::string_view line;
  while (true) {
    const std::size_t at = size - text.rest().size();
    if (!text.nextLine(line)) {
      failAt({text.place().file, 0}, "no line begins with TILT=, so this is no LM-63 photometric file");
    }
    if (text.place().line == 1) header.edition = editionOf(line, text.place());
    if (const auto name = valueOf(line, "[LUMINAIRE]")) header.name = *name;
    if (const auto name = valueOf(line, "[LUMCAT]")) catalogue = *name;
    if (const auto tilt = valueOf(line, "TILT=")) {
      header.tilt = *tilt;
      header.tiltAt = at;
      header.tiltEnd = at + line.size();
      break;
    }
  }
  if (header.name.empty()) header.name = catalogue;
  return header;
}

LampTilt readTilt(IesText& text) {
  LampTilt tilt;
  tilt.lamp = static_cast<LampTilt::Lamp>(text.whole("the lamp-to-luminaire geometry", 1, 3));
  const std::int64_t count = text.whole("the number of tilt angles", 1, kMostAngles);
  tilt.angle_deg = text.numbers(count, "tilt angle");
  checkAngles(tilt.angle_deg, 0.0, 180.0, "tilt angle", text.place());
  tilt.factor = text.numbers(count, "tilt factor");
  for (const double factor : tilt.factor) {
    if (factor < 0.0 || factor > 10.0) {
      failAt(text.place(), "tilt factor " + numberText(factor) + " is not within 0 and 10");
    }
  }
  return tilt;
}

/// The ten and three numbers that follow the tilt.
struct Lamps {
  double count, flux_lm, multiplier;
  std::int64_t verticals, horizontals, type, units;
  double width, length, height;
  double ballast, ballastLamp, power_w;
};

Lamps readLamps(IesText& text) {
  Lamps lamps{};
  lamps.count = text.number("the number of lamps");
  lamps.flux_lm = text.number("the lumens per lamp");
  lamps.multiplier = text.number("the candela multiplier");
  if (!(lamps.multiplier > 0.0)) failAt(text.place(), "the candela multiplier has to be above 0");
  lamps.verticals = text.whole("the number of vertical angles", 2, kMostAngles);
  lamps.horizontals = text.whole("the number of horizontal angles", 1, kMostAngles);
  lamps.type = text.whole("the photometric type", 1, 3);
  lamps.units = text.whole("the units type", 1, 2);
  lamps.width = text.number("the opening's width");
  lamps.length = text.number("the opening's length");
  lamps.height = text.number("the opening's height");
  lamps.ballast = text.number("the ballast factor");
  lamps.ballastLamp = text.number("the ballast-lamp factor");
  lamps.power_w = text.number("the input watts");
  if (lamps.ballast < 0.0 || lamps.ballastLamp < 0.0) failAt(text.place(), "a ballast factor is below 0");
  return lamps;
}

/// By the signs of width (along C90), length (along C0) and height: LM-63-2002, table 1, and what 1995 had
/// otherwise. A negative extent is round.
LuminousOpening openingOf(const Lamps& lamps, const Place& place) {
  const double metres = lamps.units == 1 ? kFoot_m : 1.0;
  double width = lamps.width * metres;
  double length = lamps.length * metres;
  double height = lamps.height * metres;
  if (std::max({std::abs(width), std::abs(length), std::abs(height)}) > 100.0) {
    failAt(place, "the luminous opening is larger than 100 m");
  }
  // Before 2002: -d 0 0 a disc, -d 0 h a cylinder, 0 0 -d a sphere; 0 l -d and w 0 -d cylinders that lie.
  if (width < 0.0 && length == 0.0 && height >= 0.0) length = width;
  if (width == 0.0 && length == 0.0 && height < 0.0) width = length = height;
  if (width == 0.0 && length > 0.0 && height < 0.0) width = height;
  if (length == 0.0 && width > 0.0 && height < 0.0) length = height;
  using Form = LuminousOpening::Form;
  LuminousOpening opening;
  opening.extent_m = {std::abs(length), std::abs(width), std::abs(height)};
  const auto isRound = [](double a, double b) { return a < 0.0 && b < 0.0; };
  if (isRound(width, length)) {
    opening.form = height < 0.0 ? Form::ellipsoid : Form::verticalCylinder;
  } else if (isRound(width, height)) {
    opening.form = Form::cylinderAlongC0;
  } else if (isRound(length, height)) {
    opening.form = Form::cylinderAlongC90;
  } else if (width < 0.0 || length < 0.0) {  // 1995: ellipses by one sign
    opening.form = height < 0.0 ? Form::ellipsoid : Form::verticalCylinder;
  }
  return opening;
}

/// What horizontal angles of type C have to end with, and how the rest follows from them.
void completeC(IntensityDistribution& distribution, const Place& place) {
  std::vector<double>& planes_deg = distribution.longitude_deg;
  const auto isAt = [](double a, double b) { return std::abs(a - b) < 1e-3; };
  checkAngles(planes_deg, 0.0, 360.0, "horizontal angle", place);
  if (planes_deg.size() == 1) return;
  const double first = planes_deg.front();
  const double last = planes_deg.back();
  if (isAt(first, 0.0) && isAt(last, 90.0)) mirrorPlanes(planes_deg, distribution.intensity_cd, true);
  const bool isHalf = isAt(first, 0.0) && (isAt(last, 90.0) || isAt(last, 180.0));
  if (isHalf || (isAt(first, 90.0) && isAt(last, 270.0)))
    mirrorPlanes(planes_deg, distribution.intensity_cd, true);
  closeCircle(planes_deg, distribution.intensity_cd, place);
}

IntensityDistribution distributionOfC(std::vector<double> vertical_deg, std::vector<double> horizontal_deg,
                                      std::vector<double> intensity_cd, const Place& place) {
  checkAngles(vertical_deg, 0.0, 180.0, "vertical angle", place);
  for (double& angle : vertical_deg) angle -= 90.0;
  IntensityDistribution distribution{IntensityDistribution::Type::c, std::move(horizontal_deg),
                                     std::move(vertical_deg), std::move(intensity_cd)};
  completeC(distribution, place);
  return distribution;
}

/// Types A and B. Angles that begin at 0 stand for both sides.
IntensityDistribution distributionOfAB(IntensityDistribution::Type type, std::vector<double> vertical_deg,
                                       std::vector<double> horizontal_deg, std::vector<double> intensity_cd,
                                       const Place& place) {
  checkAngles(vertical_deg, -90.0, 90.0, "vertical angle", place);
  checkAngles(horizontal_deg, -90.0, 90.0, "horizontal angle", place);
  if (horizontal_deg.size() > 1 && std::abs(horizontal_deg.front()) < 1e-3)
    mirrorPlanes(horizontal_deg, intensity_cd, false);
  if (type == IntensityDistribution::Type::a)
    return {type, std::move(horizontal_deg), std::move(vertical_deg), std::move(intensity_cd)};
  std::vector<double> turned_cd;
  for (std::size_t v = 0; v < vertical_deg.size(); ++v) {
    for (std::size_t h = 0; h < horizontal_deg.size(); ++h)
      turned_cd.push_back(intensity_cd[h * vertical_deg.size() + v]);
  }
  return {type, std::move(vertical_deg), std::move(horizontal_deg), std::move(turned_cd)};
}

}  // namespace

Photometry readIes(const std::string& bytes, const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::string_view whole = plainText(bytes, name).substr(0, bytes.find('\x1A'));
  Photometry photometry;
  photometry.text = whole;
  IesText text(whole, name);
  const Header header = readHeader(text, whole.size());
  photometry.format = "LM-63-" + std::to_string(header.edition);
  photometry.name = header.name.empty() ? cleanName(file.stem().string()) : header.name;

  const std::string tilt = lowerCase(header.tilt);
  if (tilt == "include") {
    photometry.tilt = readTilt(text);
  } else if (tilt != "none") {
    const auto other = fileInside(file.parent_path(), header.tilt);
    if (!other || !std::filesystem::exists(*other)) {
      failAt(text.place(),
             "TILT= has to be NONE, INCLUDE or a file in this one's folder, but is \"" + header.tilt + "\"");
    }
    const std::string otherBytes = readWholeFile(*other, "tilt", kMostTiltBytes);
    IesText otherText(plainText(otherBytes, other->string()), other->string());
    photometry.tilt = readTilt(otherText);
    otherText.expectEnd();
    photometry.text.replace(header.tiltAt, header.tiltEnd - header.tiltAt,
                            "TILT=INCLUDE\r\n" + std::string(trimmed(otherBytes)));
  }

  const Lamps lamps = readLamps(text);
  const LuminousOpening opening = openingOf(lamps, text.place());
  if (lamps.verticals * lamps.horizontals > 4'000'000) {
    failAt(text.place(), "the file states more than 4,000,000 intensities");
  }
  const std::vector<double> vertical_deg = text.numbers(lamps.verticals, "vertical angle");
  const Place verticalPlace = text.place();
  const std::vector<double> horizontal_deg = text.numbers(lamps.horizontals, "horizontal angle");
  const Place anglePlace = text.place();
  std::vector<double> intensity_cd = text.numbers(lamps.verticals * lamps.horizontals, "intensity");
  checkIntensities(intensity_cd, text.place());
  text.expectEnd();

  // What was a factor up to 1991 is the file's origin in 2019's: 1.00010 for a laboratory's test, and so on.
  const double factor = lamps.multiplier * lamps.ballast * (header.edition < 2019 ? lamps.ballastLamp : 1.0);
  if (!(factor > 0.0)) failAt(anglePlace, "the ballast factor is 0, so the luminaire gives no light");
  for (double& intensity : intensity_cd) intensity *= factor;
  using Type = IntensityDistribution::Type;
  photometry.distribution =
      lamps.type == 1 ? distributionOfC(vertical_deg, horizontal_deg, std::move(intensity_cd), anglePlace)
                      : distributionOfAB(lamps.type == 2 ? Type::b : Type::a, vertical_deg, horizontal_deg,
                                         std::move(intensity_cd), verticalPlace);
  photometry.opening = opening;
  photometry.lampFlux_lm = lamps.flux_lm > 0.0 ? std::max(lamps.count, 0.0) * lamps.flux_lm : 0.0;
  photometry.power_w = std::max(lamps.power_w, 0.0);
  return photometry;
}

}  // namespace clerestory
