// The suite must be able to fail: lights that are wrong on purpose, each by one fault, and the property that finds it.
#include <gtest/gtest.h>

#include <set>

#include "light_fixture.h"
#include "lights/suite/pdf_suite.h"

namespace lampyr {
namespace {

enum class Fault {
  None,
  PdfOffByOnePercent,
  CosineForgotten,
  LeaksBehind,
  EmissionNotCosine,
  PowerOffByTwo,
  DiskNotRotated,
  ZeroWhereItEmits,
  OtherRadiance,
  EmitDensityOff,
  EstimateIsZero,
  DarkPhotonsAreNone,
};

// A sound light with one fault.
class WrongLight final : public Light {
 public:
  WrongLight(const Light& light, Fault fault) : light_(light), fault_(fault) {}

  LightKind Kind() const override { return light_.Kind(); }
  const LightSettings& Settings() const override { return light_.Settings(); }
  int PatchCount() const override { return light_.PatchCount(); }
  float GetIncidentRadianceEstimate(const LightContext& context, const Point3& P) const override {
    return fault_ == Fault::EstimateIsZero ? 0.0f : light_.GetIncidentRadianceEstimate(context, P);
  }
  std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext& context, const Point3& origin,
                                                             const Vector3& direction, float length) const override {
    return light_.GetIncidentRadianceEstimate(context, origin, direction, length);
  }
  Color GetPowerEstimate(const LightContext& context) const override {
    return light_.GetPowerEstimate(context) * (fault_ == Fault::PowerOffByTwo ? 2.0f : 1.0f);
  }
  std::optional<EmissionBounds> GetEmissionBounds(const LightContext& context) const override {
    return light_.GetEmissionBounds(context);
  }
  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const override {
    auto sample = light_.GenerateSamples(context, P);
    if (!sample) return sample;
    if (fault_ == Fault::ZeroWhereItEmits && IsNeglected(sample->position, sample->direction)) return std::nullopt;
    sample->pdfDirect = Changed(sample->pdfDirect, glm::dot(sample->normal, sample->direction));
    if (fault_ == Fault::EmitDensityOff) sample->pdfEmit = sample->pdfEmit * 1.05f;
    return sample;
  }
  std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& given,
                                                 const Point3& P) const override {
    LightHit hit = given;
    if (fault_ == Fault::LeaksBehind && glm::dot(hit.normal, hit.direction) > 0) hit.normal = -hit.normal;
    auto evaluation = light_.EvaluateSamples(context, hit, P);
    if (!evaluation) return evaluation;
    evaluation->pdfDirect = Changed(evaluation->pdfDirect, glm::dot(hit.normal, hit.direction));
    if (fault_ == Fault::ZeroWhereItEmits && IsNeglected(hit.position, hit.direction))
      evaluation->pdfDirect = PdfSolidAngle(0);
    if (fault_ == Fault::OtherRadiance) evaluation->diffuse *= 1.01f;
    if (fault_ == Fault::EmitDensityOff) evaluation->pdfEmit = evaluation->pdfEmit * 1.05f;
    if (fault_ == Fault::EmissionNotCosine) evaluation->pdfEmitDirection = PdfSolidAngle(0.5f * kInvPi);
    return evaluation;
  }
  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override {
    auto photon = light_.GenerateEmission(context);
    if (!photon) return photon;
    if (fault_ == Fault::DarkPhotonsAreNone && photon->emissionCosine < 0.3f) return std::nullopt;
    if (fault_ == Fault::EmissionNotCosine) photon->pdfEmitDirection = PdfSolidAngle(0.5f * kInvPi);
    if (fault_ == Fault::EmitDensityOff) photon->pdfEmit = photon->pdfEmit * 1.05f;
    if (fault_ == Fault::DiskNotRotated) {
      const float angle = 2 * kPi * context.uDirection.x, r = std::sqrt(context.uDirection.y) * context.scene.radius;
      photon->position = context.scene.center + Vector3(r * std::cos(angle), r * std::sin(angle), 0) -
                         context.scene.radius * photon->direction;
    }
    return photon;
  }
  Color EvaluateEmissionForCamera(const LightContext& context, const LightHit& hit) const override {
    return light_.EvaluateEmissionForCamera(context, hit);
  }
  std::unique_ptr<Light> Edit(const ParameterList& changes, const LightBuildContext& build) const override {
    return light_.Edit(changes, build);
  }

