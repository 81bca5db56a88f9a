// SPDX-License-Identifier: GPL-3.0-or-later
// Photometric files: intensities by direction, flux, openings, tilt, and what is refused.
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include <import/luminaire.hpp>
#include <import/photometry.hpp>

#include "tempfolder.hpp"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

constexpr double degree = std::numbers::pi / 180.0;
const fs::path folder = fs::path(CLERESTORY_TEST_DATA) / "photometry";

Photometry fixture(const std::string& name) {
  return readPhotometry(folder / name);
}

std::string bytesOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return bytes.str();
}

std::vector<fs::path> fixtures() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path ending = entry.path().extension();
    if (ending == ".ies" || ending == ".ldt") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string refusalOf(const std::string& bytes, const std::string& name) {
  return inputErrorOf([&] { photometryFrom(bytes, folder / name); });
}

/// In type C's angles.
glm::dvec3 direction(double c_deg, double gamma_deg) {
  return {std::cos(c_deg * degree) * std::sin(gamma_deg * degree),
          std::sin(c_deg * degree) * std::sin(gamma_deg * degree), -std::cos(gamma_deg * degree)};
}

double at(const Photometry& photometry, double c_deg, double gamma_deg) {
  return photometry.distribution.intensity(direction(c_deg, gamma_deg));
}

/// Midpoints of even cells of the sphere.
double fluxByLookups(const IntensityDistribution& distribution) {
  constexpr int rows = 720;
  constexpr int columns = 720;
  double sum = 0.0;
  for (int row = 0; row < rows; ++row) {
    const double z = -1.0 + 2.0 * (row + 0.5) / rows;
    const double radius = std::sqrt(1.0 - z * z);
    for (int column = 0; column < columns; ++column) {
      const double angle = 2.0 * std::numbers::pi * (column + 0.5) / columns;
      sum += distribution.intensity({radius * std::cos(angle), radius * std::sin(angle), z});
    }
  }
  return sum * 4.0 * std::numbers::pi / (rows * columns);
}

// The closed form of the flux knows nothing of the look-up's frames: an angle that is taken the wrong way
// round or beyond the grid's end would part them. What is left is the sum's coarseness at the ends of grids.
TEST(Photometry, FluxIsTheIntegralOfWhatIsLookedUp) {
  ASSERT_EQ(fixtures().size(), 13U);
  for (const fs::path& file : fixtures()) {
    const Photometry photometry = readPhotometry(file);
    const double flux_lm = photometry.distribution.flux_lm();
    EXPECT_GT(flux_lm, 10.0) << file;
    EXPECT_NEAR(fluxByLookups(photometry.distribution), flux_lm, 0.003 * flux_lm) << file;
  }
}

