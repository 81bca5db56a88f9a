// SPDX-License-Identifier: GPL-3.0-or-later
// Panes against CIE 171's slab, Fresnel's closed forms and sums of reflections written out one by one.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <solver/glass.hpp>

namespace clerestory {
namespace {

using std::numbers::pi;

double cosDegrees(double angle) {
  return std::cos(angle * pi / 180.0);
}

/// Fresnel by angles: the reflectance of a face for light polarised across or along the plane of incidence.
double face(double incidence, double index, bool across) {
  if (incidence == 0.0) return std::pow((index - 1) / (index + 1), 2);
  const double refracted = std::asin(std::sin(incidence) / index);
  const double minus = incidence - refracted, plus = incidence + refracted;
  return across ? std::pow(std::sin(minus) / std::sin(plus), 2)
                : std::pow(std::tan(minus) / std::tan(plus), 2);
}

struct Pane {
  double t, r;
};

/// What passes and returns through `faces` in a row, followed in both directions until the light is gone.
Pane followed(double face, double passed, int sheets) {
  const std::size_t gaps = static_cast<std::size_t>(2 * sheets - 1);  // bulk, air, bulk, … between the faces
  std::vector<double> forward(gaps, 0.0), backward(gaps, 0.0);
  Pane out{0.0, face};
  forward[0] = 1.0 - face;
  for (int step = 0; step < 20000; ++step) {
    std::vector<double> nextForward(gaps, 0.0), nextBackward(gaps, 0.0);
    for (std::size_t gap = 0; gap < gaps; ++gap) {
      const double through = gap % 2 == 0 ? passed : 1.0, right = forward[gap] * through,
                   left = backward[gap] * through;
      nextBackward[gap] += right * face;
      nextForward[gap] += left * face;
      (gap + 1 < gaps ? nextForward[gap + 1] : out.t) += right * (1.0 - face);
      (gap > 0 ? nextBackward[gap - 1] : out.r) += left * (1.0 - face);
    }
    forward = nextForward;
    backward = nextBackward;
  }
  return out;
}

Pane followedUnpolarised(double angle_deg, double internal, int sheets, double index) {
  const double incidence = angle_deg * pi / 180.0;
  const double passed = std::pow(internal, 1.0 / std::cos(std::asin(std::sin(incidence) / index)));
  const Pane across = followed(face(incidence, index, true), passed, sheets);
  const Pane along = followed(face(incidence, index, false), passed, sheets);
  return {(across.t + along.t) / 2, (across.r + along.r) / 2};
}

TEST(Glass, Cie171Slab) {
  const Glass slab(0.8818);  // an internal transmittance of 0.960, both rounded
  const std::array<double, 7> angles = {0, 30, 45, 60, 70, 80, 85};
  const std::array<double, 7> transmittances = {0.882, 0.877, 0.862, 0.802, 0.686, 0.425, 0.220};
  for (std::size_t i = 0; i < angles.size(); ++i)
    EXPECT_NEAR(slab.transmittance(cosDegrees(angles[i])), transmittances[i], 5.5e-4) << angles[i];
}

TEST(Glass, OneSheetFollowed) {
  const double internal = 0.96;
  const Glass slab(followedUnpolarised(0.0, internal, 1, 1.52).t);
  for (const double angle : {0.0, 20.0, 45.0, 60.0, 75.0, 85.0, 88.0, 89.5}) {
    const Pane expected = followedUnpolarised(angle, internal, 1, 1.52);
    EXPECT_NEAR(slab.transmittance(cosDegrees(angle)), expected.t, 1e-4) << angle;
    EXPECT_NEAR(slab.reflectance(cosDegrees(angle)), expected.r, 1e-4) << angle;
  }
}

TEST(Glass, TwoAndThreeSheetsFollowed) {
  for (const int sheets : {2, 3}) {
    const double internal = 0.93, index = 1.6;
    const Glass unit(followedUnpolarised(0.0, internal, sheets, index).t, sheets, index);
    for (const double angle : {0.0, 30.0, 60.0, 80.0, 88.0}) {
      const Pane expected = followedUnpolarised(angle, internal, sheets, index);
      EXPECT_NEAR(unit.transmittance(cosDegrees(angle)), expected.t, 1e-4) << angle;
      EXPECT_NEAR(unit.reflectance(cosDegrees(angle)), expected.r, 1e-4) << angle;
    }
  }
}

TEST(Glass, WithoutAbsorptionSheetsHaveAClosedForm) {
  // Stokes: N faces of reflectance r pass (1 - r) / (1 + (N - 1) r).
  const double r = std::pow(0.52 / 2.52, 2);
  for (const int sheets : {1, 2, 4}) {
    const double clear = (1 - r) / (1 + (2 * sheets - 1) * r);
    const Glass unit(clear, sheets);
    EXPECT_NEAR(unit.transmittance(1.0), clear, 1e-6);
    EXPECT_NEAR(unit.reflectance(1.0), 1.0 - clear, 1e-6);
  }
}

TEST(Glass, StatedTransmittanceIsMetAndEnergyKept) {
  for (const int sheets : {1, 2, 3, 4})
    for (const double stated : {0.0, 0.05, 0.3, 0.65, 0.8, 0.9, 0.95, 0.999, 1.0}) {
      const Glass glass(stated, sheets);
      EXPECT_NEAR(glass.transmittance(1.0), stated, 1e-6);
      for (double cosine = 0.0; cosine <= 1.0; cosine += 1.0 / 4096.0) {
        const double t = glass.transmittance(cosine), r = glass.reflectance(cosine);
        EXPECT_GE(t, 0.0);
        EXPECT_GE(r, 0.0);
        EXPECT_LE(t + r, 1.0 + 2e-7);
      }
      EXPECT_LE(glass.hemisphericalTransmittance() + glass.hemisphericalReflectance(), 1.0 + 1e-7);
    }
}

TEST(Glass, TransmittanceFallsWithTheAngle) {
  for (const double stated : {0.4, 0.882, 0.97}) {
    const Glass glass(stated, 2);
    for (double cosine = 0.01; cosine <= 1.0; cosine += 0.01)
      EXPECT_GE(glass.transmittance(cosine), glass.transmittance(cosine - 0.01) - 1e-6) << cosine;
  }
}

TEST(Glass, NoGlassAtAll) {
  const Glass none(1.0);
  for (const float cosine : {0.0F, 0.01F, 0.5F, 1.0F}) {
    EXPECT_EQ(none.transmittance(cosine), 1.0F);
    EXPECT_EQ(none.reflectance(cosine), 0.0F);
  }
  EXPECT_DOUBLE_EQ(none.hemisphericalTransmittance(), 1.0);
  EXPECT_DOUBLE_EQ(none.hemisphericalReflectance(), 0.0);
}

TEST(Glass, HemisphericalIsTheCosineMean) {
  const Glass glass(0.882);
  double sum = 0.0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const double angle = (i + 0.5) / n * 90.0;
    sum += glass.transmittance(cosDegrees(angle)) * std::sin(2 * angle * pi / 180.0) * pi / 2 / n;
  }
  EXPECT_NEAR(glass.hemisphericalTransmittance(), sum, 1e-6);
  EXPECT_NEAR(glass.hemisphericalTransmittance() / 0.882, 0.917, 2e-3);  // CIE 171's 6 mm glass
}

TEST(Glass, FromBothSidesAndInFloat) {
  const Glass glass(0.7, 2);
  EXPECT_EQ(glass.transmittance(-0.4), glass.transmittance(0.4));
  EXPECT_EQ(glass.transmittance(0.4F), static_cast<float>(glass.transmittance(static_cast<double>(0.4F))));
  EXPECT_EQ(glass.transmittance(1.5F), glass.transmittance(1.0F));
}

TEST(Glass, NonsenseIsRefused) {
  EXPECT_THROW(Glass(-0.1), std::invalid_argument);
  EXPECT_THROW(Glass(1.1), std::invalid_argument);
  EXPECT_THROW(Glass(std::nan("")), std::invalid_argument);
  EXPECT_THROW(Glass(0.5, 0), std::invalid_argument);
  EXPECT_THROW(Glass(0.5, 1, 0.9), std::invalid_argument);
}

}  // namespace
}  // namespace clerestory
