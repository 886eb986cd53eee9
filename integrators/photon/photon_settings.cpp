#include "integrators/photon/photon_settings.h"

#include <algorithm>

namespace lampyr {

PhotonSettings PhotonSettingsOf(const IntegratorInput& input) {
  const Settings& settings = input.settings;
  PhotonSettings photons;
  photons.radius = settings.Number("radius");
  // Twice the scene's radius finds all photons; less than the rounding of positions finds none.
  const auto size = static_cast<double>(input.scene.lighting->SceneSphere().radius);
  if (photons.radius > 0 && size > 0) photons.radius = std::clamp(photons.radius, 1e-7 * size, 2 * size);
  photons.alpha = settings.Number("alpha");
  photons.lightPaths = static_cast<uint64_t>(std::max<int64_t>(settings.Integer("photons"), 0));
  photons.mostBytes = static_cast<uint64_t>(settings.Integer("photon-memory"));
  photons.guided = settings.IsOn("guide-photons");
  return photons;
}

}  // namespace lampyr
