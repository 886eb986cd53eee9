#include "integrators/walk/render_scene.h"

#include "geometry/medium_at.h"

namespace lampyr {

int32_t RenderScene::MediumOf(const Ray& cameraRay) const {
  if (!cameraExterior) return cameraMedium;
  return MediumAlong(*geometry, cameraRay, *cameraExterior, cameraMedium);
}

int32_t RenderScene::MediumOfLight(uint32_t light, bool fromBehind, const Ray& ray) const {
  if (lightMedia.empty()) return kVacuum;
  const int32_t medium = fromBehind ? lightBackMedia[light] : lightMedia[light];
  return lightStartsVary[light] ? MediumAlong(*geometry, ray, exterior, medium) : medium;
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

RenderScene RenderScene::AtWavelengths(const std::shared_ptr<const Wavelengths>& at,
                                       const std::vector<std::shared_ptr<const Material>>& afterWide) const {
  RenderScene tuned = *this;
  tuned.wavelengths = at;
  tuned.materials = MaterialsAt(at, materials);
  tuned.tunedAfterWide = MaterialsAt(at, afterWide);
  tuned.lighting = std::make_shared<const LightingServices>(lighting->AtWavelengths(at));
  for (auto& medium : tuned.media) {
    if (medium) medium = medium->AtWavelengths(medium, at);
  }
  return tuned;
}

}  // namespace lampyr