TEST(Photometry, KnownFluxes) {
  EXPECT_NEAR(uniformPhotometry(100.0).distribution.flux_lm(), 400.0 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(lambertianPhotometry(100.0).distribution.flux_lm(), 100.0 * std::numbers::pi, 0.01);
  // Of ((cos - co) / (ci - co))^2 between two cones, and of 1 within the inner: 2 pi (1 - ci + (ci - co) /
  // 3).
  const double inner = std::cos(20.0 * degree);
  const double outer = std::cos(40.0 * degree);
  EXPECT_NEAR(spotPhotometry(100.0, 20.0, 40.0).distribution.flux_lm(),
              200.0 * std::numbers::pi * (1.0 - inner + (inner - outer) / 3.0), 0.02);
  EXPECT_NEAR(at(spotPhotometry(100.0, 20.0, 40.0), 30.0, 19.0), 100.0, 1e-9);
  EXPECT_EQ(at(spotPhotometry(100.0, 20.0, 40.0), 30.0, 41.0), 0.0);
}

TEST(Photometry, EulumdatIsInLumensOfItsLamps) {
  // Its intensities were computed per 1000 lm, its output ratio with them; rounding of cd to a tenth.
  const Photometry disc = fixture("disc-1.ldt");
  EXPECT_NEAR(at(disc, 0.0, 0.0), 2.0 * 250.0, 1e-9);
  EXPECT_EQ(disc.lampFlux_lm, 2000.0);
  EXPECT_TRUE(disc.diagnoses.empty());
  const Photometry absolute = fixture("asymmetric-0.ldt");
  EXPECT_NEAR(absolute.distribution.flux_lm(), 2000.0, 0.005 * 2000.0);
  EXPECT_EQ(absolute.lampFlux_lm, 0.0);
  EXPECT_TRUE(absolute.diagnoses.empty());
}

TEST(Photometry, CTurnsFromXToY) {
  for (const char* name : {"washer-2002.ies", "washer-3.ldt", "asymmetric-2019.ies", "asymmetric-0.ldt"}) {
    const Photometry washer = fixture(name);
    EXPECT_GT(washer.distribution.intensity(glm::normalize(glm::dvec3(0, 1, -1))),
              1.2 * washer.distribution.intensity(glm::normalize(glm::dvec3(0, -1, -1))))
        << name;
  }
  const Photometry street = fixture("street-2.ldt");
  EXPECT_GT(at(street, 0.0, 45.0), 1.2 * at(street, 180.0, 45.0));
  EXPECT_NEAR(at(street, 60.0, 45.0), at(street, 300.0, 45.0), 1e-9);
  const Photometry washer = fixture("washer-2002.ies");
  EXPECT_NEAR(at(washer, 60.0, 45.0), at(washer, 120.0, 45.0), 1e-9);
  EXPECT_NEAR(at(washer, 120.0, 45.0), 215.69, 1e-9);
  EXPECT_NEAR(at(washer, 105.0, 52.5), (220.62 + 215.69 + 151.18 + 147.8) / 4.0, 1e-9);
}

TEST(Photometry, AQuarterIsTheSameAsAllPlanes) {
  const Photometry quarter = fixture("quadrant-1995.ies");
  const Photometry full = fixture("full-1995.ies");
  const Photometry eulumdat = fixture("troffer-4.ldt");
  for (double c = -360.0; c <= 360.0; c += 7.0) {
    for (double gamma = 0.0; gamma <= 180.0; gamma += 6.0) {
      EXPECT_NEAR(at(quarter, c, gamma), at(full, c, gamma), 1e-9) << c << ' ' << gamma;
      EXPECT_NEAR(at(eulumdat, c, gamma), at(full, c, gamma), 1e-9) << c << ' ' << gamma;
    }
  }
}

// LM-63-2002, section 3: (0, 0) of type B is the nadir, V = 90 is C0, H turns clockwise from above. (0, 0) of
// type A is C0, its V = -90 the nadir.
TEST(Photometry, TypesAAndBAreTurnedIntoTheSameAxes) {
  const IntensityDistribution flood = fixture("flood-b.ies").distribution;
  EXPECT_NEAR(flood.intensity({0, 0, -1}), 606.5, 1e-9);
  const double s = std::sin(30.0 * degree);
  const double c = std::cos(30.0 * degree);
  EXPECT_NEAR(flood.intensity({s, 0, -c}), 606.5, 1e-9);   // H 0, V 30
  EXPECT_NEAR(flood.intensity({-s, 0, -c}), 82.1, 1e-9);   // H 0, V -30
  EXPECT_NEAR(flood.intensity({0, -s, -c}), 606.5, 1e-9);  // H 30, V 0
  EXPECT_NEAR(flood.intensity({0, s, -c}), 82.1, 1e-9);    // H -30, V 0
  EXPECT_EQ(flood.intensity({1, 0, 0}), 0.0);
  const IntensityDistribution headlamp = fixture("headlamp-a.ies").distribution;
  const double low = std::sin(10.0 * degree);
  EXPECT_NEAR(headlamp.intensity({std::cos(10.0 * degree), 0, -low}), 500.0, 1e-9);
  for (const double side : {-1.0, 1.0}) {  // H 20 and, by symmetry, -20
    const double away = std::cos(10.0 * degree);
    EXPECT_NEAR(
        headlamp.intensity({away * std::cos(20.0 * degree), side * away * std::sin(20.0 * degree), -low}),
        183.9, 0.1);
  }
  EXPECT_EQ(headlamp.intensity({-1, 0, 0}), 0.0);
}

TEST(Photometry, MultipliersAndBallastFactorsCount) {
  EXPECT_NEAR(at(fixture("cylinder-1991.ies"), 0.0, 90.0), 80.0 * 2.0 * 0.9 * 0.95, 1e-9);
  // Where 1991 had a factor, 2019 has a code.
  const Photometry panel = fixture("asymmetric-2019.ies");
  EXPECT_NEAR(at(panel, 0.0, 0.0), 225.0, 1e-9);
  EXPECT_EQ(panel.lampFlux_lm, 0.0);
  EXPECT_EQ(fixture("quadrant-1995.ies").lampFlux_lm, 2400.0);
  EXPECT_EQ(fixture("quadrant-1995.ies").power_w, 72.0);
}

TEST(Photometry, TiltChangesTheFluxOfLampsThatAreTilted) {
  const Photometry upright = fixture("quadrant-1995.ies");
  const double half = std::sqrt(0.5);
  EXPECT_NEAR(tiltFactor(upright.tilt, luminaireAxes({0, 0, -1}, 30.0)), 1.0, 1e-12);
  EXPECT_NEAR(tiltFactor(upright.tilt, luminaireAxes({half, 0, -half}, 0.0)), 0.9, 1e-9);
  EXPECT_NEAR(tiltFactor(upright.tilt, luminaireAxes({1, 0, 0}, 0.0)), 0.7, 1e-9);
  EXPECT_NEAR(tiltFactor(upright.tilt, luminaireAxes({0, 0, 1}, 0.0)), 0.7, 1e-9);
  // A lamp along C0 stays level when the luminaire is turned about it.
  const Photometry lying = fixture("washer-2002.ies");
  EXPECT_NEAR(tiltFactor(lying.tilt, luminaireAxes({0, half, -half}, 0.0)), 1.0, 1e-9);
  EXPECT_NEAR(tiltFactor(lying.tilt, luminaireAxes({half, 0, -half}, 0.0)), 0.75, 1e-9);
  // What the report keeps is whole without the other file.
  const TempFolder temp;
  EXPECT_EQ(readPhotometry(temp.write("whole.ies", lying.text)).tilt.factor, lying.tilt.factor);
}

TEST(Photometry, OpeningsByTheSignsOfTheirSizes) {
  using Form = LuminousOpening::Form;
  struct Case {
    const char* sizes;
    Form form;
    glm::dvec3 extent_m;  // along C0 (length), C90 (width), up
  };
  const std::vector<Case> cases = {
      {"0 0 0", Form::box, {0, 0, 0}},
      {".6 1.2 0", Form::box, {1.2, .6, 0}},
      {".6 1.2 .1", Form::box, {1.2, .6, .1}},
      {"0 1.2 0", Form::box, {1.2, 0, 0}},
      {"-.2 0 0", Form::verticalCylinder, {.2, .2, 0}},    // 1995
      {"-.2 -.2 0", Form::verticalCylinder, {.2, .2, 0}},  // 2002
      {"-.2 -.4 .5", Form::verticalCylinder, {.4, .2, .5}},
      {"-.2 0 .5", Form::verticalCylinder, {.2, .2, .5}},  // 1995
      {"0 0 -.3", Form::ellipsoid, {.3, .3, .3}},          // 1995
      {"-.3 -.3 -.3", Form::ellipsoid, {.3, .3, .3}},      // 2002
      {"-.1 1 -.1", Form::cylinderAlongC0, {1, .1, .1}},   // 2002
      {"0 1 -.1", Form::cylinderAlongC0, {1, .1, .1}},     // 1995
      {"1 -.1 -.1", Form::cylinderAlongC90, {.1, 1, .1}},  // 2002
      {"1 0 -.1", Form::cylinderAlongC90, {.1, 1, .1}},    // 1995
      {"-.3 0 -.3", Form::cylinderAlongC0, {0, .3, .3}},   // 2002: a disc that faces C0
  };
  const TempFolder temp;
  for (const Case& own : cases) {
    const Photometry read =
        readPhotometry(temp.write("opening.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 " +
                                                     std::string(own.sizes) + "\n1 1 1\n0 90\n0\n1 1\n"));
    EXPECT_EQ(read.opening.form, own.form) << own.sizes;
    EXPECT_NEAR(glm::length(read.opening.extent_m - own.extent_m), 0.0, 1e-12) << own.sizes;
  }
  EXPECT_NEAR(fixture("disc-1986.ies").opening.extent_m.x, 0.3048, 1e-12);  // feet
  const LuminousOpening sides = fixture("washer-3.ldt").opening;
  EXPECT_NEAR(glm::length(sides.extent_m - glm::dvec3(0.1, 0.6, 0.04)), 0.0, 1e-12);
}

TEST(Photometry, NamesAndFormats) {
  EXPECT_EQ(fixture("disc-1986.ies").format, "LM-63-1986");
  EXPECT_EQ(fixture("cylinder-1991.ies").format, "LM-63-1991");
  EXPECT_EQ(fixture("quadrant-1995.ies").name, "A TROFFER");
  EXPECT_EQ(fixture("washer-2002.ies").name, "WASHER");
  EXPECT_EQ(fixture("asymmetric-2019.ies").format, "LM-63-2019");
  EXPECT_EQ(fixture("street-2.ldt").name, "About C0-C180");
}

TEST(Photometry, OfSeveralSetsOfLampsTheFirstIsTakenAndSaid) {
  const Photometry bySet = fixture("washer-3.ldt");
  EXPECT_EQ(bySet.lampFlux_lm, 2000.0);
  EXPECT_EQ(bySet.power_w, 20.0);
  ASSERT_EQ(bySet.diagnoses.size(), 1U);
  EXPECT_EQ(bySet.diagnoses[0].code, "C161");
  // The same with each line for both sets.
  std::string text = bytesOf(folder / "washer-3.ldt");
  const std::string sets =
      "1\r\nLED\r\n2000\r\n4000 K\r\n80\r\n20\r\n2\r\nLED\r\n3000\r\n3000 K\r\n90\r\n30\r\n";
  const std::size_t found = text.find(sets);
  ASSERT_NE(found, std::string::npos);
  text.replace(found, sets.size(),
               "1\r\n2\r\nLED\r\nLED\r\n2000\r\n3000\r\n4000 K\r\n3000 K\r\n80\r\n90\r\n20\r\n30\r\n");
  const TempFolder temp;
  const Photometry byLine = readPhotometry(temp.write("bylines.ldt", text));
  EXPECT_EQ(byLine.lampFlux_lm, 2000.0);
  EXPECT_EQ(byLine.power_w, 20.0);
  EXPECT_EQ(byLine.distribution.intensity_cd, bySet.distribution.intensity_cd);
}

TEST(Photometry, AFluxThatTheIntensitiesDoNotGiveIsSaid) {
  std::string text = bytesOf(folder / "disc-1.ldt");
  const std::size_t ratio = text.find("\r\n100\r\n") + 7;
  text.replace(ratio, text.find("\r\n", ratio) - ratio, "50");
  const TempFolder temp;
  const Photometry read = readPhotometry(temp.write("ratio.ldt", text));
  ASSERT_EQ(read.diagnoses.size(), 1U);
  EXPECT_EQ(read.diagnoses[0].code, "C162");
}

TEST(Photometry, MalformedFilesAreRefusedWithLineAndReason) {
  const std::string head = "IESNA:LM-63-2002\nTILT=NONE\n";
  const std::string good = "1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n1 1\n";
  ASSERT_EQ(refusalOf(head + good, "good.ies"), "");
  struct Case {
    std::string bytes;
    const char* says;
  };
  const std::vector<Case> cases = {
      {"", "no line begins with TILT="},
      {"IESNA:LM-63-2002\n", "no line begins with TILT="},
      {"IESNA:LM-63-2077\nTILT=NONE\n" + good, ":1: \"IESNA:LM-63-2077\" is none of the editions"},
      {head, ":2: the file ends where the number of lamps"},
      {head + "1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n1\n", ":7: the file ends where intensity 2 of 2"},
      {head + "1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n1 1 1\n", ":7: \"1\" is left over"},
      {head + "1 -1 1 2 1 4 2 0 0 0\n1 1 1\n0 90\n0\n1 1\n", ":3: the photometric type is 4"},
      {head + "1 -1 1 2.5 1 1 2 0 0 0\n1 1 1\n0 90\n0\n1 1\n", ":3: the number of vertical angles is 2.5"},
      {head + "1 -1 1 999999999 1 1 2 0 0 0\n", ":3: the number of vertical angles"},
      {head + "1 -1 1 20000 20000 1 2 0 0 0\n1 1 1\n", ":4: the file states more than"},
      {head + "1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 95deg\n0\n1 1\n",
       ":5: \"95deg\" should be vertical angle 2 of 2"},
      {head + "1 -1 1 2 1 1 2 0 0 0\n1 1 1\n90 0\n0\n1 1\n", "have to rise, but 0 follows 90"},
      {head + "1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 190\n0\n1 1\n", "190 is not within 0 and 180"},
      {head + "1 -1 1 2 2 1 2 0 0 0\n1 1 1\n0 90\n0 120\n1 1\n1 1\n", "leave a part of the circle open"},
      {head + "1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n0 0\n", "gives no light"},
      {head + "1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n5 -4\n", "intensity -4 is below 0"},
      {head + "1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n5 nan\n", "\"nan\" should be intensity 2"},
      {head + "1 -1 0 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n5 1\n", "multiplier has to be above 0"},
      {head + "1 -1 1 2 1 1 2 900 0 0\n1 1 1\n0 90\n0\n5 1\n", "larger than 100 m"},
      {"IESNA:LM-63-2002\nTILT=../secret\n" + good, ":2: TILT= has to be NONE, INCLUDE or a file in this"},
      {"IESNA:LM-63-2002\nTILT=INCLUDE\n7\n" + good, ":3: the lamp-to-luminaire geometry is 7"},
      {std::string("IESNA:LM-63-2002\nTILT=NONE\n1\0", 29), "holds zero bytes"},
  };
  for (const Case& own : cases) {
    const std::string refusal = refusalOf(own.bytes, "bad.ies");
    EXPECT_NE(refusal.find(own.says), std::string::npos) << own.says << "\n is not in: " << refusal;
    EXPECT_NE(refusal.find("bad.ies"), std::string::npos) << refusal;
  }
  std::string ldt = bytesOf(folder / "washer-3.ldt");
  EXPECT_NE(refusalOf(ldt + "17\r\n", "bad.ldt").find("\"17\" is left over"), std::string::npos);
  const std::string symmetry = refusalOf(std::string(ldt).replace(11, 1, "4"), "bad.ldt");
  EXPECT_NE(symmetry.find("left over"), std::string::npos) << symmetry;
  EXPECT_NE(refusalOf(std::string(ldt).replace(11, 1, "x"), "bad.ldt")
                .find("bad.ldt:3: \"x\" should be the symmetry indicator"),
            std::string::npos);
  EXPECT_NE(refusalOf("something else", "lamp.txt").find("ends in .ies or .ldt"), std::string::npos);
}

// A number that loses its last digits is still a number, so not every cut is noticed; but none may crash,
// hang or read past the end, and what is read has to be light.
TEST(Photometry, EveryTruncationAndEveryWrongByteEndsInAnAnswer) {
  const TempFolder temp;
  temp.write("washer.tlt", bytesOf(folder / "washer.tlt"));
  std::size_t refused = 0;
  std::size_t read = 0;
  const auto tryBytes = [&](const std::string& bytes, const std::string& name) {
    try {
      const double flux_lm = photometryFrom(bytes, temp.path() / name).distribution.flux_lm();
      EXPECT_TRUE(std::isfinite(flux_lm) && flux_lm >= 0.0) << bytes;
      ++read;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(name.substr(0, 4)), std::string::npos) << error.what();
      ++refused;
    }
  };
  for (const fs::path& file : fixtures()) {
    const std::string bytes = bytesOf(file);
    const std::string name = "hurt" + file.extension().string();
    for (std::size_t length = 0; length < bytes.size(); ++length) tryBytes(bytes.substr(0, length), name);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      for (const char wrong : {'-', '9', 'x', '\n'}) {
        std::string hurt = bytes;
        hurt[i] = wrong;
        tryBytes(hurt, name);
      }
    }
  }
  EXPECT_GT(refused, read);
}

