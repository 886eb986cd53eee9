// One light of each kind under the suite, with whatever is done to it, and the properties that it then fails.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <functional>
#include <map>
#include <set>

#include "light_fixture.h"
#include "lights/light_base.h"
#include "suite/pdf_suite.h"
#include "suite/suite_inputs.h"
#include "textures/texture_library.h"

namespace lampyr::test {

using Properties = std::set<std::string>;
using Lights = std::vector<std::string>;  // by their names in SuiteLights()

struct SuiteLight {
  std::string type, parameters;
  std::optional<Shape> shape;
};

inline const std::map<std::string, SuiteLight>& SuiteLights() {
  static const std::string image = "\"string filename\" \"suite-square.exr\" ";
  static const std::string sky = "\"string texture:file\" \"suite-latlong.exr\" ";
  static const std::map<std::string, SuiteLight> lights = {
      {"square", {"diffuse", "", AsShape(Square(2))}},
      {"ball", {"diffuse", "", Sphere(1)}},
      {"mesh", {"mesh", "", AsShape(Square(2))}},
      {"rect", {"rect", "\"float width\" 2 ", {}}},
      {"disk", {"disk", "", {}}},
      {"sphere", {"sphere", "", {}}},
      {"cylinder", {"cylinder", "", {}}},
      {"point", {"point", "", {}}},
      {"spot", {"spot", "\"float coneangle\" 50 ", {}}},
      {"goniometric", {"goniometric", image, {}}},
      {"projection", {"projection", image, {}}},
      {"parallel", {"distant", "", {}}},
      {"sun", {"distant", "\"float angle\" 40 ", {}}},
      {"even sky", {"infinite", "", {}}},
      {"dome", {"dome", sky, {}}},
      {"portal", {"portal", "\"float width\" 2 ", {}}},
      {"portal of an image", {"portal", sky, {}}},
      {"window", {"infinite", image + "\"point3 portal\" [ -1 -1 2  -1 1 2  1 1 2  1 -1 2 ] ", {}}},
  };
  return lights;
}

class SuiteTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    std::filesystem::create_directories(Folder());
    suite::WriteSuiteInputs(Folder());
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(Folder()); }
  static std::filesystem::path Folder() {
    return std::filesystem::path(::testing::TempDir()) /
           (std::string("lampyr-") + ::testing::UnitTest::GetInstance()->current_test_suite()->name() +
            std::to_string(getpid()));
  }

  static ParameterList ParseFor(const SuiteLight& light, const std::string& parameters) {
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    const std::string statement =
        (light.shape ? "AreaLightSource \"" : "LightSource \"") + light.type + "\" " + parameters;
    const SceneDescription scene =
        ParseScene("WorldBegin\n" + statement + "\n" + (light.shape ? "Shape \"sphere\"\n" : ""),
                   Folder() / "test.pbrt", diagnostics);
    return light.shape ? scene.areaLights.at(0).parameters : scene.lights.at(0).light.parameters;
  }
  static LightType TypeOf(const SuiteLight& light) { return *FindLightType(light.type, light.shape.has_value()); }

  // Unlike multipliers, so that taking one for the other shows.
  static std::string ParametersOf(const SuiteLight& light) {
    return light.parameters + "\"float diffuse\" 0.5 \"float specular\" 2 ";
  }

  LightBuildContext BuildContext(const SuiteLight& light) {
    LightBuildContext build;
    build.placement = turned_;
    build.transform = placed_;
    build.textures = &textures_;
    build.diagnostics = &diagnostics_;
    if (light.shape) build.shape = &*light.shape;
    return build;
  }
  std::shared_ptr<const Light> Make(const SuiteLight& light, const std::string& more = "") {
    const ParameterList parameters = MergeParameters(ParseFor(light, ParametersOf(light)), ParseFor(light, more));
    return MakeLight(TypeOf(light), parameters, BuildContext(light));
  }
  SuiteSubject SubjectOf(const std::string& name, const Light& light) const {
    SuiteSubject subject;
    subject.light = &light;
    subject.context.transform = &placed_;
    subject.context.scene = {placed_.toRender.translation, 3};
    subject.context.bidirectional = true;
    subject.diffuseMultiplier = 0.5;
    subject.specularMultiplier = 2;
    subject.powerError = powerError_;
    subject.name = name;
    return subject;
  }

  static Properties Failed(const std::vector<SuiteResult>& results) {
    Properties failed;
    for (const SuiteResult& result : results) {
      if (!result.passed) failed.insert(result.property);
    }
    return failed;
  }
  // Description of the last failures.
  static std::string& Explained() {
    static std::string explained;
    return explained;
  }
  // All of `named` failed, and nothing but them and those that may `follow`.
  static void ExpectNamed(const Properties& failed, const Properties& named, const Properties& follow,
                          const std::string& what) {
    for (const std::string& property : named)
      EXPECT_TRUE(failed.count(property)) << what << " passes " << property << Explained();
    for (const std::string& property : failed) {
      EXPECT_TRUE(named.count(property) || follow.count(property)) << what << " fails " << property << Explained();
    }
  }

  // The properties that fail for the light of that name as changed by `change`. Slow checks (strata, fine directions)
  // run only if single parts are requested.
  using Change = std::function<std::unique_ptr<Light>(std::shared_ptr<const Light>)>;
  Properties Failures(const std::string& name, const Change& change, unsigned parts = kAllParts) {
    const SuiteLight& light = SuiteLights().at(name);
    const std::unique_ptr<Light> changed = change(Make(light));
    SuiteSubject subject = SubjectOf(name, *changed);
    std::unique_ptr<EmitterModel> model;
    if (light.shape) model = MakeEmitterModel(*light.shape, turned_);
    subject.model = model.get();
    subject.isThorough = parts != kAllParts;
    SuiteReport report;
    SuiteOptions options;
    options.parts = parts;
    CheckLight(subject, options, report);
    const std::vector<SuiteResult> results = report.Finish(1e-3);
    Explained().clear();
    for (const SuiteResult& result : results) {
      if (result.passed) continue;
      Explained() += "\n  fails " + result.property + result.caseName + ": " + result.words;
    }
    return Failed(results);
  }

  double powerError_ = 2.5e-3;  // 6e-4 finds a hundredth, in thrice the time
  Transform turned_ = Transform::Translate({0.2, -0.3, 0.4}) * Transform::Rotate(40, {1, 0.5, 0.2});
  LightTransform placed_{turned_.ToAffine(), turned_.Inverse().ToAffine()};
  Diagnostics diagnostics_{Diagnostics::Mode::Collect};
  TextureLibrary textures_{{}, Transform(), diagnostics_};
};

}  // namespace lampyr::test
