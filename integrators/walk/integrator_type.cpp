#include "integrators/walk/integrator_type.h"

#include <algorithm>

namespace lampyr {

ShadowRays ShadowRaysOf(const IntegratorInput& input) {
  ShadowRays shadowRays;
  shadowRays.roulette = static_cast<float>(input.settings.Number("shadow-roulette"));
  shadowRays.threshold = static_cast<float>(input.settings.Number("shadow-threshold"));
  if (input.imagingRatio > 0) shadowRays.threshold /= input.imagingRatio;
  return shadowRays;
}

int MaxDepthOf(const Settings& settings) {
  return static_cast<int>(settings.Integer("max-depth"));
}

bool HasSmoothMaterial(const RenderScene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const auto& material) { return material && material->IsSmooth(); });
}

std::string DeltaLightsOfCaustics(const RenderScene& scene) {
  const std::vector<PlacedLight>& lights = scene.lighting->Lights();
  const auto deltas = std::count_if(lights.begin(), lights.end(),
                                    [](const PlacedLight& placed) { return IsDelta(placed.light->Kind()); });
  if (deltas == 0 || !HasSmoothMaterial(scene)) return "";
  return std::to_string(deltas) + " of " + std::to_string(lights.size());
}

std::string LightsWithoutPaths(const RenderScene& scene) {
  const std::vector<PlacedLight>& lights = scene.lighting->Lights();
  const auto count = std::count_if(lights.begin(), lights.end(),
                                   [](const PlacedLight& placed) { return !placed.light->Settings().traceLightPaths; });
  return count == 0 ? "" : std::to_string(count) + " of " + std::to_string(lights.size());
}

}  // namespace lampyr
