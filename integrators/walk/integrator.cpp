#include "integrators/walk/integrator.h"

#include "spectral/wavelengths.h"

namespace lampyr {

// The walk up to the first dispersion is repeated, which is short beside what follows, so that no integrator has to
// take up a walk in the middle. Random numbers are the same for each lane: they follow from the dimension alone.
Color SampleLanes(const Integrator& integrator, const Ray* ray, const SampleContext& context) {
  if (!context.scene.isSpectral) [[likely]]
    return integrator.Sample(ray, context);
  SampleContext ofLane = context;
  bool disperses = false;
  ofLane.disperses = &disperses;
  Color sum = integrator.Sample(ray, ofLane);
  if (!disperses) return sum;
  ofLane.disperses = nullptr;
  ofLane.repeatsOthers = true;
  ofLane.records = nullptr;
  for (int i = 1; i < Wavelengths::kLanes; ++i) {
    ofLane.lane = (context.lane + i) % Wavelengths::kLanes;
    sum += integrator.Sample(ray, ofLane);
  }
  return sum;
}

}  // namespace lampyr
