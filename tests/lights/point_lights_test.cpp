// Lights that are a point, against values computed by hand: what the common parameters make of them, which way up
// images are thrown, and the power of it all.
#include "lights/direction_map.h"
#include "point_light_fixture.h"
#include "sampling/rng.h"

namespace lampyr {
namespace {

using test::Build;

using test::ExpectColor;
using test::IntensityTo;
using test::PowerByQuadrature;

using PointLights = test::PointLightTest;

TEST_F(PointLights, CommonParametersMultiplyTheIntensity) {
  for (const std::string type : {"point", "spot"}) {
    const auto at = [&](const std::string& parameters) {
      return IntensityTo(*Build(type, "\"rgb I\" [ 4 2 1 ] " + parameters), Point3(0, 0, 3));
    };
    ExpectColor(at(""), {4, 2, 1}, 1e-6f);
    ExpectColor(at("\"float intensity\" 3"), {12, 6, 3}, 1e-6f);
    ExpectColor(at("\"float exposure\" 2"), {16, 8, 4}, 1e-6f);
    ExpectColor(at("\"float exposure\" -1"), {2, 1, 0.5f}, 1e-6f);
    ExpectColor(at("\"rgb color\" [ 0.5 1 3 ]"), {2, 2, 3}, 1e-6f);
    ExpectColor(at("\"float intensity\" 3 \"float exposure\" 2 \"rgb color\" [ 0.5 1 3 ]"), {24, 24, 36}, 1e-6f);
    ExpectColor(at("\"bool normalize\" true"), {4, 2, 1}, 1e-6f);          // a point has no size
    ExpectColor(at("\"float colorTemperature\" 3200"), {4, 2, 1}, 1e-6f);  // not enabled
  }
}

// From the chromaticities (x, y) of the Planckian locus, (0.3135, 0.3237) at 6500 K and (0.4234, 0.3990) at 3200 K: XYZ
// of luminance 1 is (x/y, 1, (1-x-y)/y), times the matrix of Rec. 709. The matching functions are fits, good to 1 %.
TEST_F(PointLights, ColourTemperatures) {
  const auto at = [&](const std::string& kelvin) {
    return IntensityTo(*Build("point", "\"bool enableColorTemperature\" true \"float colorTemperature\" " + kelvin),
                       Point3(0, 0, 1));
  };
  ExpectColor(at("6500"), {1.0425f, 0.9839f, 1.0348f}, 1e-2f);
  ExpectColor(at("3200"), {1.6796f, 0.8660f, 0.3256f}, 1e-2f);
  EXPECT_NEAR(at("6500").Luminance(), 1, 2e-3f);
  EXPECT_NEAR(at("3200").Luminance(), 1, 2e-3f);
}

TEST_F(PointLights, DiffuseAndSpecularParts) {
  const auto light = Build("spot", "\"rgb I\" [ 4 2 1 ] \"float diffuse\" 0.25 \"float specular\" 3");
  const auto sample = light->light->GenerateSamples(light->context, Point3(0, 0, 2));
  ASSERT_TRUE(sample);
  ExpectColor(sample->diffuse, {0.25f, 0.125f, 0.0625f}, 1e-6f);
  ExpectColor(sample->specular, {3, 1.5f, 0.75f}, 1e-6f);
  const auto photon = light->light->GenerateEmission(light->context);
  ASSERT_TRUE(photon);
  ExpectColor(photon->specular, photon->diffuse * 12, 1e-5f);
  // One part may be missing, both may not.
  EXPECT_TRUE(Build("point", "\"float diffuse\" 0")
                  ->light->GenerateSamples(Build("point", "")->context, Point3(0, 0, 2))
                  .has_value());
  const auto dark = Build("point", "\"float diffuse\" 0 \"float specular\" 0");
  EXPECT_FALSE(dark->light->GenerateSamples(dark->context, Point3(0, 0, 2)));
  EXPECT_FALSE(dark->light->GenerateEmission(dark->context));
}

// A 4 × 2 image at 90°: the frustum reaches to x = ±2, y = ±1 at z = 1, a texel is 1 × 1 there; top left is (-x, +y).
TEST_F(PointLights, ProjectionIsTheRightWayUp) {
  const auto texel = [](int x, int y) { return Color(1.0f + x, 10.0f + x + 4 * y, 100.0f + 4 * y); };
  const auto light = Make("projection", Write(4, 2, texel) + "\"float scale\" 2");
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 4; ++x) {
      const Point3 P(-1.5f + x, 0.5f - y, 1);
      ExpectColor(IntensityTo(*light, P), texel(x, y) * 2, 1e-5f);
      ExpectColor(IntensityTo(*light, 7.0f * P), texel(x, y) * 2, 1e-5f);
      // Nearest texel: the same up to its edges.
      ExpectColor(IntensityTo(*light, P + Vector3(0.49f, -0.49f, 0)), texel(x, y) * 2, 1e-5f);
      EXPECT_TRUE(IntensityTo(*light, -P).IsBlack());
    }
  }
  EXPECT_TRUE(IntensityTo(*light, Point3(2.01f, 0, 1)).IsBlack());
  EXPECT_TRUE(IntensityTo(*light, Point3(0, -1.01f, 1)).IsBlack());
  // Higher than wide: the field of view is that of the width. 2 × 4 at 90°: x = ±1, y = ±2.
  const auto tall = Make("projection", Write(2, 4, texel));
  ExpectColor(IntensityTo(*tall, Point3(-0.5f, 1.5f, 1)), texel(0, 0), 1e-5f);
  ExpectColor(IntensityTo(*tall, Point3(0.5f, -1.5f, 1)), texel(1, 3), 1e-5f);
  EXPECT_TRUE(IntensityTo(*tall, Point3(1.01f, 0, 1)).IsBlack());
  // 2·atan(1/2) across a square image.
  const auto narrow = Make("projection", Write(2, 2, texel) + "\"float fov\" 53.130102");
  ExpectColor(IntensityTo(*narrow, Point3(0.49f, 0.49f, 1)), texel(1, 0), 1e-5f);
  EXPECT_TRUE(IntensityTo(*narrow, Point3(0.51f, 0, 1)).IsBlack());
}