TEST(Photometry, EveryMissingLineOfNumbersIsNoticed) {
  for (const char* name : {"quadrant-1995.ies", "flood-b.ies", "disc-1.ldt", "troffer-4.ldt"}) {
    const std::string bytes = bytesOf(folder / name);
    const bool isIes = fs::path(name).extension() == ".ies";
    const std::size_t from = isIes ? bytes.find("TILT=") : 0;
    for (std::size_t at = from; at < bytes.size();) {
      const std::size_t end = bytes.find("\r\n", at) + 2;
      const std::string refusal = refusalOf(bytes.substr(0, at) + bytes.substr(end),
                                            std::string("cut") + fs::path(name).extension().string());
      EXPECT_NE(refusal, "") << name << " without: " << bytes.substr(at, end - at);
      at = end;
    }
  }
}

TEST(Luminaire, AxesFollowAimAndRotation) {
  const auto expectAxes = [](const glm::dmat3& axes, const glm::dvec3& c0, const glm::dvec3& c90) {
    EXPECT_NEAR(glm::length(axes[0] - c0), 0.0, 1e-12);
    EXPECT_NEAR(glm::length(axes[1] - c90), 0.0, 1e-12);
    EXPECT_NEAR(glm::length(glm::cross(axes[0], axes[1]) - axes[2]), 0.0, 1e-12);
  };
  expectAxes(luminaireAxes({0, 0, -1}, 0.0), {1, 0, 0}, {0, 1, 0});
  expectAxes(luminaireAxes({0, 0, -1}, 90.0), {0, 1, 0}, {-1, 0, 0});
  expectAxes(luminaireAxes({0, 1, 0}, 0.0), {1, 0, 0}, {0, 0, 1});  // C90 is raised
  expectAxes(luminaireAxes({1, 0, 0}, 0.0), {0, 0, 1}, {0, 1, 0});  // C0 is raised
  expectAxes(luminaireAxes({0, 0, 1}, 0.0), {1, 0, 0}, {0, -1, 0});
}

}  // namespace
}  // namespace clerestory
