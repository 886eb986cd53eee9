// Light from infinity against values computed by hand: the sun's disk, the tint, and how a sky's image is turned.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sampling/rng.h"
#include "sky_fixture.h"

namespace lampyr {
namespace {

using test::Build;

constexpr double kPiDouble = std::numbers::pi;

// Irradiance of a surface with normal n by the light's own samples, green channel.
double Irradiance(const test::BuiltLight& built, const Normal3& n, int samples = 1 << 16) {
  Rng rng(5);
  double sum = 0;
  for (int i = 0; i < samples; ++i) {
    LightContext context = built.context;
    context.u = rng.NextPoint2();
    const auto sample = built.light->GenerateSamples(context, Point3(0.0f));
    if (!sample) continue;
    sum += static_cast<double>(sample->diffuse.g) *
           static_cast<double>(std::max(glm::dot(n, sample->direction), 0.0f)) /
           static_cast<double>(sample->pdfDirect.value);
  }
  return sum / samples;
}

Color Seen(const test::BuiltLight& built, const Vector3& direction) {
  LightHit hit;
  hit.direction = glm::normalize(direction);
  return built.light->EvaluateEmissionForCamera(built.context, hit);
}

// --- distant with an angle

const Normal3 kFacing(0, 0, -1);  // the default "from" is behind the origin

TEST(DistantDisk, RadianceIsDividedByTheSizeFactor) {
  const auto radiance = [](const char* angle) {
    const auto sun =
        Build("distant", std::string("\"float angle\" ") + angle + " \"bool normalize\" true \"float scale\" 6");
    return static_cast<double>(Seen(*sun, kFacing).g);
  };
  // π sin²θ: 0.75π·⅓ at θ = 30°, π at 90°; π (2 - sin²θ): 1.25π at 120°, 2π at 180°.
  EXPECT_NEAR(radiance("60"), 6 / (kPiDouble * 0.25), 1e-5);
  EXPECT_NEAR(radiance("180"), 6 / kPiDouble, 1e-5);
  EXPECT_NEAR(radiance("240"), 6 / (kPiDouble * 1.25), 1e-5);
  EXPECT_NEAR(radiance("360"), 6 / (2 * kPiDouble), 1e-5);
  const double sine = std::sin(0.265 * kPiDouble / 180);
  EXPECT_NEAR(radiance("0.53") * kPiDouble * sine * sine, 6, 1e-5);
}

TEST(DistantDisk, NormalizedIrradianceIsThatOfParallelLight) {
  for (const char* angle : {"0", "1e-4", "0.001", "0.01", "0.53", "30", "120", "180"}) {
    const auto sun =
        Build("distant", std::string("\"bool normalize\" true \"rgb L\" [ 1 4 1 ] \"float angle\" ") + angle);
    EXPECT_NEAR(Irradiance(*sun, kFacing), 4, 0.02) << angle;
    EXPECT_NEAR(sun->light->GetIncidentRadianceEstimate(sun->context, Point3(0.0f)), 2, 1e-4) << angle;
    const double power = kPiDouble * 100 * 4;  // the scene's disk; a wide disk of the sky shines through more of it
    EXPECT_GT(static_cast<double>(sun->light->GetPowerEstimate(sun->context).g), 0.999 * power) << angle;
  }
}

TEST(DistantDisk, IlluminanceIsWhatAFacingSurfaceReceives) {
  for (const char* angle : {"0", "1e-4", "0.002", "0.53", "90", "180", "270", "360"}) {
    for (const char* normalize : {"false", "true"}) {
      const auto sun = Build("distant", std::string("\"float illuminance\" 7 \"rgb L\" [ 1 0.5 1 ] \"float angle\" ") +
                                            angle + " \"bool normalize\" " + normalize);
      EXPECT_NEAR(Irradiance(*sun, kFacing), 3.5, 0.035) << angle;
    }
  }
}

// A placement that stretches makes another cone of the disk; the surface faces its axis.
TEST(DistantDisk, IlluminanceIsThatOfThePlacedCone) {
  const Transform placements[] = {Transform::Scale({1, 2, 0.5}),
                                  Transform::Scale({1, 1, 4}) * Transform::Rotate(30, {1, 0, 0}),
                                  Transform::Rotate(70, {1, 2, 0}) * Transform::Scale({-3, 1, 1})};
  for (const Transform& placement : placements) {
    for (const char* angle : {"0", "0.53", "40", "170", "270", "360"}) {
      const Vector3 facing = glm::normalize(placement.ToAffine().Vector(kFacing));
      const auto lit = Build("distant", std::string("\"float illuminance\" 7 \"float angle\" ") + angle, placement);
      EXPECT_NEAR(Irradiance(*lit, facing), 7, 0.1) << angle;
      const auto sun = Build("distant", std::string("\"bool normalize\" true \"float angle\" ") + angle, placement);
      if (std::atof(angle) <= 90) {
        EXPECT_NEAR(Irradiance(*sun, facing), 1, 0.015) << angle;
      }
    }
  }
}

TEST(DistantDisk, WithoutThemLIsRadiance) {
  const auto sun = Build("distant", "\"float angle\" 60 \"rgb L\" [ 2 3 4 ] \"float exposure\" 1");
  EXPECT_EQ(Seen(*sun, kFacing), Color(4, 6, 8));
  EXPECT_NEAR(Irradiance(*sun, kFacing), 6 * kPiDouble * 0.25, 0.02);
  // Parallel light takes over where the disk is too small, with the disk's irradiance.
  const double theta = 0.5 * 9e-4 * kPiDouble / 180;
  const auto tiny = Build("distant", "\"float angle\" 9e-4 \"rgb L\" [ 1e10 1e10 1e10 ]");
  EXPECT_EQ(tiny->light->Kind(), LightKind::DeltaDirection);
  EXPECT_NEAR(Irradiance(*tiny, kFacing, 4) / (1e10 * kPiDouble * theta * theta), 1, 1e-6);
  const auto small = Build("distant", "\"float angle\" 1.1e-3 \"rgb L\" [ 1e10 1e10 1e10 ]");
  EXPECT_EQ(small->light->Kind(), LightKind::Infinite);
  EXPECT_NEAR(Irradiance(*small, kFacing) / (1e10 * kPiDouble * theta * theta * (1.21 / 0.81)), 1, 1e-4);
}

TEST(DistantDisk, IsSeenWithinTheHalfAngle) {
  const auto sun = Build("distant", "\"float angle\" 10 \"point3 from\" [ 0 3 0 ] \"point3 to\" [ 0 0 0 ]");
  for (const double turn : {0.0, 1.0, 2.5, 4.0}) {
    const auto at = [&](double degrees) {
      const double a = degrees * kPiDouble / 180;
      return Seen(*sun, Vector3(std::sin(a) * std::cos(turn), std::cos(a), std::sin(a) * std::sin(turn))).g;
    };
    EXPECT_EQ(at(0), 1);
    EXPECT_EQ(at(4.99), 1);
    EXPECT_EQ(at(5.01), 0);
    EXPECT_EQ(at(180), 0);
  }
  const auto hidden = Build("distant", "\"float angle\" 10 \"bool cameraVisible\" false");
  EXPECT_TRUE(Seen(*hidden, kFacing).IsBlack());
}

TEST(DistantDisk, NoSampleIsLost) {
  Rng rng(2);
  for (const char* angle : {"0.001", "0.01", "1", "179", "180", "300", "360"}) {
    const auto sun =
        Build("distant", std::string("\"point3 from\" [ 1 2 -0.3 ] \"point3 to\" [ 0 0 0 ] \"float angle\" ") + angle,
              Transform::Rotate(33, {1, 2, 3}));
    for (int i = 0; i < 20000; ++i) {
      sun->context.u =
          i < 4 ? Point2(i & 1 ? kOneMinusEpsilon : 0.0f, i & 2 ? kOneMinusEpsilon : 0.0f) : rng.NextPoint2();
      const auto sample = sun->light->GenerateSamples(sun->context, Point3(0.0f));
      ASSERT_TRUE(sample) << angle;
      LightHit hit;
      hit.direction = sample->direction;
      const auto found = sun->light->EvaluateSamples(sun->context, hit, Point3(0.0f));
      ASSERT_EQ(found->pdfDirect.value, sample->pdfDirect.value) << angle;
      ASSERT_EQ(found->diffuse, sample->diffuse) << angle;
    }
  }
}

// --- tint

TEST(InfiniteTint, ColoursLightAndSplitsItForLobes) {
  const std::string tint =
      " \"float intensity\" 2 \"float exposure\" 2 \"rgb color\" [ 1 0.5 0 ] \"float diffuse\" 3 \"float specular\" "
      "0.25";
  const Color emitted(8, 4, 0);
  for (const char* light : {"infinite", "dome", "distant"}) {
    for (const char* angle : {"", " \"float angle\" 50"}) {
      if (std::string(light) != "distant" && *angle) continue;
      const auto built = Build(light, tint + angle);
      const auto sample = built->light->GenerateSamples(built->context, Point3(0.0f));
      ASSERT_TRUE(sample);
      EXPECT_EQ(sample->diffuse, emitted * 3);
      EXPECT_EQ(sample->specular, emitted * 0.25f);
      const auto photon = built->light->GenerateEmission(built->context);
      ASSERT_TRUE(photon);
      EXPECT_EQ(photon->diffuse, emitted * 3);
      EXPECT_EQ(photon->specular, emitted * 0.25f);
      if (built->light->Kind() == LightKind::DeltaDirection) continue;
      LightHit hit;
      hit.direction = sample->direction;
      const auto found = built->light->EvaluateSamples(built->context, hit, Point3(0.0f));
      EXPECT_EQ(found->diffuse, emitted * 3);
      EXPECT_EQ(found->specular, emitted * 0.25f);
      EXPECT_EQ(built->light->EvaluateEmissionForCamera(built->context, hit), emitted);
    }
  }
}

TEST(InfiniteTint, OnlySpecularLightIsStillSampled) {
  for (const char* light : {"infinite", "dome", "distant"}) {
    const auto built = Build(light, "\"float diffuse\" 0");
    const auto sample = built->light->GenerateSamples(built->context, Point3(0.0f));
    ASSERT_TRUE(sample) << light;
    EXPECT_TRUE(sample->diffuse.IsBlack());
    EXPECT_EQ(sample->specular, Color(1.0f));
  }
  const auto none = Build("dome", "\"float diffuse\" 0 \"float specular\" 0");
  EXPECT_FALSE(none->light->GenerateSamples(none->context, Point3(0.0f)));
  EXPECT_EQ(Seen(*none, Vector3(1, 0, 0)), Color(1.0f));
}

// --- images

// Radiance along each axis, moved off the borders between texels.
std::vector<float> SixAxes(const test::BuiltLight& built) {
  const Vector3 nudge(0.013f, 0.017f, 0.011f);
  std::vector<float> seen;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {1.0f, -1.0f}) {
      Vector3 direction(0.0f);
      direction[axis] = sign;
      seen.push_back(Seen(built, direction + nudge).g);
    }
  }
  return seen;
}

