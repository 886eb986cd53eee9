// Spheres, disks and cylinders of the scene that emit, partial ones included: AreaLightSource on these shapes. How they
// are sampled: quadric_surface.h, surface_light.h.
#include <utility>

#include "lights/types/area_lights.h"
#include "lights/types/quadric_surface.h"
#include "lights/types/surface_light.h"

namespace lampyr {

std::unique_ptr<Light> MakeQuadricLight(LightTypeFunction type, const ParameterList& parameters,
                                        const LightBuildContext& build, const EmissionReader& readEmission,
                                        const Quadric& quadric) {
  QuadricSurface surface(quadric);
  if (build.letsRaysPass) surface.LetRaysPass();
  return std::make_unique<SurfaceLight<QuadricSurface>>(type, parameters, build, std::move(surface), readEmission);
}

}  // namespace lampyr
