// LightSource "rect" (UsdLux RectLight): a rectangle width × height at z = 0 that emits along -z, with the texture
// upright as seen from there: its left side at +x, its upper side at +y. Radiance in W/(m² sr).
#include "lights/types/surface_facet.h"

namespace lampyr {

LightType RectLightType() {
  LightType type;
  type.name = "rect";
  type.help = "a rectangle that emits along -z";
  type.parameters = UsdLuxSurfaceParameters({
      {"width", ParameterType::Float, "m", "1", "> 0", "size along x"},
      {"height", ParameterType::Float, "m", "1", "> 0", "size along y"},
  });
  type.create = [](const ParameterList& parameters, const LightBuildContext& build) -> std::unique_ptr<Light> {
    const RectSurface surface(static_cast<float>(parameters.GetFloat("width", 1)),
                              static_cast<float>(parameters.GetFloat("height", 1)));
    return std::make_unique<AnalyticLight<RectSurface, RectFacet>>(RectLightType, parameters, build, surface,
                                                                   Shaping::Emitter::Flat);
  };
  type.samples = UsdLuxSurfaceSamples("\"float width\" 2 \"float height\" 0.7");
  return type;
}

}  // namespace lampyr