class SkyImages : public test::SkyImageTest {};

TEST_F(SkyImages, IlluminanceIsThatOfThePlacedSky) {
  Write("square.exr", 16, 16, [](int i) { return i % 7 == 3 ? 9.0f : 1.0f; });
  Write("wide.exr", 32, 16, [](int i) { return i % 5 == 2 ? 5.0f : 0.5f; });
  const Transform placements[] = {Transform(), Transform::Rotate(40, {1, 1, 0}) * Transform::Scale({2, -2, 2}),
                                  Transform::Scale({1, 2, 0.5}),
                                  Transform::Rotate(70, {1, 2, 0}) * Transform::Scale({-3, 1, 1})};
  for (const char* file : {"square.exr", "wide.exr"}) {
    for (const Transform& placement : placements) {
      const auto sky =
          Make("infinite", std::string("\"string filename\" \"") + file + "\" \"float illuminance\" 3", placement);
      const Vector3 up = glm::normalize(placement.ToAffine().Vector(Vector3(0, 0, 1)));
      EXPECT_NEAR(Irradiance(*sky, up), 3, 0.1) << file;
    }
  }
}

TEST_F(SkyImages, DomeIsOrientedAsOpenExrSays) {
  // 64 columns of longitude +π to -π in 32 rows: bands 5° wide would do; the poles' rows are told apart by 100 and 200,
  // columns by their eighth.
  Write("sky.exr", 64, 32, [](int i) {
    const int x = i % 64, y = i / 64;
    if (y < 2) return 100.0f;
    if (y >= 30) return 200.0f;
    return static_cast<float>(1 + ((x + 4) / 8) % 8);
  });
  // Longitude = π - 2π u: +Z in the middle (eighth 4), +X at a quarter (eighth 2), -X at three quarters, -Z at the
  // edges.
  const float kPlusX = 3, kMinusX = 7, kTop = 100, kBottom = 200, kPlusZ = 5, kMinusZ = 1;
  const auto dome = Make("dome", "\"string texture:file\" \"sky.exr\"");
  EXPECT_EQ(SixAxes(*dome), (std::vector<float>{kPlusX, kMinusX, kTop, kBottom, kPlusZ, kMinusZ}));
  // Turned by 90° about X: what was at +Y is at +Z, what was at +Z is at -Y.
  const auto z = Make("dome", "\"string texture:file\" \"sky.exr\" \"string poleAxis\" \"Z\"");
  EXPECT_EQ(SixAxes(*z), (std::vector<float>{kPlusX, kMinusX, kMinusZ, kPlusZ, kTop, kBottom}));
  // pbrt's: +z at the top, +x at the left edge, +y at a quarter.
  const auto infinite = Make("infinite", "\"string filename\" \"sky.exr\"");
  EXPECT_EQ(SixAxes(*infinite), (std::vector<float>{1, 5, 3, 7, 100, 200}));
  // The light's own transform turns all of it.
  const auto turned = Make("dome", "\"string texture:file\" \"sky.exr\"", Transform::Rotate(90, {1, 0, 0}));
  EXPECT_EQ(SixAxes(*turned), SixAxes(*z));
}

