// LightSource "sphere" (UsdLux SphereLight): a sphere that emits outwards. The texture is latitude-longitude with +z at
// the top: its left edge is at +x, from where u runs towards +y, as on Shape "sphere". Radiance in W/(m² sr).
#include "lights/types/surface_facet.h"

namespace lampyr {

LightType SphereLightType() {
  LightType type;
  type.name = "sphere";
  type.help = "a sphere that emits outwards";
  type.parameters = UsdLuxSurfaceParameters({{"radius", ParameterType::Float, "m", "0.5", "> 0", "of the sphere"}});
  type.create = [](const ParameterList& parameters, const LightBuildContext& build) -> std::unique_ptr<Light> {
    Quadric sphere;
    sphere.radius = static_cast<float>(parameters.GetFloat("radius", 0.5));
    sphere.zMin = -sphere.radius;
    sphere.zMax = sphere.radius;
    return std::make_unique<AnalyticLight<QuadricSurface, QuadricFacet>>(
        SphereLightType, parameters, build, QuadricSurface(sphere), Shaping::Emitter::Round);
  };
  type.samples = UsdLuxSurfaceSamples("\"float radius\" 0.8");
  return type;
}

}  // namespace lampyr
