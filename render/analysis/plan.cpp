#include "render/analysis/plan.h"

#include <cmath>
#include <cstdio>

#include "integrators/walk/footprint.h"
#include "integrators/walk/next_event.h"
#include "render/settings/integrator_choice.h"

namespace lampyr {

namespace {

struct Facts {
  size_t lights = 0, deltas = 0, finite = 0, infinite = 0, patches = 0, tracing = 0;
  size_t smooth = 0;     // materials with a delta lobe other than passing straight through
  double arriving = 1;   // fraction of sampled light that is unoccluded where the camera looks
  bool hasSeen = false;  // light was sampled at something that the camera sees
  double indirect = 0;   // fraction of the light there that arrives over one other surface
  // Unevenness of that light over BSDF samples: the mean square over the square of the mean. 1: even.
  double concentration = 1;

  double IndirectNoise() const { return indirect * indirect * concentration; }
};

// Next-event estimation at a vertex, before and after occlusion.
struct SampledLight final : NextEventVisitor {
  double sent = 0, arrived = 0;

  float Weigh(const LightConnection& light) override {
    sent += static_cast<double>(light.value.Average());
    return 1;
  }
  void Arrived(const LightConnection& light, const Color&, const Color&) override {
    arrived += static_cast<double>(light.value.Average());
  }
};

// `block`: vertex block of sampler dimensions to draw from.
SampledLight SampleLightAt(const RenderScene& scene, const PathVertex& vertex, int block, Sampler& sampler) {
  SampledLight sampled;
  RenderCounts counts;
  const SampleContext context{scene, sampler, 0, counts};
  SampleDirectLight(context, {{}, false, {0, 0}}, vertex, block, Color(0.0f), sampled);
  return sampled;
}

// Measures direct light, and indirect light after one bounce, at what the camera sees.
void MeasureLight(const RenderScene& scene, const RenderSettings& settings, Facts& facts) {
  constexpr int across = 32, bounces = 4;
  double sent = 0, arrived = 0, indirect = 0, squares = 0;
  int rays = 0;
  SceneProbe probe(scene);
  probe.ForEachVisible(settings.width, settings.height, across, [&](const Ray&, SeenVertex& seen) {
    const SampledLight first = SampleLightAt(scene, seen.vertex, 40, probe.Numbers());
    sent += first.sent;
    arrived += first.arrived;
    for (int i = 0; i < bounces; ++i) {
      ++rays;
      PathState state;
      SeenVertex next;
      // Another block of dimensions for each bounce: other numbers.
      if (!probe.Bounce(seen, 20 + i, state, next)) continue;
      const double value = SampleLightAt(scene, next.vertex, 41 + i, probe.Numbers()).arrived *
                           static_cast<double>(state.Throughput().Average());
      indirect += value / bounces;
      squares += value * value;
    }
  });
  facts.hasSeen = sent > 0;
  if (sent > 0) facts.arriving = arrived / sent;
  if (!(indirect > 0)) return;
  facts.indirect = indirect / (indirect + arrived);
  const double sum = bounces * indirect;
  facts.concentration = squares * rays / (sum * sum);
}

Facts FactsOf(const RenderScene& scene, const RenderSettings& settings) {
  Facts facts;
  for (const PlacedLight& placed : scene.lighting->Lights()) {
    const LightKind kind = placed.light->Kind();
    ++facts.lights;
    facts.patches += static_cast<size_t>(placed.light->PatchCount());
    facts.deltas += IsDelta(kind) ? 1 : 0;
    facts.infinite += kind == LightKind::Infinite ? 1 : 0;
    facts.finite += kind == LightKind::Area ? 1 : 0;
    facts.tracing += placed.light->Settings().traceLightPaths ? 1 : 0;
  }
  for (const auto& material : scene.materials) facts.smooth += material && material->IsSmooth() ? 1 : 0;
  MeasureLight(scene, settings, facts);
  return facts;
}

std::string Count(size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string Percent(double part) {
  return std::to_string(std::lround(100 * part)) + " %";
}

// If less than this fraction of sampled light is unoccluded, most light is indirect, and light paths find it by
// themselves.
constexpr double kMostlyHidden = 0.25;
// Threshold of Facts::IndirectNoise, the squared relative noise of a sample of indirect light. Rooms with lamps on
// their ceilings have 0.1 to 0.5, the lampshade of scenes/lamp has 3.
constexpr double kNoisy = 1.5;

PlanDecision ChooseIntegrator(const Facts& facts) {
  if (facts.lights == 0) return {"integrator", "path", "nothing emits"};
  if (facts.tracing == 0) return {"integrator", "path", "no light traces light paths"};
  if (facts.smooth > 0 && facts.deltas > 0) {
    return {"integrator", "vcm",
            Count(facts.deltas, "light") + " without extent and " + Count(facts.smooth, "smooth material") +
                ": no camera path finds their caustics, and only photons show these in mirrors and through glass"};
  }
  if (facts.smooth > 0 && facts.finite > 0) {
    return {"integrator", "vcm",
            Count(facts.finite, "area light") + " and " + Count(facts.smooth, "smooth material") +
                ": camera paths find their caustics by chance, also in mirrors and through glass"};
  }
  if (facts.hasSeen && facts.arriving < kMostlyHidden && facts.deltas + facts.finite > 0) {
    return {"integrator", "bdpt",
            Percent(facts.arriving) + " of the light that is sampled arrives unoccluded: most light is indirect"};
  }
  if (facts.IndirectNoise() > kNoisy && facts.deltas + facts.finite > 0) {
    return {"integrator", "bdpt",
            Percent(facts.indirect) +
                " of the light is indirect, most of it from small areas that camera paths find by chance"};
  }
  if (facts.smooth > 0)
    return {"integrator", "path", "smooth surfaces under lights at infinity, which camera paths find as they escape"};
  return {"integrator", "path",
          "nothing is smooth and " + Percent(facts.arriving) + " of the sampled direct light arrives unoccluded"};
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

PlanDecision ChooseMerging(const Facts& facts, const std::optional<PhotonSettings>& photons, bool hasOwnRadius) {
  if (!photons) {
    return {"photons", "none",
            facts.smooth == 0 ? "nothing is smooth: other techniques find all light" : "the integrator has none"};
  }
  if (hasOwnRadius) return {"photons", "gathered", "with the radius that is set"};
  if (photons->radius == 0) return {"photons", "gathered", "initial radius: two pixel footprints"};
  char text[96];
  std::snprintf(text, sizeof text, "initial radius %.3g, the footprint of a pixel", photons->radius);
  return {"photons", "gathered", text};
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
  if (!settings.values.IsOn("guide-photons")) return {"guiding", "off", "--no-guide-photons"};
  if (!photons.guided) return {"guiding", "off", "nothing is smooth: photons carry little of the light"};
  return {"guiding", "if helpful", "learned from the first samples"};
}

PlanDecision ChooseLayers(const RenderScene& scene) {
  const std::vector<std::string>& layers = scene.lighting->Groups().Layers();
  if (layers.empty()) return {"light groups", "none", "no light names one: the image has no layers"};
  constexpr size_t most = 8;  // names that are listed
  std::string names;
  for (size_t i = 0; i < std::min(most, layers.size()); ++i) names += (i > 0 ? ", " : "") + layers[i];
  if (layers.size() > most) names += ", …";
  return {"light groups", Count(layers.size(), "layer"), names};
}

}  // namespace

PlanDecision ChooseIntegrator(const RenderScene& scene, const RenderSettings& settings) {
  return ChooseIntegrator(FactsOf(scene, settings));
}

ScenePlan PlanFor(const RenderScene& scene, const RenderSettings& settings) {
  const Facts facts = FactsOf(scene, settings);
  ScenePlan plan;
  const PlanDecision chosen = ChooseIntegrator(facts);
  plan.integrator = chosen.choice;
  if (settings.integrator.empty() || settings.integrator == "auto") {
    plan.decisions.push_back(chosen);
  } else {
    plan.decisions.push_back({"integrator", settings.integrator, "as set; \"auto\" would choose " + chosen.choice});
    if (settings.integrator != chosen.choice) plan.decisions.back().reason += ": " + chosen.reason;
  }
  RenderSettings chosenSettings = settings;
  chosenSettings.integrator = plan.decisions.front().choice;
  const std::optional<PhotonSettings> photons = MakeIntegrator(scene, chosenSettings)->Photons();
  plan.decisions.push_back(ChooseSelection(facts, settings));
  plan.decisions.push_back(ChooseLinking(*scene.lighting));
  plan.decisions.push_back(ChooseFilters(*scene.lighting));
  plan.decisions.push_back(ChooseMerging(facts, photons, settings.values.Number("radius") > 0));
  if (photons) plan.decisions.push_back(ChooseGuiding(settings, *photons));
  plan.decisions.push_back(ChooseLayers(scene));
  plan.decisions.push_back(scene.hasMotion ? PlanDecision{"motion", "on", "something moves while the shutter is open"}
                                           : PlanDecision{"motion", "off", "nothing moves: rays have no time"});
  plan.decisions.push_back(
      scene.camera->HasPinhole() ? PlanDecision{"lens", "pinhole", "the camera has no lens"}
      : scene.camera->ConnectsLightPaths()
          ? PlanDecision{"lens", "sampled", "the camera has a lens"}
          : PlanDecision{"lens", "traced", "the camera has a lens of elements: light paths are not connected to it"});
  plan.decisions.push_back(
      settings.LearnsLights()
          ? PlanDecision{"learning", "on", "--learn-lights"}
          : PlanDecision{"learning", "off", "useful where nearby lights are occluded: --learn-lights"});
  return plan;
}

}  // namespace lampyr
