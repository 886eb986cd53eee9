// Spectra and colour spaces against published colours.
#include "scene/spectrum.h"

#include <gmock/gmock.h>

#include "spectral/cie.h"
#include "spectral/color_space.h"
#include "spectral/wavelengths.h"
#include "unit/scene/scene_support.h"

namespace lampyr {
namespace {

using testing::HasSubstr;

std::vector<SpectrumSample> Sampled(double (*f)(double)) {
  std::vector<SpectrumSample> samples;
  for (double lambda = 300; lambda <= 830; lambda += 5) samples.push_back({lambda, f(lambda)});
  return samples;
}

void ExpectColor(const Color& color, const Color& expected, float tolerance) {
  EXPECT_NEAR(color.r, expected.r, tolerance);
  EXPECT_NEAR(color.g, expected.g, tolerance);
  EXPECT_NEAR(color.b, expected.b, tolerance);
}

TEST(Spectrum, DaylightIsWhiteWhateverItsScale) {
  const std::vector<SpectrumSample> d65 = Sampled(DaylightD65);
  ExpectColor(SpectrumToColor(d65, SpectrumRole::Illuminant), Color(1), 2e-3f);
  for (const double scale : {1e-30, 1e30}) {
    std::vector<SpectrumSample> scaled = d65;
    for (SpectrumSample& s : scaled) s.value *= scale;
    ExpectColor(SpectrumToColor(scaled, SpectrumRole::Illuminant), Color(1), 2e-3f);
  }
  EXPECT_EQ(FindNamedSpectrum("stdillum-D65", SpectrumRole::Illuminant), Color(1.0f));
}

// The fitted observer and the daylight formula, before calibration, against the tabulated white point.
TEST(Spectrum, DaylightHasTheChromaticityOfD65) {
  Vector3d xyz(0.0);
  for (double lambda = kLambdaMin; lambda <= kLambdaMax; ++lambda) xyz += ColorMatching(lambda) * DaylightD65(lambda);
  const double sum = xyz.x + xyz.y + xyz.z;
  EXPECT_NEAR(xyz.x / sum, 0.3127, 2e-3);
  EXPECT_NEAR(xyz.y / sum, 0.3290, 2e-3);
  EXPECT_DOUBLE_EQ(DaylightD65(560), 100);
  // The values tabulated for D65 [CIE15].
  EXPECT_NEAR(DaylightD65(380), 49.9755, 1e-4);
  EXPECT_NEAR(DaylightD65(400), 82.7549, 1e-4);
  EXPECT_NEAR(DaylightD65(460), 117.812, 1e-3);
  EXPECT_NEAR(DaylightD65(700), 71.6091, 1e-4);
}

TEST(Spectrum, ConstantReflectanceIsGrey) {
  for (const double value : {0.0, 0.2, 0.5, 1.0}) {
    const std::vector<SpectrumSample> spectrum = {{300, value}, {900, value}};
    ExpectColor(SpectrumToColor(spectrum, SpectrumRole::Albedo), Color(static_cast<float>(value)), 1e-6f);
    ExpectColor(SpectrumToColor({{500, value}, {600, value}}, SpectrumRole::Unbounded),
                Color(static_cast<float>(value)), 1e-6f);
  }
  ExpectColor(SpectrumToColor({{400, 3}, {700, 3}}, SpectrumRole::Unbounded), Color(3), 1e-5f);
}

// A dye that absorbs in a band absorbs nothing else; an index of refraction is measured in a part of the spectrum.
TEST(Spectrum, ExtinctionIsZeroBeyondItsSamplesAndIndicesGoOn) {
  const std::vector<SpectrumSample> band = {{500, 1}, {600, 1}};
  const std::vector<SpectrumSample> whole = {{300, 0}, {499.99, 0}, {500, 1}, {600, 1}, {600.01, 0}, {900, 0}};
  const Color extinction = SpectrumToColor(band, SpectrumRole::Extinction);
  ExpectColor(extinction, SpectrumToColor(whole, SpectrumRole::Extinction), 1e-3f);
  EXPECT_LT(extinction.b, 0.2f);
  EXPECT_EQ(CurveOf(band, SpectrumRole::Extinction).At(450), 0);
  EXPECT_EQ(CurveOf(band, SpectrumRole::Extinction).At(550), 1);
  ExpectColor(SpectrumToColor(band, SpectrumRole::Unbounded), Color(1), 1e-6f);
  EXPECT_EQ(CurveOf(band, SpectrumRole::Unbounded).At(450), 1);
}

TEST(Spectrum, UnboundedAveragesEachChannel) {
  const Color rising = SpectrumToColor({{400, 1}, {700, 4}}, SpectrumRole::Unbounded);
  // Mean wavelengths of the channels are near 450, 545 and 605 nm.
  EXPECT_NEAR(rising.b, 1.55, 0.15);
  EXPECT_NEAR(rising.g, 2.45, 0.15);
  EXPECT_NEAR(rising.r, 3.0, 0.2);
}

TEST(Spectrum, LightHasLuminanceOne) {
  for (const double kelvin : {1.0, 500.0, 1000.0, 2856.0, 6500.0, 20000.0, 1e9, 1e30, 1e-30}) {
    const Color color = BlackbodyToColor(kelvin, SpectrumRole::Illuminant);
    EXPECT_TRUE(color.IsValid()) << kelvin;
    EXPECT_NEAR(color.Luminance(), 1, 1e-4) << kelvin;
  }
  const Color line = SpectrumToColor({{519.99, 0}, {520, 1}, {520.01, 0}}, SpectrumRole::Illuminant);
  EXPECT_NEAR(line.Luminance(), 1, 1e-4);
  EXPECT_EQ(line.r, 0);
  EXPECT_EQ(SpectrumToColor({{400, 0}, {700, 0}}, SpectrumRole::Illuminant), Color(0.0f));
  EXPECT_EQ(SpectrumToColor({{100, 1}, {200, 1}}, SpectrumRole::Illuminant), Color(0.0f));
}

TEST(Spectrum, BlackbodyColours) {
  // Planckian locus: 2856 K is illuminant A (0.4476, 0.4075), 6500 K is (0.3135, 0.3237).
  ExpectColor(BlackbodyToColor(2856, SpectrumRole::Illuminant),
              ClampToGamut(XyzToRec709(XyzOfChromaticity(0.44757, 0.40745))), 0.03f);
  ExpectColor(BlackbodyToColor(6500, SpectrumRole::Illuminant),
              ClampToGamut(XyzToRec709(XyzOfChromaticity(0.3135, 0.3237))), 0.02f);
  EXPECT_GT(BlackbodyToColor(3000, SpectrumRole::Illuminant).r, 1.5f);
  EXPECT_GT(BlackbodyToColor(15000, SpectrumRole::Illuminant).b, 1.3f);
}

TEST(Spectrum, NamedOnes) {
  for (const std::string& name : SpectrumNames()) {
    for (const SpectrumRole role : {SpectrumRole::Albedo, SpectrumRole::Unbounded, SpectrumRole::Illuminant}) {
      const auto color = FindNamedSpectrum(name, role);
      ASSERT_TRUE(color.has_value()) << name;
      EXPECT_TRUE(color->IsValid()) << name;
      const bool isLight = name.starts_with("stdillum") && role == SpectrumRole::Illuminant;
      EXPECT_TRUE(!isLight || std::abs(color->Luminance() - 1) < 1e-4f) << name;
    }
  }
  EXPECT_EQ(FindNamedSpectrum("glass-BK7", SpectrumRole::Unbounded), Color(1.5168f));
  EXPECT_EQ(FindNamedSpectrum("metal-Xx-eta", SpectrumRole::Unbounded), std::nullopt);
  // Normal reflectance ((η-1)² + k²) / ((η+1)² + k²) of gold: reddish, and of silver: above 90 %.
  const auto reflectance = [](const std::string& metal) {
    const Color eta = *FindNamedSpectrum("metal-" + metal + "-eta", SpectrumRole::Unbounded);
    const Color k = *FindNamedSpectrum("metal-" + metal + "-k", SpectrumRole::Unbounded);
    const auto one = [](float n, float x) { return (Sqr(n - 1) + x * x) / (Sqr(n + 1) + x * x); };
    return Color(one(eta.r, k.r), one(eta.g, k.g), one(eta.b, k.b));
  };
  ExpectColor(reflectance("Au"), Color(0.93f, 0.77f, 0.39f), 0.02f);
  ExpectColor(reflectance("CuZn"), Color(0.88f, 0.76f, 0.49f), 0.02f);
  ExpectColor(reflectance("Ag"), Color(0.97f, 0.95f, 0.93f), 0.03f);
  ExpectColor(reflectance("Cu"), Color(0.92f, 0.61f, 0.57f), 0.02f);
  ExpectColor(reflectance("Al"), Color(0.91f, 0.92f, 0.92f), 0.02f);
}

double PowerOf(const SpectralCurve& curve) {
  double sum = 0;
  for (size_t i = 0; i < SpectralCurve::kCount; ++i) sum += curve.Entry(i);
  return sum;
}

TEST(Spectrum, CurvesAreOfThePairs) {
  const SpectralCurve ramp = CurveOf({{400, 0}, {700, 3}}, SpectrumRole::Unbounded);
  EXPECT_NEAR(ramp.At(550), 1.5, 1e-9);
  EXPECT_NEAR(ramp.At(380), 0, 1e-9);
  EXPECT_NEAR(ramp.At(750), 3, 1e-9) << "ends continue";
  const SpectralCurve surface = CurveOf({{400, 0}, {700, 3}}, SpectrumRole::Albedo);
  EXPECT_NEAR(surface.At(450), 0.5, 1e-9);
  EXPECT_EQ(surface.At(600), 1);
  EXPECT_EQ(surface.At(750), 0);
}

TEST(Spectrum, ANarrowLineKeepsItsPower) {
  // A triangle of 0.2 nm, at an entry, between two, and where their ranges meet.
  for (const double first : {501.0, 501.25, 501.4}) {
    const std::vector<SpectrumSample> line = {{first, 0}, {first + 0.1, 1}, {first + 0.2, 0}};
    EXPECT_NEAR(PowerOf(CurveOf(line, SpectrumRole::Unbounded)), 0.1, 0.002) << first;
    const SpectralCurve light = CurveOf(line, SpectrumRole::Illuminant);
    const Color color = ClampToGamut(ColorOf(light));
    EXPECT_NEAR(color.Luminance(), 1, 1e-4) << first;
    ExpectColor(color, SpectrumToColor(line, SpectrumRole::Illuminant), 0.02f);
    EXPECT_EQ(light.At(499), 0);
    EXPECT_EQ(light.At(504), 0);
  }
}

TEST(Spectrum, CurvesOfBlackbodiesHaveTheirColours) {
  for (const double kelvin : {2856.0, 6500.0, 12000.0}) {
    const Vector3d color = ColorOf(BlackbodyCurve(kelvin, SpectrumRole::Illuminant));
    ASSERT_GT(std::min({color.x, color.y, color.z}), 0) << "within the gamut";
    ExpectColor(Color(static_cast<float>(color.x), static_cast<float>(color.y), static_cast<float>(color.z)),
                BlackbodyToColor(kelvin, SpectrumRole::Illuminant), 1e-3f);
  }
  const SpectralCurve surface = BlackbodyCurve(3000, SpectrumRole::Albedo);
  EXPECT_EQ(surface.Largest(), 1);
  ExpectColor(ClampToGamut(ColorOf(surface)), BlackbodyToColor(3000, SpectrumRole::Albedo), 1e-3f);
}

TEST(Spectrum, CurvesOfPowerAreRelativeToDaylight) {
  for (const double scale : {1e-30, 1.0, 1e30}) {
    const SpectralCurve power([&](double wavelength) { return scale * DaylightD65(wavelength); });
    const SpectralCurve light = CurveOfPower(power, SpectrumRole::Illuminant);
    for (size_t i = 0; i < SpectralCurve::kCount; ++i) ASSERT_NEAR(light.Entry(i), 1, 1e-6) << scale;
    EXPECT_NEAR(CurveOfPower(power, SpectrumRole::Albedo).Largest(), 1, 1e-12);
    EXPECT_NEAR(CurveOfPower(power, SpectrumRole::Albedo).At(560), 100 / DaylightD65(460), 1e-12);
  }
  const SpectralCurve dark = CurveOfPower(SpectralCurve(), SpectrumRole::Illuminant);
  EXPECT_EQ(dark.Largest(), 0);
}

// Lines narrower than the table of a curve keep their power, wherever they are.
TEST(Spectrum, CurvesOfLinesHaveTheirColours) {
  for (const double width : {1e-3, 0.02, 0.7, 3.0}) {
    for (const double at : {500.0, 500.016, 600.031, 550.49}) {
      const std::vector<SpectrumSample> lines = {{at - width, 0}, {at, 1},     {at + width, 0},
                                                 {640, 0},        {640.01, 2}, {640.02, 0}};
      const SpectralCurve curve = CurveOf(lines, SpectrumRole::Unbounded);
      double power = 0;
      for (size_t i = 0; i < SpectralCurve::kCount; ++i) power += curve.Entry(i);
      EXPECT_NEAR(power, width + 0.02, 1e-9 + 1e-6 * width);
    }
  }
  const std::vector<SpectrumSample> ends = {{500.25, 2}, {600.5, 4}};
  EXPECT_NEAR(CurveOf(ends, SpectrumRole::Unbounded).At(500), 2 + 0.25 * 0.25 * 0.5 * 2 / 100.25, 1e-12);
  EXPECT_NEAR(CurveOf(ends, SpectrumRole::Extinction).At(500), 0.25 * (2 + 0.125 * 2 / 100.25), 1e-12);
  EXPECT_EQ(CurveOf(ends, SpectrumRole::Unbounded).At(450), 2);
  EXPECT_EQ(CurveOf(ends, SpectrumRole::Unbounded).At(700), 4);
}

TEST(Spectrum, PairsAreChecked) {
  const auto error = [](const std::vector<double>& numbers) {
    return ErrorOf([&] { SpectrumFromPairs(numbers, SpectrumRole::Unbounded, {}); });
  };
  EXPECT_THAT(error({400, 1, 500}), HasSubstr("3 numbers are not a multiple of 2"));
  EXPECT_THAT(error({400, 1}), HasSubstr("at least 2 pairs"));
  EXPECT_THAT(error({400, 1, 400, 2}), HasSubstr("pair 2 of the spectrum does not have a longer wavelength"));
  EXPECT_THAT(error({400, 1, 500, -2}), HasSubstr("pair 2 of the spectrum has a negative value"));
  EXPECT_THAT(error({0, 1, 500, 2}), HasSubstr("not above 0 nm"));
  EXPECT_THAT(error({0.4, 1, 0.7, 2}), HasSubstr("Are these micrometres?"));
  const auto reflectance = [](double value) { SpectrumFromPairs({400, 0.5, 700, value}, SpectrumRole::Albedo, {}); };
  EXPECT_THAT(ErrorOf([&] { reflectance(40); }), HasSubstr("pair 2 of the spectrum has a value above 1"));
  EXPECT_NO_THROW(reflectance(1.02));  // of measurements
}

TEST(Spectrum, FilesAndNamesThroughParameters) {
  const TemporaryFolder folder;
  folder.Write("flat.spd", "# flat\n300 0.25\n900 0.25\n");
  folder.Write("bad.spd", "300 0.25\n400 x\n");
  folder.Write("percent.spd", "# percent\n300 0.25\n400 25\n");
  const auto scene =
      folder.Write("s.pbrt",
                   "WorldBegin\nShape \"s\" \"spectrum a\" \"flat.spd\" \"spectrum b\" \"bad.spd\"\n"
                   "\"spectrum c\" \"metal-au-eta\" \"spectrum d\" [ 300 .5 900 .5 ] \"spectrum e\" \"percent.spd\"");
  Diagnostics strict(Diagnostics::Mode::Strict);
  const SceneDescription description = ReadScene(scene, strict);
  const ParameterList& list = description.shapes.at(0).shape.parameters;
  ExpectColor(list.GetColor("a", {}, SpectrumRole::Albedo), Color(0.25f), 1e-6f);
  EXPECT_EQ(ErrorOf([&] { list.FindColor("b", SpectrumRole::Albedo); }),
            (folder / "bad.spd").string() + ":2:5: error: \"x\" is not a number");
  EXPECT_EQ(
      ErrorOf([&] { list.FindColor("c", SpectrumRole::Unbounded); }),
      scene.string() +
          ":3:1: error: \"metal-au-eta\" is neither a spectrum's name nor a file (did you mean \"metal-Au-eta\"?)");
  ExpectColor(list.GetColor("d", {}, SpectrumRole::Albedo), Color(0.5f), 1e-6f);
  EXPECT_THAT(ErrorOf([&] { list.FindColor("e", SpectrumRole::Albedo); }),
              HasSubstr("percent.spd:3:1: error: pair 2 of the spectrum has a value above 1"));
}

TEST(ColorSpace, PublishedMatrices) {
  // Display P3 and Rec. 2020 red in linear Rec. 709 (published conversion matrices).
  const Vector3d p3 = ToRec709({1, 0, 0}, RgbColorSpace::DciP3, WhiteHandling::Adapt);
  EXPECT_NEAR(p3.x, 1.2249, 2e-3);
  EXPECT_NEAR(p3.y, -0.0420, 2e-3);
  EXPECT_NEAR(p3.z, -0.0196, 2e-3);
  const Vector3d rec2020 = ToRec709({1, 0, 0}, RgbColorSpace::Rec2020, WhiteHandling::Keep);
  EXPECT_NEAR(rec2020.x, 1.6605, 2e-3);
  EXPECT_NEAR(rec2020.y, -0.1246, 2e-3);
  EXPECT_NEAR(rec2020.z, -0.0182, 2e-3);
  const Vector3d aces = ToRec709({1, 0, 0}, RgbColorSpace::Aces2065, WhiteHandling::Adapt);
  EXPECT_NEAR(aces.x, 2.5217, 2e-2);
  EXPECT_NEAR(aces.y, -0.2765, 1e-2);
  EXPECT_NEAR(aces.z, -0.0154, 1e-2);
}

TEST(ColorSpace, WhiteStaysForReflectanceAndIsWarmForAcesLight) {
  for (const RgbColorSpace space :
       {RgbColorSpace::Srgb, RgbColorSpace::DciP3, RgbColorSpace::Rec2020, RgbColorSpace::Aces2065}) {
    const Vector3d white = ToRec709({1, 1, 1}, space, WhiteHandling::Adapt);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(white[i], 1, 1e-9);
  }
  const Vector3d light = ToRec709({1, 1, 1}, RgbColorSpace::Aces2065, WhiteHandling::Keep);
  EXPECT_GT(light.x, 1.03);
  EXPECT_LT(light.z, 0.95);
  const Color luminance(static_cast<float>(light.x), static_cast<float>(light.y), static_cast<float>(light.z));
  EXPECT_NEAR(luminance.Luminance(), 1, 1e-4);
}

TEST(ColorSpace, ConvertsWhatIsWrittenUnderIt) {
  const SceneDescription scene =
      Parse(InWorld("AttributeBegin ColorSpace \"rec2020\" LightSource \"point\" \"rgb I\" [ 0 1 0 ] Material \"m\" "
                    "\"rgb r\" [ 0 1 0 ] AttributeEnd\n"
                    "LightSource \"point\" \"rgb I\" [ 0 1 0 ]"));
  EXPECT_EQ(scene.lights.at(1).light.parameters.GetColor("I", {}, SpectrumRole::Illuminant), Color(0, 1, 0));
  const Color wide = scene.lights.at(0).light.parameters.GetColor("I", {}, SpectrumRole::Illuminant);
  EXPECT_EQ(wide.r, 0);
  EXPECT_NEAR(wide.Luminance(), 0.6780, 1e-3) << "luminance of the Rec. 2020 green";
  const Color surface = scene.materials.at(0).parameters.GetColor("r", {}, SpectrumRole::Albedo);
  EXPECT_LE(surface.Max(), 1);
  EXPECT_TRUE(surface.IsValid());
}

// Luminances by Planck's law, summed over wavelengths apart from this code.
TEST(Spectrum, NormalizedBlackbodiesTellTemperaturesApart) {
  const double expected[][2] = {{700, 2.94643e-7}, {1000, 9.6054e-4}, {2000, 5.18084},
                                {6000, 100.739},   {1e4, 47.4037},    {1e5, 0.0202957}};
  for (const auto& [kelvin, luminance] : expected) {
    const Color color = NormalizedBlackbody(kelvin);
    EXPECT_NEAR(static_cast<double>(color.Luminance()), luminance, 1e-4 * luminance) << kelvin;
    const Color unit = BlackbodyToColor(kelvin, SpectrumRole::Illuminant) * color.Luminance();
    EXPECT_NEAR(unit.r, color.r, 1e-4f * color.r) << kelvin;
    EXPECT_NEAR(unit.b, color.b, 1e-4f * color.Max()) << kelvin;
  }
  EXPECT_TRUE(NormalizedBlackbody(100).IsValid());
}

}  // namespace
}  // namespace lampyr
