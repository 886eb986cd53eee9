// Cones and IES profiles on lights that are a point: value × intensity by hand, about which axis, and the power of the
// product.
#include "point_light_fixture.h"
#include "sampling/rng.h"

namespace lampyr {
namespace {

using test::ExpectColor;
using test::IntensityTo;
using test::PowerByQuadrature;

class ShapedPoints : public test::PointLightTest {
 protected:
  // 100, 60 and 0 cd at 0°, 45° and 90° from the nadir, alike all around.
  std::string Round() { return Profile("round.ies", "3 1", "0 45 90\n0\n100 60 0\n"); }
  // From 40 cd straight down to what differs by plane at the horizon: 10, 20, 30 and 40 cd at 0°, 90°, 180° and 270°;
  // nothing upwards.
  std::string FourSided() {
    return Profile("four.ies", "2 5", "0 90\n0 90 180 270 360\n40 10\n40 20\n40 30\n40 40\n40 10\n");
  }

 private:
  std::string Profile(const std::string& name, const std::string& counts, const std::string& angles) {
    return "\"string shaping:ies:file\" " +
           WriteText(name, "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 " + counts + " 1 2 0 0 0\n1 1 0\n" + angles);
  }
};

Vector3 Polar(double theta, double phi, const Vector3& axis, const Vector3& x, const Vector3& y) {
  const double t = theta * M_PI / 180, p = phi * M_PI / 180;
  return static_cast<float>(std::cos(t)) * axis + static_cast<float>(std::sin(t) * std::cos(p)) * x +
         static_cast<float>(std::sin(t) * std::sin(p)) * y;
}

TEST_F(ShapedPoints, ProfileTimesIntensityAboutMinusZ) {
  const auto light = Make("point", Round() + "\"rgb I\" [ 3 2 1 ] \"point3 from\" [ 0 0 1 ]");
  const auto at = [&](double theta, double phi) {
    return IntensityTo(*light, Point3(0, 0, 1) + 2.0f * Polar(theta, phi, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}));
  };
  for (const double phi : {0.0, 77.0, 200.0}) {
    ExpectColor(at(0, phi), {300, 200, 100}, 1e-4f);
    ExpectColor(at(22.5, phi), {240, 160, 80}, 1e-4f);
    ExpectColor(at(67.5, phi), {90, 60, 30}, 1e-4f);
    EXPECT_TRUE(at(91, phi).IsBlack());
  }
  // The four planes, halfway down to the horizon: φ from +x towards +y.
  const auto sided = Make("point", FourSided());
  const auto side = [&](double phi) { return IntensityTo(*sided, Polar(45, phi, {0, 0, -1}, {1, 0, 0}, {0, 1, 0})).g; };
  EXPECT_NEAR(side(0), 25, 1e-3);
  EXPECT_NEAR(side(90), 30, 1e-3);
  EXPECT_NEAR(side(180), 35, 1e-3);
  EXPECT_NEAR(side(270), 40, 1e-3);
  EXPECT_NEAR(side(135), 32.5, 1e-3);
}

TEST_F(ShapedPoints, NormalizeAndAngleScale) {
  // Normalised, a point keeps its power 4π I.
  const auto even = Make("point", FourSided() + "\"bool shaping:ies:normalize\" true \"rgb I\" [ 3 2 1 ]");
  ExpectColor(even->light->GetPowerEstimate(even->context), Color(3, 2, 1) * (4 * kPi), 1e-3f);
  ExpectColor(PowerByQuadrature(*even), Color(3, 2, 1) * (4 * kPi), 2e-3f);
  // Stretched to twice its angles: 45° of the file is at 90°.
  const auto wide = Make("point", Round() + "\"float shaping:ies:angleScale\" 2");
  EXPECT_NEAR(IntensityTo(*wide, Point3(1, 0, 0)).g, 60, 1e-2f);
  EXPECT_NEAR(IntensityTo(*wide, Point3(1, 0, -1)).g, 80, 1e-2f);
}

TEST_F(ShapedPoints, ConeOfAPoint) {
  // Softness 0.5 of 60°: full up to 30°, half at 45°, at 50° 1 - smoothstep(2/3) = 7/27.
  const auto light =
      Make("point", "\"rgb I\" [ 3 2 1 ] \"float shaping:cone:angle\" 60 \"float shaping:cone:softness\" 0.5");
  const auto at = [&](double theta) { return IntensityTo(*light, Polar(theta, 40, {0, 0, -1}, {1, 0, 0}, {0, 1, 0})); };
  ExpectColor(at(29), {3, 2, 1}, 1e-4f);
  ExpectColor(at(45), {1.5f, 1, 0.5f}, 1e-4f);
  ExpectColor(at(50), Color(3, 2, 1) * (7.0f / 27), 1e-4f);
  EXPECT_TRUE(at(60.1).IsBlack());
  // A sharp cone: 2π (1 - cosθ).
  const auto sharp = Make("point", "\"float shaping:cone:angle\" 60");
  EXPECT_NEAR(sharp->light->GetPowerEstimate(sharp->context).g, kPi, 1e-3f);
  const auto scaled = Make("point", "\"float shaping:cone:angle\" 60 \"float power\" 10");
  EXPECT_NEAR(scaled->light->GetPowerEstimate(scaled->context).g, 10, 1e-4f);
  EXPECT_NEAR(IntensityTo(*scaled, Point3(0, 0, -1)).g, 10 / kPi, 1e-3f);
  EXPECT_NEAR(sharp->light->GetEmissionBounds(sharp->context)->cosThetaE, 0.5f, 1e-4f);
  EXPECT_EQ(sharp->light->GetEmissionBounds(sharp->context)->axis, Vector3(0, 0, -1));
  // Only what lies in the cone is reached.
  const auto segment =
      sharp->light->GetIncidentRadianceEstimate(sharp->context, Point3(-9, 0, -1), Vector3(1, 0, 0), 18);
  ASSERT_TRUE(segment);
  EXPECT_NEAR(segment->minT, 9 - std::sqrt(3.0f), 2e-3f);
  EXPECT_NEAR(segment->maxT, 9 + std::sqrt(3.0f), 2e-3f);
  EXPECT_FALSE(sharp->light->GetIncidentRadianceEstimate(sharp->context, Point3(-9, 0, 1), Vector3(1, 0, 0), 18));
}

TEST_F(ShapedPoints, SpotIsShapedAboutItsAxis) {
  // Along -z as for points; the spot's own edge: a smoothstep of the cosine.
  const auto down =
      Make("spot", FourSided() + "\"point3 to\" [ 0 0 -1 ] \"float coneangle\" 60 \"float conedeltaangle\" 30");
  const double edge = 0.5, core = std::sqrt(0.75), t = (std::sqrt(0.5) - edge) / (core - edge);
  const auto own = static_cast<float>(t * t * (3 - 2 * t));
  EXPECT_NEAR(IntensityTo(*down, Polar(45, 90, {0, 0, -1}, {1, 0, 0}, {0, 1, 0})).g, 30 * own, 1e-2f);
  EXPECT_NEAR(IntensityTo(*down, Polar(20, 180, {0, 0, -1}, {1, 0, 0}, {0, 1, 0})).g, 40 - 10 * 2 / 9.0f, 1e-2f);
  EXPECT_TRUE(IntensityTo(*down, Polar(61, 180, {0, 0, -1}, {1, 0, 0}, {0, 1, 0})).IsBlack());
  // Along +y: φ = 0 at +x, φ = 90° where the axis and +x lead by the same hand, at y' = -axis × x = (0, 0, 1).
  const auto aside =
      Make("spot", FourSided() + "\"point3 to\" [ 0 1 0 ] \"float coneangle\" 80 \"float conedeltaangle\" 0");
  EXPECT_NEAR(IntensityTo(*aside, Polar(45, 0, {0, 1, 0}, {1, 0, 0}, {0, 0, 1})).g, 25, 1e-2f);
  EXPECT_NEAR(IntensityTo(*aside, Polar(45, 90, {0, 1, 0}, {1, 0, 0}, {0, 0, 1})).g, 30, 1e-2f);
  // The default looks along +z: turned about x.
  const auto up = Make("spot", FourSided() + "\"float coneangle\" 80 \"float conedeltaangle\" 0");
  EXPECT_NEAR(IntensityTo(*up, Polar(45, 0, {0, 0, 1}, {1, 0, 0}, {0, -1, 0})).g, 25, 1e-2f);
  EXPECT_NEAR(IntensityTo(*up, Polar(45, 90, {0, 0, 1}, {1, 0, 0}, {0, -1, 0})).g, 30, 1e-2f);
}

TEST_F(ShapedPoints, ImagesTimesProfiles) {
  const auto texel = [](int x, int y) { return Color(1.0f + x, 2, 3.0f + y); };
  const auto slide = Make("projection", Write(2, 2, texel) + FourSided());
  ExpectColor(IntensityTo(*slide, Point3(0.5f, 0, 1) + Vector3(0, 1e-4f, 0)),
              texel(1, 0) * static_cast<float>(40 - 30 * std::atan(0.5) / (M_PI / 2)), 1e-3f);
  ExpectColor(IntensityTo(*slide, Point3(1e-4f, -0.5f, 1)),
              texel(1, 1) * static_cast<float>(40 - 20 * std::atan(0.5) / (M_PI / 2)), 1e-3f);
  // The goniometric's image is black but for the middle, which is +y: at the profile's horizon, φ = 90°.
  const auto lamp = Make("goniometric", FourSided() + "\"rgb I\" [ 3 2 1 ] " + Write(3, 3, [](int x, int y) {
                                          return Color(x == 1 && y == 1 ? 5.0f : 0.0f);
                                        }));
  ExpectColor(IntensityTo(*lamp, Point3(0, 1, -1e-3f)), Color(3, 2, 1) * 100.0f, 2e-3f);
  EXPECT_TRUE(IntensityTo(*lamp, Point3(0, 1, 1e-3f)).IsBlack());
  EXPECT_TRUE(IntensityTo(*lamp, Point3(0, 0, -1)).IsBlack());
  // Without an image the profile is all there is, and nobody is warned.
  const auto bare = Make("goniometric", Round());
  EXPECT_NEAR(IntensityTo(*bare, Point3(0, 0, -2)).g, 100, 1e-2f);
  EXPECT_TRUE(diagnostics_.Warnings().empty()) << diagnostics_.Warnings().front();
}

TEST_F(ShapedPoints, PowerOfTheProduct) {
  const auto texel = [](int x, int y) { return Color(1 + Sqr(x - 3.0f), (x + y) % 3 ? 1.0f : 0.0f, 0.5f * y); };
  const std::string image = Write(7, 7, texel), ies = FourSided(), power = "\"float power\" 10 ";
  const Transform transforms[] = {Transform(), Transform::Rotate(50, {1, 2, -1}) * Transform::Scale({-2, 2, 2}),
                                  Transform::Rotate(50, {1, 2, -1}) * Transform::Scale({3, 0.5, 1})};
  const std::pair<std::string, std::string> lights[] = {
      {"point", ies + power},
      {"spot", ies + power + "\"float coneangle\" 70 \"float conedeltaangle\" 40"},
      {"spot", Round() + power + "\"float coneangle\" 10"},
      {"goniometric", ies + image + power},
      {"projection", ies + image + power + "\"float fov\" 70"},
      {"projection", image + power + "\"float fov\" 70 \"float shaping:cone:angle\" 15"}};
  for (const auto& [type, parameters] : lights) {
    for (size_t i = 0; i < std::size(transforms); ++i) {
      SCOPED_TRACE(type + " " + parameters + " transform " + std::to_string(i));
      const auto light = Make(type, parameters, transforms[i]);
      const Color estimate = light->light->GetPowerEstimate(light->context);
      ExpectColor(estimate, PowerByQuadrature(*light), i < 2 ? 3e-3f : 2e-2f);
      if (i < 2) {
        EXPECT_NEAR(estimate.Luminance(), 10, 1e-3f);
      }
    }
  }
}

// Where one factor is much narrower than the other, photons are not wasted on the other: the flux of a photon is nearly
// the power, whichever of the two is the narrow one.
TEST_F(ShapedPoints, PhotonsGoWhereTheProductIs) {
  const std::string image = Write(64, 64, [](int x, int y) { return Color(x == 30 && y == 33 ? 1.0f : 1e-7f); });
  for (const auto& [type, parameters] :
       {std::pair<std::string, std::string>("spot", FourSided() + "\"float coneangle\" 3 \"float conedeltaangle\" 1"),
        {"spot", "\"float coneangle\" 80 \"float shaping:cone:angle\" 3"},
        {"goniometric", image + Round() + "\"float shaping:ies:angleScale\" 2"},
        {"projection", Write(2, 2, [](int x, int) { return Color(1.0f + x); }) + "\"float shaping:cone:angle\" 2"}}) {
    const auto light = Make(type, parameters);
    const double power = light->light->GetPowerEstimate(light->context).Average();
    Rng rng(9);
    double sum = 0, squares = 0;
    constexpr int kPhotons = 20000;
    for (int i = 0; i < kPhotons; ++i) {
      light->context.u = rng.NextPoint2();
      const auto photon = light->light->GenerateEmission(light->context);
      const double flux =
          photon ? static_cast<double>(photon->diffuse.Average() / photon->pdfEmitDirection.value) : 0.0;
      sum += flux / power;
      squares += flux * flux / (power * power);
    }
    EXPECT_NEAR(sum / kPhotons, 1, 0.01) << type;
    EXPECT_LT(squares / kPhotons - 1, 0.2) << type << " " << parameters;
  }
}

TEST_F(ShapedPoints, DarkProductsAndErrors) {
  // A spot upwards, a profile that shines down: about the spot's axis it is lit, a goniometric image of above is not.
  const auto dark = Make("goniometric", FourSided() + "\"float power\" 3 " + Write(5, 5, [](int x, int y) {
                                          return Color(x == 2 && y == 4 ? 1.0f : 0.0f);
                                        }));
  EXPECT_FALSE(dark->light->GenerateEmission(dark->context));
  EXPECT_EQ(dark->light->GetPowerEstimate(dark->context).g, 0);
  EXPECT_THROW(Make("spot", "\"string shaping:ies:file\" \"nowhere.ies\""), Error);
  EXPECT_THROW(Make("spot", "\"string shaping:ies:file\" " + WriteText("bad.ies", "no profile\n")), Error);
  EXPECT_THROW(Make("point", "\"float shaping:cone:angle\" 200"), Error);
}

}  // namespace
}  // namespace lampyr
