// Wrong parameters are located errors; lights at the extremes of size, distance and brightness stay finite.
#include <gtest/gtest.h>

#include "light_fixture.h"
#include "sampling/rng.h"

namespace lampyr {
namespace {

using test::Build;

std::string ErrorOf(const std::string& type, const std::string& parameters, const Shape* shape = nullptr) {
  try {
    Build(type, parameters, Transform(), shape);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(LightInput, ErrorsNameThePlaceAndTheCure) {
  const std::string unknown = ErrorOf("spot", "\"float conangle\" 20");
  EXPECT_NE(unknown.find("test.pbrt:2:"), std::string::npos) << unknown;
  EXPECT_NE(unknown.find("\"coneangle\""), std::string::npos) << unknown;
  EXPECT_NE(ErrorOf("spot", "\"integer coneangle\" 20").find("float"), std::string::npos);
  EXPECT_NE(ErrorOf("spot", "\"float coneangle\" 200").find("out of range"), std::string::npos);
  EXPECT_NE(ErrorOf("spot", "\"float coneangle\" 0").find("out of range"), std::string::npos);
  EXPECT_NE(ErrorOf("spot", "\"point3 from\" [ 1 1 1 ] \"point3 to\" [ 1 1 1 ]").find("same point"), std::string::npos);
  EXPECT_NE(ErrorOf("distant", "\"point3 from\" [ 0 0 1 ]").find("same point"), std::string::npos);
  EXPECT_NE(ErrorOf("point", "\"float importanceMultiplier\" 0").find("out of range"), std::string::npos);
  EXPECT_NE(ErrorOf("point", "\"rgb I\" [ -1 0 0 ]"), "no error");
  EXPECT_NE(ErrorOf("point", "\"rgb I\" [ 1e38 0 0 ] \"float scale\" 1e10").find("not finite"), std::string::npos);
  EXPECT_NE(ErrorOf("infinite", "\"string filename\" \"nowhere.exr\""), "no error");
  const Shape curves = std::make_shared<const CurveSet>();
  EXPECT_NE(ErrorOf("diffuse", "", &curves).find("curves"), std::string::npos);
  EXPECT_EQ(FindLightType("diffuse", false), nullptr);
  EXPECT_EQ(FindLightType("nothing", false), nullptr);
}

TEST(LightInput, TablesAreComplete) {
  for (const LightType& type : LightRegistry()) {
    EXPECT_FALSE(type.help.empty());
    EXPECT_FALSE(type.samples.empty());
    for (const ParameterInfo& row : type.parameters) EXPECT_FALSE(row.help.empty()) << type.name << " " << row.name;
  }
}

void ExpectFinite(const test::BuiltLight& built, const Point3& P, const std::string& what) {
  Rng rng(11);
  const auto valid = [](float x) { return x >= 0 && x < kInfinity; };
  for (int i = 0; i < 500; ++i) {
    LightContext context = built.context;
    context.u = i == 0 ? Point2(0.0f) : i == 1 ? Point2(kOneMinusEpsilon) : rng.NextPoint2();
    context.uDirection = i == 0 ? Point2(0.0f) : i == 1 ? Point2(kOneMinusEpsilon) : rng.NextPoint2();
    if (const auto s = built.light->GenerateSamples(context, P)) {
      EXPECT_TRUE(s->diffuse.IsValid() && valid(s->pdfDirect.value) && valid(s->pdfEmit.value) && IsFinite(s->normal) &&
                  valid(s->pdfEmitDirection.value) && valid(s->solidAngleToArea) && IsFinite(s->direction) &&
                  IsFinite(s->position))
          << what;
      EXPECT_NEAR(glm::length(s->direction), 1, 1e-5f) << what;
      EXPECT_GT(s->pdfDirect.value, 0) << what;
    }
    if (const auto e = built.light->GenerateEmission(context)) {
      EXPECT_TRUE(e->diffuse.IsValid() && valid(e->pdfEmit.value) && valid(e->pdfEmitDirection.value) &&
                  IsFinite(e->position) && IsFinite(e->direction))
          << what;
      EXPECT_GT(e->pdfEmit.value, 0) << what;
      EXPECT_TRUE(e->diffuse.IsBlack() || e->emissionCosine * e->pdfEmitDirection.value > 0) << what;
    }
  }
  EXPECT_TRUE(valid(built.light->GetIncidentRadianceEstimate(built.context, P))) << what;
  EXPECT_TRUE(built.light->GetPowerEstimate(built.context).IsValid()) << what;
  const auto segment = built.light->GetIncidentRadianceEstimate(built.context, P, Vector3(0, 0, 1), 1.0f);
  if (segment) {
    EXPECT_TRUE(valid(segment->radiance)) << what;
  }
}

TEST(LightExtremes, SizesDistancesAndBrightness) {
  for (const double size : {1e-6, 1.0, 1e6}) {
    const Transform scale = Transform::Scale(Vector3d(size));
    const Shape sphere = test::Sphere(static_cast<float>(size));
    const Shape square = test::AsShape(test::Square(static_cast<float>(size)));
    for (const float distance : {1e-5f, 1.0f, 1e6f}) {
      const std::string what = "size " + std::to_string(size) + " distance " + std::to_string(distance);
      const Point3 P = distance * glm::normalize(Vector3(0.3f, 0.2f, 1));
      for (const char* brightness : {"1e-30", "1", "1e20"}) {
        const std::string scaled = std::string("\"float scale\" ") + brightness;
        ExpectFinite(*Build("diffuse", scaled, Transform(), &sphere), P, "sphere " + what);
        ExpectFinite(*Build("diffuse", scaled, Transform(), &square), P, "square " + what);
        ExpectFinite(*Build("spot", scaled, scale), P, "spot " + what);
        ExpectFinite(*Build("point", scaled, scale), P, "point " + what);
        ExpectFinite(*Build("distant", scaled, scale), P, "distant " + what);
        ExpectFinite(*Build("infinite", scaled, scale), P, "infinite " + what);
      }
    }
  }
}

TEST(LightExtremes, TinyFarSphereKeepsItsSolidAngle) {
  // Radius 1e-6 at 1e3: Ω = π r²/d².
  const Shape sphere = test::Sphere(1e-6f);
  const auto built = Build("diffuse", "", Transform(), &sphere);
  const auto sample = built->light->GenerateSamples(built->context, Point3(0, 0, 1e3f));
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->pdfDirect.value * kPi * 1e-18f, 1, 1e-5f);
  EXPECT_NEAR(sample->distance, 1e3f, 1e-3f);
}

TEST(LightExtremes, SphereAlmostTouched) {
  const Shape sphere = test::Sphere(1);
  const auto built = Build("diffuse", "", Transform(), &sphere);
  for (const float height : {1e-6f, 1e-5f, 3e-5f, 1e-4f, 1e-2f})
    ExpectFinite(*built, Point3(0, 0, 1 + height), "touching");
}

TEST(LightExtremes, MeshesThatAreNone) {
  const auto empty = std::make_shared<TriangleMesh>();
  const Shape nothing = test::AsShape(empty);
  const auto dark = Build("diffuse", "", Transform(), &nothing);
  EXPECT_EQ(dark->light->PatchCount(), 1);
  EXPECT_FALSE(dark->light->GenerateSamples(dark->context, Point3(1.0f)));
  EXPECT_FALSE(dark->light->GenerateEmission(dark->context));
  EXPECT_TRUE(dark->light->GetPowerEstimate(dark->context).IsBlack());

  auto flat = test::Square(1);
  flat->triangles = {{0, 0, 1}, {0, 1, 2}, {1, 1, 1}};
  const Shape withSlivers = test::AsShape(flat);
  const auto some = Build("diffuse", "", Transform(), &withSlivers);
  Rng rng(2);
  for (int i = 0; i < 200; ++i) {
    some->context.u = rng.NextPoint2();
    const auto sample = some->light->GenerateSamples(some->context, Point3(0, 0, 1));
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->patchIndex, 1);
  }
}

}  // namespace
}  // namespace lampyr