TEST_F(SkyImages, SquareDomeHasItsPoleInTheMiddle) {
  Write("sky.exr", 32, 32, [](int i) {
    const int x = i % 32 - 16, y = i / 32 - 16;
    if (std::abs(x) <= 2 && std::abs(y) <= 2) return 100.0f;
    if (std::abs(x) >= 13 && std::abs(y) >= 13) return 200.0f;
    if (std::abs(x) > std::abs(y)) return x > 0 ? 1.0f : 2.0f;
    return y > 0 ? 3.0f : 4.0f;
  });
  // Right +x, down +y, middle +z.
  const auto infinite = Make("infinite", "\"string filename\" \"sky.exr\"");
  EXPECT_EQ(SixAxes(*infinite), (std::vector<float>{1, 2, 3, 4, 100, 200}));
  const auto z = Make("dome", "\"string texture:file\" \"sky.exr\" \"string poleAxis\" \"Z\"");
  EXPECT_EQ(SixAxes(*z), (std::vector<float>{1, 2, 3, 4, 100, 200}));
  const auto y = Make("dome", "\"string texture:file\" \"sky.exr\"");
  EXPECT_EQ(SixAxes(*y), (std::vector<float>{1, 2, 100, 200, 4, 3}));
}

TEST_F(SkyImages, SamplesSeeWhatTheirDirectionSees) {
  Write("sky.exr", 16, 8, [](int i) { return static_cast<float>(i % 7); });
  for (const char* text : {"\"string texture:file\" \"sky.exr\" \"float specular\" 0",
                           "\"string texture:file\" \"sky.exr\" \"string poleAxis\" \"Z\""}) {
    const auto dome = Make("dome", text, Transform::Rotate(70, {1, 1, 0}));
    Rng rng(3);
    for (int i = 0; i < 2000; ++i) {
      dome->context.u = rng.NextPoint2();
      const auto sample = dome->light->GenerateSamples(dome->context, Point3(0.0f));
      ASSERT_TRUE(sample);
      ASSERT_EQ(sample->diffuse, Seen(*dome, sample->direction));
    }
  }
}

