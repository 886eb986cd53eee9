// The photons that a pass gathers: those of the light paths of the pass before, in a map, and how far it looks for
// them.
#pragma once

#include <cmath>
#include <memory>

#include "integrators/photon/photon_map.h"

namespace lampyr {

// Relative to the first pass's: r_i = r_1 · i^((α - 1) / 2) ([Knaus11 eq. 15]; `pass` counts from 0).
inline double RadiusScale(uint32_t pass, double alpha) {
  return std::pow(static_cast<double>(pass) + 1, 0.5 * (alpha - 1));
}

struct PhotonPass {
  std::shared_ptr<const PhotonMap> map;
  std::shared_ptr<PhotonUse> use;  // null: nobody wants to know what the photons are good for
  float radius = 0;                // scene units
  float radiusScale = 1;           // RadiusScale of the pass, for who looks as far as a pixel is large
  double lightPaths = 1;           // that the photons come from
  uint32_t pass = 0;

  // Photons that are merged with a vertex per density (1/m²) of them: N π r².
  double MergesPerDensity() const {
    constexpr double pi = 3.14159265358979323846;
    return lightPaths * pi * static_cast<double>(radius) * static_cast<double>(radius);
  }
};

}  // namespace lampyr
