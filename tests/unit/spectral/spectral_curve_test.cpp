// Curves, and the dispersion formulas, against values by hand and of a data sheet.
#include "spectral/spectral_curve.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lampyr {
namespace {

TEST(SpectralCurve, IsLinearBetweenItsEntries) {
  const SpectralCurve curve([](double wavelength) { return (wavelength - 500) * (wavelength - 500); });
  EXPECT_EQ(SpectralCurve::WavelengthOf(0), 360);
  EXPECT_EQ(SpectralCurve::WavelengthOf(SpectralCurve::kCount - 1), 830);
  EXPECT_EQ(curve.Entry(0), 140 * 140);
  EXPECT_EQ(curve.At(510), 100);
  EXPECT_EQ(curve.At(511), 121);
  EXPECT_NEAR(curve.At(510.25), 105.25, 1e-9);
  EXPECT_NEAR(curve.At(510.5), 110.5, 1e-9);
  EXPECT_NEAR(curve.At(829.5), (330.0 * 330 + 329.0 * 329) / 2, 1e-6);
}

TEST(SpectralCurve, ContinuesItsEnds) {
  const SpectralCurve curve([](double wavelength) { return wavelength; });
  for (const double below : {360.0, 359.0, 1.0, -5.0}) EXPECT_EQ(curve.At(below), 360) << below;
  for (const double above : {830.0, 831.0, 1e9}) EXPECT_EQ(curve.At(above), 830) << above;
}

TEST(SpectralCurve, KnowsItsLargestValueAndWhetherItIsConstant) {
  const SpectralCurve peak([](double wavelength) { return wavelength == 612 ? 3.0 : 2.0; });
  EXPECT_EQ(peak.Largest(), 3);
  EXPECT_FALSE(peak.IsConstant());
  EXPECT_TRUE(SpectralCurve([](double) { return 1.25; }).IsConstant());
  EXPECT_TRUE(SpectralCurve().IsConstant());
  EXPECT_EQ(SpectralCurve().At(500), 0);
}

TEST(SpectralCurve, SellmeierOfADataSheet) {
  const SellmeierCoefficients bk7{{1.03961212, 0.231792344, 1.01046945}, {0.00600069867, 0.0200179144, 103.560653}};
  // Lines h, F, d, C and t of N-BK7.
  EXPECT_NEAR(bk7.IndexAt(404.6561), 1.53024, 1e-5);
  EXPECT_NEAR(bk7.IndexAt(486.1327), 1.52238, 1e-5);
  EXPECT_NEAR(bk7.IndexAt(587.5618), 1.51680, 1e-5);
  EXPECT_NEAR(bk7.IndexAt(656.2725), 1.51432, 1e-5);
  EXPECT_NEAR(bk7.IndexAt(1013.98), 1.50731, 1e-5);
  // n² = 1 - 0.25 / 0.05.
  EXPECT_TRUE(std::isnan((SellmeierCoefficients{{1, 0, 0}, {0.3, 0, 0}}.IndexAt(500))));
  EXPECT_EQ(SellmeierCoefficients{}.IndexAt(500), 1);
}

TEST(SpectralCurve, CauchyByHand) {
  EXPECT_NEAR((CauchyCoefficients{1.5, 0.004, 0}.IndexAt(500)), 1.516, 1e-12);
  EXPECT_NEAR((CauchyCoefficients{1.5, 0.004, 0.0001}.IndexAt(500)), 1.5176, 1e-12);
  EXPECT_NEAR((CauchyCoefficients{1.5, 0.004, 0.0001}.IndexAt(800)), 1.5 + 0.00625 + 0.000244140625, 1e-12);
  EXPECT_EQ(CauchyCoefficients{}.IndexAt(400), 1);
}

}  // namespace
}  // namespace lampyr
