#include "render/analysis/plan.h"

#include <algorithm>
#include <cstdio>

#include "base/parallel.h"
#include "render/settings/integrator_choice.h"

namespace lampyr {

namespace {

struct Facts {
  size_t lights = 0, infinite = 0, patches = 0, tracing = 0;
  size_t smooth = 0;  // materials with a delta lobe other than passing straight through
};

Facts FactsOf(const RenderScene& scene) {
  Facts facts;
  for (const PlacedLight& placed : scene.lighting->Lights()) {
    const LightKind kind = placed.light->Kind();
    ++facts.lights;
    facts.patches += static_cast<size_t>(placed.light->PatchCount());
    facts.infinite += kind == LightKind::Infinite ? 1 : 0;
    facts.tracing += placed.light->Settings().traceLightPaths ? 1 : 0;
  }
  for (const auto& material : scene.materials) facts.smooth += material && material->IsSmooth() ? 1 : 0;
  return facts;
}

std::string Count(size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

// A number with two digits.
std::string Short(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

// `pilot`: receives its estimates, if one was needed.
IntegratorChoice ChooseIntegrator(const RenderScene& scene, const RenderSettings& settings, const Facts& facts,
                                  int threads, RenderPilot& pilot) {
  const auto once = std::make_shared<const TechniqueCounts>();
  if (facts.lights == 0) {
    const bool mediaGlow =
        std::any_of(scene.media.begin(), scene.media.end(), [](const auto& medium) { return medium->IsEmissive(); });
    return {{"integrator", "path", mediaGlow ? "there is no light but that of media" : "nothing emits"}, once};
  }
  if (facts.tracing == 0) return {{"integrator", "path", "no light traces light paths"}, once};
  pilot = RunPilot(scene, settings, threads);
  const PilotCandidate* best = pilot.Best();
  if (!best) {
    const bool foundLight = !pilot.candidates.empty();
    return {{"integrator", "vcm",
             std::string(foundLight ? "a pilot found light that no other" : "a pilot found no light: vcm") +
                 (foundLight ? " integrator finds" : " has the most techniques to find it by")},
            once};
  }
  std::string reason = "least error in equal time, as a pilot estimates it:";
  const char* separator = " ";
  for (const PilotCandidate& other : pilot.candidates) {
    // Only integrators as the command line names them: one light path per camera path, merging everywhere or nowhere.
    if (&other == best || &other != pilot.Find(other.integrator)) continue;
    const double ratio = other.ErrorTimesCost() / best->ErrorTimesCost();
    reason += separator + other.integrator +
              (other.missing > kNegligibleLight ? " misses " + Short(100 * other.missing) + " % of the light"
                                                : " has " + Short(ratio) + " × its relMSE");
    separator = ", ";
  }
  const std::string described = best->Describe();
  if (described != best->integrator) reason += "; with" + described.substr(best->integrator.size() + 1);
  const PilotCandidate* named = pilot.Find(best->integrator);
  return {{"integrator", best->integrator, reason},
          std::make_shared<TechniqueCounts>(best->counts),
          named ? named->ErrorTimesCost() / best->ErrorTimesCost() : 1.0};
}

PlanDecision ChooseSelection(const Facts& facts, const RenderSettings& settings) {
  const size_t infinite = facts.infinite, others = facts.lights - infinite;
  if (facts.lights <= 1 && facts.patches <= 2)
    return {"light selection", "none", facts.lights == 0 ? "there is no light" : "there is a single light"};
  const std::string name = NameOf(settings.LightSampler());
  std::string of = Count(others, "light");
  if (facts.patches > facts.lights) of += " of " + std::to_string(facts.patches - infinite) + " patches";
  if (infinite > 0) of += ", " + std::to_string(infinite) + " at infinity beside";
  return {"light selection", name, of};
}

PlanDecision ChooseMerging(const Facts& facts, const std::string& integrator,
                           const std::optional<PhotonSettings>& photons, bool hasOwnRadius) {
  if (!photons) {
    return {"photons", "none",
            facts.smooth == 0 ? "nothing is smooth: other techniques find all light" : "the integrator has none"};
  }
  if (hasOwnRadius) return {"photons", "gathered", "with the radius that is set"};
  return {"photons", "gathered",
          integrator == "sppm" ? "initial radius: two pixel footprints" : "initial radius: the footprint of a pixel"};
}

PlanDecision ChooseFilters(const LightingServices& lighting) {
  size_t filtered = 0;
  for (const PlacedLight& placed : lighting.Lights()) filtered += placed.filter >= 0 ? 1 : 0;
  if (filtered == 0) return {"light filters", "off", "no light has one"};
  return {"light filters", "on", Count(filtered, "light") + " with a filter, applied to every connection"};
}

PlanDecision ChooseLinking(const LightingServices& lighting) {
  if (!lighting.Linking().Excludes()) return {"light linking", "off", "all lights shine on all surfaces"};
  return {"light linking", "on",
          std::to_string(lighting.Linking().Sets().lights.size()) + " sets of lights, each with a selector of its own"};
}

PlanDecision ChooseGuiding(const RenderSettings& settings, const PhotonSettings& photons) {
  if (!settings.values.IsOn("guide-photons")) return {"photon guiding", "off", "--no-guide-photons"};
  if (!photons.guided) return {"photon guiding", "off", "nothing is smooth: photons carry little of the light"};
  return {"photon guiding", "if helpful", "learned from the first samples"};
}

PlanDecision ChoosePathGuiding(const RenderSettings& settings, const Integrator& integrator) {
  if (!integrator.FollowsCameraPaths())
    return {"path guiding", "off", "camera paths end where light is scattered widely"};
  if (!settings.GuidesPaths()) return {"path guiding", "off", "--no-guide-paths"};
  if (settings.AlwaysGuidesPaths()) return {"path guiding", "on", "--guide-always"};
  return {"path guiding", "if helpful", "learned from the first samples, and tested on those that follow"};
}

PlanDecision ChooseSpectral(const RenderScene& scene, const RenderSettings& settings) {
  if (settings.bands) {
    char bands[100];
    std::snprintf(bands, sizeof bands, "%d bands of the spectrum from %g to %g nm are written", settings.bands->count,
                  settings.bands->from, settings.bands->to);
    return {"wavelengths", "on", bands};
  }
  if (settings.spectral)
    return {"wavelengths", *settings.spectral ? "on" : "off", *settings.spectral ? "--spectral" : "--no-spectral"};
  if (!scene.isSpectral) return {"wavelengths", "off", "nothing disperses light: red, green and blue suffice"};
  const auto dispersing = std::count_if(scene.materials.begin(), scene.materials.end(),
                                        [](const auto& material) { return material && material->Disperses(); });
  return {"wavelengths", "on",
          Count(static_cast<size_t>(dispersing), "material") + " with an index that depends on the wavelength"};
}

// The first of some names.
std::string FirstOf(const std::vector<std::string>& names) {
  constexpr size_t most = 8;
  std::string listed;
  for (size_t i = 0; i < std::min(most, names.size()); ++i) listed += (i > 0 ? ", " : "") + names[i];
  return names.size() > most ? listed + ", …" : listed;
}

PlanDecision ChooseLearning(const RenderScene& scene, const RenderSettings& settings, const Integrator& integrator) {
  if (!settings.LearnsLights()) return {"learning", "off", "--no-learn-lights"};
  if (integrator.Paths() == TracedPaths::Light) return {"learning", "none", "the integrator connects to no lights"};
  if (!scene.lighting->LearnsSelection()) return {"learning", "none", "no tree of lights is chosen from"};
  if (settings.AlwaysLearnsLights()) return {"learning", "on", "--learn-always"};
  return {"learning", "if helpful", "which lights are occluded where is learned, and tested"};
}

PlanDecision ChooseGroups(const RenderScene& scene) {
  const std::vector<std::string>& layers = scene.lighting->Groups().Layers();
  if (layers.empty()) return {"light groups", "none", "no light names one"};
  return {"light groups", Count(layers.size(), "layer"), FirstOf(layers)};
}

PlanDecision ChooseLayers(const RenderScene& scene) {
  std::vector<std::string> names;
  for (const OutputLayer& layer : scene.outputs->Layers()) {
    if (!layer.text.empty()) names.push_back(layer.name);
  }
  if (names.empty()) return {"layers", "none", "none is asked for: \"string layers\" of the Film, or render --layer"};
  return {"layers", Count(names.size(), "layer"), FirstOf(names)};
}

}  // namespace

void IntegratorChoice::Apply(RenderSettings& settings) const {
  settings.integrator = decision.choice;
  settings.counts = counts;
}

IntegratorChoice ChooseIntegrator(const RenderScene& scene, const RenderSettings& settings, int threads) {
  RenderPilot pilot;
  return ChooseIntegrator(scene, settings, FactsOf(scene), threads > 0 ? threads : HardwareThreads(), pilot);
}

ScenePlan PlanFor(const RenderScene& scene, const RenderSettings& settings, int threads) {
  const Facts facts = FactsOf(scene);
  ScenePlan plan;
  const PlanDecision chosen =
      ChooseIntegrator(scene, settings, facts, threads > 0 ? threads : HardwareThreads(), plan.pilot).decision;
  plan.integrator = chosen.choice;
  if (settings.integrator.empty() || settings.integrator == "auto") {
    plan.decisions.push_back(chosen);
  } else {
    plan.decisions.push_back({"integrator", settings.integrator, "as set; \"auto\" would choose " + chosen.choice});
    if (settings.integrator != chosen.choice) plan.decisions.back().reason += ": " + chosen.reason;
  }
  RenderSettings chosenSettings = settings;
  chosenSettings.integrator = plan.decisions.front().choice;
  const std::unique_ptr<Integrator> integrator = MakeIntegrator(scene, chosenSettings);
  const std::optional<PhotonSettings> photons = integrator->Photons();
  plan.decisions.push_back(ChooseSelection(facts, settings));
  plan.decisions.push_back(ChooseLinking(*scene.lighting));
  plan.decisions.push_back(ChooseFilters(*scene.lighting));
  plan.decisions.push_back(
      ChooseMerging(facts, chosenSettings.integrator, photons, settings.values.Number("radius") > 0));
  if (photons) plan.decisions.push_back(ChooseGuiding(settings, *photons));
  plan.decisions.push_back(ChoosePathGuiding(settings, *integrator));
  plan.decisions.push_back(ChooseSpectral(scene, settings));
  plan.decisions.push_back(ChooseGroups(scene));
  plan.decisions.push_back(ChooseLayers(scene));
  plan.decisions.push_back(scene.hasMotion ? PlanDecision{"motion", "on", "something moves while the shutter is open"}
                                           : PlanDecision{"motion", "off", "nothing moves: rays have no time"});
  plan.decisions.push_back(
      scene.camera->HasPinhole() ? PlanDecision{"lens", "pinhole", "the camera has no lens"}
      : scene.camera->ConnectsLightPaths()
          ? PlanDecision{"lens", "sampled", "the camera has a lens"}
          : PlanDecision{"lens", "traced", "the camera has a lens of elements: light paths are not connected to it"});
  plan.decisions.push_back(ChooseLearning(scene, settings, *integrator));
  return plan;
}

}  // namespace lampyr
