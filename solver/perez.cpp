// SPDX-License-Identifier: GPL-3.0-or-later
// Tables and formulae of Perez' sky.
#include "perez.hpp"

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace clerestory {
namespace {

/// By bin of clearness: a, b, c, d, e, each of x1 to x4. The 1993 paper's Table 1 with its erratum.
constexpr std::array<std::array<std::array<double, 4>, 5>, 8> coefficients = {
    {{{{1.3525, -0.2576, -0.2690, -1.4366},
       {-0.7670, 0.0007, 1.2734, -0.1233},
       {2.8000, 0.6004, 1.2375, 1.0000},
       {1.8734, 0.6297, 0.9738, 0.2809},
       {0.0356, -0.1246, -0.5718, 0.9938}}},
     {{{-1.2219, -0.7730, 1.4148, 1.1016},
       {-0.2054, 0.0367, -3.9128, 0.9156},
       {6.9750, 0.1774, 6.4477, -0.1239},
       {-1.5798, -0.5081, -1.7812, 0.1080},
       {0.2624, 0.0672, -0.2190, -0.4285}}},
     {{{-1.1000, -0.2515, 0.8952, 0.0156},
       {0.2782, -0.1812, -4.5000, 1.1766},
       {24.7219, -13.0812, -37.7000, 34.8438},
       {-5.0000, 1.5218, 3.9229, -2.6204},
       {-0.0156, 0.1597, 0.4199, -0.5562}}},
     {{{-0.5484, -0.6654, -0.2672, 0.7117},
       {0.7234, -0.6219, -5.6812, 2.6297},
       {33.3389, -18.3000, -62.2500, 52.0781},
       {-3.5000, 0.0016, 1.1477, 0.1062},
       {0.4659, -0.3296, -0.0876, -0.0329}}},
     {{{-0.6000, -0.3566, -2.5000, 2.3250},
       {0.2937, 0.0496, -5.6812, 1.8415},
       {21.0000, -4.7656, -21.5906, 7.2492},
       {-3.5000, -0.1554, 1.4062, 0.3988},
       {0.0032, 0.0766, -0.0656, -0.1294}}},
     {{{-1.0156, -0.3670, 1.0078, 1.4051},
       {0.2875, -0.5328, -3.8500, 3.3750},
       {14.0000, -0.9999, -7.1406, 7.5469},
       {-3.4000, -0.1078, -1.0750, 1.5702},
       {-0.0672, 0.4016, 0.3017, -0.4844}}},
     {{{-1.0000, 0.0211, 0.5025, -0.5119},
       {-0.3000, 0.1922, 0.7023, -1.6317},
       {19.0000, -5.0000, 1.2438, -1.9094},
       {-4.0000, 0.0250, 0.3844, 0.2656},
       {1.0468, -0.3788, -2.4517, 1.4656}}},
     {{{-1.0500, 0.0289, 0.4260, 0.3590},
       {-0.3250, 0.1156, 0.7781, 0.0025},
       {31.0625, -14.5000, -46.1148, 55.3750},
       {-7.2312, 0.4050, 13.3500, 0.6234},
       {1.5000, -0.6426, 1.8564, 0.5636}}}}};

/// By bin of clearness: a, b, c, d of the 1990 paper's Table 4.
constexpr std::array<std::array<double, 4>, 8> diffuseEfficacy = {{{97.24, -0.46, 12.00, -8.91},
                                                                   {107.22, 1.15, 0.59, -3.95},
                                                                   {104.97, 2.96, -5.53, -8.77},
                                                                   {102.39, 5.59, -13.95, -13.90},
                                                                   {100.71, 5.94, -22.75, -23.74},
                                                                   {106.42, 3.83, -36.15, -28.83},
                                                                   {141.88, 1.90, -53.24, -14.03},
                                                                   {152.23, 0.35, -45.27, -7.98}}};
constexpr std::array<std::array<double, 4>, 8> directEfficacy = {{{57.20, -4.55, -2.98, 117.12},
                                                                  {98.99, -3.46, -1.21, 12.38},
                                                                  {109.83, -4.90, -1.71, -8.81},
                                                                  {110.34, -5.84, -1.99, -4.56},
                                                                  {106.36, -3.97, -1.75, -6.16},
                                                                  {107.19, -1.25, -1.51, -26.73},
                                                                  {105.75, 0.77, -1.26, -34.44},
                                                                  {101.18, 1.58, -1.10, -8.29}}};

constexpr std::array<double, 7> binEnds = {1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2};
constexpr double solarConstant_W_m2 = 1367.0;
constexpr double lowestSun_deg = 3.0;  // the model was fitted to higher suns
constexpr double dewPoint_C = 11.0;

double zenithAngle(double sunAltitude_deg) {
  return glm::radians(90.0 - std::max(sunAltitude_deg, lowestSun_deg));
}

/// Square of the mean distance of the sun over that of a day (Spencer 1971).
double nearness(int dayOfYear) {
  if (dayOfYear < 1) return 1.0;
  const double turn = 2.0 * std::numbers::pi * (dayOfYear - 1) / 365.0;
  return 1.00011 + 0.034221 * std::cos(turn) + 0.00128 * std::sin(turn) + 0.000719 * std::cos(2.0 * turn) +
         0.000077 * std::sin(2.0 * turn);
}

}  // namespace

PerezWeather perezWeather(const Irradiance& irradiance, double sunAltitude_deg, int dayOfYear) {
  const double zenith = zenithAngle(sunAltitude_deg);
  const double kappa = 1.041 * zenith * zenith * zenith;
  const double diffuse = std::max(irradiance.diffuseHorizontal_W_m2, 1e-6);
  const double clearness = ((diffuse + irradiance.directNormal_W_m2) / diffuse + kappa) / (1.0 + kappa);
  // Kasten's optical air mass.
  const double airMass = 1.0 / (std::cos(zenith) + 0.15 * std::pow(93.885 - glm::degrees(zenith), -1.253));
  PerezWeather weather{};
  weather.clearness = std::clamp(clearness, 1.0, 12.01);
  weather.brightness = std::clamp(airMass * diffuse / (solarConstant_W_m2 * nearness(dayOfYear)), 0.01, 0.6);
  weather.bin = static_cast<std::size_t>(std::upper_bound(binEnds.begin(), binEnds.end(), weather.clearness) -
                                         binEnds.begin());
  return weather;
}

SkyShape perezShape(const PerezWeather& weather, double sunAltitude_deg) {
  const double zenith = zenithAngle(sunAltitude_deg);
  double brightness = weather.brightness;
  // Darker skies of middling clearness lie outside the fit and turn negative.
  if (weather.clearness > 1.065 && weather.clearness < 2.8) brightness = std::max(brightness, 0.2);
  const auto& table = coefficients[weather.bin];
  std::array<double, 5> x{};
  for (std::size_t i = 0; i < 5; ++i) {
    x[i] = table[i][0] + table[i][1] * zenith + brightness * (table[i][2] + table[i][3] * zenith);
  }
  if (weather.bin == 0) {
    x[2] = std::exp(std::pow(brightness * (table[2][0] + table[2][1] * zenith), table[2][2])) - table[2][3];
    x[3] =
        -std::exp(brightness * (table[3][0] + table[3][1] * zenith)) + table[3][2] + brightness * table[3][3];
  }
  // A gradation that rises without bound to the horizon is none: b may not be positive.
  return {x[0], std::min(x[1], 0.0), 1.0, x[2], x[3], x[4]};
}

PerezEfficacy perezEfficacy(const PerezWeather& weather, double sunAltitude_deg) {
  const double zenith = zenithAngle(sunAltitude_deg);
  const double water_cm = std::exp(0.07 * dewPoint_C - 0.075);
  const auto& diffuse = diffuseEfficacy[weather.bin];
  const auto& direct = directEfficacy[weather.bin];
  return {diffuse[0] + diffuse[1] * water_cm + diffuse[2] * std::cos(zenith) +
              diffuse[3] * std::log(weather.brightness),
          std::max(0.0, direct[0] + direct[1] * water_cm + direct[2] * std::exp(5.73 * zenith - 5.0) +
                            direct[3] * weather.brightness)};
}

Irradiance perezIrradiance(double diffuseHorizontal_lx, double directNormal_lx, double sunAltitude_deg,
                           int dayOfYear) {
  constexpr int rounds = 20;  // efficacies vary slowly: each round gains a digit
  Irradiance irradiance{directNormal_lx / 100.0, diffuseHorizontal_lx / 120.0};
  for (int round = 0; round < rounds; ++round) {
    const PerezEfficacy efficacy =
        perezEfficacy(perezWeather(irradiance, sunAltitude_deg, dayOfYear), sunAltitude_deg);
    irradiance = {directNormal_lx / std::max(efficacy.direct_lm_W, 20.0),
                  diffuseHorizontal_lx / efficacy.diffuse_lm_W};
  }
  return irradiance;
}

}  // namespace clerestory
