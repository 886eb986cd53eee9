#include "spectral/cie.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lampyr {

namespace {

double Lobe(double lambda, double mean, double widthBelow, double widthAbove) {
  const double t = (lambda - mean) / (lambda < mean ? widthBelow : widthAbove);
  return std::exp(-0.5 * t * t);
}

// S0, S1, S2 from 300 nm to 830 nm [CIE15, table T.2].
constexpr double kStep = 10, kFirst = 300;
constexpr std::array<std::array<double, 3>, 54> kDaylight = {{
    {0.04, 0.02, 0.0},   {6.0, 4.5, 2.0},     {29.6, 22.4, 4.0},   {55.3, 42.0, 8.5},   {57.3, 40.6, 7.8},
    {61.8, 41.6, 6.7},   {61.5, 38.0, 5.3},   {68.8, 42.4, 6.1},   {63.4, 38.5, 3.0},   {65.8, 35.0, 1.2},
    {94.8, 43.4, -1.1},  {104.8, 46.3, -0.5}, {105.9, 43.9, -0.7}, {96.8, 37.1, -1.2},  {113.9, 36.7, -2.6},
    {125.6, 35.9, -2.9}, {125.5, 32.6, -2.8}, {121.3, 27.9, -2.6}, {121.3, 24.3, -2.6}, {113.5, 20.1, -1.8},
    {113.1, 16.2, -1.5}, {110.8, 13.2, -1.3}, {106.5, 8.6, -1.2},  {108.8, 6.1, -1.0},  {105.3, 4.2, -0.5},
    {104.4, 1.9, -0.3},  {100.0, 0.0, 0.0},   {96.0, -1.6, 0.2},   {95.1, -3.5, 0.5},   {89.1, -3.5, 2.1},
    {90.5, -5.8, 3.2},   {90.3, -7.2, 4.1},   {88.4, -8.6, 4.7},   {84.0, -9.5, 5.1},   {85.1, -10.9, 6.7},
    {81.9, -10.7, 7.3},  {82.6, -12.0, 8.6},  {84.9, -14.0, 9.8},  {81.3, -13.6, 10.2}, {71.9, -12.0, 8.3},
    {74.3, -13.3, 9.6},  {76.4, -12.9, 8.5},  {63.3, -10.6, 7.0},  {71.7, -11.6, 7.6},  {77.0, -12.2, 8.0},
    {65.2, -10.2, 6.7},  {47.7, -7.8, 5.2},   {68.6, -11.2, 7.4},  {65.0, -10.4, 6.8},  {66.0, -10.6, 7.0},
    {61.0, -9.7, 6.4},   {53.3, -8.3, 5.5},   {58.9, -9.3, 6.1},   {61.9, -9.8, 6.5},
}};

// Weights of S1 and S2 for D65 (6503.6 K), rounded to three decimals as for the tables of [CIE15].
constexpr double kM1 = -0.295, kM2 = -0.689;

}  // namespace

Vector3d ColorMatching(double lambda) {
  return {1.056 * Lobe(lambda, 599.8, 37.9, 31.0) + 0.362 * Lobe(lambda, 442.0, 16.0, 26.7) -
              0.065 * Lobe(lambda, 501.1, 20.4, 26.2),
          0.821 * Lobe(lambda, 568.8, 46.9, 40.5) + 0.286 * Lobe(lambda, 530.9, 16.3, 31.1),
          1.217 * Lobe(lambda, 437.0, 11.8, 36.0) + 0.681 * Lobe(lambda, 459.0, 26.0, 13.8)};
}

double Daylight(double lambda, double m1, double m2) {
  const auto entry = [&](size_t i) { return kDaylight[i][0] + m1 * kDaylight[i][1] + m2 * kDaylight[i][2]; };
  const double position = std::clamp((lambda - kFirst) / kStep, 0.0, double(kDaylight.size() - 1));
  const size_t i = std::min(static_cast<size_t>(position), kDaylight.size() - 2);
  return std::lerp(entry(i), entry(i + 1), position - double(i));
}

double DaylightD65(double lambda) {
  return Daylight(lambda, kM1, kM2);
}

double Blackbody(double lambda, double kelvin) {
  constexpr double kSecondRadiation = 1.438776877e7;  // c2 = hc/k in nm·K
  // Relative to the exponential at the longest wavelength: the light of a cold body would otherwise underflow to 0 at
  // all wavelengths.
  const double x = kSecondRadiation / (lambda * kelvin);
  const double xLong = kSecondRadiation / (kLambdaMax * kelvin);
  const double boson = -std::expm1(-x);  // 1 - e^-x
  return std::pow(kLambdaMax / lambda, 5) * std::exp(-std::max(0.0, x - xLong)) / std::max(boson, 1e-300);
}

}  // namespace lampyr
