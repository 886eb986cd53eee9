// Wavelengths of passes, and the upsampling of colours: what is carried by wavelength comes back as its colour.
#include "spectral/wavelengths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "spectral/cie.h"
#include "spectral/color_space.h"

namespace lampyr {
namespace {

// The standard observer: integrals of the published functions at 1 nm, and values where they were measured.
TEST(ColorMatching, IsThatOfTheStandardObserver) {
  Vector3d sum(0.0);
  for (int wavelength = 360; wavelength <= 830; ++wavelength) sum += ColorMatching(wavelength);
  EXPECT_NEAR(sum.x, 106.8655, 1e-3);
  EXPECT_NEAR(sum.y, 106.8569, 1e-3);
  EXPECT_NEAR(sum.z, 106.8923, 1e-3);
  EXPECT_EQ(ColorMatching(555).y, 1);
  EXPECT_EQ(ColorMatching(600).x, 1.0622);
  EXPECT_NEAR(ColorMatching(442).z, 1.76, 0.01);
  for (const double outside : {359.0, 831.0, -1.0}) EXPECT_EQ(ColorMatching(outside), Vector3d(0.0));
}

const std::vector<Color>& SaturatedColors() {
  static const std::vector<Color> colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}};
  return colors;
}

Vector3d VectorOf(const Color& color) {
  return {color.r, color.g, color.b};
}

SpectralCurve Upsampled(const Color& color) {
  return SpectralCurve([&color](double wavelength) {
    const Color basis = UpsamplingBasis(wavelength);
    return glm::dot(VectorOf(color), VectorOf(basis));
  });
}

// CIELAB under D65.
Vector3d LabOf(const Vector3d& rgb) {
  const Vector3d xyz = Rec709ToXyz() * rgb / XyzOfChromaticity(0.3127, 0.3290);
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
  return {116 * f(xyz.y) - 16, 500 * (f(xyz.x) - f(xyz.y)), 200 * (f(xyz.y) - f(xyz.z))};
}

// The mean over passes of what ToRgb makes of `lanes`.
Vector3d MeanOverPasses(uint64_t seed, uint64_t passes, const std::function<Color(const Wavelengths&)>& lanes) {
  Vector3d sum(0.0);
  for (uint64_t pass = 0; pass < passes; ++pass) {
    const Wavelengths wavelengths = Wavelengths::OfPass(seed, pass);
    const Color values = lanes(wavelengths);
    sum += Vector3d(wavelengths.ToRgb() * glm::vec3(values.r, values.g, values.b));
  }
  return sum / static_cast<double>(passes);
}

// Half of the density is even over a range that is wanted as a spectrum: every part of it has at least its share of the
// wavelengths, and integrals over all wavelengths and over a part are right.
TEST(Wavelengths, EvenOverARange) {
  const WavelengthRange range{450, 550};
  constexpr int kCount = 3 * 4000;
  double all = 0, part = 0, share = 0;
  for (int i = 0; i < kCount; ++i) {
    const Wavelengths wavelengths((i + 0.5) / kCount, range);
    for (int lane = 0; lane < Wavelengths::kLanes; ++lane) {
      const double wavelength = wavelengths[lane], weight = wavelengths.PerDensity(lane) / kCount;
      const bool isInPart = wavelength >= 470 && wavelength < 480;
      all += weight;
      part += isInPart ? weight : 0;
      share += isInPart ? 1.0 / (kCount * Wavelengths::kLanes) : 0;
      if (wavelength > range.from && wavelength < range.to) {
        EXPECT_LE(wavelengths.PerDensity(lane), 2 * (range.to - range.from) / Wavelengths::kLanes * (1 + 1e-3));
      }
    }
  }
  EXPECT_NEAR(all / (SpectralCurve::kLast - SpectralCurve::kFirst), 1, 1e-3);
  EXPECT_NEAR(part / 10, 1, 5e-3);
  EXPECT_GT(share, 0.5 * 10 / (range.to - range.from));
}

// The place of a wavelength between 0 and 1 by the density of wavelengths.
double QuantileOf(double wavelength) {
  double low = 0, high = 1;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    const int lane = static_cast<int>(middle * Wavelengths::kLanes);
    (Wavelengths(middle * Wavelengths::kLanes - lane)[lane] <= wavelength ? low : high) = middle;
  }
  return low;
}

TEST(UpsamplingBasis, AddsUpToOneWithinZeroAndOne) {
  for (double wavelength = 350; wavelength <= 840; wavelength += 0.25) {
    const Vector3d basis = VectorOf(UpsamplingBasis(wavelength));
    for (int c = 0; c < 3; ++c) ASSERT_TRUE(basis[c] >= 0 && basis[c] <= 1) << wavelength << " " << basis[c];
    ASSERT_NEAR(basis.x + basis.y + basis.z, 1, 1e-6) << wavelength;
  }
}

TEST(UpsamplingBasis, ReturnsTheColour) {
  constexpr int kSteps = 6;
  double worst = 0;
  for (int i = 0; i < kSteps * kSteps * kSteps; ++i) {
    const auto level = [](int step) { return static_cast<float>(step % kSteps) / (kSteps - 1); };
    const Color color(level(i), level(i / kSteps), level(i / kSteps / kSteps));
    const Vector3d back = ColorOf(Upsampled(color));
    worst = std::max(worst, glm::length(LabOf(back) - LabOf(VectorOf(color))));
  }
  // The table is rounded to seven decimals.
  EXPECT_LT(worst, 0.01);
}

TEST(UpsamplingBasis, WhiteIsWhite) {
  const Vector3d white = ColorOf(SpectralCurve([](double) { return 1.0; }));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(white[c], 1, 1e-12);
}