// A 5 × 5 image whose texels are all different; gray is the mean of R, G and B.
TEST_F(PointLights, GoniometricAlongTheAxes) {
  const auto texel = [](int x, int y) { return Color(0, 3.0f * x, 30.0f * (y + 1)); };
  const auto gray = [](int x, int y) { return static_cast<float>(x + 10 * (y + 1)); };
  const auto light = Make("goniometric", Write(5, 5, texel) + "\"rgb I\" [ 2 1 0.5 ] \"float scale\" 3");
  const auto expect = [&](const Vector3& direction, int x, int y) {
    SCOPED_TRACE(std::to_string(direction.x) + " " + std::to_string(direction.y) + " " + std::to_string(direction.z));
    ExpectColor(IntensityTo(*light, 2.0f * direction), Color(6, 3, 1.5f) * gray(x, y), 1e-5f);
  };
  expect({0, 1, 0}, 2, 2);
  expect({1, 0, 0}, 4, 2);
  expect({-1, 0, 0}, 0, 2);
  expect({0, 0, 1}, 2, 4);
  expect({0, 0, -1}, 2, 0);
  // All corners are -y; the quadrant tells which.
  expect({0.1f, -1, 0.1f}, 4, 4);
  expect({-0.1f, -1, 0.1f}, 0, 4);
  expect({0.1f, -1, -0.1f}, 4, 0);
  expect({-0.1f, -1, -0.1f}, 0, 0);
}

