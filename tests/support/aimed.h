// A guide whose targets are known: photons of every light are aimed into two balls.
#pragma once

#include <memory>
#include <vector>

#include "lights/services/lighting_services.h"
#include "sampling/rng.h"
#include "sampling/warp.h"

namespace lampyr::test {

// The balls have `radius` and are around `center` and beside it. `lighting` must outlive the guide.
inline std::shared_ptr<const EmissionGuide> AimAt(const LightingServices& lighting, const Point3& center,
                                                  float radius) {
  std::vector<UsefulPhoton> useful;
  Rng rng(11);
  for (uint32_t light = 0; light < lighting.Lights().size(); ++light) {
    for (int i = 0; i < 200; ++i) {
      UsefulPhoton photon;
      photon.light = light;
      photon.firstHit = center + radius * SampleUniformSphere(rng.NextPoint2());
      if (i % 4 == 0) photon.firstHit += Vector3(1.5f * radius, 0, 0);
      photon.contribution = photon.secondMoment = photon.unguidedDensity = 1;
      useful.push_back(photon);
    }
  }
  return std::make_shared<const EmissionGuide>(useful, lighting.Lights(), lighting.EmissionSelector(),
                                               lighting.SceneSphere());
}

}  // namespace lampyr::test
