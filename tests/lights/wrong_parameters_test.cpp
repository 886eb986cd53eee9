// Types that do not do what their parameters say, or forget them when they are edited: whatever the author's sample
// blocks set.
#include "forwarding_light.h"
#include "lights/light_base.h"
#include "suite_fixture.h"

namespace lampyr {
namespace {

using namespace test;

ParameterList Without(const ParameterList& parameters, const std::string& name) {
  std::vector<Parameter> kept;
  for (const Parameter& parameter : parameters.All()) {
    if (parameter.name != name) kept.push_back(parameter);
  }
  return {parameters.Where(), parameters.Owner(), kept};
}

ParameterList Swapped(const ParameterList& parameters, const std::string& a, const std::string& b) {
  std::vector<Parameter> swapped = parameters.All();
  for (Parameter& parameter : swapped) {
    if (parameter.name == a || parameter.name == b) parameter.name = parameter.name == a ? b : a;
  }
  return {parameters.Where(), parameters.Owner(), swapped};
}

// Editing does not see changes of one parameter.
class ForgetfulLight final : public ForwardingLight {
 public:
  ForgetfulLight(std::shared_ptr<const Light> light, std::string name)
      : ForwardingLight(std::move(light)), name_(std::move(name)) {}
  std::unique_ptr<Light> Edit(const ParameterList& changes, const LightBuildContext& build) const override {
    return std::make_unique<ForgetfulLight>(Sound().Edit(Without(changes, name_), build), name_);
  }

 private:
  std::string name_;
};

// Edited a second time, it is what it was in the beginning but for that.
class ForgetsFirstEdit final : public ForwardingLight {
 public:
  ForgetsFirstEdit(std::shared_ptr<const Light> light, std::shared_ptr<const Light> first)
      : ForwardingLight(std::move(light)), first_(std::move(first)) {}
  std::unique_ptr<Light> Edit(const ParameterList& changes, const LightBuildContext& build) const override {
    return std::make_unique<ForgetsFirstEdit>(first_->Edit(changes, build), first_);
  }

