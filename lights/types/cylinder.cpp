// LightSource "cylinder" (UsdLux CylinderLight): the side of a cylinder along x, without caps, that emits outwards. The
// texture is wrapped around it: its left edge is at +y, from where u runs towards +z; its upper edge is at +x. Radiance
// in W/(m² sr).
#include "lights/types/surface_facet.h"

namespace lampyr {

LightType CylinderLightType() {
  LightType type;
  type.name = "cylinder";
  type.help = "a cylinder along x, without caps, that emits outwards";
  type.parameters = UsdLuxSurfaceParameters({
      {"length", ParameterType::Float, "m", "1", "> 0", "along x"},
      {"radius", ParameterType::Float, "m", "0.5", "> 0", "of the cylinder"},
  });
  type.create = [](const ParameterList& parameters, const LightBuildContext& build) -> std::unique_ptr<Light> {
    Quadric cylinder;
    cylinder.kind = Quadric::Kind::Cylinder;
    cylinder.radius = static_cast<float>(parameters.GetFloat("radius", 0.5));
    cylinder.zMax = 0.5f * static_cast<float>(parameters.GetFloat("length", 1));
    cylinder.zMin = -cylinder.zMax;
    // The quadric's z lies along x, its x along y.
    cylinder.toRender.linear = glm::mat3(Vector3(0, 1, 0), Vector3(0, 0, 1), Vector3(1, 0, 0));
    cylinder.toObject.linear = glm::transpose(cylinder.toRender.linear);
    return std::make_unique<AnalyticLight<QuadricSurface, QuadricFacet>>(
        CylinderLightType, parameters, build, QuadricSurface(cylinder), Shaping::Emitter::Round);
  };
  type.samples = UsdLuxSurfaceSamples("\"float length\" 2 \"float radius\" 0.4");
  return type;
}

}  // namespace lampyr
