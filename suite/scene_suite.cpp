#include "suite/scene_suite.h"

#include <cstdio>

#include "lights/direction_map.h"
#include "suite/checks.h"
#include "suite/suite_shapes.h"

namespace lampyr {

namespace {

// Largest number of lights that are checked thoroughly, at a second or two each. For more lights, thorough checks are
// left to the suite on their types.
constexpr size_t kThoroughLights = 16;

// One light at one time of the shutter.
void CheckPlaced(const PlacedLight& placed, const SceneLight& scene, const BoundingSphere& sphere, float time,
                 bool isThorough, const SuiteOptions& options, SuiteReport& report) {
  const LightTransform transform = placed.motion ? placed.At(time) : placed.transform;
  std::unique_ptr<EmitterModel> model;
  if (scene.shape) model = MakeEmitterModel(*scene.shape, suite::ToTransform(transform.toRender));
  SuiteSubject subject;
  subject.light = scene.withoutCutOuts ? scene.withoutCutOuts.get() : placed.light.get();
  subject.context.transform = &transform;
  subject.context.scene = sphere;
  subject.context.time = time;
  subject.context.bidirectional = true;
  subject.model = model.get();
  subject.isThorough = isThorough;
  subject.diffuseMultiplier = scene.parameters.GetFloat("diffuse", 1);
  subject.specularMultiplier = scene.parameters.GetFloat("specular", 1);
  const bool keepsAngles = IsSimilarity(transform.toRender.linear);
  subject.isPowerExact = !IsUneven(scene.parameters) && (subject.light->Kind() == LightKind::Area || keepsAngles);
  subject.name = scene.name;
  char when[32];
  std::snprintf(when, sizeof(when), "time %g", static_cast<double>(time));
  subject.caseName = placed.motion ? when : "as placed";
  CheckLight(subject, options, report);
}

// Receivers throughout the scene's sphere, the first at its centre; every second one in a medium.
std::vector<Receiver> SceneReceivers(const BoundingSphere& sphere, Rng& rng) {
  std::vector<Receiver> receivers(64);
  for (size_t i = 0; i < receivers.size(); ++i) {
    const float reach = i == 0 ? 0.0f : sphere.radius * std::cbrt(rng.NextFloat());
    receivers[i].position = sphere.center + reach * Vector3(suite::RandomDirection(rng));
    const Normal3 normal(suite::RandomDirection(rng));
    if (i % 2 == 0) receivers[i].normal = normal;
  }
  return receivers;
}

void CheckSelection(const LightingServices& services, const SuiteOptions& options, SuiteReport& report) {
  Rng rng(options.seed);
  double worst = 0, impossible = 0;
  for (const Receiver& receiver : SceneReceivers(services.SceneSphere(), rng)) {
    double sum = 0;
    for (uint32_t i = 0; i < services.Lights().size(); ++i) {
      const PlacedLight& placed = services.Lights()[i];
      const auto probability = static_cast<double>(services.SelectionProbability(receiver, i, kAnyPatch).value);
      sum += probability;
      if (probability > 0) continue;
      LightContext context;
      context.transform = &placed.transform;
      context.scene = services.SceneSphere();
      for (int k = 0; k < 16; ++k) {
        context.u = rng.NextPoint2();
        if (placed.light->GenerateSamples(context, receiver.position)) impossible = 1;
      }
    }
    LightChoices choices;
    services.SelectLights(receiver, 0.5f, choices);
    const double error = std::abs(sum - choices.count);
    if (!(error <= worst)) worst = error;  // not a number, too
  }
  report.AddError("all lights", "selection", "probabilities sum to the number of choices", worst, 1e-4);
  report.AddError("all lights", "selection", "no light that contributes is impossible", impossible, 0.5);
}

}  // namespace

bool IsUneven(const ParameterList& parameters) {
  for (const Parameter& parameter : parameters.All()) {
    if (parameter.name.starts_with("shaping:")) return true;
    if (parameter.name.ends_with(":file") || parameter.name == "filename") return true;
  }
  return false;
}

std::vector<SuiteResult> RunPdfSuiteOnScene(const LightingServices& services, const std::vector<SceneLight>& lights,
                                            const SuiteOptions& options) {
  SuiteReport all = suite::RunCases(lights.size(), options, [&](size_t index, SuiteReport& report) {
    const PlacedLight& placed = services.Lights()[index];
    for (const float time : {0.0f, 0.5f, 1.0f}) {
      if (time > 0 && !placed.motion) break;
      const bool isThorough = time == 0 && lights.size() <= kThoroughLights;
      const std::string when = placed.motion ? "time " + std::to_string(time) : "as placed";
      suite::WithoutExceptions(lights[index].name, when, report, [&] {
        CheckPlaced(placed, lights[index], services.SceneSphere(), time, isThorough, options, report);
      });
    }
  });
  if (!lights.empty()) CheckSelection(services, options, all);
  return all.Finish(options.familyWise);
}

}  // namespace lampyr