 private:
  std::shared_ptr<const Light> first_;
};

class WrongParameters : public SuiteTest {
 protected:
  // One sample block that sets next to nothing.
  static LightType Plain(const std::string& name, bool isAreaLight) {
    LightType type = *FindLightType(name, isAreaLight);
    type.samples = {""};
    if (name == "goniometric" || name == "projection") type.samples = {"\"string filename\" \"suite-square.exr\""};
    return type;
  }
  using Read = std::function<ParameterList(const ParameterList&)>;
  static LightType Reading(LightType type, const Read& read) {
    type.create = [create = type.create, read](const ParameterList& parameters, const LightBuildContext& build) {
      // Like its own Edit: by the factory of this type.
      return create(read(parameters), build);
    };
    return type;
  }
  Properties FailuresOf(const LightType& type) {
    SuiteOptions options;
    options.parts = kParameterPart;
    return Failed(RunPdfSuite({type}, Folder(), options));
  }
  static std::vector<LightType> Types() {
    return {Plain("rect", false), Plain("point", false), Plain("distant", false), Plain("infinite", false)};
  }
};

TEST_F(WrongParameters, SoundTypesPass) {
  for (const char* name : {"rect", "disk", "sphere", "cylinder", "point", "spot", "goniometric", "projection",
                           "distant", "infinite", "dome", "portal"}) {
    EXPECT_EQ(FailuresOf(Plain(name, false)), Properties{}) << name;
  }
}

// A type may be for some shapes alone, but not for none.
TEST_F(WrongParameters, MayBeRefusedOnSomeShapes) {
  for (const bool acceptsSpheres : {true, false}) {
    LightType type = Plain("diffuse", true);
    type.create = [create = type.create, acceptsSpheres](const ParameterList& parameters,
                                                         const LightBuildContext& build) {
      const Quadric* quadric = std::get_if<Quadric>(build.shape);
      if (!acceptsSpheres || !quadric || quadric->kind != Quadric::Kind::Sphere)
        throw Error(parameters.Where(), "needs a sphere");
      return create(parameters, build);
    };
    EXPECT_EQ(FailuresOf(type), acceptsSpheres ? Properties{} : Properties{"shapes"});
  }
}

class ThrowingLight final : public ForwardingLight {
 public:
  using ForwardingLight::ForwardingLight;
  std::optional<EmissionSample> GenerateEmission(const LightContext&) const override {
    throw std::runtime_error("the bulb broke");
  }
};

// A light that throws is named with its case, and does not keep others from being checked.
TEST_F(WrongParameters, ExceptionsAreOfACase) {
  LightType type = Plain("point", false);
  type.create = [create = type.create](const ParameterList& parameters, const LightBuildContext& build) {
    return std::make_unique<ThrowingLight>(create(parameters, build));
  };
  EXPECT_TRUE(FailuresOf(type).count("exceptions"));
}

TEST_F(WrongParameters, ThatAreIgnoredAreFound) {
  for (const LightType& type : Types()) {
    for (const char* name : {"intensity", "exposure", "color", "colorTemperature", "diffuse", "specular",
                             "importanceMultiplier", "lightGroup"}) {
      const auto failed =
          FailuresOf(Reading(type, [name](const ParameterList& parameters) { return Without(parameters, name); }));
      EXPECT_TRUE(failed.count("parameters")) << type.name << " ignores " << name;
    }
  }
  // Visibility to the camera: deltas are never visible, but have the setting nevertheless.
  for (const LightType& type : Types()) {
    const auto failed =
        FailuresOf(Reading(type, [](const ParameterList& parameters) { return Without(parameters, "cameraVisible"); }));
    EXPECT_TRUE(failed.count("parameters")) << type.name << " ignores cameraVisible";
  }
  for (const LightType& type : {Plain("rect", false), Plain("sphere", false)}) {
    const auto failed =
        FailuresOf(Reading(type, [](const ParameterList& parameters) { return Without(parameters, "normalize"); }));
    EXPECT_TRUE(failed.count("parameters")) << type.name << " ignores normalize";
  }
}

TEST_F(WrongParameters, ThatAreSwappedAreFound) {
  for (const LightType& type : Types()) {
    const auto failed = FailuresOf(
        Reading(type, [](const ParameterList& parameters) { return Swapped(parameters, "diffuse", "specular"); }));
    EXPECT_TRUE(failed.count("parameters")) << type.name;
  }
}

TEST_F(WrongParameters, ThatEditingKeepsAreFound) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> kept = {
      {"rect", {"width", "twoSided", "exposure", "diffuse", "cameraVisible", "texture:file", "shaping:focus"}},
      {"sphere", {"radius", "normalize", "colorTemperature"}},
      {"spot", {"coneangle", "from", "power", "shaping:ies:angleScale", "name"}},
      {"distant", {"angle", "to", "illuminance", "fixedSampleCount"}},
      {"dome", {"texture:file", "lightGroup", "specular"}},
  };
  for (const auto& [name, parameters] : kept) {
    for (const std::string& parameter : parameters) {
      LightType type = Plain(name, false);
      type.create = [create = type.create, parameter = parameter](const ParameterList& given,
                                                                  const LightBuildContext& build) {
        return std::make_unique<ForgetfulLight>(create(given, build), parameter);
      };
      EXPECT_EQ(FailuresOf(type), Properties{"edit"}) << name << " keeps its " << parameter;
    }
  }
}

TEST_F(WrongParameters, ThatAnEarlierEditSetAreNotForgotten) {
  for (LightType type : Types()) {
    type.create = [create = type.create](const ParameterList& given, const LightBuildContext& build) {
      const std::shared_ptr<const Light> light = create(given, build);
      return std::make_unique<ForgetsFirstEdit>(light, light);
    };
    EXPECT_EQ(FailuresOf(type), Properties{"edit"}) << type.name;
  }
}

}  // namespace
}  // namespace lampyr
