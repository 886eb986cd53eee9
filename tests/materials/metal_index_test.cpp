// Metals whose index is given by wavelength: the colour of what they reflect, where light is carried as RGB.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <string>

#include "materials/fresnel.h"
#include "materials/metal_index.h"
#include "scene/spectrum.h"

namespace lampyr {
namespace {

// Fresnel's formulas with complex numbers.
double ReflectanceOf(double cosine, std::complex<double> index) {
  const std::complex<double> refracted = std::sqrt(1.0 - (1 - cosine * cosine) / (index * index));
  const auto s = (cosine - index * refracted) / (cosine + index * refracted),
             p = (index * cosine - refracted) / (index * cosine + refracted);
  return 0.5 * (std::norm(s) + std::norm(p));
}

TEST(MetalIndex, ReflectsTheColourOfTheSpectrum) {
  for (const char* name : {"Ag", "Al", "Au", "Cu", "CuZn", "TiO2"}) {
    const std::string metal = std::string("metal-") + name;
    const auto eta = FindNamedCurve(metal + "-eta", SpectrumRole::Unbounded),
               k = FindNamedCurve(metal + "-k", SpectrumRole::Unbounded);
    ASSERT_TRUE(eta && k) << name;
    const MetalIndex index = RgbIndexOf(*eta, *k);
    for (const auto& [degrees, tolerance] : {std::pair(0, 3e-4f), std::pair(75, 0.02f), std::pair(40, 0.02f)}) {
      const double cosine = std::cos(degrees * M_PI / 180);
      std::vector<SpectrumSample> spectrum;
      for (int nm = SpectralCurve::kFirst; nm <= SpectralCurve::kLast; ++nm)
        spectrum.push_back({static_cast<double>(nm), ReflectanceOf(cosine, {eta->At(nm), k->At(nm)})});
      const Color expected = SpectrumToColor(spectrum, SpectrumRole::Albedo);
      const Color found = FresnelConductor(static_cast<float>(cosine), index.eta, index.k);
      EXPECT_NEAR(found.r, expected.r, tolerance) << name << " at " << degrees;
      EXPECT_NEAR(found.g, expected.g, tolerance) << name << " at " << degrees;
      EXPECT_NEAR(found.b, expected.b, tolerance) << name << " at " << degrees;
    }
  }
}

// The red of gold is brighter than white's, and is kept at 1.
TEST(MetalIndex, GoldIsAsRedAsCanBe) {
  const MetalIndex gold = RgbIndexOf(*FindNamedCurve("metal-Au-eta", SpectrumRole::Unbounded),
                                     *FindNamedCurve("metal-Au-k", SpectrumRole::Unbounded));
  const Color reflected = FresnelConductor(1, gold.eta, gold.k);
  EXPECT_GT(reflected.r, 0.999f);
  EXPECT_LE(reflected.r, 1.0f);
  EXPECT_NEAR(reflected.g, 0.783f, 0.003f);
  EXPECT_NEAR(reflected.b, 0.343f, 0.003f);
}

}  // namespace
}  // namespace lampyr
