#include "integrators/walk/render_scene.h"

namespace lampyr {

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
