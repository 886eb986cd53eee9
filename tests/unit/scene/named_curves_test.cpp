// The named spectra as curves, against published figures and against their colours in RGB.
#include <gmock/gmock.h>

#include <map>

#include "scene/spectrum.h"
#include "spectral/cie.h"
#include "spectral/color_space.h"
#include "spectral/wavelengths.h"

namespace lampyr {
namespace {

SpectralCurve CurveNamed(const std::string& name, SpectrumRole role) {
  const auto curve = FindNamedCurve(name, role);
  EXPECT_TRUE(curve.has_value()) << name;
  return curve.value_or(SpectralCurve());
}

bool IsIlluminant(const std::string& name) {
  return name.starts_with("stdillum") || name.starts_with("illum");
}

struct Chromaticity {
  double x, y;
};

// Chromaticity of light relative to D65.
Chromaticity ChromaticityOf(const SpectralCurve& relativeToWhite) {
  const Vector3d xyz = Rec709ToXyz() * ColorOf(relativeToWhite);
  const double sum = xyz.x + xyz.y + xyz.z;
  return {xyz.x / sum, xyz.y / sum};
}

// The mean that each channel sees, as SpectrumToColor has it.
Color MeanOf(const SpectralCurve& curve) {
  std::vector<SpectrumSample> samples;
  for (size_t i = 0; i < SpectralCurve::kCount; ++i)
    samples.push_back({SpectralCurve::WavelengthOf(i), curve.Entry(i)});
  return SpectrumToColor(samples, SpectrumRole::Unbounded);
}

void ExpectNear(const Color& found, const Color& expected, float relative, float absolute, const std::string& what) {
  EXPECT_NEAR(found.r, expected.r, relative * expected.r + absolute) << what;
  EXPECT_NEAR(found.g, expected.g, relative * expected.g + absolute) << what;
  EXPECT_NEAR(found.b, expected.b, relative * expected.b + absolute) << what;
}

TEST(NamedCurves, EveryNameHasOne) {
  for (const std::string& name : SpectrumNames()) {
    for (const SpectrumRole role : {SpectrumRole::Albedo, SpectrumRole::Unbounded, SpectrumRole::Illuminant}) {
      const SpectralCurve curve = CurveNamed(name, role);
      for (size_t i = 0; i < SpectralCurve::kCount; ++i) {
        ASSERT_TRUE(std::isfinite(curve.Entry(i)) && curve.Entry(i) >= 0) << name << " " << curve.Entry(i);
        ASSERT_TRUE(role != SpectrumRole::Albedo || curve.Entry(i) <= 1) << name << " " << curve.Entry(i);
      }
    }
  }
  for (const char* name : {"metal-Xx-eta", "stdillum-F13", "stdillum-F0", "glass-", ""})
    EXPECT_FALSE(FindNamedCurve(name, SpectrumRole::Unbounded).has_value()) << name;
}

// n_d and the Abbe number of the data sheets: (n_d - 1) / (n_F - n_C).
TEST(NamedCurves, GlassesHaveTheFiguresOfTheirDataSheets) {
  struct Sheet {
    const char* name;
    double index, abbe;
  };
  constexpr double kD = 587.5618, kF = 486.1327, kC = 656.2725;  // nm
  for (const Sheet& sheet :
       {Sheet{"glass-BK7", 1.51680, 64.17}, Sheet{"glass-BAF10", 1.67003, 47.11}, Sheet{"glass-FK51A", 1.48656, 84.47},
        Sheet{"glass-LASF9", 1.85025, 32.17}, Sheet{"glass-F5", 1.67271, 32.25}, Sheet{"glass-F10", 1.72828, 28.53},
        Sheet{"glass-F11", 1.78472, 25.68}}) {
    const SpectralCurve curve = CurveNamed(sheet.name, SpectrumRole::Unbounded);
    EXPECT_NEAR(curve.At(kD), sheet.index, 1e-5) << sheet.name;
    EXPECT_NEAR((curve.At(kD) - 1) / (curve.At(kF) - curve.At(kC)), sheet.abbe, 0.01) << sheet.name;
    for (size_t i = 1; i < SpectralCurve::kCount; ++i) ASSERT_LT(curve.Entry(i), curve.Entry(i - 1)) << sheet.name;
  }
}

TEST(NamedCurves, MetalsAreTheirColoursAtThreeWavelengths) {
  for (const std::string& name : SpectrumNames()) {
    if (!name.starts_with("metal-")) continue;
    const SpectralCurve curve = CurveNamed(name, SpectrumRole::Unbounded);
    const Color rgb = *FindNamedSpectrum(name, SpectrumRole::Unbounded);
    EXPECT_NEAR(curve.At(630), double(rgb.r), 0.01 * double(rgb.r)) << name;
    EXPECT_NEAR(curve.At(532), double(rgb.g), 0.01 * double(rgb.g)) << name;
    EXPECT_NEAR(curve.At(465), double(rgb.b), 0.01 * double(rgb.b)) << name;
  }
}

// Entries of the sources, in the middle of the visible range and beyond the colours.
TEST(NamedCurves, MetalsPassThroughWhatWasMeasured) {
  const auto at = [](const char* name, double wavelength) {
    return CurveNamed(name, SpectrumRole::Unbounded).At(wavelength);
  };
  // 3, 2 and 1.5 eV.
  EXPECT_NEAR(at("metal-Au-eta", 413.281), 1.636, 1e-3);
  EXPECT_NEAR(at("metal-Cu-k", 619.921), 3.24, 2e-3);
  EXPECT_NEAR(at("metal-Al-eta", 826.561), 2.74, 4e-3);
  EXPECT_NEAR(at("metal-CuZn-eta", 500), 0.686, 1e-9);
  EXPECT_NEAR(at("metal-CuZn-k", 700), 4.106, 1e-9);
  // Between those that are kept.
  EXPECT_NEAR(at("metal-CuZn-eta", 450), 1.094, 3e-3);
  EXPECT_NEAR(at("metal-CuZn-k", 470), 1.957, 3e-3);
  // Lines of sodium and of mercury.
  EXPECT_NEAR(at("metal-MgO-eta", 589.26), 1.73737, 2e-4);
  EXPECT_NEAR(at("metal-MgO-eta", 404.63), 1.76104, 3e-4);
  EXPECT_NEAR(at("metal-TiO2-eta", 589.3), 2.909, 2e-3);
  EXPECT_NEAR(at("metal-TiO2-eta", 435.8), 3.216, 1e-2);
}

TEST(NamedCurves, IlluminantsHaveTheirChromaticities) {
  // [CIE15].
  const std::map<std::string, Chromaticity> published = {
      {"stdillum-A", {0.44758, 0.40745}},    {"stdillum-D50", {0.34567, 0.35850}}, {"stdillum-D65", {0.3127, 0.3290}},
      {"illum-acesD60", {0.32168, 0.33767}}, {"stdillum-F1", {0.3131, 0.3371}},    {"stdillum-F2", {0.3721, 0.3751}},
      {"stdillum-F3", {0.4091, 0.3941}},     {"stdillum-F4", {0.4402, 0.4031}},    {"stdillum-F5", {0.3138, 0.3452}},
      {"stdillum-F6", {0.3779, 0.3882}},     {"stdillum-F7", {0.3129, 0.3292}},    {"stdillum-F8", {0.3458, 0.3586}},
      {"stdillum-F9", {0.3741, 0.3727}},     {"stdillum-F10", {0.3458, 0.3588}},   {"stdillum-F11", {0.3805, 0.3769}},
      {"stdillum-F12", {0.4370, 0.4042}},
  };
  for (const std::string& name : SpectrumNames()) {
    if (!IsIlluminant(name)) continue;
    const Chromaticity found = ChromaticityOf(CurveNamed(name, SpectrumRole::Illuminant));
    ASSERT_TRUE(published.contains(name)) << name;
    // F lamps are within 5e-4, A within 1.2e-3: the matching functions are a fit.
    EXPECT_NEAR(found.x, published.at(name).x, 0.002) << name;
    EXPECT_NEAR(found.y, published.at(name).y, 0.002) << name;
  }
}

// Values that the tables of [CIE15] have, relative to another entry.
TEST(NamedCurves, IlluminantsHaveTheirShapes) {
  const auto ratio = [](const char* name, double a, double b) {
    const SpectralCurve curve = CurveNamed(name, SpectrumRole::Illuminant);
    return curve.At(a) * DaylightD65(a) / (curve.At(b) * DaylightD65(b));
  };
  EXPECT_NEAR(ratio("stdillum-A", 400, 560), 0.147080, 1e-5);
  EXPECT_NEAR(ratio("stdillum-A", 700, 560), 1.98261, 1e-4);
  EXPECT_NEAR(ratio("stdillum-D50", 400, 560), 0.4931, 1e-4);
  EXPECT_NEAR(ratio("stdillum-D50", 700, 560), 0.9163, 1e-3);
  EXPECT_NEAR(ratio("stdillum-F2", 435, 560), 34.98 / 16.16, 1e-9);
  EXPECT_NEAR(ratio("stdillum-F11", 545, 560), 72.84 / 2.83, 1e-9);
  EXPECT_EQ(CurveNamed("stdillum-F2", SpectrumRole::Illuminant).At(379), 0);
  EXPECT_EQ(CurveNamed("stdillum-F2", SpectrumRole::Illuminant).At(781), 0);
}

TEST(NamedCurves, DaylightIsExactlyWhite) {
  const SpectralCurve named = CurveNamed("stdillum-D65", SpectrumRole::Illuminant);
  const SpectralCurve power = CurveOfPower(SpectralCurve(DaylightD65), SpectrumRole::Illuminant);
  for (size_t i = 0; i < SpectralCurve::kCount; ++i) {
    ASSERT_EQ(named.Entry(i), 1);
    ASSERT_NEAR(power.Entry(i), 1, 1e-6) << SpectralCurve::WavelengthOf(i);
  }
}

// RGB has the chromaticity as published, and the curve what the fitted matching functions make of it.
TEST(NamedCurves, LightHasTheColourItHasInRgb) {
  for (const std::string& name : SpectrumNames()) {
    if (!IsIlluminant(name)) continue;
    ExpectNear(ClampToGamut(ColorOf(CurveNamed(name, SpectrumRole::Illuminant))),
               *FindNamedSpectrum(name, SpectrumRole::Illuminant), 0, 0.02f, name);
  }
}

// Glasses have one index in RGB, and oxides that of three wavelengths.
TEST(NamedCurves, IndicesHaveTheMeanTheyHaveInRgb) {
  for (const std::string& name : SpectrumNames()) {
    if (!name.starts_with("glass-") && !name.starts_with("metal-MgO") && !name.starts_with("metal-TiO2")) continue;
    ExpectNear(MeanOf(CurveNamed(name, SpectrumRole::Unbounded)), *FindNamedSpectrum(name, SpectrumRole::Unbounded),
               0.02f, 0, name);
  }
}

// η and k of metals change within a channel, so that its mean is not that of RGB, at one wavelength. What they look
// like is near: normal reflectance.
TEST(NamedCurves, MetalsLookAsInRgb) {
  const auto reflectance = [](double eta, double k) {
    return ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
  };
  for (const std::string metal : {"Ag", "Al", "Au", "Cu", "CuZn"}) {
    const std::string eta = "metal-" + metal + "-eta", k = "metal-" + metal + "-k";
    const SpectralCurve etaCurve = CurveNamed(eta, SpectrumRole::Unbounded);
    const SpectralCurve kCurve = CurveNamed(k, SpectrumRole::Unbounded);
    const SpectralCurve curve([&](double w) { return reflectance(etaCurve.At(w), kCurve.At(w)); });
    const Color etaRgb = *FindNamedSpectrum(eta, SpectrumRole::Unbounded);
    const Color kRgb = *FindNamedSpectrum(k, SpectrumRole::Unbounded);
    const auto channel = [&](float e, float x) { return static_cast<float>(reflectance(double(e), double(x))); };
    const Color rgb(channel(etaRgb.r, kRgb.r), channel(etaRgb.g, kRgb.g), channel(etaRgb.b, kRgb.b));
    ExpectNear(ClampToGamut(ColorOf(curve)), rgb, 0, 0.1f, metal);
  }
}

TEST(NamedCurves, AReflectanceIsAtMostOne) {
  EXPECT_EQ(CurveNamed("metal-Ag-k", SpectrumRole::Albedo).At(600), 1);
  EXPECT_NEAR(CurveNamed("metal-Ag-eta", SpectrumRole::Albedo).At(600), 0.124, 2e-3);
  EXPECT_EQ(CurveNamed("stdillum-F2", SpectrumRole::Albedo).Largest(), 1);
}

}  // namespace
}  // namespace lampyr
