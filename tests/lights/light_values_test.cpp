// Radiance, intensity, power and irradiance of each light against values computed by hand.
#include <gtest/gtest.h>

#include "geometry/geometry_scene.h"
#include "light_fixture.h"
#include "sampling/rng.h"

namespace lampyr {
namespace {

using test::Build;

double Irradiance(const test::BuiltLight& built, const Point3& P, const Normal3& n, int samples = 1 << 16) {
  Rng rng(5);
  double sum = 0;
  for (int i = 0; i < samples; ++i) {
    LightContext context = built.context;
    context.u = rng.NextPoint2();
    const auto sample = built.light->GenerateSamples(context, P);
    if (sample)
      sum += static_cast<double>(sample->diffuse.g * std::max(glm::dot(n, sample->direction), 0.0f) /
                                 sample->pdfDirect.value);
  }
  return sum / samples;
}

TEST(LightValues, PointFallsOffWithTheSquare) {
  const auto built = Build("point", "\"rgb I\" [ 8 4 2 ] \"float scale\" 3 \"point3 from\" [ 1 0 0 ]");
  const auto sample = built->light->GenerateSamples(built->context, Point3(1, 2, 0));
  ASSERT_TRUE(sample);
  EXPECT_FLOAT_EQ(sample->diffuse.r, 6);
  EXPECT_FLOAT_EQ(sample->diffuse.b, 1.5f);
  EXPECT_FLOAT_EQ(sample->distance, 2);
  EXPECT_EQ(sample->direction, Vector3(0, -1, 0));
  EXPECT_NEAR(built->light->GetPowerEstimate(built->context).g, 12 * 4 * kPi, 1e-3f);
  EXPECT_FALSE(built->light->GenerateSamples(built->context, Point3(1, 0, 0)));
}

TEST(LightValues, PowerOfPointAndSpot) {
  const auto point = Build("point", "\"rgb I\" [ 1 0.5 2 ] \"float power\" 100");
  EXPECT_NEAR(point->light->GetPowerEstimate(point->context).r, 100, 1e-3f);
  EXPECT_NEAR(point->light->GetPowerEstimate(point->context).b, 200, 2e-3f);
  const auto spot = Build("spot", "\"float power\" 100 \"float coneangle\" 40 \"float conedeltaangle\" 15");
  EXPECT_NEAR(spot->light->GetPowerEstimate(spot->context).g, 100, 1e-3f);
}

TEST(LightValues, SpotIsASmoothstepInTheCosine) {
  const auto spot = Build("spot", "\"rgb I\" [ 2 2 2 ] \"float coneangle\" 60 \"float conedeltaangle\" 30");
  const auto at = [&](double degrees) {
    const double a = degrees * 3.14159265358979 / 180;
    const auto sample = spot->light->GenerateSamples(spot->context, Point3(std::sin(a), 0, std::cos(a)));
    return sample ? static_cast<double>(sample->diffuse.g) : 0.0;
  };
  const double edge = std::cos(60 * 3.14159265358979 / 180), core = std::cos(30 * 3.14159265358979 / 180);
  const double t = (std::cos(45 * 3.14159265358979 / 180) - edge) / (core - edge);
  EXPECT_NEAR(at(0), 2, 1e-6);
  EXPECT_NEAR(at(29.9), 2, 1e-6);
  EXPECT_NEAR(at(45), 2 * t * t * (3 - 2 * t), 1e-5);
  EXPECT_EQ(at(60.1), 0);
  EXPECT_EQ(at(180), 0);
}

TEST(LightValues, DistantIsIrradiance) {
  const auto sun = Build(
      "distant", "\"rgb L\" [ 1 2 3 ] \"float illuminance\" 10 \"point3 from\" [ 0 5 0 ] \"point3 to\" [ 0 0 0 ]");
  EXPECT_NEAR(Irradiance(*sun, Point3(0.0f), Normal3(0, 1, 0), 4), 20, 1e-5);
  EXPECT_EQ(Irradiance(*sun, Point3(0.0f), Normal3(0, -1, 0), 4), 0);
  EXPECT_NEAR(sun->light->GetPowerEstimate(sun->context).g, 20 * kPi * 100, 1e-2f);
}

TEST(LightValues, InfiniteFillsAHemisphere) {
  const auto sky = Build("infinite", "\"rgb L\" [ 1 1 1 ]");
  EXPECT_NEAR(Irradiance(*sky, Point3(0.0f), Normal3(0, 0, 1)), static_cast<double>(kPi), 0.02);
  const auto lux = Build("infinite", "\"float illuminance\" 5");
  EXPECT_NEAR(Irradiance(*lux, Point3(0.0f), Normal3(0, 0, 1)), 5, 0.05);
}

TEST(LightValues, SphereAndDiskOverAReceiver) {
  // E = π L (r/d)², for a sphere seen from below.
  const Shape sphere = test::Sphere(0.5f, Transform::Translate({0, 0, 2}));
  const auto ball = Build("diffuse", "\"rgb L\" [ 3 3 3 ]", Transform(), &sphere);
  EXPECT_NEAR(Irradiance(*ball, Point3(0.0f), Normal3(0, 0, 1)), static_cast<double>(kPi) * 3 * 0.0625, 1e-3);
  // E = π L r² / (r² + h²), for a disk facing the receiver.
  Quadric disk;
  disk.kind = Quadric::Kind::Disk;
  disk.zMin = 2;
  disk.radius = 1;
  disk.flipNormals = true;
  const Shape shape = disk;
  const auto lamp = Build("diffuse", "\"rgb L\" [ 3 3 3 ]", Transform(), &shape);
  EXPECT_NEAR(Irradiance(*lamp, Point3(0.0f), Normal3(0, 0, 1)), static_cast<double>(kPi) * 3 / 5, 4e-3);
  EXPECT_EQ(Irradiance(*lamp, Point3(0, 0, 4), Normal3(0, 0, -1), 64), 0);
}

TEST(LightValues, PowerOfAreaLights) {
  const Shape square = test::AsShape(test::Square(2));
  const auto one = Build("diffuse", "\"float power\" 50", Transform(), &square);
  const auto two = Build("diffuse", "\"float power\" 50 \"bool twosided\" true", Transform(), &square);
  for (const auto* built : {one.get(), two.get()}) {
    EXPECT_NEAR(built->light->GetPowerEstimate(built->context).g, 50, 1e-3f);
  }
  LightHit hit;
  hit.direction = Vector3(0, 0, -1);
  hit.normal = Normal3(0, 0, 1);
  hit.distance = 1;
  EXPECT_NEAR(one->light->EvaluateEmissionForCamera(one->context, hit).g, 50 / (4 * kPi), 1e-5f);
  EXPECT_NEAR(two->light->EvaluateEmissionForCamera(two->context, hit).g, 25 / (4 * kPi), 1e-5f);
}

TEST(LightValues, PatchesAreGivenThePatch) {
  const Shape square = test::AsShape(test::Square(2));
  auto built = Build("diffuse", "\"rgb L\" [ 1 1 1 ]", Transform(), &square);
  ASSERT_EQ(built->light->PatchCount(), 2);
  const Point3 P(0.1f, 0.2f, 3);
  float power = 0;
  for (int patch = 0; patch < 2; ++patch) {
    built->context.patch = patch;
    const auto sample = built->light->GenerateSamples(built->context, P);
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->patchIndex, patch);
    EXPECT_FLOAT_EQ(sample->pdfEmit.value, 0.5f);
    power += built->light->GetPowerEstimate(built->context).g;
    EXPECT_GT(built->light->GetEmissionBounds(built->context)->cosThetaO, 0.9999f);
  }
  EXPECT_NEAR(power, 4 * kPi, 1e-4f);
}

class HalfOpaque final : public AlphaSource {
 public:
  float Alpha(const Point2& uv, const Point3&, const Normal3&) const override { return uv.x < 0.5f ? 0.0f : 1.0f; }
};

TEST(LightValues, CutOutsDoNotEmit) {
  const Shape square = test::AsShape(test::Square(2));
  const auto cut = Build("diffuse", "", Transform(), &square, std::make_shared<HalfOpaque>());
  const auto whole = Build("diffuse", "", Transform(), &square);
  const double half = Irradiance(*cut, Point3(0, 0, 2), Normal3(0, 0, -1));
  EXPECT_NEAR(half, 0.5 * Irradiance(*whole, Point3(0, 0, 2), Normal3(0, 0, -1)), 0.02);
  Rng rng(3);
  for (int i = 0; i < 1000; ++i) {
    cut->context.u = rng.NextPoint2();
    const auto sample = cut->light->GenerateSamples(cut->context, Point3(0, 0, 2));
    if (sample) {
      EXPECT_GE(sample->position.x, 0);
    }
  }
}

TEST(LightValues, EditMakesAllAnew) {
  auto spot = Build("spot", "\"rgb I\" [ 1 2 3 ] \"float coneangle\" 20 \"string name\" \"key\"");
  const auto wide = spot->light->Edit(test::Parse("spot", "\"float coneangle\" 80", false), spot->build);
  EXPECT_EQ(wide->Settings().name, "key");
  const Point3 aside(1, 0, 1);
  EXPECT_FALSE(spot->light->GenerateSamples(spot->context, aside));
  const auto sample = wide->GenerateSamples(spot->context, aside);
  ASSERT_TRUE(sample);
  EXPECT_FLOAT_EQ(sample->diffuse.g, 1);
  EXPECT_GT(sample->pdfEmitDirection.value, 0);
  EXPECT_THROW(spot->light->Edit(test::Parse("spot", "\"float coneangle\" -1", false), spot->build), Error);

  const Shape square = test::AsShape(test::Square(2));
  const auto area = Build("diffuse", "\"rgb L\" [ 1 1 1 ]", Transform(), &square);
  const auto brighter =
      area->light->Edit(test::Parse("diffuse", "\"float scale\" 2 \"bool twosided\" true", true), area->build);
  EXPECT_NEAR(brighter->GetPowerEstimate(area->context).g, 16 * kPi, 1e-3f);
  EXPECT_TRUE(brighter->GetEmissionBounds(area->context)->twoSided);
}

TEST(LightValues, SettingsOfEveryLight) {
  const auto light =
      Build("point",
            "\"string name\" \"a\" \"string lightGroup\" \"g\" \"bool cameraVisible\" false "
            "\"bool traceLightPaths\" false \"float importanceMultiplier\" 2 \"integer fixedSampleCount\" 4");
  const LightSettings& settings = light->light->Settings();
  EXPECT_EQ(settings.name, "a");
  EXPECT_EQ(settings.lightGroup, "g");
  EXPECT_FALSE(settings.cameraVisible);
  EXPECT_FALSE(settings.traceLightPaths);
  EXPECT_EQ(settings.importanceMultiplier, 2);
  EXPECT_EQ(settings.fixedSampleCount, 4);
}

}  // namespace
}  // namespace lampyr
