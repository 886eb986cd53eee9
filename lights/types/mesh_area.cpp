// AreaLightSource "mesh": any shape that can emit, with UsdLux's names (MeshLightAPI). Shaping is about -z of the
// shape's own axes. Radiance in W/(m² sr).
#include "lights/types/area_lights.h"
#include "lights/types/surface_facet.h"

namespace lampyr {

LightType MeshAreaLightType() {
  LightType type;
  type.name = "mesh";
  type.isAreaLight = true;
  type.help = "a shape that emits, with the parameters of the UsdLux lights";
  type.parameters = UsdLuxSurfaceParameters({});
  type.create = [](const ParameterList& parameters, const LightBuildContext& build) {
    const EmissionReader reader = [](const ParameterList& p, const LightBuildContext& b,
                                     const SurfaceEmission::Area& area) {
      return SurfaceEmission::ReadUsdLux(p, b, area, Shaping::Emitter::Round);
    };
    return MakeShapeLight(MeshAreaLightType, parameters, build, reader);
  };
  type.samples = UsdLuxSurfaceSamples("");
  return type;
}

}  // namespace lampyr
