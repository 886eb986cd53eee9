// Next-event estimation: lights are selected at a vertex, sampled, and connected to it by a shadow ray. Shared by all
// integrators; each supplies the MIS weight (NextEventVisitor).
#pragma once

#include "integrators/walk/shadow_roulette.h"
#include "integrators/walk/walk.h"

namespace lampyr {

// A sample of a light at a vertex, before its shadow ray.
struct LightConnection {
  const DirectSample& direct;
  BsdfEvaluation f;       // BSDF of the vertex, towards the light
  Color value;            // contribution of the path, before MIS weight and transmittance
  EdgeFactors factors{};  // of the edge from the vertex to the light, by participating media

  // The event at `vertex`.
  ScatteringParts Parts(const Vertex& vertex) const {
    return PartsOf(vertex, direct.sample->direction, false, f.diffuse * direct.sample->diffuse,
                   f.specular * direct.sample->specular);
  }
};

class NextEventVisitor {
 public:
  virtual ~NextEventVisitor() = default;
  // False: skip this light, because it is found by other techniques.
  virtual bool Wants(uint32_t /*light*/) { return true; }
  // MIS weight of the sample.
  virtual float Weigh(const LightConnection&) = 0;
  // The shadow ray was not fully occluded. `value` includes the transmittance but not the MIS weight; `contribution` is
  // what is added to the estimate.
  virtual void Arrived(const LightConnection&, const Color& /*value*/, const Color& /*contribution*/) {}
};

struct NextEventSettings {
  PathDimensions dimensions{};
  bool bidirectional = false;  // evaluate the densities of emission, too
  ShadowRays shadowRays;
  bool learns = true;  // results are recorded for learned selection
};

// Direct light scattered at `vertex`: the sum of the weighted contributions. `index`: of the vertex on its path, from
// 0. `soFar`: radiance that the sample has gathered so far, for the roulette of shadow rays.
Color SampleDirectLight(const SampleContext& context, const NextEventSettings& settings, const PathVertex& vertex,
                        int index, const Color& soFar, NextEventVisitor& visitor);

// The contribution of one light that is selected already; `u` samples it.
Color SampleLight(const SampleContext& context, const NextEventSettings& settings, const PathVertex& vertex,
                  const SelectedLight& light, const Point2& u, const Color& soFar, NextEventVisitor& visitor);

// Calls visit(selected, u) for each light selected at `receiver`; u: the numbers to sample that light with.
template <class Visit>
void ForChosenLights(const LightingServices& lighting, const Receiver& receiver, float uSelect, const Point2& u,
                     const Visit& visit) {
  LightChoices lights;
  lighting.SelectLights(receiver, uSelect, lights);
  for (int i = 0; i < lights.count; ++i) visit(lights.of[i], MovedPoint(u, i));
}

}  // namespace lampyr
