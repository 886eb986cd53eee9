// Cone, focus and IES profile against values computed by hand; sampling, density and integrals against each other.
#include "shaping_fixture.h"

#include "sampling/rng.h"
#include "support/chi_squared.h"

namespace lampyr {
namespace {

using test::AtAngles;
using test::Emitter;
using test::IesOnDisk;
using test::IesText;
using test::MakeShaping;

std::string ErrorOf(const std::string& parameters) {
  try {
    MakeShaping(parameters);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Shaping, AbsentWithoutParameters) {
  EXPECT_EQ(MakeShaping(""), nullptr);
  EXPECT_EQ(MakeShaping("\"float shaping:focus\" 0"), nullptr);
  EXPECT_NE(MakeShaping("\"float shaping:cone:softness\" 0"), nullptr);
}

TEST(Shaping, HardConeEndsAtItsAngle) {
  const auto cone = MakeShaping("\"float shaping:cone:angle\" 30");
  for (const double phi : {0.0, 77.0, 180.0, 300.0}) {
    EXPECT_EQ(cone->Factor(AtAngles(0, phi)), Color(1));
    EXPECT_EQ(cone->Factor(AtAngles(29.999, phi)), Color(1));
    EXPECT_EQ(cone->Factor(AtAngles(30.001, phi)), Color(0));
    EXPECT_EQ(cone->Factor(AtAngles(150, phi)), Color(0));
  }
  // 2π (1 - cos 30°) = 0.841787; over the cosine: π sin² 30° = 0.785398; round: a quarter of the first.
  EXPECT_NEAR(cone->Integral().r, 0.841787f, 1e-5f);
  EXPECT_NEAR(MakeShaping("\"float shaping:cone:angle\" 30", Emitter::Flat)->Integral().g, 0.785398f, 1e-5f);
  EXPECT_NEAR(MakeShaping("\"float shaping:cone:angle\" 30", Emitter::Round)->Integral().b, 0.210447f, 1e-5f);
  EXPECT_EQ(cone->Largest(), 1);
  EXPECT_NEAR(cone->CosWidest(), 0.866025f, 1e-6f);
  EXPECT_LE(cone->CosWidest(), 0.8660254f);
}

TEST(Shaping, SoftConeIsASmoothstepOfTheAngle) {
  // Angle 40°, softness 0.25: from 30° to 40°. At 32.5° t = 1/4: 1 - 0.15625; at 35°: 1/2; at 37.5°: 0.15625.
  const auto cone = MakeShaping("\"float shaping:cone:angle\" 40 \"float shaping:cone:softness\" 0.25");
  EXPECT_EQ(cone->Factor(AtAngles(29.99)).r, 1);
  EXPECT_NEAR(cone->Factor(AtAngles(32.5, 10)).r, 0.84375f, 1e-5f);
  EXPECT_NEAR(cone->Factor(AtAngles(35, 100)).g, 0.5f, 1e-5f);
  EXPECT_NEAR(cone->Factor(AtAngles(37.5, 200)).b, 0.15625f, 1e-5f);
  EXPECT_EQ(cone->Factor(AtAngles(40.01)).r, 0);
  // Softness 1 begins on the axis: 90° at half of 180°: 1/2; 45°, t = 1/4: 0.84375.
  const auto wide = MakeShaping("\"float shaping:cone:angle\" 180 \"float shaping:cone:softness\" 1");
  EXPECT_NEAR(wide->Factor(AtAngles(90, 33)).r, 0.5f, 1e-5f);
  EXPECT_NEAR(wide->Factor(AtAngles(45, 33)).r, 0.84375f, 1e-5f);
  // Values beyond [0,1] are clamped, with a warning.
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const auto clamped =
      MakeShaping("\"float shaping:cone:angle\" 180 \"float shaping:cone:softness\" 3", Emitter::Point, &diagnostics);
  EXPECT_NEAR(clamped->Factor(AtAngles(45)).r, 0.84375f, 1e-5f);
  ASSERT_EQ(diagnostics.Warnings().size(), 1u);
  EXPECT_NE(diagnostics.Warnings()[0].find("clamped"), std::string::npos);
}

TEST(Shaping, NarrowConesKeepTheirDigits) {
  // 0.01°: 1 - cos = 1.5230871e-8, which float cosines cannot hold. Softness 0.5 begins at 0.005°: 0.0075° is 1/2.
  const auto hard = MakeShaping("\"float shaping:cone:angle\" 0.01");
  EXPECT_NEAR(hard->Integral().r / 9.569839e-8f, 1, 1e-4f);  // 2π · 1.5230871e-8
  EXPECT_EQ(hard->Factor(AtAngles(0.00999, 40)).r, 1);
  EXPECT_EQ(hard->Factor(AtAngles(0.01001, 40)).r, 0);
  const auto soft = MakeShaping("\"float shaping:cone:angle\" 0.01 \"float shaping:cone:softness\" 0.5");
  EXPECT_NEAR(soft->Factor(AtAngles(0.0075, 290)).r, 0.5f, 1e-3f);
  EXPECT_NEAR(hard->Density(AtAngles(0.005)).value * 9.569839e-8f, 1, 1e-4f);
}

TEST(Shaping, FocusIsAPowerOfTheCosineToTheAxis) {
  // cos 60° = 1/2: focus 3 gives 1/8. With tint (0.2, 0.5, 2): 7/8 tint + 1/8 = 0.3, 0.5625, 1.875.
  const auto black = MakeShaping("\"float shaping:focus\" 3");
  EXPECT_NEAR(black->Factor(AtAngles(60, 20)).r, 0.125f, 1e-6f);
  EXPECT_NEAR(black->Factor(AtAngles(120, 20)).g, 0.125f, 1e-6f);  // backwards too
  EXPECT_EQ(black->CosWidest(), -1);
  const auto tinted = MakeShaping("\"float shaping:focus\" 3 \"rgb shaping:focusTint\" [ 0.2 0.5 2 ]");
  EXPECT_NEAR(tinted->Factor(AtAngles(60)).r, 0.3f, 1e-6f);
  EXPECT_NEAR(tinted->Factor(AtAngles(60)).g, 0.5625f, 1e-6f);
  EXPECT_NEAR(tinted->Factor(AtAngles(60)).b, 1.875f, 1e-6f);
  EXPECT_EQ(tinted->Largest(), 2);
  // ∫ cos³ over the hemisphere's projected solid angle: 2π / 5 = 1.256637; both hemispheres unprojected: 4π / 4.
  EXPECT_NEAR(MakeShaping("\"float shaping:focus\" 3", Emitter::Flat)->Integral().r, 1.256637f, 1e-4f);
  EXPECT_NEAR(black->Integral().r, 3.141593f, 3e-4f);
  // A negative focus is ignored.
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  EXPECT_EQ(MakeShaping("\"float shaping:focus\" -1", Emitter::Flat, &diagnostics), nullptr);
  EXPECT_EQ(diagnostics.Warnings().size(), 1u);
}

TEST(Shaping, IesIsCandelaOverBothAngles) {
  // 0°: 100; 90°: 40 at φ = 0 and 80 at φ = 90°, mirrored to all four quadrants; dark above.
  const IesOnDisk file(IesText("0 90", "0 90", "100 40 100 80"));
  const auto shaping = MakeShaping(file.Parameter());
  EXPECT_NEAR(shaping->Factor(AtAngles(0)).r, 100, 1e-3);
  EXPECT_NEAR(shaping->Factor(AtAngles(45, 0)).r, 70, 1e-3);
  EXPECT_NEAR(shaping->Factor(AtAngles(45, 90)).r, 90, 1e-3);
  EXPECT_NEAR(shaping->Factor(AtAngles(45, 45)).r, 80, 1e-3);
  EXPECT_NEAR(shaping->Factor(AtAngles(45, 135)).r, 80, 1e-3);
  EXPECT_NEAR(shaping->Factor(AtAngles(30, 210)).r, 100 - 20 + 20.0 / 3 / 1.5, 1e-3);  // 60 + 40/3 at 90°, a third
  EXPECT_NEAR(shaping->Factor(AtAngles(89.9999, 180)).r, 40, 1e-2);
  EXPECT_EQ(shaping->Factor(AtAngles(90.001, 180)).r, 0);
  EXPECT_EQ(shaping->Largest(), 100);
  EXPECT_NEAR(shaping->CosWidest(), 0, 1e-6);
  // ∫: mean of the planes 60 at 90°: 2π ∫ (100 - 40 θ/(π/2)) sinθ dθ = 2π (100 - 40 · 2/π) = 468.3185.
  EXPECT_NEAR(shaping->Integral().r, 468.3185f, 0.03f);
  // Normalised: over 468.3185 / 4π, so that the integral is 4π = 12.566371.
  const auto normalized = MakeShaping(file.Parameter() + "\"bool shaping:ies:normalize\" true");
  EXPECT_NEAR(normalized->Integral().r, 12.566371f, 1e-3f);
  EXPECT_NEAR(normalized->Factor(AtAngles(0)).r, 100 * 12.566371 / 468.3185, 1e-4);
}

TEST(Shaping, AngleScaleStretchesFromThePoles) {
  // 10 at the nadir, 20 at 60°, 5 at the zenith.
  const IesOnDisk file(IesText("0 60 180", "0", "10 20 5"));
  const auto at = [&](const char* scale, double theta) {
    const auto shaping = MakeShaping(file.Parameter() + "\"float shaping:ies:angleScale\" " + scale);
    return shaping->Factor(AtAngles(theta, 50)).r;
  };
  EXPECT_NEAR(at("0", 30), 15, 1e-4);
  EXPECT_NEAR(at("1", 120), 12.5, 1e-4);     // half way from 20 to 5
  EXPECT_NEAR(at("0.5", 30), 20, 1e-4);      // 30° / 0.5 = 60°
  EXPECT_NEAR(at("0.5", 100), 5, 1e-4);      // 200° is clamped to 180°
  EXPECT_NEAR(at("1.5", 90), 20, 1e-4);      // 60°
  EXPECT_NEAR(at("-0.5", 150), 12.5, 1e-4);  // (150 - 180) / 0.5 + 180 = 120°
  EXPECT_NEAR(at("-0.5", 20), 10, 1e-4);     // -140° is clamped to 0°
  EXPECT_NEAR(at("-2", 60), 12.5, 1e-4);     // (60 - 180) / 2 + 180 = 120°
  // A profile that is measured to 90° only ends at 45°.
  const IesOnDisk down(IesText("0 90", "0", "10 10"));
  const auto half = MakeShaping(down.Parameter() + "\"float shaping:ies:angleScale\" 0.5");
  EXPECT_EQ(half->Factor(AtAngles(44.99)).r, 10);
  EXPECT_EQ(half->Factor(AtAngles(45.01)).r, 0);
  EXPECT_NEAR(half->CosWidest(), 0.7071068f, 1e-6f);
}

// --- Variants for the statistics

struct Variant {
  std::string name, parameters;
};

std::string Stripes() {
  return IesText("0 20 40 60 80 100 120 140 160 180", "0 45 90 180 270 360",
                 "5 0 0 9 1 0 0 0 2 1 5 0 4 0 1 0 0 3 2 1 5 0 0 0 0 0 0 3 0 1 5 8 8 8 0 0 0 0 0 1 "
                 "5 1 0 9 1 0 2 0 2 1 5 0 0 9 1 0 0 0 2 1");
}

const std::vector<Variant>& Variants() {
  static const IesOnDisk symmetric(IesText("0 10 30 45 50 90", "0", "900 1000 700 100 0 0"));
  static const IesOnDisk quadrant(IesText("0 30 60 90", "0 30 60 90",
                                          "100 300 900 0 100 250 400 0 100 200 100 0 "
                                          "100 120 50 10"));
  static const IesOnDisk upward(IesText("90 120 180", "0 90 180", "0 50 70 0 10 70 0 500 70"));
  static const IesOnDisk stripes(Stripes());
  static const IesOnDisk step(IesText("20 40", "0", "7 7"));
  static const std::vector<Variant> variants = {
      {"hard 0.01", "\"float shaping:cone:angle\" 0.01"},
      {"soft 0.01", "\"float shaping:cone:angle\" 0.01 \"float shaping:cone:softness\" 0.7"},
      {"hard 35", "\"float shaping:cone:angle\" 35"},
      {"soft 35", "\"float shaping:cone:angle\" 35 \"float shaping:cone:softness\" 0.3"},
      {"soft 90", "\"float shaping:cone:angle\" 90 \"float shaping:cone:softness\" 1"},
      {"soft 179.9", "\"float shaping:cone:angle\" 179.9 \"float shaping:cone:softness\" 0.6"},
      {"hard 180", "\"float shaping:cone:angle\" 180"},
      {"focus 0.3", "\"float shaping:focus\" 0.3"},
      {"focus 40 tinted", "\"float shaping:focus\" 40 \"rgb shaping:focusTint\" [ 0.02 0 0.01 ]"},
      {"focus 20000", "\"float shaping:focus\" 20000"},
      {"cone and focus",
       "\"float shaping:cone:angle\" 60 \"float shaping:cone:softness\" 0.5 \"float shaping:focus\" 4"},
      {"ies symmetric", symmetric.Parameter()},
      {"ies quadrant", quadrant.Parameter()},
      {"ies upward", upward.Parameter()},
      {"ies stripes", stripes.Parameter() + "\"bool shaping:ies:normalize\" true"},
      {"ies step", step.Parameter()},
      {"ies x0.2", stripes.Parameter() + "\"float shaping:ies:angleScale\" 0.2"},
      {"ies x1.7", stripes.Parameter() + "\"float shaping:ies:angleScale\" 1.7"},
      {"ies x-0.3", quadrant.Parameter() + "\"float shaping:ies:angleScale\" -0.3"},
      {"ies x-1.5", symmetric.Parameter() + "\"float shaping:ies:angleScale\" -1.5"},
      {"ies x0.001", symmetric.Parameter() + "\"float shaping:ies:angleScale\" 0.001"},
      {"ies upward x-0.002", upward.Parameter() + "\"float shaping:ies:angleScale\" -0.002"},
      {"ies and cone and focus", stripes.Parameter() +
                                     "\"float shaping:cone:angle\" 70 \"float shaping:cone:softness\" "
                                     "0.8 \"float shaping:focus\" 2"},
  };
  return variants;
}

constexpr std::pair<Emitter, const char*> kEmitters[] = {
    {Emitter::Point, "point"}, {Emitter::Flat, "flat"}, {Emitter::Round, "round"}};

// The function to which the density should be proportional.
double Target(const Shaping& shaping, Emitter emitter, const Vector3& d) {
  const double factor = static_cast<double>(shaping.Factor(d).Max());
  return emitter == Emitter::Flat ? factor * std::max(-static_cast<double>(d.z), 0.0) : factor;
}

// A direction whose angle from -z or +z is spread over many sizes.
Vector3 ManyScales(Rng& rng, double widest) {
  const Point2 u = rng.NextPoint2(), v = rng.NextPoint2();
  const double theta =
      v.x < 0.5f ? widest * 1.05 * static_cast<double>(u.x) : 180 * std::pow(10.0, -6 * static_cast<double>(u.x));
  return AtAngles(v.x > 0.9f ? 180 - theta : theta, 360 * static_cast<double>(u.y));
}

double WidestDegrees(const Shaping& shaping) {
  return std::acos(std::clamp(static_cast<double>(shaping.CosWidest()), -1.0, 1.0)) * 180 / M_PI;
}

TEST(ShapingSampling, DensityIsPositiveWhereLightIsAndBoundedNearIt) {
  Rng rng(5);
  for (const auto& [emitter, emitterName] : kEmitters) {
    for (const Variant& variant : Variants()) {
      const auto shaping = MakeShaping(variant.parameters, emitter);
      const double widest = WidestDegrees(*shaping);
      int lit = 0;
      for (int i = 0; i < 20000; ++i) {
        const Vector3 d = ManyScales(rng, widest);
        const double target = Target(*shaping, emitter, d);
        if (!(target > 0)) continue;
        ++lit;
        ASSERT_GT(shaping->Density(d).value, 0) << variant.name << " " << emitterName << " z " << d.z;
        ASSERT_LE(shaping->Factor(d).Max(), shaping->Largest() * 1.00001f) << variant.name;
        ASSERT_GE(-d.z, shaping->CosWidest()) << variant.name;
      }
      EXPECT_TRUE(lit > 500 || shaping->Integral().IsBlack()) << variant.name << " " << emitterName << " " << lit;
    }
  }
}

// Means over samples of what is known: 1 (the density is that of the samples), the integral, its spread.
TEST(ShapingSampling, SamplesFollowTheFactor) {
  Rng rng(9);
  for (const auto& [emitter, emitterName] : kEmitters) {
    for (const Variant& variant : Variants()) {
      const std::string what = variant.name + " " + emitterName;
      const auto shaping = MakeShaping(variant.parameters, emitter);
      if (shaping->Integral().IsBlack()) continue;
      const int n = 40000;
      double sum = 0, squares = 0;
      int lost = 0;
      for (int i = 0; i < n; ++i) {
        const Vector3 d = shaping->SampleDirection(rng.NextPoint2());
        ASSERT_NEAR(glm::length(d), 1, 1e-5f) << what;
        const double density = static_cast<double>(shaping->Density(d).value);
        if (!(density > 0)) {
          ++lost;
          continue;
        }
        const double weight = static_cast<double>(shaping->Factor(d).r) / density *
                              (emitter == Emitter::Flat ? -static_cast<double>(d.z) : 1) *
                              (emitter == Emitter::Round ? 0.25 : 1);
        sum += weight;
        squares += weight * weight;
      }
      const double mean = sum / n, integral = static_cast<double>(shaping->Integral().r);
      const double deviation = std::sqrt(std::max(squares / n - mean * mean, 0.0));
      EXPECT_LT(lost, n / 1000) << what;
      EXPECT_LT(deviation / integral, variant.name.find("tinted") != std::string::npos ? 1.5 : 0.3) << what;
      EXPECT_NEAR(mean / integral, 1, 5 * deviation / integral / std::sqrt(n) + 2e-4) << what;
    }
  }
}

// ∫ of density, and of the factor, by a quadrature that knows nothing of the tables: midpoints, evenly in θ over the
// widest angle and in φ.
TEST(ShapingSampling, QuadratureAgrees) {
  for (const auto& [emitter, emitterName] : kEmitters) {
    for (const Variant& variant : Variants()) {
      const std::string what = variant.name + " " + emitterName;
      const auto shaping = MakeShaping(variant.parameters, emitter);
      if (shaping->Integral().IsBlack()) continue;
      const bool symmetric = variant.name.find("ies") == std::string::npos;
      // 3° of φ: no plane of these profiles lies within a cell.
      const int rows = symmetric ? 40000 : 10000, columns = symmetric ? 1 : 120;
      // Beams about the zenith need their own steps.
      const bool zenith = variant.name == "ies upward x-0.002";
      const double widest = (zenith ? 0.002 * 90 : WidestDegrees(*shaping)) * M_PI / 180;
      double density = 0, factor = 0;
      for (int j = 0; j < rows; ++j) {
        const double t = (j + 0.5) / rows * widest, theta = zenith ? M_PI - t : t;
        for (int i = 0; i < columns; ++i) {
          const Vector3 d = AtAngles(theta * 180 / M_PI, 360 * (i + 0.5) / columns);
          const double area = widest / rows * std::sin(t) * 2 * M_PI / columns;
          const double cosine = emitter == Emitter::Flat ? std::max(std::cos(theta), 0.0) : 1;
          density += area * static_cast<double>(shaping->Density(d).value);
          factor += area * static_cast<double>(shaping->Factor(d).r) * cosine;
        }
      }
      if (emitter == Emitter::Round) factor *= 0.25;
      EXPECT_NEAR(density, 1, symmetric ? 2e-3 : 6e-3) << what;
      EXPECT_NEAR(factor / static_cast<double>(shaping->Integral().r), 1, 3e-4) << what;
    }
  }
}

TEST(ShapingSampling, ChiSquared) {
  std::vector<Variant> variants;
  for (const Variant& variant : Variants()) {
    // Beams below the resolution of the test's cosines have the tests above.
    if (variant.name.find("0.01") == std::string::npos && variant.name.find("0.00") == std::string::npos &&
        variant.name.find("20000") == std::string::npos)
      variants.push_back(variant);
  }
  const double level = testing::SidakLevel(static_cast<int>(3 * variants.size()));
  Rng rng(21);
  for (const auto& [emitter, emitterName] : kEmitters) {
    for (const Variant& variant : variants) {
      const auto shaping = MakeShaping(variant.parameters, emitter);
      if (shaping->Integral().IsBlack()) continue;
      const auto result = testing::ChiSquaredTestDirections(
          [&] { return std::optional<Vector3>(shaping->SampleDirection(rng.NextPoint2())); },
          [&](const Vector3& d) { return static_cast<double>(shaping->Density(d).value); });
      EXPECT_GT(result.pValue, level) << variant.name << " " << emitterName << " integral " << result.integral;
    }
  }
}

TEST(ShapingSampling, WeightedIntegral) {
  // Cone of 60°, weight cos²θ: 2π (1 - 1/8) / 3 = 1.832596. Weight x² : π ∫ (1 - z²) dz over [1/2, 1] = π (1/2 - 7/24).
  const auto cone = MakeShaping("\"float shaping:cone:angle\" 60");
  EXPECT_NEAR(cone->Integral([](const Vector3d& d) { return d.z * d.z; }).r, 1.832596f, 1e-4f);
  EXPECT_NEAR(cone->Integral([](const Vector3d& d) { return d.x * d.x; }).r, 0.654498f, 1e-4f);
  EXPECT_NEAR(cone->Integral([](const Vector3d& d) { return d.y; }).r, 0, 1e-5f);
}

TEST(ShapingSampling, GuidesWhereItIsNarrow) {
  const auto guides = [](const char* parameters, Emitter emitter) {
    return MakeShaping(parameters, emitter)->GuidesEmission();
  };
  EXPECT_TRUE(guides("\"float shaping:cone:angle\" 40", Emitter::Round));
  EXPECT_TRUE(guides("\"float shaping:cone:angle\" 90", Emitter::Round));
  EXPECT_FALSE(guides("\"float shaping:cone:angle\" 100", Emitter::Round));
  EXPECT_TRUE(guides("\"float shaping:focus\" 50", Emitter::Round));
  EXPECT_TRUE(guides("\"float shaping:cone:angle\" 180", Emitter::Point));
  EXPECT_TRUE(guides("\"float shaping:cone:angle\" 180", Emitter::Flat));
}

TEST(Shaping, DarkProfilesAreDark) {
  const IesOnDisk file(IesText("0 90", "0", "0 0"));
  for (const auto& [emitter, name] : kEmitters) {
    for (const char* more : {"", "\"bool shaping:ies:normalize\" true"}) {
      const auto dark = MakeShaping(file.Parameter() + more, emitter);
      EXPECT_TRUE(dark->Integral().IsBlack());
      EXPECT_TRUE(dark->Factor(AtAngles(10)).IsBlack());
      EXPECT_EQ(dark->Largest(), 0);
      EXPECT_EQ(dark->Density(dark->SampleDirection({0.3f, 0.4f})).value, 0);
    }
  }
  // A flat light whose profile shines upwards only.
  const IesOnDisk up(IesText("90 180", "0", "0 5"));
  const auto none = MakeShaping(up.Parameter(), Emitter::Flat);
  EXPECT_TRUE(none->Integral().IsBlack());
  EXPECT_EQ(none->Density(none->SampleDirection({0.3f, 0.4f})).value, 0);
}

TEST(Shaping, StrangeProfilesStayFinite) {
  const std::string texts[] = {
      IesText("0 0.00001 0.00002 0.001 180", "0", "1 1e30 1 1e-30 1"),
      IesText("0 179.99999 180", "0 0.00001 359.99999 360", "1 0 1e9 0 1e-9 1 1 1 1 1e30 0 7"),
      IesText("89.99999 90 90.00001", "0 90", "0 1e20 0 0 1 0"),
      IesText("0 1e-5", "0 180", "1e-40 0 1e-42 1e-44"),
      IesText("0 180", "0 90 180 270 360", "0 0 0 0 0 0 0 0 0 3"),
  };
  Rng rng(77);
  for (const std::string& text : texts) {
    const IesOnDisk file(text);
    for (const auto& [emitter, name] : kEmitters) {
      for (const char* more : {"", "\"bool shaping:ies:normalize\" true", "\"float shaping:ies:angleScale\" -0.00001",
                               "\"float shaping:ies:angleScale\" 1e6 \"float shaping:focus\" 1e5"}) {
        const auto shaping = MakeShaping(file.Parameter() + more, emitter);
        EXPECT_TRUE(shaping->Integral().IsValid()) << text;
        for (int i = 0; i < 2000; ++i) {
          const Vector3 d = i % 2 ? ManyScales(rng, 180) : shaping->SampleDirection(rng.NextPoint2());
          const Color factor = shaping->Factor(d);
          const float density = shaping->Density(d).value;
          ASSERT_TRUE(IsFinite(d) && factor.IsValid() && density >= 0 && density < kInfinity) << text << more;
          ASSERT_LE(factor.Max(), shaping->Largest() * 1.00001f) << text << more;
          if (Target(*shaping, emitter, d) > 0) {
            ASSERT_GT(density, 0) << text << more << " " << name << " z " << d.z << " x " << d.x << " y " << d.y
                                  << " F " << factor.r << " T " << Target(*shaping, emitter, d);
          }
        }
      }
    }
  }
}

TEST(Shaping, NonsenseIsALocatedError) {
  EXPECT_NE(ErrorOf("\"float shaping:cone:angle\" 200").find("(0,180]"), std::string::npos);
  EXPECT_NE(ErrorOf("\"float shaping:cone:angle\" 0").find("test.pbrt:2:"), std::string::npos);
  EXPECT_NE(ErrorOf("\"string shaping:ies:file\" \"nowhere.ies\"").find("test.pbrt:2:"), std::string::npos);
  EXPECT_NE(ErrorOf("\"rgb shaping:focusTint\" [ -1 0 0 ] \"float shaping:focus\" 1").find("negative"),
            std::string::npos);
  const IesOnDisk file(IesText("0 90", "0", "1 1"));
  EXPECT_NE(ErrorOf(file.Parameter() + "\"float shaping:ies:angleScale\" 1e-9").find("angleScale"), std::string::npos);
  const IesOnDisk broken("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0 1 1 1 0 90 0 5");
  EXPECT_NE(ErrorOf(broken.Parameter()).find("profile.ies:3:"), std::string::npos) << ErrorOf(broken.Parameter());
  for (const ParameterInfo& row : ShapingParameters()) EXPECT_FALSE(row.help.empty()) << row.name;
}

}  // namespace
}  // namespace lampyr