TEST(Wavelengths, RiseFromLaneToLaneThroughTheVisibleRange) {
  EXPECT_NEAR(Wavelengths(0)[0], 360, 1e-6);
  EXPECT_NEAR(Wavelengths(1 - 1e-12)[2], 830, 1e-2);
  double last = 0;
  for (double u = 0; u < 1; u += 0.01) {
    const Wavelengths wavelengths(u);
    EXPECT_GT(wavelengths[0], last);
    EXPECT_LT(wavelengths[0], wavelengths[1]);
    EXPECT_LT(wavelengths[1], wavelengths[2]);
    last = wavelengths[0];
  }
  EXPECT_NEAR(Wavelengths(1 - 1e-12)[0], Wavelengths(0)[1], 1e-6);
}

TEST(Wavelengths, GrayStaysExactlyGray) {
  for (uint64_t pass = 0; pass < 64; ++pass) {
    const Wavelengths wavelengths = Wavelengths::OfPass(3, pass);
    for (const float value : {0.0f, 0.1f, 1 / 3.0f, 1.0f, 1e-30f, 3e30f})
      ASSERT_EQ(wavelengths.FromRgb(Color(value)), Color(value)) << pass;
  }
}

TEST(Wavelengths, LanesAreWithinTheColour) {
  for (uint64_t pass = 0; pass < 256; ++pass) {
    const Wavelengths wavelengths = Wavelengths::OfPass(0, pass);
    for (const Color& color : {Color(0.2f, 0.9f, 0.4f), Color(7, 0.5f, 2), Color(0, 0, 1), Color(1, 0, 0)}) {
      const Vector3d lanes = VectorOf(wavelengths.FromRgb(color));
      const double least = std::min({color.r, color.g, color.b}), most = color.Max();
      for (int lane = 0; lane < Wavelengths::kLanes; ++lane) {
        ASSERT_GE(lanes[lane], least * (1 - 1e-6)) << pass;
        ASSERT_LE(lanes[lane], most * (1 + 1e-6)) << pass;
        const double expected = glm::dot(VectorOf(color), VectorOf(UpsamplingBasis(wavelengths[lane])));
        ASSERT_NEAR(lanes[lane], expected, 1e-6 * most) << pass;
      }
    }
  }
}

TEST(Wavelengths, WhiteIsWhatBecomesOfWhite) {
  for (uint64_t pass = 0; pass < 32; ++pass) {
    const Wavelengths wavelengths = Wavelengths::OfPass(1, pass);
    const glm::vec3 white = wavelengths.ToRgb() * glm::vec3(1);
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(double(white[c]), wavelengths.White()[static_cast<size_t>(c)], 1e-5) << pass;
  }
}

TEST(Wavelengths, PassesAverageToWhite) {
  // The ends of the range are not alike: the error is as the distance of the places.
  for (const uint64_t seed : {0, 1, 77}) {
    const Vector3d mean = MeanOverPasses(seed, 1024, [](const Wavelengths&) { return Color(1); });
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], 1, 1e-3) << seed;
  }
}

TEST(Wavelengths, PassesAverageToSaturatedColours) {
  for (const Color& color : SaturatedColors()) {
    const Vector3d mean = MeanOverPasses(5, 256, [&](const Wavelengths& w) { return w.FromRgb(color); });
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], VectorOf(color)[c], 1e-2) << color.r << color.g << color.b;
  }
}

TEST(Wavelengths, PassesAverageToTheColourOfACurve) {
  const SellmeierCoefficients glass{{1.03961212, 0.231792344, 1.01046945}, {0.00600069867, 0.0200179144, 103.560653}};
  // An index, steeper by a factor, and a slope across the range.
  const SpectralCurve curves[] = {
      SpectralCurve([&](double wavelength) { return glass.IndexAt(wavelength); }),
      SpectralCurve([&](double wavelength) { return 40 * (glass.IndexAt(wavelength) - 1.5); }),
      SpectralCurve([](double wavelength) { return (wavelength - 360) / 470; }),
  };
  for (const SpectralCurve& curve : curves) {
    const Vector3d color = ColorOf(curve);
    const Vector3d mean = MeanOverPasses(2, 256, [&](const Wavelengths& w) { return w.At(curve); });
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], color[c], 1e-3 * curve.Largest()) << curve.At(500);
  }
}

TEST(Wavelengths, PassesAreARegularGrid) {
  for (const uint64_t seed : {0, 1, 12345}) {
    for (const uint64_t passes : {1, 2, 8, 64}) {
      std::vector<double> places;
      for (uint64_t pass = 0; pass < passes; ++pass) {
        const Wavelengths wavelengths = Wavelengths::OfPass(seed, pass);
        for (int lane = 0; lane < Wavelengths::kLanes; ++lane) places.push_back(QuantileOf(wavelengths[lane]));
      }
      std::sort(places.begin(), places.end());
      const double step = 1.0 / static_cast<double>(places.size());
      for (size_t i = 1; i < places.size(); ++i) ASSERT_NEAR(places[i] - places[i - 1], step, 1e-8) << seed << " " << i;
    }
  }
}

TEST(Wavelengths, SeedsAndPassesDiffer) {
  for (uint64_t a = 0; a < 8; ++a) {
    for (uint64_t b = 0; b < a; ++b) {
      EXPECT_GT(std::abs(Wavelengths::OfPass(a, 0)[1] - Wavelengths::OfPass(b, 0)[1]), 0.1) << a << " " << b;
      EXPECT_GT(std::abs(Wavelengths::OfPass(0, a)[1] - Wavelengths::OfPass(0, b)[1]), 0.1) << a << " " << b;
    }
    EXPECT_EQ(Wavelengths::OfPass(a, 5)[0], Wavelengths::OfPass(a, 5)[0]);
  }
}

}  // namespace
}  // namespace lampyr
