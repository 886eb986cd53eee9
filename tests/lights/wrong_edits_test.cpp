// Lights that, once edited, have kept a part of what they were: the suite fails them by "edit".
#include "lights/light_base.h"
#include "mixed_light.h"
#include "suite/checks.h"
#include "suite_fixture.h"

namespace lampyr {
namespace {

using namespace test;

// Sound until it is edited: from then on, `part` is that of the light as it was before.
class StaleLight final : public ForwardingLight {
 public:
  StaleLight(std::shared_ptr<const Light> light, std::optional<Part> part)
      : ForwardingLight(light), light_(std::move(light)), part_(part) {}

  std::unique_ptr<Light> Edit(const ParameterList& changes, const LightBuildContext& build) const override {
    std::shared_ptr<const Light> edited = light_->Edit(changes, build);
    if (!part_) return std::make_unique<StaleLight>(std::move(edited), part_);
    return std::make_unique<MixedLight>(std::move(edited), light_, *part_);
  }

 private:
  std::shared_ptr<const Light> light_;
  std::optional<Part> part_;
};

LightType Stale(LightType type, std::optional<Part> part) {
  type.create = [create = type.create, part](const ParameterList& parameters, const LightBuildContext& build) {
    return std::make_unique<StaleLight>(create(parameters, build), part);
  };
  return type;
}

class WrongEdits : public SuiteTest {
 protected:
  // True if a light of that name passes the suite when edited by `changes`.
  bool Passes(const std::string& name, const std::string& changes, std::optional<Part> part) {
    const SuiteLight& light = SuiteLights().at(name);
    const LightType type = Stale(TypeOf(light), part);
    const LightBuildContext build = BuildContext(light);
    const ParameterList parameters = ParseFor(light, ParametersOf(light));
    const std::unique_ptr<Light> made = MakeLight(type, parameters, build);
    SuiteReport report;
    suite::CheckEdit(SubjectOf(name, *made), {&type, &parameters, &build, {ParseFor(light, changes)}}, report);
    const Properties failed = Failed(report.Finish(1e-3));
    EXPECT_TRUE(failed.empty() || failed == Properties{"edit"}) << name;
    return failed.empty();
  }
  void ExpectCaught(const Lights& lights, const std::string& changes, const std::vector<Part>& parts) {
    for (const std::string& name : lights) {
      EXPECT_TRUE(Passes(name, changes, {})) << name;
      for (const Part part : parts) EXPECT_FALSE(Passes(name, changes, part)) << name << " with old part " << int(part);
    }
  }
};

TEST_F(WrongEdits, KeepingTheBrightnessIsFound) {
  const std::string brighter = "\"float intensity\" 2.5";
  const std::vector<Part> all = {Part::Everything, Part::Samples,  Part::Photons, Part::PhotonColor,
                                 Part::Power,      Part::Estimate, Part::Segment};
  ExpectCaught({"parallel", "spot"}, brighter, all);
  std::vector<Part> found = all;
  found.insert(found.end(), {Part::Evaluations, Part::Camera});
  ExpectCaught({"square", "ball", "rect", "disk", "sun", "even sky", "dome", "portal", "window"}, brighter, found);
  ExpectCaught({"square", "ball", "rect", "disk", "spot"}, brighter, {Part::Bounds});
}

TEST_F(WrongEdits, KeepingATableIsFound) {
  const std::vector<Part> tables = {Part::Draws, Part::DirectPdf, Part::PhotonDraws, Part::PhotonPdf};
  ExpectCaught({"dome", "portal of an image"}, "\"string texture:file\" \"suite-latlong-2.exr\"", tables);
  ExpectCaught({"window"}, "\"string filename\" \"suite-square-2.exr\"", tables);
  ExpectCaught({"goniometric", "projection"}, "\"string filename\" \"suite-square-2.exr\"",
               {Part::PhotonDraws, Part::PhotonPdf, Part::Power});
  ExpectCaught({"sun"}, "\"float angle\" 20", tables);
  ExpectCaught({"spot"}, "\"float coneangle\" 20", {Part::PhotonDraws, Part::PhotonPdf, Part::Bounds});
}

TEST_F(WrongEdits, KeepingTheFormIsFound) {
  const std::vector<Part> parts = {Part::Surface, Part::Bounds, Part::Samples, Part::Power, Part::Photons};
  ExpectCaught({"rect"}, "\"float width\" 0.7", parts);
  ExpectCaught({"disk", "sphere", "cylinder"}, "\"float radius\" 0.7", parts);
}

TEST_F(WrongEdits, KeepingTheSettingsIsFound) {
  ExpectCaught({"square", "rect", "spot", "parallel", "dome", "portal"}, "\"string lightGroup\" \"other\"",
               {Part::Settings});
}

// By the whole suite: it edits each type by itself.
TEST_F(WrongEdits, AWholeTypeFailsByThatAlone) {
  SuiteOptions options;
  options.samples = options.photons = 1000;
  for (const bool isStale : {false, true}) {
    LightType type = Stale(*FindLightType("spot", false), isStale ? std::optional(Part::Power) : std::nullopt);
    type.samples = {"\"rgb I\" [ 3 2 1 ]"};
    const Properties failed = Failed(RunPdfSuite({type}, Folder(), options));
    EXPECT_EQ(failed, isStale ? Properties{"edit"} : Properties{});
  }
}

}  // namespace
}  // namespace lampyr