// Neighbours differ in a large image, and the transform rounds: what a sample says is still that of its direction.
TEST_F(SkyImages, SamplesOfNarrowTexelsSeeWhatTheirDirectionSees) {
  Rng noise(11);
  const auto value = [&](int) { return 0.1f + noise.NextFloat(); };
  Write("wide.exr", 2048, 1024, value);
  Write("square.exr", 1024, 1024, value);
  for (const char* file : {"wide.exr", "square.exr"}) {
    for (const Transform& placement : {Transform::Rotate(70, {1, 1, 0}), Transform::Scale({-3, 3, 3}),
                                       Transform::Rotate(31, {0.3, 1, 0}) * Transform::Scale({1, 40, 2})}) {
      const auto dome = Make("dome", std::string("\"string texture:file\" \"") + file + "\"", placement);
      Rng rng(3);
      for (int i = 0; i < 50000; ++i) {
        dome->context.u = rng.NextPoint2();
        const auto sample = dome->light->GenerateSamples(dome->context, Point3(0.0f));
        ASSERT_TRUE(sample);
        LightHit hit;
        hit.direction = sample->direction;
        hit.normal = -hit.direction;
        const auto evaluation = dome->light->EvaluateSamples(dome->context, hit, Point3(0.0f));
        ASSERT_TRUE(evaluation);
        ASSERT_EQ(sample->diffuse, evaluation->diffuse) << file << " " << i;
        ASSERT_NEAR(sample->pdfDirect.value / evaluation->pdfDirect.value, 1, 2e-5f) << file << " " << i;
      }
    }
  }
}

