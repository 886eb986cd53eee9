#include "render/analysis/integrator_hints.h"

#include <algorithm>

#include "render/settings/integrator_choice.h"

namespace lampyr {

std::vector<std::string> IntegratorHints(const RenderScene& scene, const std::string& integrator) {
  std::vector<std::string> hints;
  const std::vector<PlacedLight>& lights = scene.lighting->Lights();
  const auto isBackground = [](const PlacedLight& placed) {
    return placed.light->Kind() == LightKind::Infinite && placed.light->Settings().cameraVisible;
  };
  if (integrator == "light" && std::any_of(lights.begin(), lights.end(), isBackground)) {
    hints.push_back(
        "no path from a light behind everything can be joined to the camera, so the background stays black; "
        "--integrator path and bdpt show it");
  }
  if (!HasSmoothMaterial(scene)) return hints;
  const auto deltas = std::count_if(lights.begin(), lights.end(),
                                    [](const PlacedLight& placed) { return IsDelta(placed.light->Kind()); });
  if (integrator == "path" && deltas > 0) {
    hints.push_back("no path from the camera can hit a light without extent (" + std::to_string(deltas) + " of " +
                    std::to_string(lights.size()) +
                    " lights: point, spot, distant and the like), so what they send through smooth glass or off "
                    "mirrors is missing; --integrator bdpt finds it");
  }
  if (integrator == "bdpt" && deltas > 0) {
    hints.push_back("light without extent (" + std::to_string(deltas) + " of " + std::to_string(lights.size()) +
                    " lights) that comes through smooth glass or off mirrors and is seen through or in them again "
                    "cannot be found by joining paths; --integrator vcm and sppm find it");
  }
  if (integrator == "light") {
    hints.push_back(
        "no path from a light can be joined to the camera at a mirror or smooth glass, so these stay "
        "black; --integrator bdpt shows them");
  }
  return hints;
}

}  // namespace lampyr