TEST_F(PointLights, PowerIsWhatItSays) {
  const std::string white = Write(3, 3, [](int, int) { return Color(1.0f); });
  // A square frustum of 90° is a face of the cube, 4π/6.
  EXPECT_NEAR(Make("projection", white)->light->GetPowerEstimate(Make("projection", white)->context).g, 2 * M_PI / 3,
              1e-5);
  // At 60°: 4 asin(sin²30°).
  const auto narrow = Make("projection", white + "\"float fov\" 60");
  EXPECT_NEAR(narrow->light->GetPowerEstimate(narrow->context).g, 4 * std::asin(0.25), 1e-5);
  // A colour of luminance 0.2126390·1 + 0.7151687·0.5 + 0.0721923·2 = 0.7146080.
  const std::string colored = Write(4, 2, [](int, int) { return Color(1, 0.5f, 2); });
  const auto projector = Make("projection", colored + "\"float power\" 10");
  ExpectColor(projector->light->GetPowerEstimate(projector->context), Color(1, 0.5f, 2) * (10 / 0.714608f), 1e-5f);
  const auto lamp = Make("goniometric", Write(2, 2, [](int x, int y) { return Color(1.0f + x + y); }) +
                                            "\"rgb I\" [ 2 1 0.5 ] \"float power\" 10");
  ExpectColor(lamp->light->GetPowerEstimate(lamp->context), {20, 10, 5}, 1e-5f);
  EXPECT_NEAR(IntensityTo(*lamp, Point3(1, 0.5f, 2)).g, 10 / (4 * kPi) * 3 / 2, 1e-5f);  // the lower right texel
}

TEST_F(PointLights, PowerByQuadratureUnderAllTransforms) {
  const auto texel = [](int x, int y) { return Color(1 + Sqr(x - 3.0f), (x + y) % 3 ? 1.0f : 0.0f, 0.5f * y); };
  const std::string square = Write(7, 7, texel), wide = Write(9, 4, texel), large = Write(100, 100, texel);
  glm::dmat4 shear(1.0);
  shear[1][0] = 0.6;
  shear[2][1] = -0.4;
  const Transform transforms[] = {Transform(), Transform::Rotate(50, {1, 2, -1}) * Transform::Scale({-2, 2, 2}),
                                  Transform::Rotate(50, {1, 2, -1}) * Transform::Scale({3, 0.5, 1}),
                                  Transform(shear) * Transform::Rotate(20, {1, 0, 1})};
  const std::pair<std::string, std::string> lights[] = {{"goniometric", square},
                                                        {"goniometric", large + "\"float power\" 5"},
                                                        {"projection", wide + "\"float power\" 5"},
                                                        {"projection", wide + "\"float fov\" 140"},
                                                        {"spot", "\"float coneangle\" 70"},
                                                        {"spot", "\"float power\" 5"},
                                                        {"point", "\"float shaping:cone:angle\" 50 \"float power\" 5"},
                                                        {"point", ""}};
  for (const auto& [type, parameters] : lights) {
    for (size_t i = 0; i < std::size(transforms); ++i) {
      SCOPED_TRACE(type + " " + parameters + " transform " + std::to_string(i));
      const auto light = Make(type, parameters, transforms[i]);
      const Color power = PowerByQuadrature(*light);
      EXPECT_GT(power.g, 0);
      if (parameters.find("power") != std::string::npos) {
        EXPECT_NEAR(power.Luminance(), 5, i < 2 ? 0.015 : 0.05);
      }
      ExpectColor(light->light->GetPowerEstimate(light->context), power, i < 2 ? 3e-3f : 1e-2f);
    }
  }
}

TEST_F(PointLights, OneBrightTexelTakesAllPhotons) {
  const std::string image = Write(8, 8, [](int x, int y) { return Color(x == 5 && y == 2 ? 1e6f : 0.0f); });
  for (const std::string type : {"goniometric", "projection"}) {
    const auto light = Make(type, image);
    // The texel's solid angle: column 5 of x in [0.25, 0.5], row 2 of y in [0.25, 0.5] at z = 1.
    const auto corner = [](double x, double y) { return std::atan(x * y / std::sqrt(1 + x * x + y * y)); };
    const double solidAngle =
        type == "goniometric" ? 4 * M_PI / 64 : corner(0.5, 0.5) - 2 * corner(0.25, 0.5) + corner(0.25, 0.25);
    EXPECT_NEAR(static_cast<double>(light->light->GetPowerEstimate(light->context).g) / solidAngle, 1e6, 10);
    Rng rng(3);
    double sum = 0;
    int photons = 0;
    for (int i = 0; i < 4000; ++i) {
      light->context.u = rng.NextPoint2();
      const auto photon = light->light->GenerateEmission(light->context);
      if (!photon) continue;  // rounded across the texel's edge
      ++photons;
      EXPECT_FLOAT_EQ(photon->diffuse.g, 1e6f);
      // All photons carry the same flux but for what cos³θ changes within a 64th of the image.
      const double flux = 1 / static_cast<double>(photon->pdfEmitDirection.value);
      EXPECT_NEAR(flux / solidAngle, 1, 0.04);
      sum += flux;
      if (type == "projection") {
        EXPECT_GT(std::min(photon->direction.x, photon->direction.y), 0);
      }
    }
    EXPECT_GE(photons, 3999);
    EXPECT_NEAR(sum / photons / solidAngle, 1, 2e-3);
  }
}

