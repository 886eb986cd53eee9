// Random emitters of all shapes, for the tests of the light tree.
#pragma once

#include <cmath>
#include <vector>

#include "lights/selection/light_bounds.h"
#include "sampling/rng.h"
#include "sampling/warp.h"

namespace lampyr::test {

inline Point3 RandomPoint(Rng& rng, float size) {
  return size * (Point3(rng.NextFloat(), rng.NextFloat(), rng.NextFloat()) - 0.5f);
}
inline Vector3 RandomDirection(Rng& rng) {
  return SampleUniformSphere(rng.NextPoint2());
}

// Points, spots, small and large surfaces, some of them two-sided.
inline ClusterBounds RandomEmitter(Rng& rng, float size) {
  ClusterBounds emitter;
  const Point3 center = RandomPoint(rng, size);
  emitter.box.Add(center);
  emitter.axis = RandomDirection(rng);
  emitter.intensity = std::exp(4 * rng.NextFloat());
  switch (rng.NextUint32() % 4) {
    case 0:
      emitter.cosThetaO = -1;
      break;
    case 1:
      emitter.cosThetaO = 0.3f + 0.69f * rng.NextFloat();
      emitter.meanNormal = 0.01f * emitter.axis;
      break;
    default:
      emitter.cosThetaE = 0;
      emitter.twoSided = rng.NextUint32() % 4 == 0;
      emitter.box.Add(center + 0.2f * size * rng.NextFloat() * RandomDirection(rng));
      emitter.meanNormal = emitter.axis;
  }
  emitter.FillBox();
  return emitter;
}

inline std::vector<ClusterBounds> RandomEmitters(size_t count, Rng& rng, float size = 1) {
  std::vector<ClusterBounds> emitters;
  for (size_t i = 0; i < count; ++i) emitters.push_back(RandomEmitter(rng, size));
  return emitters;
}

}  // namespace lampyr::test
