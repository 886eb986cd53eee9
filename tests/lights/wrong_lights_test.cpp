// The suite must be able to fail: lights that are wrong on purpose, each by one fault, and the property that finds it.
#include <gtest/gtest.h>

#include <set>

#include "light_fixture.h"
#include "suite/pdf_suite.h"
#include "wrong_light.h"

namespace lampyr {
namespace {

using test::Fault;
using test::WrongLight;

// The properties that a light with this fault fails.
std::set<std::string> Failures(const std::string& type, const Shape* shape, Fault fault) {
  const Transform turn = Transform::Rotate(40, {1, 0.5, 0});
  const auto built =
      test::Build(type, type == "spot" ? "\"float coneangle\" 50" : "", shape ? Transform() : turn, shape);
  const WrongLight wrong(std::move(built->light), fault);
  std::unique_ptr<EmitterModel> model;
  if (shape) model = MakeEmitterModel(*shape, Transform());
  SuiteSubject subject;
  subject.light = &wrong;
  subject.context = built->context;
  subject.model = model.get();
  subject.isThorough = false;
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
    EXPECT_TRUE(Failures("diffuse", shape, Fault::NegativeInPlaces).count("valid"));
    EXPECT_TRUE(Failures("diffuse", shape, Fault::NoNumberInPlaces).count("valid"));
  }
  EXPECT_TRUE(Failures("diffuse", &square, Fault::PatchChoiceForgotten).count("patches"));  // two triangles
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
