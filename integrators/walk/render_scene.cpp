#include "integrators/walk/render_scene.h"

#include "geometry/medium_at.h"

namespace lampyr {

int32_t RenderScene::MediumOf(const Ray& cameraRay) const {
  if (!cameraExterior) return cameraMedium;
  return MediumAlong(*geometry, cameraRay, *cameraExterior);
}

RenderCounts& RenderCounts::operator+=(const RenderCounts& other) {
  cameraRays += other.cameraRays;
  indirectRays += other.indirectRays;
  shadowRays += other.shadowRays;
  lookups += other.lookups;
  foundPhotons += other.foundPhotons;
  timedLookups += other.timedLookups;
  lookupSeconds += other.lookupSeconds;
  droppedSamples += other.droppedSamples;
  return *this;
}

}  // namespace lampyr
