// Next-event estimation: lights are chosen at a vertex, sampled, and joined to it by a shadow ray. The only place that
// does so; each technique brings its weight (NextEventVisitor).
#pragma once

#include "integrators/walk/shadow_roulette.h"
#include "integrators/walk/walk.h"

namespace lampyr {

// A sample of a light at a vertex, before its shadow ray.
struct LightConnection {
  const DirectSample& direct;
  BsdfEvaluation f;  // of the vertex, towards the light
  Color value;       // unweighted contribution to the path, if nothing is in the way
};

class NextEventVisitor {
 public:
  virtual ~NextEventVisitor() = default;
  // False: this light is found otherwise.
  virtual bool Wants(uint32_t /*light*/) { return true; }
  // The weight of the sample against other techniques.
  virtual float Weigh(const LightConnection&) = 0;
  // A part of the value has arrived: the unweighted value, and what it contributes.
  virtual void Arrived(const LightConnection&, const Color& /*value*/, const Color& /*contribution*/) {}
};

struct NextEventSettings {
  PathDimensions dimensions{};
  bool bidirectional = false;  // densities of emission are wanted, too
  ShadowRays shadowRays;
};

// The sum of the weighted contributions. `index`: of the vertex on its path, from 0. `soFar`: what the sample has
// gathered before (ShadowRays).
Color SampleDirectLight(const SampleContext& context, const NextEventSettings& settings, const PathVertex& vertex,
                        int index, const Color& soFar, NextEventVisitor& visitor);

// Calls visit(selected, u) for each light that is chosen at `receiver`, with the numbers of its sample.
template <class Visit>
void ForChosenLights(const LightingServices& lighting, const Receiver& receiver, float uSelect, const Point2& u,
                     const Visit& visit) {
  LightChoices lights;
  lighting.SelectLights(receiver, uSelect, lights);
  for (int i = 0; i < lights.count; ++i) visit(lights.of[i], MovedPoint(u, i));
}

}  // namespace lampyr
