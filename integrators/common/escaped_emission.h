// The background: what a camera ray sees that meets nothing.
#pragma once

#include "film/layer_sample.h"
#include "lights/services/lighting_services.h"

namespace lampyr {

// All lights at infinity that it sees, times `throughput`: what is left of them on their way. `layers`: see
// SampleSinks.
inline Color EscapedEmissionForCamera(const LightingServices& lighting, const Ray& ray, const Color& throughput,
                                      LayerSample* layers) {
  Color sum;
  for (size_t i = 0; i < lighting.InfiniteCount(); ++i) {
    const Color seen = lighting.EscapedEmissionForCamera(i, ray);
    sum += seen;
    if (layers) layers->Add(lighting.GroupOfInfinite(i), throughput * seen);
  }
  return throughput * sum;
}

}  // namespace lampyr