 private:
  bool IsNeglected(const Point3& position, const Vector3& direction) const {
    return Kind() == LightKind::Area ? position.x < 0 : direction.x < 0;
  }
  PdfSolidAngle Changed(PdfSolidAngle pdf, float cosine) const {
    if (fault_ == Fault::PdfOffByOnePercent) return pdf * 1.01f;
    return fault_ == Fault::CosineForgotten ? pdf * std::abs(cosine) : pdf;
  }

  const Light& light_;
  Fault fault_;
};

// The properties that a light with this fault fails.
std::set<std::string> Failures(const std::string& type, const Shape* shape, Fault fault) {
  const Transform turn = Transform::Rotate(40, {1, 0.5, 0});
  const auto built =
      test::Build(type, type == "spot" ? "\"float coneangle\" 50" : "", shape ? Transform() : turn, shape);
  const WrongLight wrong(*built->light, fault);
  std::unique_ptr<EmitterModel> model;
  if (shape) model = MakeEmitterModel(*shape, Transform());
  SuiteSubject subject;
  subject.light = &wrong;
  subject.context = built->context;
  subject.model = model.get();
  subject.name = type;
  subject.caseName = "wrong";
  SuiteReport report;
  SuiteOptions options;
  CheckLight(subject, options, report);
  std::set<std::string> failed;
  for (const SuiteResult& result : report.Finish(1e-3)) {
    if (!result.passed) failed.insert(result.property);
  }
  return failed;
}

TEST(WrongLights, SoundOnesPass) {
  const Shape square = test::AsShape(test::Square(2)), sphere = test::Sphere(1);
  EXPECT_TRUE(Failures("diffuse", &square, Fault::None).empty());
  EXPECT_TRUE(Failures("diffuse", &sphere, Fault::None).empty());
  for (const char* type : {"point", "spot", "distant", "infinite"})
    EXPECT_TRUE(Failures(type, nullptr, Fault::None).empty());
}

TEST(WrongLights, EveryFaultOfAnAreaLightIsFound) {
  const Shape square = test::AsShape(test::Square(2)), sphere = test::Sphere(1);
  for (const Shape* shape : {&square, &sphere}) {
    EXPECT_TRUE(Failures("diffuse", shape, Fault::PdfOffByOnePercent).count("integral"));
    EXPECT_TRUE(Failures("diffuse", shape, Fault::CosineForgotten).count("integral"));
    EXPECT_TRUE(Failures("diffuse", shape, Fault::LeaksBehind).count("one-sided"));
    EXPECT_TRUE(Failures("diffuse", shape, Fault::EmissionNotCosine).count("emission-directions"));
    EXPECT_TRUE(Failures("diffuse", shape, Fault::PowerOffByTwo).count("power-estimate"));
    EXPECT_TRUE(Failures("diffuse", shape, Fault::ZeroWhereItEmits).count("irradiance"));
    EXPECT_TRUE(Failures("diffuse", shape, Fault::OtherRadiance).count("consistency"));
    EXPECT_TRUE(Failures("diffuse", shape, Fault::EmitDensityOff).count("emission-integral"));
    EXPECT_TRUE(Failures("diffuse", shape, Fault::EmitDensityOff).count("power"));
    EXPECT_TRUE(Failures("diffuse", shape, Fault::EstimateIsZero).count("estimate"));
    EXPECT_TRUE(Failures("diffuse", shape, Fault::DarkPhotonsAreNone).count("emission-origin"));
  }
}

TEST(WrongLights, EveryFaultAtInfinityIsFound) {
  for (const char* type : {"distant", "infinite"}) {
    const std::set<std::string> disk = Failures(type, nullptr, Fault::DiskNotRotated);
    EXPECT_TRUE(disk.count("emission-positions") || disk.count("emission-edge")) << type;
    EXPECT_TRUE(Failures(type, nullptr, Fault::PowerOffByTwo).count("power-estimate")) << type;
    EXPECT_TRUE(Failures(type, nullptr, Fault::EmitDensityOff).count("power")) << type;
  }
  EXPECT_TRUE(Failures("infinite", nullptr, Fault::PdfOffByOnePercent).count("integral"));
  EXPECT_TRUE(Failures("infinite", nullptr, Fault::ZeroWhereItEmits).count("irradiance"));
}

TEST(WrongLights, EveryFaultOfAPointIsFound) {
  EXPECT_TRUE(Failures("spot", nullptr, Fault::EmissionNotCosine).count("power"));
  EXPECT_TRUE(Failures("spot", nullptr, Fault::PowerOffByTwo).count("power-estimate"));
  EXPECT_TRUE(Failures("point", nullptr, Fault::EmitDensityOff).count("power"));
  EXPECT_TRUE(Failures("point", nullptr, Fault::EstimateIsZero).count("estimate"));
}

}  // namespace
}  // namespace lampyr