TEST_F(SkyImages, OneBrightTexelGetsTheSamples) {
  // 1e9 in one texel of 8192 and 1 elsewhere; NaN and negative texels emit nothing.
  Write("sky.exr", 128, 64, [](int i) {
    return i == 1000 ? 1e9f : i == 2000 ? std::numeric_limits<float>::quiet_NaN() : i == 3000 ? -1.0f : 1.0f;
  });
  const auto dome = Make("dome", "\"string texture:file\" \"sky.exr\"");
  EXPECT_EQ(diagnostics_.Warnings().size(), 1u);
  Rng rng(3);
  int bright = 0;
  for (int i = 0; i < 1000; ++i) {
    dome->context.u = rng.NextPoint2();
    const auto sample = dome->light->GenerateSamples(dome->context, Point3(0.0f));
    ASSERT_TRUE(sample);
    ASSERT_TRUE(std::isfinite(sample->pdfDirect.value) && sample->pdfDirect.value > 0);
    bright += sample->diffuse.g > 1 ? 1 : 0;
  }
  EXPECT_GT(bright, 990);
}

TEST_F(SkyImages, BlackSkiesAreNotSampled) {
  Write("sky.exr", 16, 8, [](int) { return 0.0f; });
  const auto dome = Make("dome", "\"string texture:file\" \"sky.exr\"");
  EXPECT_FALSE(dome->light->GenerateSamples(dome->context, Point3(0.0f)));
  EXPECT_FALSE(dome->light->GenerateEmission(dome->context));
  EXPECT_TRUE(dome->light->GetPowerEstimate(dome->context).IsBlack());
}

TEST_F(SkyImages, WhatIsNotSupportedIsSaid) {
  Write("odd.exr", 12, 8, [](int) { return 1.0f; });
  Write("square.exr", 8, 8, [](int) { return 1.0f; });
  EXPECT_NE(ErrorOf("dome", "\"string texture:file\" \"odd.exr\"").find("twice as wide as high"), std::string::npos);
  EXPECT_NE(
      ErrorOf("dome", "\"string texture:file\" \"square.exr\" \"string texture:format\" \"latlong\"").find("square"),
      std::string::npos);
  for (const char* format : {"angular", "mirroredBall", "cubeMapVerticalCross"}) {
    const std::string message = ErrorOf(
        "dome", std::string("\"string texture:file\" \"square.exr\" \"string texture:format\" \"") + format + "\"");
    EXPECT_NE(message.find("not supported"), std::string::npos) << message;
  }
  EXPECT_NE(ErrorOf("dome", "\"string texture:format\" \"latlon\"").find("latlong"), std::string::npos);
  EXPECT_NE(ErrorOf("dome", "\"string poleAxis\" \"X\"").find("poleAxis"), std::string::npos);
  EXPECT_NE(ErrorOf("dome", "\"string texture:fil\" \"odd.exr\"").find("texture:file"), std::string::npos);
}

}  // namespace
}  // namespace lampyr
