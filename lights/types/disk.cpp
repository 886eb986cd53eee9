// LightSource "disk" (UsdLux DiskLight): a disk at z = 0 that emits along -z. The texture covers the square around the
// disk and is upright as seen from the lit side: left edge at +x, upper edge at +y. Radiance in W/(m² sr).
#include "lights/types/surface_facet.h"

namespace lampyr {

LightType DiskLightType() {
  LightType type;
  type.name = "disk";
  type.help = "a disk that emits along -z";
  type.parameters = UsdLuxSurfaceParameters({{"radius", ParameterType::Float, "m", "0.5", "> 0", "of the disk"}});
  type.create = [](const ParameterList& parameters, const LightBuildContext& build) -> std::unique_ptr<Light> {
    Quadric disk;
    disk.kind = Quadric::Kind::Disk;
    disk.radius = static_cast<float>(parameters.GetFloat("radius", 0.5));
    disk.zMin = disk.zMax = 0;
    disk.flipNormals = true;
    return std::make_unique<AnalyticLight<QuadricSurface, QuadricFacet>>(
        DiskLightType, parameters, build, QuadricSurface(disk, true), Shaping::Emitter::Flat);
  };
  type.samples = UsdLuxSurfaceSamples("\"float radius\" 0.8");
  return type;
}

}  // namespace lampyr
