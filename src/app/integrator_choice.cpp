#include "app/integrator_choice.h"

#include "base/error.h"
#include "integrators/bdpt/bdpt_integrator.h"
#include "integrators/light/light_integrator.h"
#include "integrators/path/path_integrator.h"

namespace lampyr {

const std::vector<std::string>& IntegratorNames() {
  static const std::vector<std::string> names = {"path", "light", "bdpt"};
  return names;
}

AnyIntegrator MakeIntegrator(const RenderScene& scene, const RenderSettings& settings) {
  if (settings.integrator == "path") return MakePathIntegrator(scene, {settings.maxDepth});
  if (settings.integrator == "light") return MakeLightIntegrator(scene, {settings.maxDepth});
  if (settings.integrator == "bdpt") {
    BdptSettings bdpt;
    bdpt.maxDepth = settings.maxDepth;
    bdpt.filmPixels = static_cast<double>(settings.width) * static_cast<double>(settings.height);
    return MakeBdptIntegrator(scene, bdpt);
  }
  throw Error("there is no integrator \"" + settings.integrator + "\"");
}

}  // namespace lampyr