TEST_F(PointLights, BlackAndBrokenImages) {
  const std::string black = Write(4, 4, [](int, int) { return Color(0.0f); });
  const std::string broken = Write(2, 2, [](int x, int y) {
    return x + y == 0 ? Color(std::nanf("")) : x + y == 1 ? Color(x ? -3.0f : kInfinity) : Color(2.0f);
  });
  for (const std::string type : {"goniometric", "projection"}) {
    for (const std::string power : {"", "\"float power\" 10"}) {
      const auto dark = Make(type, black + power);
      EXPECT_FALSE(dark->light->GenerateSamples(dark->context, Point3(0.1f, 0.2f, 2)));
      EXPECT_FALSE(dark->light->GenerateEmission(dark->context));
      EXPECT_EQ(dark->light->GetIncidentRadianceEstimate(dark->context, Point3(0.1f, 0.2f, 2)), 0);
      EXPECT_EQ(dark->light->GetPowerEstimate(dark->context).g, 0);
    }
    const auto light = Make(type, broken + "\"float power\" 10");
    EXPECT_NEAR(light->light->GetPowerEstimate(light->context).g, 10, 1e-4f);
    EXPECT_NEAR(PowerByQuadrature(*light).g, 10, 0.05f);
  }
  EXPECT_EQ(diagnostics_.Warnings().size(), 2u);  // each light once
}

// One channel, by whatever name, or a Y among others.
TEST_F(PointLights, GrayImages) {
  for (const std::vector<std::string>& channels : {std::vector<std::string>{"Y"}, {"depth"}, {"A", "Y"}}) {
    Image image(2, 2, channels);
    for (size_t i = 0; i < 4; ++i) image.data[i * channels.size() + channels.size() - 1] = 1.0f + static_cast<float>(i);
    const std::filesystem::path file = folder_ / "gray.exr";
    WriteExr(file, image, ExrPrecision::Float);
    TextureLibrary textures({}, Transform(), diagnostics_);
    for (const std::string type : {"goniometric", "projection", "infinite"}) {
      LightBuildContext build;
      build.textures = &textures;
      const auto light = MakeLight(*FindLightType(type, false),
                                   test::Parse(type, "\"string filename\" \"" + file.string() + "\"", false), build);
      LightContext context;
      const LightTransform identity;
      context.transform = &identity;
      context.scene = {Point3(0.0f), 1};
      // Towards the lower right of the image: texel 4.
      Color found;
      if (type == "infinite") {
        LightHit hit;
        hit.direction = glm::normalize(Vector3(1, 1, 0.5f));
        found = light->EvaluateSamples(context, hit, Point3(0.0f))->diffuse;
      } else {
        const auto sample = light->GenerateSamples(
            context, glm::normalize(type == "goniometric" ? Vector3(1, 0.5f, 1) : Vector3(0.5f, -0.5f, 1)));
        ASSERT_TRUE(sample) << type;
        found = sample->diffuse;
      }
      ExpectColor(found, Color(4.0f), 1e-5f);
    }
  }
}

