#include "app/plan.h"

#include <cmath>
#include <cstdio>

#include "app/integrator_choice.h"
#include "integrators/common/footprint.h"
#include "sampling/rng.h"

namespace lampyr {

namespace {

struct Facts {
  size_t lights = 0, deltas = 0, finite = 0, infinite = 0, patches = 0, tracing = 0;
  size_t smooth = 0;     // materials with a delta that is more than a way through
  double arriving = 1;   // the part of sampled light that arrives where the camera looks
  bool hasSeen = false;  // the camera sees something that light could be sampled at
};

// Of what next-event estimation would bring to what the camera sees, the part that nothing is in the way of.
void MeasureDirectLight(const RenderScene& scene, const RenderSettings& settings, Facts& facts) {
  double sent = 0, arrived = 0;
  VisitSeen(scene, settings.width, settings.height, 32, [&](const Ray&, PathVertex& vertex, double, Sampler& sampler) {
    LightChoices lights;
    scene.lighting->SelectLights(vertex.receiver, sampler.Get1D(), lights);
    const Point2 u = sampler.Get2D();
    for (int k = 0; k < lights.count; ++k) {
      const DirectSample direct =
          scene.lighting->GenerateSamples(vertex.receiver, lights.of[k], MovedPoint(u, k), 0, false);
      if (!direct) continue;
      const LightSample& light = *direct.sample;
      const BsdfEvaluation f = vertex.bsdf.Evaluate(vertex.toPrevious, light.direction, TransportMode::Radiance);
      const Color value = f.diffuse * light.diffuse + f.specular * light.specular;
      const double weight =
          static_cast<double>(value.Average() * AbsDot(light.direction, vertex.bsdf.ShadingFrame().z) /
                              (direct.selection * light.pdfDirect).value);
      if (!(weight > 0)) continue;
      facts.hasSeen = true;
      sent += weight;
      if (!scene.lighting->Transmission(vertex.point, direct, 0).IsBlack()) arrived += weight;
    }
  });
  if (sent > 0) facts.arriving = arrived / sent;
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
  MeasureDirectLight(scene, settings, facts);
  return facts;
}

std::string Count(size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string Percent(double part) {
  return std::to_string(std::lround(100 * part)) + " %";
}

// Light that arrives at less than this part is mostly found at second hand, where light paths go by themselves.
constexpr double kMostlyHidden = 0.25;

PlanDecision ChooseIntegrator(const Facts& facts) {
  if (facts.lights == 0) return {"integrator", "path", "nothing emits"};
  if (facts.tracing == 0) return {"integrator", "path", "no light traces light paths"};
  if (facts.smooth > 0 && facts.deltas > 0) {
    return {
        "integrator", "vcm",
        Count(facts.deltas, "light") + " without extent and " + Count(facts.smooth, "smooth material") +
            ": caustics that no path from the camera finds, and that only photons show in mirrors and through glass"};
  }
  if (facts.smooth > 0 && facts.finite > 0) {
    return {"integrator", "vcm",
            Count(facts.finite, "area light") + " and " + Count(facts.smooth, "smooth material") +
                ": caustics, which paths from the camera find by chance, in mirrors and through glass as well"};
  }
  if (facts.hasSeen && facts.arriving < kMostlyHidden && facts.deltas + facts.finite > 0) {
    return {"integrator", "bdpt",
            Percent(facts.arriving) +
                " of the light that is sampled arrives where the camera looks: it comes at second hand"};
  }
  if (facts.smooth > 0)
    return {"integrator", "path",
            "smooth surfaces under lights at infinity, which paths from the camera find as they escape"};
  return {"integrator", "path",
          "nothing is smooth and " + Percent(facts.arriving) +
              " of the light that is sampled arrives where the camera looks"};
}

PlanDecision ChooseSelection(const Facts& facts, const RenderSettings& settings) {
  const size_t infinite = facts.infinite, others = facts.lights - infinite;
  if (facts.lights <= 1 && facts.patches <= 2)
    return {"light selection", "none", facts.lights == 0 ? "there is no light" : "there is a single light"};
  const char* names[] = {"uniform", "power", "tree", "exhaustive"};
  const std::string name = names[static_cast<int>(settings.lightSelection)];
  std::string of = Count(others, "light");
  if (facts.patches > facts.lights) of += " of " + std::to_string(facts.patches - infinite) + " patches";
  if (infinite > 0) of += ", " + std::to_string(infinite) + " at infinity beside";
  return {"light selection", name, of};
}

PlanDecision ChooseMerging(const Facts& facts, const std::string& integrator, const RenderScene& scene,
                           const RenderSettings& settings) {
  if (integrator == "vcm" && settings.merges) {
    char text[96];
    const double radius = FirstRadius(scene, settings);
    std::snprintf(text, sizeof text, "within %.3g of a vertex at first, a pixel as it is seen", radius);
    return {"merging", "on", settings.photons.radius > 0 ? "within the radius that is set" : text};
  }
  if (integrator == "sppm") return {"photons", "gathered", "all light but that which is sampled directly"};
  return {"merging", "off",
          facts.smooth == 0 ? "nothing is smooth: other techniques find all light" : "the integrator has none"};
}

}  // namespace

ScenePlan PlanFor(const RenderScene& scene, const RenderSettings& settings) {
  const Facts facts = FactsOf(scene, settings);
  ScenePlan plan;
  const PlanDecision chosen = ChooseIntegrator(facts);
  plan.integrator = chosen.choice;
  if (settings.integrator.empty() || settings.integrator == "auto") {
    plan.decisions.push_back(chosen);
  } else {
    plan.decisions.push_back({"integrator", settings.integrator, "as it is set; \"auto\" would be " + chosen.choice});
    if (settings.integrator != chosen.choice) plan.decisions.back().reason += ": " + chosen.reason;
  }
  const std::string integrator = plan.decisions.front().choice;
  plan.decisions.push_back(ChooseSelection(facts, settings));
  plan.decisions.push_back(ChooseMerging(facts, integrator, scene, settings));
  plan.decisions.push_back(scene.hasMotion ? PlanDecision{"motion", "on", "something moves while the shutter is open"}
                                           : PlanDecision{"motion", "off", "nothing moves: rays have no time"});
  plan.decisions.push_back(scene.camera->HasPinhole()
                               ? PlanDecision{"lens", "pinhole", "the camera has no lens: nothing is drawn for it"}
                               : PlanDecision{"lens", "sampled", "the camera has a lens"});
  plan.decisions.push_back(
      settings.learnLights
          ? PlanDecision{"learning", "on", "--learn-lights"}
          : PlanDecision{"learning", "off", "it pays where what is near is behind walls: --learn-lights"});
  return plan;
}

}  // namespace lampyr