TEST_F(PointLights, ErrorsNameTheCure) {
  const auto error = [&](const std::string& type, const std::string& parameters) -> std::string {
    try {
      Make(type, parameters);
    } catch (const Error& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_NE(error("projection", "").find("\"filename\""), std::string::npos);
  EXPECT_NE(error("projection", "\"string filename\" \"nowhere.exr\"").find("nowhere.exr"), std::string::npos);
  const std::string wide = Write(4, 2, [](int, int) { return Color(1.0f); });
  EXPECT_NE(error("goniometric", wide).find("4×2"), std::string::npos);
  EXPECT_NE(error("projection", wide + "\"float fov\" 180").find("out of range"), std::string::npos);
  EXPECT_NE(error("projection", wide + "\"rgb I\" [ 1 1 1 ]").find("no parameter \"I\""), std::string::npos);
  EXPECT_EQ(error("goniometric", ""), "no error");
  EXPECT_EQ(diagnostics_.Warnings().size(), 1u);
}

// The part of a segment that a projection or a spot can reach: all that is lit, and little more.
TEST_F(PointLights, SegmentsAreCutToWhatIsReached) {
  const std::string image = Write(4, 2, [](int, int) { return Color(1.0f); });
  const Transform placed = Transform::Rotate(70, {2, 1, -1}) * Transform::Scale({2, 0.6, 1});
  for (const auto& [type, parameters] : {std::pair<std::string, std::string>("projection", image + "\"float fov\" 40"),
                                         {"spot", "\"float coneangle\" 25"}}) {
    const auto light = Make(type, parameters, placed);
    Rng rng(17);
    int lit = 0;
    double waste = 0;
    for (int i = 0; i < 3000; ++i) {
      const Point3 origin = 3.0f * SampleUniformSphere(rng.NextPoint2());
      const Vector3 direction = SampleUniformSphere(rng.NextPoint2());
      const auto estimate = light->light->GetIncidentRadianceEstimate(light->context, origin, direction, 6);
      double first = 7, last = -1;
      for (int k = 0; k <= 600; ++k) {
        const float t = 0.01f * static_cast<float>(k);
        if (!light->light->GenerateSamples(light->context, origin + t * direction)) continue;
        first = std::min(first, static_cast<double>(t));
        last = std::max(last, static_cast<double>(t));
      }
      if (last < 0) continue;
      ++lit;
      ASSERT_TRUE(estimate);
      EXPECT_LE(estimate->minT, first + 1e-4);
      EXPECT_GE(estimate->maxT, last - 1e-4);
      waste += static_cast<double>(estimate->maxT - estimate->minT) - (last - first);
    }
    EXPECT_GT(lit, 100);
    EXPECT_LT(waste / lit, 0.05) << type;
    EXPECT_FALSE(light->light->GetIncidentRadianceEstimate(light->context, Point3(placed.Point({0, 0, -1})),
                                                           Vector3(glm::normalize(placed.Vector({1, 0, -0.2}))), 100));
  }
}

// Lengths of float overflow below 5e-20 and are lost beyond 1e19; directions and their densities are not.
TEST(DirectionMap, HoldsAtAnyScale) {
  const auto placed = [](float scale) {
    LightTransform transform;
    transform.toRender.linear = glm::mat3(0.6f, 0.8f, 0, -1.6f, 1.2f, 0, 0, 0, 3) * scale;
    transform.toLocal.linear = glm::mat3(0.6f, -0.4f, 0, 0.8f, 0.3f, 0, 0, 0, 1 / 3.0f) * (1 / scale);
    return transform;
  };
  const Vector3 direction = glm::normalize(Vector3(1, -2, 3));
  const LightTransform one = placed(1);
  const Vector3 local = ToLocalDirection(one, direction);
  for (const float scale : {1e-37f, 1e-25f, 4e-20f, 1e-15f, 1e15f, 1e20f, 1e37f}) {
    const LightTransform scaled = placed(scale);
    EXPECT_LT(glm::length(ToLocalDirection(scaled, direction) - local), 1e-6f) << scale;
    EXPECT_LT(glm::length(ToRenderDirection(scaled, local) - direction), 1e-6f) << scale;
    const float factor = LocalSolidAngleFactor(one, direction);
    EXPECT_NEAR(LocalSolidAngleFactor(scaled, direction), factor, 1e-5f * factor) << scale;
    EXPECT_FALSE(IsSimilarity(scaled.toRender.linear)) << scale;
    EXPECT_TRUE(IsSimilarity(glm::mat3(scale))) << scale;
  }
}

}  // namespace
}  // namespace lampyr
